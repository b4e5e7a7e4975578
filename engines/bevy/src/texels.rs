//! Texels as the GPU would read them, from the formats' definitions (Vulkan specification, "Formats").

use anyhow::{Result, bail};
use half::f16;
use wgpu_types::TextureFormat;

pub(crate) fn decode(bytes: &[u8], format: TextureFormat) -> Result<Vec<[f32; 3]>> {
    Ok(match format {
        TextureFormat::Rgba16Float => bytes.chunks_exact(8).map(|t| [0, 2, 4].map(|at| half(t, at))).collect(),
        TextureFormat::Rgba32Float => {
            bytes.chunks_exact(16).map(|t| [0, 4, 8].map(|at| f32::from_bits(word(t, at)))).collect()
        }
        TextureFormat::Rgb9e5Ufloat => bytes.chunks_exact(4).map(|t| rgb9e5(word(t, 0))).collect(),
        TextureFormat::Rg11b10Ufloat => bytes.chunks_exact(4).map(|t| rg11b10(word(t, 0))).collect(),
        other => bail!("found the format {other:?}, expected one of four"),
    })
}

fn half(texel: &[u8], at: usize) -> f32 {
    f16::from_le_bytes([texel[at], texel[at + 1]]).to_f32()
}

fn word(texel: &[u8], at: usize) -> u32 {
    u32::from_le_bytes([texel[at], texel[at + 1], texel[at + 2], texel[at + 3]])
}

/// Nine bits a channel, red lowest, over a shared exponent of bias 15 in the top five.
fn rgb9e5(word: u32) -> [f32; 3] {
    let scale = (f64::from(word >> 27) - 15.0 - 9.0).exp2();
    [0, 9, 18].map(|shift| (f64::from(word >> shift & 0x1ff) * scale) as f32)
}

/// 11, 11 and 10 bits, each a half float without sign and with its mantissa cut to 6, 6 and 5 bits.
fn rg11b10(word: u32) -> [f32; 3] {
    let wide = |bits: u32, cut: u32| f16::from_bits((bits << cut) as u16).to_f32();
    [wide(word & 0x7ff, 4), wide(word >> 11 & 0x7ff, 4), wide(word >> 22, 5)]
}
