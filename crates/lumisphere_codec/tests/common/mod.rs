//! Test inputs that are not part of the project.

use std::path::{Path, PathBuf};

/// The folder with test inputs, or `None` with a loud line if there is none.
pub(crate) fn data(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("LUMISPHERE_DATA").map(PathBuf::from);
    if folder.is_none() {
        #[allow(clippy::print_stderr)]
        {
            eprintln!("SKIPPED {test}: LUMISPHERE_DATA is not set");
        }
    }
    folder
}

/// All files of a folder, sorted by name.
#[allow(dead_code)]
pub(crate) fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.retain(|f| f.is_file());
    files.sort();
    assert!(!files.is_empty(), "{folder:?} is empty");
    files
}
