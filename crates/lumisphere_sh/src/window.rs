//! Windows over the bands, against the ringing of truncated series.

use crate::coefficients::Sh;
use crate::error::ShError;
use crate::quadratic::Quadratic;
use std::f64::consts::PI;

/// A factor for each band that falls from 1 at l = 0 to 0 at the window's width (in bands, not rounded).
///
/// A smaller width filters more. A width that is not above 0 (or not a number) leaves only band 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Window {
    /// No filter: 1 in every band.
    #[default]
    None,
    /// `(1 + cos(π l/w)) / 2`.
    Hann(f64),
    /// `sin(π l/w) / (π l/w)`.
    Lanczos(f64),
    /// The fourth power of Lanczos.
    Sinc4(f64),
}

/// A window whose width is yet to be found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WindowShape {
    /// See [`Window::Hann`].
    Hann,
    /// See [`Window::Lanczos`].
    Lanczos,
    /// See [`Window::Sinc4`].
    Sinc4,
}

impl WindowShape {
    /// The window of this shape and of a width in bands.
    pub fn with_width(self, width: f64) -> Window {
        match self {
            Self::Hann => Window::Hann(width),
            Self::Lanczos => Window::Lanczos(width),
            Self::Sinc4 => Window::Sinc4(width),
        }
    }
}

impl Window {
    /// The factor of band l, in [0, 1].
    pub fn factor(self, l: usize) -> f64 {
        let inside = |width: f64, f: fn(f64) -> f64| match l {
            0 => 1.0,
            _ if (l as f64) < width => f(PI * l as f64 / width),
            _ => 0.0,
        };
        match self {
            Self::None => 1.0,
            Self::Hann(width) => inside(width, |x| 0.5 * (1.0 + x.cos())),
            Self::Lanczos(width) => inside(width, |x| x.sin() / x),
            Self::Sinc4(width) => inside(width, |x| (x.sin() / x).powi(4)),
        }
    }

    /// The factors of bands 0 to `band_count - 1`.
    pub fn factors(self, band_count: usize) -> Vec<f64> {
        (0..band_count).map(|l| self.factor(l)).collect()
    }

    /// The filtered function.
    pub fn apply<const N: usize>(self, f: &Sh<N>) -> Sh<N> {
        f.scale_bands(|l| self.factor(l))
    }
}

/// The least value over the sphere of each channel of a function of bands 0 to 2, exact to rounding.
///
/// # Errors
/// [`ShError::TooManyBands`] beyond three bands, where no such closed form is known.
pub fn order_2_minimum<const N: usize>(f: &Sh<N>) -> Result<[f64; N], ShError> {
    if f.band_count() > 3 {
        return Err(ShError::TooManyBands { what: "the exact minimum", found: f.band_count(), limit: 3 });
    }
    Ok(std::array::from_fn(|channel| Quadratic::of_channel(f, channel).minimum()))
}

/// Of the windows of a shape, the one that filters least and leaves a function of bands 0 to 2, such as irradiance,
/// nowhere below 0 in any channel. [`Window::None`] if the function is so already.
///
/// One width serves all channels, so that hues do not drift. The search for the width by bisection, with the minimum over
/// the sphere as its test, is that of P.-P. Sloan, "Deringing Spherical Harmonics", SIGGRAPH Asia 2017 Technical Briefs; the
/// minimum is exact here ([`order_2_minimum`]). As the minimum need not fall steadily with the width, 1/width is first
/// stepped through [0, 1] from the weakest window, and only the step where the sign changes is halved. The window returned
/// is always on the side without negative values.
///
/// # Errors
/// [`ShError::TooManyBands`] beyond three bands; [`ShError::NegativeMean`] if a channel's mean is negative or not a number.
pub fn least_nonnegative_window<const N: usize>(shape: WindowShape, f: &Sh<N>) -> Result<Window, ShError> {
    let mean = f.mean();
    if let Some(channel) = mean.iter().position(|m| m.is_nan() || *m < 0.0) {
        return Err(ShError::NegativeMean { channel, found: mean[channel] });
    }
    if is_nonnegative(f)? {
        return Ok(Window::None);
    }
    const STEPS: usize = 128;
    let at = |inverse_width: f64| shape.with_width(1.0 / inverse_width);
    let works = |inverse_width: f64| is_nonnegative(&at(inverse_width).apply(f));
    // At 1/width = 1 only band 0 is left, which is not negative.
    let (mut weak, mut strong) = (0.0, 1.0);
    for k in 1..=STEPS {
        strong = k as f64 / STEPS as f64;
        if works(strong)? {
            break;
        }
        weak = strong;
    }
    for _ in 0..60 {
        let middle = 0.5 * (weak + strong);
        if works(middle)? { strong = middle } else { weak = middle }
    }
    Ok(at(strong))
}

