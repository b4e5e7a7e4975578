//! What a writer returns.

/// A finished file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Encoded {
    /// The whole file.
    pub bytes: Vec<u8>,
    /// Values that the format cannot hold and that were replaced: NaN by 0, a negative value by 0 where the format has
    /// no sign, a value that rounds beyond the largest one by the largest one.
    pub clamped: usize,
}
