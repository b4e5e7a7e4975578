//! What a check of ours found.

/// A line on what was looked at, and a sentence for each thing that is wrong.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Findings {
    pub summary: String,
    pub faults: Vec<String>,
}
