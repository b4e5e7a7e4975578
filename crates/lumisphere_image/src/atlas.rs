//! All levels of a chain of lat-long or octahedral maps in one picture.
//!
//! Each level is a tile with a border of b texels around it. Level 0 lies at the top left, the others side by side below
//! it, level 1 leftmost. The first texel inside level k's border, for a level 0 of W x H texels, is at
//!
//! | level | x | y | size |
//! |---|---|---|---|
//! | 0 | b | b | W x H |
//! | k ≥ 1 | b + W (1 - 2^(1-k)) + 2b (k - 1) | H + 3b | W/2^k x H/2^k |
//!
//! so a shader finds a tile from W, H, b and k alone. The picture is (W + 2b or, where wider, the row below) wide and
//! H + 2b high for one level, H + H/2 + 4b for more; what no tile covers is black.
//!
//! Without a border, bilinear filtering at a tile's edge mixes in the neighbouring tile. One texel is enough for it: the
//! border holds what lies across the edge on the sphere (around in u and over the pole on a lat-long, over the fold on
//! an octahedral map), so that filtering is also seamless. Mips of the atlas itself mix levels and have no use.

use crate::cube_layout::check_texels;
use crate::environment::{Environment, Rgb};
use crate::error::ImageError;
use crate::picture::Picture;
use lumisphere_sphere::{Grid, Projection};

/// Levels in one picture, and where they are.
#[derive(Debug, Clone, PartialEq)]
pub struct Atlas {
    /// The picture.
    pub picture: Picture,
    /// The inside of each level's tile, without its border.
    pub rects: Vec<AtlasRect>,
}

/// A rectangle of texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AtlasRect {
    /// First column.
    pub x: usize,
    /// First row.
    pub y: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// Sizes and places of an atlas.
struct Plan {
    width: usize,
    height: usize,
    rects: Vec<AtlasRect>,
}

const HALVES: &str = "at least one level, each exactly half as wide and high as the one before and alike in projection";
const SHAPE: &str = "a lat-long map twice as wide as high";
const BORDER: &str = "a border no wider than the last level is high";
const SIZE: &str = "another size of picture for this border, see the table of the atlas";

/// The levels, largest first, in one picture with `border` texels around each (0: none; 1 serves bilinear filtering).
///
/// # Errors
/// [`ImageError::AtlasProjection`] for other projections than lat-long and octahedral, [`ImageError::Atlas`] unless each
/// level is exactly half of the one before, a lat-long is 2:1, and the border is at most the height of the last level.
pub fn atlas(levels: &[Environment], border: usize) -> Result<Atlas, ImageError> {
    let none = ImageError::Atlas { level_count: 0, expected: HALVES, width: 0, height: 0 };
    let first = levels.first().ok_or(none)?.grid();
    let plan = Plan::new(first.projection(), [first.width(), first.height()], levels.len(), border)?;
    let mut texels = vec![[0.0; 3]; plan.width * plan.height];
    for (level, &rect) in levels.iter().zip(&plan.rects) {
        let (width, height) = (level.grid().width(), level.grid().height());
        if (level.projection(), width, height) != (first.projection(), rect.width, rect.height) {
            return Err(ImageError::Atlas { level_count: levels.len(), expected: HALVES, width, height });
        }
        draw_tile(&mut texels, plan.width, rect, level, border);
    }
    let (width, height) = (plan.width, plan.height);
    Ok(Atlas { picture: Picture { width, height, texels, projection: None, notes: Vec::new() }, rects: plan.rects })
}

/// The levels of a picture that [`atlas`] laid out with this border, to the bit. Borders are not read.
///
/// # Errors
/// [`ImageError::AtlasProjection`] for other projections than lat-long and octahedral, [`ImageError::Atlas`] if no atlas
/// of so many levels has the picture's size, [`ImageError::TexelCount`] if it has fewer or more texels than that.
pub fn levels_from_atlas(
    picture: &Picture,
    projection: Projection,
    level_count: usize,
    border: usize,
) -> Result<Vec<Environment>, ImageError> {
    // First, so that the sizes below are those of memory and no sum of them overflows.
    check_texels(picture)?;
    let (width, height) = (picture.width, picture.height);
    let wrong = || ImageError::Atlas { level_count, expected: SIZE, width, height };
    let size = level_size(projection, height, level_count, border).ok_or_else(wrong)?;
    let plan = Plan::new(projection, size, level_count, border)?;
    if (plan.width, plan.height) != (width, height) {
        return Err(wrong());
    }
    let level = |rect: &AtlasRect| {
        let rows = (rect.y..rect.y + rect.height).flat_map(|y| {
            let start = y * width + rect.x;
            &picture.texels[start..start + rect.width]
        });
        Environment::new(Grid::new(projection, rect.width, rect.height)?, rows.copied().collect())
    };
    plan.rects.iter().map(level).collect()
}

