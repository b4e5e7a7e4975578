//! Replays what fuzzing found: `fuzz/corpus/<reader>` holds one input for each way through a reader, and
//! `fuzz/regressions/<reader>` the inputs that once broke it, which it must refuse.
//!
//! The targets in `fuzz/` assert more and need a nightly compiler; this runs everywhere.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

#[allow(dead_code)]
mod common;
use lumisphere_codec::{CodecError, DecodedTexture, Limits, dds, env, exr, hdr, ktx1, ktx2, png};
use std::path::{Path, PathBuf};

/// That of the targets.
const LIMITS: Limits = Limits { max_bytes: 4 << 20 };

fn folder(kind: &str, reader: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz").join(kind).join(reader)
}

/// Reads the whole corpus of a reader: `decode` gives a texel count or an error. There must be both.
fn replay(reader: &str, decode: impl Fn(&[u8]) -> Result<usize, CodecError>) {
    let (mut read, mut refused) = (0, 0);
    for path in common::files(&folder("corpus", reader)) {
        match decode(&std::fs::read(&path).unwrap()) {
            Ok(texels) => {
                // 12 is the smallest texel of any reader.
                assert!(texels > 0 && texels as u64 * 12 <= LIMITS.max_bytes, "{path:?}: {texels} texels");
                read += 1;
            }
            Err(_) => refused += 1,
        }
    }
    eprintln!("{reader}: {read} read, {refused} refused");
    assert!(read > 0 && refused > 0, "{reader}: {read} read, {refused} refused");
    for path in common::files(&folder("regressions", reader)) {
        assert!(decode(&std::fs::read(&path).unwrap()).is_err(), "{path:?}");
    }
}

#[test]
fn hdr() {
    replay("hdr", |bytes| hdr::decode(bytes, &LIMITS).map(|p| p.texels.len()));
}

#[test]
fn exr() {
    replay("exr", |bytes| exr::decode(bytes, &LIMITS).map(|p| p.texels.len()));
}

#[test]
fn png() {
    replay("png", |bytes| png::decode(bytes, &LIMITS).map(|p| p.texels.len()));
}

/// Texels of all levels.
fn texel_count(texture: DecodedTexture) -> usize {
    texture.levels.iter().map(Vec::len).sum()
}

#[test]
fn ktx1() {
    replay("ktx1", |bytes| ktx1::decode(bytes, &LIMITS).map(texel_count));
}

#[test]
fn ktx2() {
    replay("ktx2", |bytes| ktx2::decode(bytes, &LIMITS).map(texel_count));
}

#[test]
fn dds() {
    replay("dds", |bytes| dds::decode(bytes, &LIMITS).map(texel_count));
}

#[test]
fn env() {
    replay("env", |bytes| env::decode(bytes, &LIMITS).map(|file| texel_count(file.texture)));
}
