//! NaN, infinite and negative texels: found, counted and repaired.

use crate::environment::{Environment, Rgb};
use crate::error::ImageError;
use lumisphere_sphere::{Grid, Projection, TexelPosition};
use rayon::prelude::*;

/// What to do about texels that are no radiance. Each channel is repaired by itself.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum RepairPolicy {
    /// NaN, infinite and negative channels become 0.
    Zero,
    /// NaN and infinite channels become the mean of the same channel over those of the 8 neighbours where it is finite
    /// (a negative one counts as 0), else 0; negative channels become 0. The neighbours of a lat-long go around in u and
    /// over the poles, those of a cube across the edges. The default.
    #[default]
    Neighbours,
    /// All channels are held in [0, maximum]: +Inf becomes the maximum; NaN, -Inf and negative ones become 0.
    Clamp(f32),
    /// Nothing is changed; an image that needs a repair is an error.
    Reject,
}

/// What [`sanitise`] found. A texel counts once for each kind, whatever the number of its channels concerned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Repairs {
    /// The policy that was applied.
    pub policy: RepairPolicy,
    /// Texels with a NaN.
    pub nan: usize,
    /// Texels with a positive infinity.
    pub positive_infinite: usize,
    /// Texels with a negative infinity.
    pub negative_infinite: usize,
    /// Texels with a finite negative channel.
    pub negative: usize,
    /// Texels with a finite channel above the maximum of [`RepairPolicy::Clamp`]; 0 under the other policies.
    pub above_maximum: usize,
    /// The most negative finite channel, or 0.
    pub most_negative: f32,
}

impl Repairs {
    /// True if there was nothing to repair.
    pub fn is_clean(&self) -> bool {
        self.nan + self.positive_infinite + self.negative_infinite + self.negative + self.above_maximum == 0
    }

    fn none(policy: RepairPolicy) -> Self {
        Self {
            policy,
            nan: 0,
            positive_infinite: 0,
            negative_infinite: 0,
            negative: 0,
            above_maximum: 0,
            most_negative: 0.0,
        }
    }

    fn count(&mut self, texel: Rgb, maximum: f32) {
        let any = |test: fn(f32) -> bool| usize::from(texel.iter().any(|&c| test(c)));
        self.nan += any(f32::is_nan);
        self.positive_infinite += any(|c| c == f32::INFINITY);
        self.negative_infinite += any(|c| c == f32::NEG_INFINITY);
        self.negative += any(|c| c < 0.0 && c.is_finite());
        self.above_maximum += usize::from(texel.iter().any(|&c| c.is_finite() && c > maximum));
        let finite = texel.iter().filter(|c| c.is_finite());
        self.most_negative = finite.fold(self.most_negative, |low, &c| low.min(c));
    }
}

/// Texels scanned at a time: fixed, so that the order of the findings never depends on the number of threads.
const CHUNK: usize = 1 << 14;

/// Finds NaN, infinite and negative texels and repairs them by `policy`, in place.
///
/// Repairs read the image as it was before, so the result does not depend on any order. A clean image costs one read.
///
/// # Errors
/// [`ImageError::Unclean`] under [`RepairPolicy::Reject`] if there is anything to repair (the image is unchanged);
/// [`ImageError::Setting`] if the maximum of [`RepairPolicy::Clamp`] is not a positive finite number.
pub fn sanitise(environment: &mut Environment, policy: RepairPolicy) -> Result<Repairs, ImageError> {
    let maximum = match policy {
        RepairPolicy::Clamp(maximum) if !(maximum > 0.0 && maximum.is_finite()) => {
            return Err(ImageError::Setting {
                name: "the maximum of a clamp",
                found: f64::from(maximum),
                expected: "a positive finite number",
            });
        }
        RepairPolicy::Clamp(maximum) => maximum,
        _ => f32::MAX,
    };
    let found = find_unclean(environment.texels(), maximum);
    let mut repairs = Repairs::none(policy);
    for &index in &found {
        repairs.count(environment.texels()[index], maximum);
    }
    if policy == RepairPolicy::Reject && !repairs.is_clean() {
        return Err(ImageError::Unclean {
            nan: repairs.nan,
            infinite: repairs.positive_infinite + repairs.negative_infinite,
            negative: repairs.negative,
        });
    }
    let repaired: Vec<Rgb> = found.par_iter().map(|&index| repaired_texel(environment, index, policy)).collect();
    for (&index, texel) in found.iter().zip(repaired) {
        environment.texels_mut()[index] = texel;
    }
    Ok(repairs)
}

