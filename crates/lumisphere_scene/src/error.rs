//! What can be wrong with a scene.

/// Whatever a resolver of references reports.
pub type ResolveError = Box<dyn std::error::Error + Send + Sync>;

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A file that is no JSON, or not the JSON of a glTF.
    #[error("the glTF's JSON cannot be read: {message}")]
    Json {
        /// What the parser says, with line and column.
        message: String,
    },
    /// A value that cannot be.
    #[error("{what} is {found}, expected {expected}")]
    Invalid {
        /// What it is and where: "accessor 3: componentType".
        what: String,
        /// What is there.
        found: String,
        /// What may be there.
        expected: String,
    },
    /// A reference to something that is not there.
    #[error("{what} refers to {target} {found}, expected below {count}")]
    OutOfRange {
        /// What refers.
        what: String,
        /// The kind of thing referred to.
        target: &'static str,
        /// The index found.
        found: u64,
        /// How many there are.
        count: usize,
    },
    /// More memory than allowed.
    #[error("{what} needs {needed} bytes, {left} of the limit of {limit} are left")]
    TooLarge {
        /// What asks for it.
        what: String,
        /// Bytes asked for.
        needed: u64,
        /// Bytes that are left.
        left: u64,
        /// The limit of the whole scene.
        limit: u64,
    },
    /// A file that cannot be shown without something we do not have.
    #[error("the file requires the extension {found}, expected none but {known}")]
    RequiredExtension {
        /// The extension.
        found: String,
        /// Those that are read.
        known: String,
    },
    /// A file beside the scene that the resolver did not find.
    #[error("{what}: cannot read {uri:?}")]
    Unresolved {
        /// What refers to it.
        what: String,
        /// The reference, percent-decoded.
        uri: String,
        /// Why.
        source: ResolveError,
    },
    /// A picture that cannot be decoded.
    #[error("{what} cannot be decoded: {message}")]
    Picture {
        /// Which picture.
        what: String,
        /// What the decoder says.
        message: String,
    },
    /// A damaged OBJ file.
    #[error("the OBJ file cannot be read: {message}")]
    Obj {
        /// What the reader says.
        message: String,
    },
}

impl SceneError {
    /// A value that cannot be.
    pub(crate) fn invalid(what: impl Into<String>, found: impl ToString, expected: impl Into<String>) -> Self {
        Self::Invalid { what: what.into(), found: found.to_string(), expected: expected.into() }
    }
}

/// The item of an index that a file gives.
pub(crate) fn item<'a, T>(
    items: &'a [T],
    index: usize,
    what: impl FnOnce() -> String,
    target: &'static str,
) -> Result<&'a T, SceneError> {
    let out_of_range = || SceneError::OutOfRange { what: what(), target, found: index as u64, count: items.len() };
    items.get(index).ok_or_else(out_of_range)
}