fn is_nonnegative<const N: usize>(f: &Sh<N>) -> Result<bool, ShError> {
    Ok(order_2_minimum(f)?.iter().all(|m| *m >= 0.0))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::coefficients::Sh1;
    use crate::test_support::Random;
    use crate::zonal::{clamped_cosine, convolve};

    const SHAPES: [WindowShape; 3] = [WindowShape::Hann, WindowShape::Lanczos, WindowShape::Sinc4];

    /// Irradiance of a light of unit irradiance in one direction.
    fn irradiance_of_delta(direction: [f64; 3]) -> Sh1 {
        let radiance = Sh1::new(3, crate::basis::eval(3, direction).into_iter().map(|y| [y]).collect()).unwrap();
        convolve(&radiance, &clamped_cosine(3))
    }

    #[test]
    fn a_delta_light_rings_as_known() {
        let irradiance = irradiance_of_delta([0.0, 0.0, 1.0]);
        for x in [-1.0_f64, -8.0 / 15.0, 0.0, 0.3, 1.0] {
            let found = irradiance.evaluate([(1.0 - x * x).sqrt(), 0.0, x])[0];
            assert!((found - (3.0 / 32.0 + 0.5 * x + 15.0 / 32.0 * x * x)).abs() < 1e-15);
        }
        let minimum = order_2_minimum(&irradiance).unwrap()[0];
        // At x = -8/15: 3/32 - 2/15 = -19/480.
        assert!((minimum + 19.0 / 480.0).abs() < 1e-15 && (minimum + 0.0396).abs() < 5e-5, "{minimum}");
        let elsewhere = order_2_minimum(&irradiance_of_delta([0.48, -0.6, 0.64])).unwrap()[0];
        assert!((elsewhere - minimum).abs() < 1e-14);
    }

    #[test]
    fn windows_fall_from_1_to_0() {
        for shape in SHAPES {
            let factors = shape.with_width(4.5).factors(7);
            assert_eq!((factors[0], factors[5], factors[6]), (1.0, 0.0, 0.0));
            assert!(factors[..6].is_sorted_by(|a, b| a > b), "{factors:?}");
            assert!(shape.with_width(1e9).factor(2) > 1.0 - 1e-15);
            for bad in [0.0, -1.0, f64::NAN] {
                assert_eq!(shape.with_width(bad).factors(2), [1.0, 0.0]);
            }
        }
        assert_eq!(Window::default().factors(3), [1.0; 3]);
        assert!((Window::Hann(4.0).factor(2) - 0.5).abs() < 1e-15);
        assert!((Window::Lanczos(4.0).factor(2) - 2.0 / PI).abs() < 1e-15);
        assert!((Window::Sinc4(4.0).factor(2) - (2.0 / PI).powi(4)).abs() < 1e-15);
    }

    fn width(window: Window) -> f64 {
        match window {
            Window::None => f64::INFINITY,
            Window::Hann(w) | Window::Lanczos(w) | Window::Sinc4(w) => w,
        }
    }

    #[test]
    fn the_window_found_is_the_weakest_that_works() {
        let mut random = Random::new(51);
        for shape in SHAPES {
            for _ in 0..10 {
                let mut light = Sh1::zero(3).unwrap();
                for _ in 0..3 {
                    light = light.add(&irradiance_of_delta(random.direction()).scale(random.signed().powi(4)));
                }
                let window = least_nonnegative_window(shape, &light).unwrap();
                let after = order_2_minimum(&window.apply(&light)).unwrap()[0];
                assert!(after >= -1e-9 * light.mean()[0], "{window:?} {after}");
                if window == Window::None {
                    assert!(order_2_minimum(&light).unwrap()[0] >= 0.0);
                } else {
                    let weaker = shape.with_width(width(window) * 1.001).apply(&light);
                    assert!(order_2_minimum(&weaker).unwrap()[0] < 0.0, "{window:?}");
                }
            }
            let delta = irradiance_of_delta([0.6, 0.0, 0.8]);
            let found = width(least_nonnegative_window(shape, &delta).unwrap());
            let turned = width(least_nonnegative_window(shape, &irradiance_of_delta([0.0, 0.0, 1.0])).unwrap());
            assert!(found.is_finite() && (found / turned - 1.0).abs() < 1e-9, "{found} {turned}");
        }
    }

    #[test]
    fn the_worst_channel_decides() {
        let delta = irradiance_of_delta([0.0, 0.0, 1.0]);
        let values: Vec<[f64; 3]> = delta.values().iter().map(|v| [0.0, v[0], 0.1 * v[0]]).collect();
        let colour = Sh::<3>::new(3, values).unwrap();
        let (one, all) = (
            least_nonnegative_window(WindowShape::Hann, &delta).unwrap(),
            least_nonnegative_window(WindowShape::Hann, &colour).unwrap(),
        );
        assert!((width(one) / width(all) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn functions_that_no_window_helps_are_refused() {
        let negative = Sh1::new(1, vec![[-1.0]]).unwrap();
        let error = least_nonnegative_window(WindowShape::Hann, &negative).unwrap_err();
        assert!(matches!(error, ShError::NegativeMean { channel: 0, .. }));
        let nan = Sh1::new(1, vec![[f64::NAN]]).unwrap();
        assert!(least_nonnegative_window(WindowShape::Hann, &nan).is_err());
        let long = Sh1::zero(4).unwrap();
        let error = least_nonnegative_window(WindowShape::Sinc4, &long).unwrap_err();
        assert!(matches!(error, ShError::TooManyBands { found: 4, limit: 3, .. }));
        assert_eq!(least_nonnegative_window(WindowShape::Sinc4, &Sh1::zero(3).unwrap()), Ok(Window::None));
    }
}
