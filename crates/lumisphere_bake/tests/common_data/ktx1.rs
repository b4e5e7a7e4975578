//! Just enough of KTX 1 to read the cubes that cmgen writes.
//!
//! Khronos, "KTX File Format Specification", version 1: a header of 64 bytes, key/value pairs, then for each level the
//! size of one face and six faces. Little-endian files only.

use lumisphere_codec::pack::unpack_r11g11b10;
use lumisphere_image::Environment;
use lumisphere_sphere::{Grid, Projection};

const MAGIC: [u8; 12] = [0xab, b'K', b'T', b'X', b' ', b'1', b'1', 0xbb, 0x0d, 0x0a, 0x1a, 0x0a];
/// GL_R11F_G11F_B10F.
const INTERNAL_FORMAT: usize = 0x8c3a;

pub(crate) struct CubeFile {
    pub(crate) levels: Vec<Environment>,
    pub(crate) values: Vec<(String, String)>,
}

impl CubeFile {
    pub(crate) fn parse(bytes: &[u8]) -> Self {
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!(bytes[..12], MAGIC);
        assert_eq!(word(12), 0x0403_0201, "byte order");
        assert_eq!(word(28), INTERNAL_FORMAT);
        let (size, faces, level_count, pairs) = (word(36), word(52), word(56), word(60));
        assert_eq!((word(40), faces), (size, 6));
        let mut at = 64;
        let mut values = Vec::new();
        while at < 64 + pairs {
            let pair = &bytes[at + 4..at + 4 + word(at)];
            let split = pair.iter().position(|b| *b == 0).unwrap();
            let text = |b: &[u8]| String::from_utf8_lossy(b).trim_end_matches('\0').to_owned();
            values.push((text(&pair[..split]), text(&pair[split + 1..])));
            at += 4 + word(at).next_multiple_of(4);
        }
        let mut levels = Vec::new();
        for level in 0..level_count {
            let n = size >> level;
            assert_eq!(word(at), 4 * n * n, "bytes of a face of level {level}");
            let texels = (0..6 * n * n).map(|i| unpack_r11g11b10(word(at + 4 + 4 * i) as u32)).collect();
            levels.push(Environment::new(Grid::new(Projection::Cube, n, n).unwrap(), texels).unwrap());
            at += 4 + 24 * n * n;
        }
        assert_eq!(at, bytes.len());
        Self { levels, values }
    }

    /// Lines of three numbers.
    pub(crate) fn colours(&self, key: &str) -> Vec<[f64; 3]> {
        let text = &self.values.iter().find(|(k, _)| k == key).unwrap().1;
        let line = |l: &str| -> [f64; 3] {
            let numbers: Vec<f64> = l.split_whitespace().map(|n| n.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        };
        text.lines().filter(|l| !l.trim().is_empty()).map(line).collect()
    }
}
