//! From f |cos θ| to a radius.

use super::slice::Slice;

/// How a value becomes a radius; the rim is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Scale {
    /// The rim and the step between rings, sr⁻¹.
    Linear { rim: f64, step: f64 },
    /// Powers of ten at the rim and at the centre.
    Logarithmic { rim: i32, centre: i32 },
}

/// Peaks further apart than this need a logarithmic radius.
const FURTHEST_PEAKS: f64 = 5.0;
/// Curves narrower than this, in degrees, would be needles on a linear radius.
const NARROWEST: f64 = 15.0;
/// Decades below the lowest peak that a logarithmic radius shows.
const BELOW_PEAK: i32 = 1;
/// Most decades that a logarithmic radius shows.
const MOST_DECADES: i32 = 8;

impl Scale {
    /// One scale for all slices, so that they can be compared.
    pub(crate) fn of<'a>(slices: impl IntoIterator<Item = &'a Slice<'a>>) -> Self {
        let slices: Vec<&Slice<'_>> = slices.into_iter().collect();
        let peaks = slices.iter().flat_map(|s| [s.peak.1].into_iter().chain(s.side_peaks()));
        let peaks: Vec<f64> = peaks.filter(|p| *p > 0.0 && p.is_finite()).collect();
        let high = peaks.iter().copied().fold(0.0, f64::max);
        let low = peaks.iter().copied().fold(f64::INFINITY, f64::min);
        if peaks.is_empty() {
            return Self::linear(1.0);
        }
        let narrow = slices.iter().any(|s| s.peak.1 > 0.0 && s.width() < NARROWEST);
        if high / low > FURTHEST_PEAKS || narrow {
            let rim = high.log10().ceil() as i32;
            let centre = (low.log10().floor() as i32 - BELOW_PEAK).max(rim - MOST_DECADES);
            Self::Logarithmic { rim, centre }
        } else {
            Self::linear(high)
        }
    }

    /// Three to five rings at round values, the rim at or just above `highest`.
    fn linear(highest: f64) -> Self {
        let decade = 10_f64.powf(highest.log10().floor());
        let steps = [0.1, 0.2, 0.25, 0.5, 1.0, 2.0].map(|s| s * decade);
        let step = steps.into_iter().find(|s| highest / s <= 5.0 + 1e-9).unwrap_or(decade);
        Self::Linear { rim: (highest / step - 1e-9).ceil() * step, step }
    }

    /// From 0 at the centre to 1 at the rim.
    pub(crate) fn radius(&self, value: f64) -> f64 {
        match *self {
            Self::Linear { rim, .. } => (value / rim).clamp(0.0, 1.0),
            Self::Logarithmic { rim, centre } => {
                let decades = value.log10() - f64::from(centre);
                // Nothing has the logarithm -∞.
                (decades / f64::from(rim - centre)).clamp(0.0, 1.0)
            }
        }
    }

    /// The rings with their labels, from inside out.
    pub(crate) fn rings(&self) -> Vec<(f64, String)> {
        match *self {
            Self::Linear { rim, step } => {
                let count = (rim / step).round() as i32;
                let ring = |i: i32| (f64::from(i) / f64::from(count), short(f64::from(i) * step));
                (1..=count).map(ring).collect()
            }
            Self::Logarithmic { rim, centre } => {
                let every = ((rim - centre + 3) / 4).max(1);
                let powers = (centre + 1..=rim).filter(|p| (rim - p) % every == 0);
                powers.map(|p| (f64::from(p - centre) / f64::from(rim - centre), power(p))).collect()
            }
        }
    }

    /// What the radius means.
    pub(crate) fn text(&self) -> String {
        match *self {
            Self::Linear { rim, .. } => format!("linear, rim {} sr⁻¹", short(rim)),
            Self::Logarithmic { rim, centre } => {
                format!("logarithmic, rim {}, centre {} sr⁻¹", power(rim), power(centre))
            }
        }
    }
}

/// Four significant digits without zeros at the end.
pub(crate) fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let decimals = (3 - value.abs().log10().floor() as i32).clamp(0, 9) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn power(exponent: i32) -> String {
    match exponent {
        -2..=3 => short(10_f64.powi(exponent)),
        _ => format!("1e{exponent}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_are_round_and_the_rim_holds_the_peak() {
        for highest in [0.1, 0.32, 0.5, 0.99, 1.0, 3.2, 7.0, 49.0, 1234.0] {
            let scale = Scale::linear(highest);
            let rings = scale.rings();
            assert!((2..=5).contains(&rings.len()), "{highest}: {rings:?}");
            assert!((0.5..=1.0).contains(&scale.radius(highest)), "{highest}: {scale:?}");
            assert_eq!(rings[rings.len() - 1].0, 1.0);
        }
        assert_eq!(Scale::linear(0.32).rings()[0].1, "0.1");
    }

    #[test]
    fn decades_are_as_far_apart() {
        let scale = Scale::Logarithmic { rim: 2, centre: -2 };
        for (value, radius) in [(100.0, 1.0), (1.0, 0.5), (0.01, 0.0), (0.0, 0.0), (1e-9, 0.0), (1e9, 1.0)] {
            assert!((scale.radius(value) - radius).abs() < 1e-12, "{value}");
        }
    }
}