/// Width and height of level 0 in an atlas of this height.
fn level_size(projection: Projection, height: usize, level_count: usize, border: usize) -> Option<[usize; 2]> {
    let rows = if level_count > 1 { 2 } else { 1 };
    let inside = height.checked_sub(border.checked_mul(2 * rows)?)?;
    let top = if rows == 1 { inside } else { inside / 3 * 2 };
    let width = if projection == Projection::LatLong { top.checked_mul(2)? } else { top };
    Some([width, top])
}

impl Plan {
    fn new(
        projection: Projection,
        [width, height]: [usize; 2],
        level_count: usize,
        border: usize,
    ) -> Result<Self, ImageError> {
        let wrong = |expected| ImageError::Atlas { level_count, expected, width, height };
        match projection {
            Projection::LatLong if height.checked_mul(2) != Some(width) => return Err(wrong(SHAPE)),
            Projection::LatLong | Projection::Octahedral => {}
            found => return Err(ImageError::AtlasProjection { found }),
        }
        let halvings = level_count.checked_sub(1).ok_or(wrong(HALVES))?;
        if height == 0 || halvings > height.trailing_zeros() as usize {
            return Err(wrong(HALVES));
        }
        if border > height >> halvings {
            return Err(wrong(BORDER));
        }
        let mut rects = vec![AtlasRect { x: border, y: border, width, height }];
        let mut end = 0;
        for k in 1..level_count {
            let (width, tile_height) = (width >> k, height >> k);
            rects.push(AtlasRect { x: end + border, y: height + 3 * border, width, height: tile_height });
            end += width + 2 * border;
        }
        let below = if level_count > 1 { height / 2 + 2 * border } else { 0 };
        Ok(Self { width: (width + 2 * border).max(end), height: height + 2 * border + below, rects })
    }
}

/// The level with its border.
fn draw_tile(texels: &mut [Rgb], stride: usize, rect: AtlasRect, level: &Environment, border: usize) {
    for row in 0..rect.height + 2 * border {
        let start = (rect.y - border + row) * stride + rect.x - border;
        for (column, texel) in texels[start..start + rect.width + 2 * border].iter_mut().enumerate() {
            let inside = |i: usize, size: usize| (border..border + size).contains(&i).then(|| i - border);
            *texel = match (inside(column, rect.width), inside(row, rect.height)) {
                (Some(x), Some(y)) => level.texel(0, x, y),
                _ => across(level, column as isize - border as isize, row as isize - border as isize),
            };
        }
    }
}

