//! The colour spaces of FLIP.

/// Linear Rec.709 to XYZ as rational numbers: what follows from the primaries (0.64, 0.33), (0.30, 0.60), (0.15, 0.06)
/// and the white of [`white`] (FLIP's choice; D65 to five digits).
const XYZ_OF_RGB: [[f64; 3]; 3] = [
    [10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0],
    [2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0],
    [1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0],
];

/// Linear RGB and XYZ relative to white, both ways.
pub(crate) struct Colours {
    relative_of_rgb: [[f64; 3]; 3],
    rgb_of_relative: [[f64; 3]; 3],
}

impl Colours {
    pub(crate) fn new() -> Self {
        let relative_of_rgb = XYZ_OF_RGB.map(|row| row.map(|v| v / row.iter().sum::<f64>()));
        Self { relative_of_rgb, rgb_of_relative: inverse(&relative_of_rgb) }
    }

    /// Y Cx Cz, a linear form of CIELAB whose axes are lightness, red-green and blue-yellow (Andersson et al. 2020,
    /// §4.1).
    pub(crate) fn ycxcz(&self, rgb: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = times(&self.relative_of_rgb, rgb);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    /// The inverse of [`Self::ycxcz`].
    pub(crate) fn rgb(&self, [luma, cx, cz]: [f64; 3]) -> [f64; 3] {
        let y = (luma + 16.0) / 116.0;
        times(&self.rgb_of_relative, [y + cx / 500.0, y, y - cz / 200.0])
    }

    /// CIELAB with chroma scaled by L/100: the Hunt effect, colours are more vivid in bright light (§4.1).
    pub(crate) fn hunt_lab(&self, rgb: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = times(&self.relative_of_rgb, rgb).map(lab_curve);
        let lightness = 116.0 * y - 16.0;
        let chroma = 0.01 * lightness;
        [lightness, chroma * 500.0 * (x - y), chroma * 200.0 * (y - z)]
    }
}

/// CIE 15: the cube root, and its tangent near 0.
fn lab_curve(t: f64) -> f64 {
    const DELTA: f64 = 6.0 / 29.0;
    if t > DELTA * DELTA * DELTA { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
}

/// |ΔL| + √(Δa² + Δb²): S. Abasi et al., "Distance metrics for very large color differences" (2020).
pub(crate) fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

fn times(m: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// By cofactors.
fn inverse(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let cofactor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant: f64 = (0..3).map(|c| m[0][c] * cofactor(0, c)).sum();
    std::array::from_fn(|r| std::array::from_fn(|c| cofactor(c, r) / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opponent_colours_go_both_ways_and_white_has_no_chroma() {
        let colours = Colours::new();
        for rgb in [[0.2, 0.7, 0.1], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]] {
            let back = colours.rgb(colours.ycxcz(rgb));
            assert!((0..3).all(|c| (back[c] - rgb[c]).abs() < 1e-14), "{back:?}");
        }
        let white = colours.hunt_lab([1.0; 3]);
        assert!((white[0] - 100.0).abs() < 1e-12 && white[1].abs() < 1e-12 && white[2].abs() < 1e-12, "{white:?}");
        // CIELAB of sRGB red is (53.24, 80.09, 67.20); chroma counts by L/100.
        let red = colours.hunt_lab([1.0, 0.0, 0.0]);
        let expected = [53.24, 0.5324 * 80.09, 0.5324 * 67.20];
        assert!((0..3).all(|c| (red[c] - expected[c]).abs() < 0.02), "{red:?}");
    }
}
