//! Between OpenEXR's orientation of environment maps and ours.

use lumisphere_image::Rgb;

/// Columns that lie between OpenEXR's +Z centre and our +X centre. For widths that are no multiple of four the turn is
/// off by at most half a texel.
fn quarter(width: usize) -> usize {
    (width + 2) / 4 % width.max(1)
}

/// Turns a lat-long map from OpenEXR's orientation to ours.
pub(super) fn latlong_from_exr(texels: &mut [Rgb], width: usize) {
    texels.chunks_exact_mut(width).for_each(|row| row.rotate_right(quarter(width)));
}

/// The inverse of [`latlong_from_exr`].
pub(super) fn latlong_to_exr(texels: &mut [Rgb], width: usize) {
    texels.chunks_exact_mut(width).for_each(|row| row.rotate_left(quarter(width)));
}

/// Turns six faces of `size` x `size` from OpenEXR's orientation to ours, or back: mirroring is its own inverse.
pub(super) fn mirror_cube(texels: &mut [Rgb], size: usize) {
    for (face, texels) in texels.chunks_exact_mut(size * size).enumerate() {
        if matches!(face, 2 | 3) {
            // Reversing everything and then each row leaves only the order of rows reversed.
            texels.reverse();
        }
        texels.chunks_exact_mut(size).for_each(<[Rgb]>::reverse);
    }
}