/// The texel at (x, y), which may lie beyond an edge, at most one size of the map away.
pub(crate) fn across(level: &Environment, x: isize, y: isize) -> Rgb {
    let (width, height) = (level.grid().width() as isize, level.grid().height() as isize);
    let reflected = |i: isize, size: isize| if i < 0 { -1 - i } else { 2 * size - 1 - i };
    let (mut x, mut y) = (x, y);
    if level.projection() == Projection::LatLong {
        if !(0..height).contains(&y) {
            (x, y) = (x + width / 2, reflected(y, height));
        }
        x = x.rem_euclid(width);
    } else {
        // Each side is folded at its middle: beyond it lies the same side, the other way round.
        if !(0..width).contains(&x) {
            (x, y) = (reflected(x, width), height - 1 - y);
        }
        if !(0..height).contains(&y) {
            (x, y) = (width - 1 - x, reflected(y, height));
        }
    }
    level.texel(0, x as usize, y as usize)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere_sphere::vector::angle_between;

    const PROJECTIONS: [Projection; 2] = [Projection::LatLong, Projection::Octahedral];

    /// Each texel holds the direction of its centre.
    fn directions(projection: Projection, height: usize) -> Environment {
        let width = if projection == Projection::LatLong { 2 * height } else { height };
        Environment::from_fn(Grid::new(projection, width, height).unwrap(), |d| d.map(|c| c as f32))
    }

    fn chain(projection: Projection, height: usize, count: usize) -> Vec<Environment> {
        (0..count).map(|k| directions(projection, height >> k)).collect()
    }

    #[test]
    fn tiles_lie_where_the_formula_says() {
        for projection in PROJECTIONS {
            for (height, count, border) in [(64, 7, 0), (64, 7, 1), (48, 5, 1), (16, 1, 2), (16, 3, 4)] {
                let levels = chain(projection, height, count);
                let found = atlas(&levels, border).unwrap();
                let (w, h, b) = (levels[0].grid().width(), height, border);
                for (k, rect) in found.rects.iter().enumerate() {
                    let place = match k {
                        0 => (b, b),
                        _ => (b + w - w / (1 << (k - 1)) + 2 * b * (k - 1), h + 3 * b),
                    };
                    assert_eq!((rect.x, rect.y), place, "{projection:?} {height} {border} level {k}");
                    assert_eq!((rect.width, rect.height), (w >> k, h >> k));
                    for (x, y) in (0..rect.width * rect.height).map(|i| (i % rect.width, i / rect.width)) {
                        let texel = found.picture.texels[(rect.y + y) * found.picture.width + rect.x + x];
                        assert_eq!(texel, levels[k].texel(0, x, y));
                    }
                }
                let without = if count == 1 { h + 2 * b } else { h + h / 2 + 4 * b };
                assert_eq!(found.picture.height, without);
                assert_eq!(levels_from_atlas(&found.picture, projection, count, border), Ok(levels));
            }
        }
    }

    /// Around each texel of the border the sphere goes on: its texel is no farther from its neighbour inside than
    /// neighbours inside are from each other.
    #[test]
    fn the_border_continues_the_sphere() {
        /// On both maps the largest step between neighbours is at most this many steps of the smallest side.
        const STEPS: f64 = 4.5;
        for projection in PROJECTIONS {
            let size = 32;
            let levels = [directions(projection, size)];
            let found = atlas(&levels, 1).unwrap().picture;
            let at = |x: usize, y: usize| found.texels[y * found.width + x].map(f64::from);
            let bound = STEPS / size as f64;
            let check = |a, b| {
                let step = angle_between(a, b);
                assert!(step > 0.0 && step < bound, "{projection:?} from {a:?} to {b:?}: {step}");
            };
            let (right, bottom) = (found.width - 1, found.height - 1);
            for y in 0..found.height {
                check(at(0, y), at(1, y));
                check(at(right - 1, y), at(right, y));
            }
            for x in 0..found.width {
                check(at(x, 0), at(x, 1));
                check(at(x, bottom - 1), at(x, bottom));
            }
            // A border that wraps like a plane would be found: opposite edges are far apart.
            let wrapped = angle_between(at(5, 1), at(5, size));
            assert!(wrapped > 2.0 * bound, "{projection:?} {wrapped}");
        }
    }

    /// The bilinear mean at the edge of a tile is the one that the sphere's own neighbours give.
    #[test]
    fn border_texels_are_the_neighbours_across_the_edge() {
        let level = directions(Projection::LatLong, 4);
        let found = atlas(std::slice::from_ref(&level), 1).unwrap().picture;
        let at = |x: usize, y: usize| found.texels[y * 10 + x];
        assert_eq!(at(0, 2), level.texel(0, 7, 1));
        assert_eq!(at(9, 4), level.texel(0, 0, 3));
        // Over the pole to the opposite meridian; at the corner, around as well.
        assert_eq!(at(1, 0), level.texel(0, 4, 0));
        assert_eq!(at(0, 5), level.texel(0, 3, 3));
        let level = directions(Projection::Octahedral, 4);
        let found = atlas(std::slice::from_ref(&level), 1).unwrap().picture;
        let at = |x: usize, y: usize| found.texels[y * 6 + x];
        assert_eq!(at(0, 1), level.texel(0, 0, 3));
        assert_eq!(at(2, 5), level.texel(0, 2, 3));
        assert_eq!(at(0, 0), level.texel(0, 3, 3));
    }

    #[test]
    fn what_makes_no_atlas_is_refused() {
        let levels = chain(Projection::Octahedral, 16, 3);
        let refused = |result: Result<Atlas, ImageError>| matches!(result, Err(ImageError::Atlas { .. }));
        assert!(refused(atlas(&[], 0)));
        assert!(refused(atlas(&[levels[0].clone(), levels[2].clone()], 0)));
        assert!(refused(atlas(&levels, 5)));
        assert!(refused(atlas(&chain(Projection::LatLong, 6, 3), 0)));
        let wide = Environment::filled(Grid::new(Projection::LatLong, 8, 2).unwrap(), [0.0; 3]);
        assert!(refused(atlas(&[wide], 0)));
        let cube = Environment::filled(Grid::new(Projection::Cube, 2, 2).unwrap(), [0.0; 3]);
        assert_eq!(atlas(&[cube], 0), Err(ImageError::AtlasProjection { found: Projection::Cube }));
        let picture = atlas(&levels, 1).unwrap().picture;
        for (projection, count, border) in [
            (Projection::Octahedral, 3, 0),
            (Projection::Octahedral, 1, 1),
            (Projection::Octahedral, 0, 1),
            (Projection::Octahedral, usize::MAX, 1),
            (Projection::Octahedral, 3, usize::MAX),
            (Projection::LatLong, 3, 1),
        ] {
            let found = levels_from_atlas(&picture, projection, count, border);
            assert!(matches!(found, Err(ImageError::Atlas { .. })), "{projection:?} {count} {border}: {found:?}");
        }
        for height in [picture.height, usize::MAX] {
            let short = Picture { texels: Vec::new(), height, ..picture.clone() };
            let found = levels_from_atlas(&short, Projection::LatLong, 3, 1);
            assert!(matches!(found, Err(ImageError::TexelCount { found: 0, .. })));
        }
    }
}
