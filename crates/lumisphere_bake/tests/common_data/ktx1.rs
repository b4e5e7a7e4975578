//! The cubes that cmgen writes, with their keys.

use lumisphere_codec::{DecodedTexture, Limits, ktx1};
use lumisphere_image::Environment;
use lumisphere_sphere::{Grid, Projection};

pub(crate) struct CubeFile {
    pub(crate) levels: Vec<Environment>,
    texture: DecodedTexture,
}

impl CubeFile {
    pub(crate) fn parse(bytes: &[u8]) -> Self {
        let mut texture = ktx1::decode(bytes, &Limits::default()).unwrap();
        let level = |(lod, texels): (usize, Vec<[f32; 4]>)| {
            let n = texture.width >> lod;
            let rgb = texels.into_iter().map(|[r, g, b, _]| [r, g, b]).collect();
            Environment::new(Grid::new(Projection::Cube, n, n).unwrap(), rgb).unwrap()
        };
        let levels = std::mem::take(&mut texture.levels).into_iter().enumerate().map(level).collect();
        Self { levels, texture }
    }

    /// Lines of three numbers.
    pub(crate) fn colours(&self, key: &str) -> Vec<[f64; 3]> {
        let line = |l: &str| -> [f64; 3] {
            let numbers: Vec<f64> = l.split_whitespace().map(|n| n.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        };
        self.texture.text(key).unwrap().lines().filter(|l| !l.trim().is_empty()).map(line).collect()
    }
}