/// Indices of the texels with a channel outside [0, maximum], ascending.
fn find_unclean(texels: &[Rgb], maximum: f32) -> Vec<usize> {
    let clean = |c: f32| (c >= 0.0) & (c <= maximum);
    let found: Vec<Vec<usize>> = texels
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, texels)| {
            // No early exit: the plain conjunction vectorises.
            if texels.as_flattened().iter().fold(true, |all, &c| all & clean(c)) {
                return Vec::new();
            }
            let unclean = texels.iter().enumerate().filter(|(_, texel)| !texel.iter().all(|&c| clean(c)));
            unclean.map(|(i, _)| chunk * CHUNK + i).collect()
        })
        .collect();
    found.concat()
}

fn repaired_texel(environment: &Environment, index: usize, policy: RepairPolicy) -> Rgb {
    let texel = environment.texels()[index];
    match policy {
        RepairPolicy::Zero => texel.map(|c| if c.is_finite() { c.max(0.0) } else { 0.0 }),
        // f32::max returns the other operand for a NaN.
        RepairPolicy::Clamp(maximum) => texel.map(|c| c.max(0.0).min(maximum)),
        RepairPolicy::Neighbours => {
            let around = if texel.iter().all(|c| c.is_finite()) { [0.0; 3] } else { mean_around(environment, index) };
            std::array::from_fn(|c| if texel[c].is_finite() { texel[c].max(0.0) } else { around[c] })
        }
        RepairPolicy::Reject => texel,
    }
}

/// Mean of the finite neighbours for each channel, 0 where there is none.
fn mean_around(environment: &Environment, index: usize) -> Rgb {
    let mut sum = [0.0_f64; 3];
    let mut count = [0.0_f64; 3];
    for (dx, dy) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
        let Some(neighbour) = neighbour(environment.grid(), index, dx, dy) else { continue };
        for (c, &value) in environment.texels()[neighbour].iter().enumerate().filter(|(_, v)| v.is_finite()) {
            sum[c] += f64::from(value.max(0.0));
            count[c] += 1.0;
        }
    }
    std::array::from_fn(|c| if count[c] > 0.0 { (sum[c] / count[c]) as f32 } else { 0.0 })
}

