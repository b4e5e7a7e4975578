//! BC6H_UF16 blocks: 4 x 4 texels of unsigned half floats in 16 bytes (Direct3D 11, "BC6H Format").

use rayon::prelude::*;

/// Texels along the side of a block.
const SIDE: usize = 4;
const BLOCK_BYTES: usize = 16;

/// Decodes whole images of the given width and height.
///
/// Exact: a block gives half floats. Blocks of a reserved mode give 0, as Direct3D has it.
pub(super) fn decode(data: &[u8], (width, height): (usize, usize)) -> Vec<[f32; 4]> {
    let row_bytes = width.div_ceil(SIDE) * BLOCK_BYTES;
    let rows_per_image = height.div_ceil(SIDE);
    let rows = data.par_chunks_exact(row_bytes).enumerate();
    rows.flat_map_iter(|(i, blocks)| {
        let count = SIDE.min(height - i % rows_per_image * SIDE);
        let mut texels = vec![[0.0; 4]; width * count];
        for (column, block) in blocks.chunks_exact(BLOCK_BYTES).enumerate() {
            let mut colours = [0.0; SIDE * SIDE * 3];
            bcdec_rs::bc6h_float(block, &mut colours, SIDE * 3, false);
            for (y, line) in colours.chunks_exact(SIDE * 3).take(count).enumerate() {
                let out = &mut texels[y * width + column * SIDE..(y + 1) * width];
                for (out, c) in out.iter_mut().zip(line.chunks_exact(3)) {
                    *out = [c[0], c[1], c[2], 1.0];
                }
            }
        }
        texels
    })
    .collect()
}

#[cfg(feature = "bc6h-encode")]
pub(super) use encode::encode;

#[cfg(feature = "bc6h-encode")]
mod encode {
    use super::{BLOCK_BYTES, SIDE};
    use crate::encoded::Encoded;
    use crate::pack;
    use ctt_intel_texture_compressor::{RgbaF16Surface, bc6h};
    use rayon::prelude::*;

    /// Encodes whole images of the given width and height, "basic" settings.
    ///
    /// Of the encoder's five settings: on a photograph (512 x 256, overcast square) the slowest errs 2 % less and takes
    /// eight times as long (relative RMS 6.6e-3 for 6.7e-3), the fastest errs 14 % more.
    ///
    /// Values are first rounded to half floats and clamped to 0 to 65504. Blocks over the right and lower edge repeat the
    /// last column and row. A row of blocks is one task, so the bytes do not depend on the thread count.
    pub(in super::super) fn encode(texels: &[[f32; 3]], (width, height): (usize, usize)) -> Encoded {
        let row_bytes = width.div_ceil(SIDE) * BLOCK_BYTES;
        let rows_per_image = height.div_ceil(SIDE);
        let mut bytes = vec![0; texels.len() / (width * height) * rows_per_image * row_bytes];
        let rows = bytes.par_chunks_exact_mut(row_bytes).enumerate();
        rows.for_each(|(i, out)| {
            let image = &texels[i / rows_per_image * width * height..][..width * height];
            encode_row(image, width, i % rows_per_image * SIDE, out);
        });
        let clamped = texels.par_iter().with_min_len(pack::CHUNK).map(|t| t.iter().filter(|v| is_clamped(**v)).count());
        Encoded { bytes, clamped: clamped.sum() }
    }

    /// Encodes four lines of an image from line `top` on.
    fn encode_row(image: &[[f32; 3]], width: usize, top: usize, out: &mut [u8]) {
        let padded = width.next_multiple_of(SIDE);
        let last = image.len() / width - 1;
        let mut halves = Vec::with_capacity(SIDE * padded * 4);
        for y in top..top + SIDE {
            let line = &image[y.min(last) * width..][..width];
            for x in 0..padded {
                // NaN becomes 0 here: max gives the other operand.
                halves.extend(line[x.min(width - 1)].map(|v| pack::pack_f16(v.max(0.0)).to_le()));
                halves.push(0);
            }
        }
        let stride = padded * 8;
        let surface = RgbaF16Surface::new(bytemuck::cast_slice(&halves), padded as u32, SIDE as u32, stride as u32);
        bc6h::compress_blocks_into(&bc6h::basic_settings(), &surface, out);
    }

    /// NaN, negative, or nearer to 65536 than to the largest half float.
    fn is_clamped(value: f32) -> bool {
        !(0.0..65520.0).contains(&value)
    }
}
