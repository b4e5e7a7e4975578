//! Our KTX1 against the files that cmgen writes.
#![allow(clippy::unwrap_used)]

mod common;

use lumisphere_codec::ktx1::{decode, encode};
use lumisphere_codec::{Faces, LevelTexels, Limits, TexelFormat, Texture};

fn word(file: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(file[at..at + 4].try_into().unwrap())
}

/// Where the key/value data ends and level 0 starts.
fn levels_start(file: &[u8]) -> usize {
    64 + word(file, 60) as usize
}

#[test]
fn cubes_of_cmgen_come_back_byte_for_byte() {
    let Some(data) = common::data("cubes_of_cmgen_come_back_byte_for_byte") else { return };
    let folder = data.join("baked/B_lightroom_filament");
    for (name, side, level_count) in [("default_env_ibl.ktx", 256, 5), ("default_env_skybox_tiny.ktx", 64, 1)] {
        let file = std::fs::read(folder.join(name)).unwrap();
        let read = decode(&file, &Limits::default()).unwrap();
        assert_eq!((read.width, read.height, read.faces), (side, side, Faces::Cube));
        assert_eq!((read.format, read.levels.len()), (TexelFormat::B10g11r11, level_count));
        let rgb: Vec<Vec<[f32; 3]>> =
            read.levels.iter().map(|l| l.iter().map(|t| [t[0], t[1], t[2]]).collect()).collect();
        let levels = rgb.iter().map(|l| LevelTexels::Rgb(l)).collect();
        let texture = Texture { width: side, height: side, faces: Faces::Cube, levels };
        let metadata: Vec<(&str, &str)> =
            read.metadata.iter().map(|(k, v)| (k.as_str(), std::str::from_utf8(v).unwrap())).collect();
        let ours = encode(&texture, read.format, &metadata).unwrap().bytes;

        // Every level with its size, to the end of the file.
        assert_eq!(ours[levels_start(&ours)..], file[levels_start(&file)..], "{name}");
        // Of the header, what cmgen has wrong: type, its size, format of the base; and the length of the metadata.
        let differing: Vec<(usize, u32, u32)> = (0..64)
            .step_by(4)
            .map(|at| (at, word(&ours, at), word(&file, at)))
            .filter(|(_, ours, theirs)| ours != theirs)
            .collect();
        let lengths = (60, word(&ours, 60), word(&file, 60));
        assert_eq!(differing, [(16, 0x8c3b, 0x8c3a), (20, 4, 1), (32, 0x1907, 0x8c3a), lengths], "{name}");
    }
}

/// As Filament's loader for the web does: parts between single white-space characters, each a number to its first
/// character that is none.
fn numbers(text: &str) -> Vec<f64> {
    text.splitn(27, char::is_whitespace).map(|n| n.trim_end_matches('\0').trim_end().parse().unwrap()).collect()
}

#[test]
fn spherical_harmonics_stay_readable() {
    let Some(data) = common::data("spherical_harmonics_stay_readable") else { return };
    let file = std::fs::read(data.join("baked/B_lightroom_filament/default_env_ibl.ktx")).unwrap();
    let read = decode(&file, &Limits::default()).unwrap();
    let theirs = numbers(read.text("sh").unwrap());
    assert_eq!((theirs.len(), theirs[0], theirs[26]), (27, 0.785783, -0.00674966));

    let texels = vec![[1.0; 3]; 6];
    let texture = Texture { width: 1, height: 1, faces: Faces::Cube, levels: vec![LevelTexels::Rgb(&texels)] };
    let ours = encode(&texture, read.format, &[("sh", read.text("sh").unwrap())]).unwrap().bytes;
    // The raw value in the file, with the NUL that Filament hands on.
    let at = ours.windows(3).position(|w| w == b"sh\0").unwrap();
    let value = &ours[at + 3..at + word(&ours, at - 4) as usize];
    assert_eq!(numbers(std::str::from_utf8(value).unwrap()), theirs);
}