/// Index of the texel that lies one step away, or `None` beyond the border of a projection that does not join there.
fn neighbour(grid: Grid, index: usize, dx: isize, dy: isize) -> Option<usize> {
    let (width, height) = (grid.width(), grid.height());
    let (face, y, x) = (index / (width * height), index / width % height, index % width);
    if let (Some(nx), Some(ny)) = (x.checked_add_signed(dx), y.checked_add_signed(dy))
        && nx < width
        && ny < height
    {
        // The two discs of a dual paraboloid touch in the picture, not on the sphere.
        let apart = grid.projection() == Projection::DualParaboloid && nx / height != x / height;
        let known = !apart && grid.texel_direction(face, nx, ny).is_some();
        return known.then_some((face * height + ny) * width + nx);
    }
    // Half a texel beyond the border these two projections still give the direction that lies there.
    if !matches!(grid.projection(), Projection::LatLong | Projection::Cube) {
        return None;
    }
    let at = TexelPosition { face, x: x as f64 + 0.5 + dx as f64, y: y as f64 + 0.5 + dy as f64 };
    let over = grid.position(grid.direction(at)?);
    let (x, y) = ((over.x as usize).min(width - 1), (over.y as usize).min(height - 1));
    Some((over.face * height + y) * width + x)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn grey(projection: Projection, w: usize, h: usize) -> Environment {
        let grid = Grid::new(projection, w, h).unwrap();
        Environment::from_fn(grid, |_| [0.5; 3])
    }

    #[test]
    fn counts_each_kind_once_a_texel_and_the_policies_do_as_they_say() {
        let mut damaged = grey(Projection::LatLong, 8, 4);
        damaged.texels_mut()[0] = [f32::NAN, f32::NAN, -2.0];
        damaged.texels_mut()[9] = [f32::INFINITY, 1.0, f32::NEG_INFINITY];
        damaged.texels_mut()[20] = [-0.25, -0.0, 7.0];
        let cases = [
            (RepairPolicy::Zero, [0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 7.0], 0),
            (RepairPolicy::Clamp(4.0), [0.0, 0.0, 0.0], [4.0, 1.0, 0.0], [0.0, 0.0, 4.0], 1),
            // Texel 9 is a neighbour of texel 0 and the other way round.
            (RepairPolicy::Neighbours, [0.5, 4.5 / 8.0, 0.0], [0.5, 1.0, 3.5 / 8.0], [0.0, 0.0, 7.0], 0),
        ];
        for (policy, first, ninth, twentieth, above) in cases {
            let mut image = damaged.clone();
            let repairs = sanitise(&mut image, policy).unwrap();
            assert_eq!((repairs.nan, repairs.positive_infinite, repairs.negative_infinite), (1, 1, 1));
            assert_eq!((repairs.negative, repairs.most_negative, repairs.above_maximum), (2, -2.0, above));
            assert_eq!(
                (image.texels()[0], image.texels()[9], image.texels()[20]),
                (first, ninth, twentieth),
                "{policy:?}"
            );
            assert!(sanitise(&mut image, policy).unwrap().is_clean());
            assert_eq!(image.texels()[5], [0.5; 3]);
        }
    }

    #[test]
    fn reject_reports_and_leaves_the_image_alone() {
        let mut image = grey(Projection::Cube, 2, 2);
        assert!(sanitise(&mut image, RepairPolicy::Reject).unwrap().is_clean());
        image.texels_mut()[3] = [-1.0, f32::INFINITY, 0.0];
        let before = image.clone();
        let error = sanitise(&mut image, RepairPolicy::Reject).unwrap_err();
        assert_eq!(error, ImageError::Unclean { nan: 0, infinite: 1, negative: 1 });
        assert_eq!(image, before);
        assert!(sanitise(&mut image, RepairPolicy::Clamp(f32::NAN)).is_err());
    }

    #[test]
    fn neighbours_go_around_the_panorama_and_over_the_edges_of_the_cube() {
        let grid = Grid::new(Projection::LatLong, 8, 4).unwrap();
        // Texel (0, 1): its left neighbour is (7, 1); over the pole from (0, 0) lies (4, 0).
        assert_eq!(neighbour(grid, 8, -1, 0), Some(15));
        assert_eq!(neighbour(grid, 0, 0, -1), Some(4));
        assert_eq!(neighbour(grid, 7, 1, 1), Some(8));
        let cube = Grid::new(Projection::Cube, 4, 4).unwrap();
        // The top row of +Z meets the bottom row of +Y, the left column of +Z the right one of -X.
        assert_eq!(neighbour(cube, 4 * 16 + 1, 0, -1), Some(2 * 16 + 12 + 1));
        assert_eq!(neighbour(cube, 4 * 16 + 4, -1, 0), Some(16 + 4 + 3));
    }

    #[test]
    fn blank_corners_and_the_other_disc_are_no_neighbours() {
        let probe = Grid::new(Projection::AngularMap, 9, 9).unwrap();
        // (1, 1) lies on the rim: its neighbour (0, 0) is blank, (2, 2) is not.
        assert_eq!(neighbour(probe, 10, -1, -1), None);
        assert_eq!(neighbour(probe, 10, 1, 1), Some(20));
        let discs = Grid::new(Projection::DualParaboloid, 8, 4).unwrap();
        assert_eq!((neighbour(discs, 11, 1, 0), neighbour(discs, 11, -1, 0)), (None, Some(10)));
    }

    #[test]
    fn a_hole_without_finite_neighbours_becomes_black() {
        let grid = Grid::new(Projection::Cube, 1, 1).unwrap();
        let mut image = Environment::new(grid, vec![[f32::NAN; 3]; 6]).unwrap();
        sanitise(&mut image, RepairPolicy::default()).unwrap();
        assert_eq!(image.texels(), [[0.0; 3]; 6]);
    }

    #[test]
    fn findings_beyond_the_first_chunk_keep_their_place() {
        let mut image = grey(Projection::LatLong, 400, 200);
        for index in [CHUNK - 1, CHUNK, 4 * CHUNK + 17] {
            image.texels_mut()[index][1] = f32::NAN;
        }
        let mut repaired = image.clone();
        assert_eq!(sanitise(&mut repaired, RepairPolicy::Neighbours).unwrap().nan, 3);
        assert_eq!(repaired, grey(Projection::LatLong, 400, 200));
    }
}
