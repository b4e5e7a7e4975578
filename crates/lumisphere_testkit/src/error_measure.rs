//! Differences between two lists of numbers.

use lumisphere_image::Rgb;

/// sqrt(Σ (a - b)² / Σ b²): the error of `a` against the truth `b`. NaN if the lengths differ or the truth is null.
pub fn relative_rms(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::NAN;
    }
    let difference: f64 = a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum();
    let size: f64 = b.iter().map(|y| y * y).sum();
    (difference / size).sqrt()
}

/// [`relative_rms`] over all channels of two lists of texels.
pub fn relative_rms_rgb(a: &[Rgb], b: &[Rgb]) -> f64 {
    let flat = |texels: &[Rgb]| texels.iter().flatten().map(|&c| f64::from(c)).collect::<Vec<f64>>();
    relative_rms(&flat(a), &flat(b))
}

/// max |a - b| / |b|. NaN if the lengths differ or any term is NaN; infinite where the truth alone is null.
pub fn worst_relative(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::NAN;
    }
    let term = |(x, y): (&f64, &f64)| if x == y { 0.0 } else { (x - y).abs() / y.abs() };
    a.iter().zip(b).map(term).fold(0.0, |worst, t| if t > worst || t.is_nan() { t } else { worst })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_of_known_differences() {
        assert!((relative_rms(&[1.0, 2.2], &[1.0, 2.0]) - 0.2 / 5.0_f64.sqrt()).abs() < 1e-15);
        assert!((relative_rms_rgb(&[[1.0, 2.5, 2.0]], &[[1.0, 2.0, 2.0]]) - 0.5 / 3.0).abs() < 1e-15);
        assert!((worst_relative(&[1.1, 2.0], &[1.0, 2.0]) - 0.1).abs() < 1e-15);
        assert!(relative_rms(&[1.0], &[]).is_nan() && worst_relative(&[1.0], &[]).is_nan());
        assert!(worst_relative(&[f64::NAN, 1.0], &[1.0, 1.0]).is_nan());
        assert_eq!(worst_relative(&[1.0, 0.0], &[0.0, 0.0]), f64::INFINITY);
    }
}
