//! Textures for the containers that hold them in any format.

use super::{Seeds, texels};
use lumisphere_codec::{CodecError, Encoded, Faces, LevelTexels, TexelFormat, Texture};

/// A cube with levels and a picture of odd sides, in each format that `write` takes.
pub(super) fn plain(write: impl Fn(&Texture<'_>, TexelFormat) -> Result<Encoded, CodecError>) -> Seeds {
    let mut seeds = Vec::new();
    for format in TexelFormat::ALL {
        for (name, file) in [("cube", cube(format, |t| write(t, format))), ("flat", flat(format, |t| write(t, format)))]
        {
            seeds.extend(file.ok().map(|f| (format!("{format:?}-{name}").to_lowercase(), f.bytes)));
        }
    }
    seeds
}

/// 2 x 2 with two levels.
fn cube<T>(format: TexelFormat, write: impl FnOnce(&Texture<'_>) -> T) -> T {
    with_levels((2, 2), Faces::Cube, 2, format, write)
}

/// 5 x 3 with three levels.
pub(super) fn flat<T>(format: TexelFormat, write: impl FnOnce(&Texture<'_>) -> T) -> T {
    with_levels((5, 3), Faces::One, 3, format, write)
}

fn with_levels<T>(
    (width, height): (usize, usize),
    faces: Faces,
    count: usize,
    format: TexelFormat,
    write: impl FnOnce(&Texture<'_>) -> T,
) -> T {
    let levels: Vec<Vec<[f32; 3]>> =
        (0..count).map(|k| texels(faces.count() * (width >> k).max(1) * (height >> k).max(1))).collect();
    let rg: Vec<Vec<[f32; 2]>> = levels.iter().map(|l| l.iter().map(|[r, g, _]| [*r, *g]).collect()).collect();
    let levels = match format.is_rgb() {
        true => levels.iter().map(|l| LevelTexels::Rgb(l)).collect(),
        false => rg.iter().map(|l| LevelTexels::Rg(l)).collect(),
    };
    write(&Texture { width, height, faces, levels })
}

/// A row of `Rgba32F` texels whose bits are BC6H blocks, one of each mode and a reserved one: a header of `BLOCKS` x 1
/// texels that is changed to 4 `BLOCKS` x 4 and to BC6H makes it a file of those.
pub(super) fn blocks<T>(write: impl FnOnce(&Texture<'_>) -> T) -> T {
    let texels: Vec<[f32; 4]> = MODES
        .iter()
        .enumerate()
        .map(|(i, mode)| {
            let mut bytes: [u8; 16] = std::array::from_fn(|j| ((16 * i + j) * 73 + j * j * 29) as u8);
            // Modes 0 and 1 have two bits, which the other three leave alone here.
            bytes[0] = bytes[0] & !31 | mode;
            std::array::from_fn(|c| f32::from_le_bytes(std::array::from_fn(|b| bytes[4 * c + b])))
        })
        .collect();
    write(&Texture { width: BLOCKS, height: 1, faces: Faces::One, levels: vec![LevelTexels::Rgba(&texels)] })
}

/// The lower five bits of a block (Direct3D 11, "BC6H Format").
const MODES: [u8; 15] = [0, 1, 2, 6, 10, 14, 18, 22, 26, 30, 3, 7, 11, 15, 19];
pub(super) const BLOCKS: usize = MODES.len();

/// A copy of a file with words changed, little-endian: offsets and values.
pub(super) fn patched(file: &[u8], words: &[(usize, u32)]) -> Vec<u8> {
    let mut file = file.to_vec();
    for (at, value) in words {
        file[*at..*at + 4].copy_from_slice(&value.to_le_bytes());
    }
    file
}
