//! How much memory a scene may ask for.

use crate::SceneError;

/// What a reader may allocate for a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of vertices, indices, texels, buffers and nodes together. Short-lived working memory comes on top: up to some
    /// 200 bytes a triangle while tangents are made, and a second copy of the picture that is being decoded.
    pub max_bytes: u64,
}

impl Default for Limits {
    /// 1 GiB.
    fn default() -> Self {
        Self { max_bytes: 1 << 30 }
    }
}

/// What is left of [`Limits`].
#[derive(Debug)]
pub(crate) struct Budget {
    left: u64,
    limit: u64,
}

impl Budget {
    pub(crate) fn new(limits: &Limits) -> Self {
        Self { left: limits.max_bytes, limit: limits.max_bytes }
    }

    pub(crate) fn left(&self) -> u64 {
        self.left
    }

    /// Takes `count` things of `size` bytes before they are allocated.
    pub(crate) fn take(&mut self, what: impl FnOnce() -> String, count: u64, size: usize) -> Result<(), SceneError> {
        let needed = count.saturating_mul(size as u64);
        match self.left.checked_sub(needed) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(SceneError::TooLarge { what: what(), needed, left: self.left, limit: self.limit }),
        }
    }
}
