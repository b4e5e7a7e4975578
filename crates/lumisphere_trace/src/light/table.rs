//! All lights of a world, and the choice of one of them.

use super::distribution::Distribution;
use lumisphere_scene::LightShape;
use lumisphere_scene::photometry::luminance;
use std::f64::consts::PI;

/// Which light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Source {
    /// One of the scene's lights.
    Shape(usize),
    /// A triangle that emits.
    Triangle(u32),
    /// The environment.
    Environment,
}

/// Lights by their power: flux among those that have a place, irradiance of a ball among those that are far away. Where there are
/// both, each kind is chosen half of the time, since which of them matters depends on where one stands.
#[derive(Debug, Clone, Default)]
pub(crate) struct LightTable {
    shapes: usize,
    /// Triangles that emit, ascending.
    triangles: Vec<u32>,
    choice: Distribution,
    /// The light that is chosen for sure.
    only: Option<Source>,
}

impl LightTable {
    /// `triangles` with the flux of each, ascending; `environment` the luminance of its whole sphere.
    pub(crate) fn new(shapes: &[LightShape], triangles: &[(u32, f64)], environment: f64) -> Self {
        let local = shapes.iter().map(local_power).chain(triangles.iter().map(|t| t.1)).chain([0.0]);
        let distant = shapes.iter().map(distant_power).chain(triangles.iter().map(|_| 0.0)).chain([environment]);
        let share = |kind: &[f64]| {
            let sum: f64 = kind.iter().filter(|w| w.is_finite()).sum();
            if sum > 0.0 { 1.0 / sum } else { 0.0 }
        };
        let (local, distant): (Vec<f64>, Vec<f64>) = (local.collect(), distant.collect());
        let scales = [share(&local), share(&distant)];
        let weights = local.iter().zip(&distant).map(|(a, b)| a * scales[0] + b * scales[1]);
        let mut table = Self {
            shapes: shapes.len(),
            triangles: triangles.iter().map(|t| t.0).collect(),
            choice: Distribution::new(weights),
            only: None,
        };
        table.only = table.choose(|| 0.0).filter(|(_, probability)| *probability == 1.0).map(|(source, _)| source);
        table
    }

    /// A light and its probability, by a number that is asked for only if there are several.
    pub(crate) fn choose(&self, u: impl FnOnce() -> f64) -> Option<(Source, f64)> {
        if let Some(only) = self.only {
            return Some((only, 1.0));
        }
        let (index, _) = self.choice.sample(u())?;
        let source = match index.checked_sub(self.shapes) {
            None => Source::Shape(index),
            Some(i) => self.triangles.get(i).map_or(Source::Environment, |&triangle| Source::Triangle(triangle)),
        };
        Some((source, self.choice.probability(index)))
    }

    /// The probability of a light.
    pub(crate) fn probability(&self, source: Source) -> f64 {
        if self.only == Some(source) {
            return 1.0;
        }
        let index = match source {
            Source::Shape(index) => index,
            Source::Triangle(triangle) => match self.triangles.binary_search(&triangle) {
                Ok(index) => self.shapes + index,
                Err(_) => return 0.0,
            },
            Source::Environment => self.shapes + self.triangles.len(),
        };
        self.choice.probability(index)
    }
}

/// Luminous flux.
fn local_power(shape: &LightShape) -> f64 {
    match shape {
        LightShape::Point { intensity, .. } => 4.0 * PI * luminance(*intensity),
        LightShape::Spot { intensity, outer_angle, .. } => 2.0 * PI * (1.0 - outer_angle.cos()) * luminance(*intensity),
        LightShape::Sphere { luminance: l, .. } | LightShape::Rectangle { luminance: l, .. } => {
            PI * shape.area() * luminance(*l)
        }
        LightShape::Directional { .. } => 0.0,
    }
}

/// Illuminance of a surface that faces the light.
fn distant_power(shape: &LightShape) -> f64 {
    match shape {
        LightShape::Directional { illuminance, .. } => luminance(*illuminance),
        _ => 0.0,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn kinds_share_and_lights_of_a_kind_go_by_power() {
        let point = |candela: f64| LightShape::Point { position: [0.0; 3], intensity: [candela; 3] };
        let sun = LightShape::Directional { direction: [0.0, -1.0, 0.0], illuminance: [3.0; 3] };
        let table = LightTable::new(&[point(1.0), sun], &[(4, 4.0 * PI), (9, 8.0 * PI)], 1.0);
        let expected = [
            (Source::Shape(0), 0.125),
            (Source::Shape(1), 0.375),
            (Source::Triangle(4), 0.125),
            (Source::Triangle(9), 0.25),
            (Source::Environment, 0.125),
            (Source::Triangle(5), 0.0),
        ];
        for (source, probability) in expected {
            assert!((table.probability(source) - probability).abs() < 1e-12, "{source:?}");
        }
        let mut counts = [0; 5];
        for i in 0..800 {
            let (source, probability) = table.choose(|| (f64::from(i) + 0.5) / 800.0).unwrap();
            let index = expected.iter().position(|e| e.0 == source).unwrap();
            assert!((probability - expected[index].1).abs() < 1e-12);
            counts[index] += 1;
        }
        assert_eq!(counts, [100, 300, 100, 200, 100]);
        assert_eq!(LightTable::new(&[], &[], 0.0).choose(|| 0.5), None);
    }
}
