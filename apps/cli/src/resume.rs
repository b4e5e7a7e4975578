//! Whether a bake is there already.

use crate::record::Record;
use sha2::{Digest, Sha256};
use std::path::Path;

/// One digest of several texts; their lengths keep them apart.
pub(crate) fn digest(parts: &[&str]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update(part.len().to_le_bytes());
        hash.update(part.as_bytes());
    }
    hex(hash.finalize().as_slice())
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Of a file.
pub(crate) fn digest_of_bytes(bytes: &[u8]) -> String {
    hex(Sha256::digest(bytes).as_slice())
}

/// Whether the folder's record has this digest and all files that it lists are there in their size.
pub(crate) fn is_done(folder: &Path, digest: &str) -> bool {
    let Ok(record) = Record::read(folder) else { return false };
    let there = |(name, file): (&String, &crate::record::FileRecord)| {
        std::fs::metadata(folder.join(name)).is_ok_and(|m| m.is_file() && m.len() == file.bytes as u64)
    };
    record.digest == digest && record.files.iter().all(there)
}

#[cfg(test)]
mod tests {
    use super::digest;

    #[test]
    fn texts_do_not_run_together() {
        assert_ne!(digest(&["ab", "c"]), digest(&["a", "bc"]));
        assert_eq!(digest(&["ab", "c"]), digest(&["ab", "c"]));
    }
}
