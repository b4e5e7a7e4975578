//! `cargo run --example keep -- NAME FOLDER`: replaces the corpus of a reader by small files of a folder.
//!
//! Seeds stay. Chunks of PNG files, on their own or inside of others, get the right check sums, which the fuzzer does not
//! need and the reader does.

#[path = "../seeds/crc.rs"]
mod crc;

use std::path::{Path, PathBuf};

/// Bytes of a reader's corpus, seeds included.
const LARGEST: usize = 200_000;
/// Files of it, seeds not included; of more, evenly many of all sizes are taken.
const MOST: usize = 450;

fn main() -> std::io::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, folder] = arguments.as_slice() else { panic!("usage: keep NAME FOLDER") };
    let corpus = Path::new("corpus").join(name);
    let mut size = 0;
    for path in files(&corpus)? {
        if path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("seed-")) {
            size += std::fs::read(&path)?.len();
        } else {
            std::fs::remove_file(&path)?;
        }
    }
    let mut found = files(Path::new(folder))?
        .into_iter()
        .map(|p| Ok((std::fs::read(&p)?, p)))
        .collect::<std::io::Result<Vec<_>>>()?;
    found.sort_by_key(|(bytes, path)| (bytes.len(), path.clone()));
    let step = found.len().div_ceil(MOST).max(1);
    for (mut bytes, path) in found.into_iter().step_by(step) {
        size += bytes.len();
        if size > LARGEST {
            break;
        }
        (0..bytes.len()).for_each(|at| correct_chunks(&mut bytes[at..]));
        std::fs::write(corpus.join(path.file_name().expect("a file has a name")), bytes)?;
    }
    Ok(())
}

fn files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect()
}

/// Gives each whole chunk of a PNG file its check sum, if one starts here.
fn correct_chunks(bytes: &mut [u8]) {
    if !bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        return;
    }
    let mut at = 8;
    while let Some(length) =
        bytes.get(at..).and_then(|rest| rest.first_chunk()).map(|b| u32::from_be_bytes(*b) as usize)
    {
        let end = at + 8 + length;
        if bytes.len() < end + 4 {
            return;
        }
        let crc = crc::crc32(&bytes[at + 4..end]);
        bytes[end..end + 4].copy_from_slice(&crc.to_be_bytes());
        at = end + 4;
    }
}
