//! What the texels of a file can hold: how far a bake may be off because of its format alone.

use anyhow::{Result, bail};
use lumisphere::image::{Environment, Rgb};
use lumisphere_codec::ktx2::{self, Supercompression};
use lumisphere_codec::{Faces, LevelTexels, Limits, TexelFormat, Texture, env, hdr, pack};

/// How texels are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StoredTexels {
    /// In the texel format of a texture.
    Texture(TexelFormat),
    /// 8 bits with a shared exponent, in a Radiance picture.
    Rgbe,
    /// Half floats, in an OpenEXR picture.
    Half,
    /// Floats, in an OpenEXR picture.
    Float,
}

/// How a format's own error is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FormatError {
    /// From each texel by itself.
    Texel,
    /// By writing and reading all of a level: texels of a block share bits.
    Level(TexelFormat),
    /// The encoder is not in this build: [`STATED_BLOCK_ERROR`].
    Stated,
}

/// Relative RMS that is allowed to blocks which this build cannot write. Intel's encoder leaves 1.3 % of the 128² chain of
/// `builtin:studio` in BC6H (`lumisphere formats --size 128`).
pub(crate) const STATED_BLOCK_ERROR: f64 = 0.03;

impl StoredTexels {
    /// What storing makes of a texel, where texels are stored by themselves; other formats leave it as it is.
    pub(crate) fn quantise(self, texel: Rgb) -> Rgb {
        let half = |c: f32| pack::unpack_f16(pack::pack_f16(c));
        match self {
            Self::Texture(TexelFormat::Rgba16F | TexelFormat::Rgb16F) | Self::Half => texel.map(half),
            Self::Texture(TexelFormat::Rgb9e5) => pack::unpack_rgb9e5(pack::pack_rgb9e5(texel)),
            Self::Texture(TexelFormat::B10g11r11) => pack::unpack_r11g11b10(pack::pack_r11g11b10(texel)),
            Self::Rgbe => rgbe(texel).unwrap_or(texel),
            Self::Texture(_) | Self::Float => texel,
        }
    }

    /// How the format's own error is found.
    pub(crate) fn error(self) -> FormatError {
        match self {
            Self::Texture(format @ (TexelFormat::Bc6hUfloat | TexelFormat::UastcHdr4x4 | TexelFormat::Rgbd8)) => {
                if through(&one_texel_cube(), format).is_ok() {
                    FormatError::Level(format)
                } else {
                    FormatError::Stated
                }
            }
            _ => FormatError::Texel,
        }
    }

    /// For people.
    pub(crate) fn name(self) -> String {
        match self {
            Self::Texture(format) => format!("{format:?}"),
            Self::Rgbe => "Rgbe".to_owned(),
            Self::Half => "half floats".to_owned(),
            Self::Float => "floats".to_owned(),
        }
    }
}

fn rgbe(texel: Rgb) -> Option<Rgb> {
    let file = hdr::encode(1, 1, &[texel]).ok()?;
    hdr::decode(&file.bytes, &Limits::default()).ok()?.texels.first().copied()
}

fn one_texel_cube() -> [Vec<Rgb>; 1] {
    [vec![[1.0; 3]; 6]]
}

/// Levels of a cube (texels of each, down from a power of two) as a file of the format gives them back.
pub(crate) fn through(levels: &[Vec<Rgb>], format: TexelFormat) -> Result<Vec<Vec<Rgb>>> {
    let Some(first) = levels.first() else { bail!("found no level, expected one") };
    let size = (first.len() / 6).isqrt();
    let rgb = levels.iter().map(|level| LevelTexels::Rgb(level)).collect();
    let texture = Texture { width: size, height: size, faces: Faces::Cube, levels: rgb };
    let limits = Limits { max_bytes: u64::MAX };
    let decoded = if format == TexelFormat::Rgbd8 {
        env::decode(&env::encode(&texture, None, 1.0)?.bytes, &limits)?.texture
    } else {
        ktx2::decode(&ktx2::encode(&texture, format, Supercompression::None, &[])?.bytes, &limits)?
    };
    Ok(decoded.levels.into_iter().map(|l| l.into_iter().map(|[r, g, b, _]| [r, g, b]).collect()).collect())
}

/// [`through`] for levels over the sphere. `.env` files always go down to one texel: what is missing is made up and
/// taken away again.
pub(crate) fn levels_through(levels: &[Environment], format: TexelFormat) -> Result<Vec<Environment>> {
    let mut texels: Vec<Vec<Rgb>> = levels.iter().map(|level| level.texels().to_vec()).collect();
    if format == TexelFormat::Rgbd8 {
        let mut side = texels.last().map_or(1, |level| (level.len() / 6).isqrt());
        while side > 1 {
            side /= 2;
            texels.push(vec![[0.0; 3]; 6 * side * side]);
        }
    }
    let back = through(&texels, format)?;
    levels.iter().zip(back).map(|(level, texels)| Ok(Environment::new(level.grid(), texels)?)).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere::sphere::{Grid, Projection};

    #[test]
    fn formats_err_by_their_own_precision_and_no_more() {
        // Half of the last place: 11, 9 and 8 bits of the largest channel, 7 and 6 of each.
        let texel = [0.703, 0.2001, 0.0907];
        let cases = [
            (StoredTexels::Half, 2f32.powi(-12)),
            (StoredTexels::Texture(TexelFormat::Rgb9e5), 2f32.powi(-10)),
            (StoredTexels::Rgbe, 2f32.powi(-9)),
            (StoredTexels::Texture(TexelFormat::B10g11r11), 0.703 * 2f32.powi(-7)),
            (StoredTexels::Texture(TexelFormat::Rgba32F), 0.0),
        ];
        for (stored, limit) in cases {
            let found = stored.quantise(texel);
            let error = (0..3).map(|c| (found[c] - texel[c]).abs()).fold(0.0, f32::max);
            assert!(error <= limit, "{stored:?}: {error} {limit}");
            assert!(limit == 0.0 || error > 0.0, "{stored:?} is exact");
        }
    }

    #[test]
    fn whole_levels_go_through_rgbd() {
        let level = |size: usize| {
            let grid = Grid::new(Projection::Cube, size, size).unwrap();
            Environment::from_fn(grid, |d| d.map(|v| (1.0 + 0.5 * v) as f32))
        };
        let levels = [level(8), level(4)];
        let back = levels_through(&levels, TexelFormat::Rgbd8).unwrap();
        assert_eq!(back.len(), 2);
        for (a, b) in levels.iter().zip(&back) {
            let pairs = a.texels().iter().flatten().zip(b.texels().iter().flatten());
            // 2.2 / (2 · 127) where colours are from the upper half.
            assert!(pairs.clone().all(|(a, b)| (a - b).abs() <= 0.01 * a.max(1.0)));
            assert!(pairs.clone().any(|(a, b)| a != b));
        }
    }
}
