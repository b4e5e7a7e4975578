//! What a reader left out, repaired or replaced.

/// One thing that the scene holds otherwise than its file says, and how often.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// In words: "KHR_materials_iridescence is ignored".
    pub text: String,
    /// How often it happened, at least 1.
    pub count: usize,
}

/// Adds a note; equal ones are counted.
pub(crate) fn note(notes: &mut Vec<Note>, text: impl Into<String>) {
    let text = text.into();
    match notes.iter_mut().find(|n| n.text == text) {
        Some(known) => known.count += 1,
        None => notes.push(Note { text, count: 1 }),
    }
}
