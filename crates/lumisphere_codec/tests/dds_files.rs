//! DDS files that other programs wrote.
#![allow(clippy::unwrap_used)]

mod common;

use lumisphere_codec::{Limits, decode_texture};

#[test]
fn bad_files_are_refused_in_words() {
    let Some(data) = common::data("bad_files_are_refused_in_words") else { return };
    for path in common::files(&data.join("bad/dds")) {
        let error = decode_texture(&std::fs::read(&path).unwrap(), &Limits::default()).unwrap_err().to_string();
        // 16-bit RGB by bit masks.
        assert!(error.contains("DDS: a pixel format with flags"), "{path:?}: {error}");
    }
}
