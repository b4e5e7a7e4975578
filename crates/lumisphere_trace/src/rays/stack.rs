//! Subtrees that wait for their turn, nearest on top.

use super::node::Child;

/// Entries held without allocation; deeper trees take some.
pub(super) const INLINE: usize = 32;

/// Distance at which a ray enters a subtree, and the subtree: one integer that sorts by distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Entry(u64);

impl Entry {
    /// `near` is not negative, so its bits sort as it does.
    #[inline(always)]
    pub(super) fn new(near: f32, child: Child) -> Self {
        Self(u64::from(near.to_bits()) << 32 | u64::from(child.0))
    }

    #[inline(always)]
    pub(super) fn near(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    pub(super) fn child(self) -> Child {
        Child(self.0 as u32)
    }
}

/// A stack on the machine's stack; what does not fit goes to the heap.
pub(super) struct Stack {
    entries: [Entry; INLINE],
    len: usize,
    spill: Vec<Entry>,
}

impl Stack {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self { entries: [Entry(0); INLINE], len: 0, spill: Vec::new() }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, entry: Entry) {
        match self.entries.get_mut(self.len) {
            Some(place) => {
                *place = entry;
                self.len += 1;
            }
            None => self.spill.push(entry),
        }
    }

    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<Entry> {
        if self.len == INLINE && !self.spill.is_empty() {
            return self.spill.pop();
        }
        self.len = self.len.checked_sub(1)?;
        self.entries.get(self.len).copied()
    }
}
