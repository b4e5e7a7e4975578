//! One path from the eye: what light comes along it.
//!
//! At each surface one light is asked directly, and the path goes on in a direction that the surface proposes; what is found both
//! ways is weighed by the power heuristic. J. T. Kajiya, "The Rendering Equation", SIGGRAPH 1986; E. Veach, "Robust Monte Carlo
//! Methods for Light Transport Simulation", 1997, chapters 8 to 10.

use crate::finish::attenuation;
use crate::light::{Density, Source, shape};
use crate::rays::Ray;
use crate::sampler::Sampler;
use crate::settings::{LightPaths, LightSampling, TraceSettings, Visibility};
use crate::vertex::Vertex;
use crate::world::{Meeting, World, leaving};
use lumisphere_bsdf::Rgb;
use lumisphere_scene::photometry::luminance;
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::try_normalize;

/// What a path from the eye found.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Found {
    pub(crate) radiance: Rgb,
    pub(crate) first: Option<FirstHit>,
}

/// The surface that the eye sees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FirstHit {
    /// Of shading, unit, in the world.
    pub(crate) normal: Vec3,
    /// Base colour of the material.
    pub(crate) base_color: Rgb,
    /// Along the ray, in metres.
    pub(crate) distance: f64,
}

/// The last scattering on the way, for the weight of light that is met.
#[derive(Debug, Clone, Copy)]
struct Last {
    point: Vec3,
    wi: Vec3,
    pdf: f64,
}

/// Dimensions of a vertex: the surface's three, the roulette's, the place on a light, its choice. Pairs begin a group of four.
const SURFACE: usize = 0;
const ROULETTE: usize = 3;
const LIGHT: usize = 4;
const CHOICE: usize = 6;
/// Salts of the keys of holes.
const ALONG: u64 = 1;
const TO_LIGHT: u64 = 2;
/// Paths survive the roulette with at most this probability, so that they end even where all is white.
const SURVIVAL: f64 = 0.98;

/// Traces paths through a world.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PathTracer<'w> {
    pub(crate) world: &'w World<'w>,
    pub(crate) settings: TraceSettings,
}

impl PathTracer<'_> {
    /// Light along a ray from the eye, whose direction has length 1.
    pub(crate) fn trace(&self, mut ray: Ray, mut sampler: Sampler) -> Found {
        let mut found = Found::default();
        let mut throughput = [1.0; 3];
        let mut last: Option<Last> = None;
        let mut scatterings = 0;
        loop {
            let place = match self.world.meet(&ray, sampler.stray_key(ALONG)) {
                Meeting::Surface(place) => place,
                Meeting::Nothing => {
                    add(&mut found.radiance, throughput, self.environment_met(ray.direction.map(f64::from), last));
                    return found;
                }
                Meeting::Light { index, radiance } => {
                    add(&mut found.radiance, throughput, self.shape_met(index, radiance, last));
                    return found;
                }
            };
            let direction = ray.direction.map(f64::from);
            let vertex = Vertex::new(self.world, place, try_normalize(direction).unwrap_or(direction));
            if scatterings == 0 {
                found.first = Some(first_hit(&vertex));
            }
            if let Some(volume) = vertex.material.volume.filter(|_| vertex.seen_from_inside()) {
                throughput = times(throughput, attenuation(&volume, vertex.place.distance));
            }
            add(&mut found.radiance, throughput, self.surface_met(&vertex, last));
            if scatterings >= self.settings.scatterings() {
                return found;
            }
            sampler.next_block();
            add(&mut found.radiance, throughput, self.light_asked(&vertex, &sampler));
            let Some((wi, weight, pdf)) = vertex.sample(sampler.numbers(SURFACE)) else { return found };
            throughput = times(throughput, weight);
            scatterings += 1;
            if scatterings >= self.settings.roulette_after && !survives(&mut throughput, sampler.number(ROULETTE)) {
                return found;
            }
            if throughput == [0.0; 3] {
                return found;
            }
            last = Some(Last { point: vertex.point.map(f64::from), wi, pdf });
            if self.sees_through() {
                add(&mut found.radiance, throughput, self.environment_met(wi, last));
                return found;
            }
            ray = leaving(vertex.point, vertex.normal, wi);
        }
    }

    /// Whether scattered light meets nothing but the environment.
    fn sees_through(&self) -> bool {
        self.settings.light_paths == LightPaths::Environment && self.settings.visibility == Visibility::Ignored
    }

    /// One light, asked directly: f |cos θ| L / pdf.
    fn light_asked(&self, vertex: &Vertex, sampler: &Sampler) -> Rgb {
        if self.settings.light_sampling == LightSampling::Surfaces {
            return [0.0; 3];
        }
        self.try_light(vertex, sampler).unwrap_or([0.0; 3])
    }

    fn try_light(&self, vertex: &Vertex, sampler: &Sampler) -> Option<Rgb> {
        let (source, probability) = self.choose(|| sampler.number(CHOICE))?;
        let arriving = self.world.arriving(source, vertex.point.map(f64::from), sampler.numbers(LIGHT))?;
        let (scattered, surface_pdf) = vertex.scattered(arriving.wi)?;
        let factor = match arriving.density {
            Density::Sharp => 1.0 / probability,
            Density::Spread(pdf) => self.light_weight(pdf * probability, surface_pdf) / (pdf * probability),
        };
        let light = times(scattered, arriving.light).map(|c| c * factor);
        let hidden = || {
            let key = sampler.stray_key(TO_LIGHT);
            !self.sees_through() && !self.world.reaches(vertex.point, vertex.normal, source, &arriving, key)
        };
        (luminance(light) > 0.0 && !hidden()).then_some(light)
    }

    /// A light of those that count, and its probability.
    fn choose(&self, u: impl FnOnce() -> f64) -> Option<(Source, f64)> {
        match self.settings.light_paths {
            LightPaths::Environment => Some((Source::Environment, 1.0)),
            LightPaths::Direct | LightPaths::Full => self.world.lights().choose(u),
        }
    }

    fn probability(&self, source: Source) -> f64 {
        match self.settings.light_paths {
            LightPaths::Environment => 1.0,
            LightPaths::Direct | LightPaths::Full => self.world.lights().probability(source),
        }
    }

    fn environment_met(&self, wi: Vec3, last: Option<Last>) -> Rgb {
        let Some(environment) = self.world.environment() else { return [0.0; 3] };
        let (radiance, pdf) = environment.look(wi);
        self.weighed(radiance, last, |_| pdf * self.probability(Source::Environment))
    }

    fn shape_met(&self, index: usize, radiance: Rgb, last: Option<Last>) -> Rgb {
        if self.settings.light_paths == LightPaths::Environment {
            return [0.0; 3];
        }
        let light_pdf = |last: &Last| {
            let pdf = self.world.scene().lights.get(index).and_then(|l| shape::pdf(&l.shape, last.point, last.wi));
            pdf.unwrap_or(0.0) * self.probability(Source::Shape(index))
        };
        self.weighed(radiance, last, light_pdf)
    }

    fn surface_met(&self, vertex: &Vertex, last: Option<Last>) -> Rgb {
        if self.settings.light_paths == LightPaths::Environment || !vertex.material.emits() {
            return [0.0; 3];
        }
        let away = vertex.frame.world_from_local(vertex.wo);
        let radiance = self.world.emitted(vertex.place.triangle, vertex.place.at, away);
        let light_pdf = |last: &Last| {
            self.world.triangle_pdf(vertex, last.wi) * self.probability(Source::Triangle(vertex.place.triangle))
        };
        self.weighed(radiance, last, light_pdf)
    }

    /// Light that is met by a path, weighed against its being asked directly; all of it if the eye sees it.
    fn weighed(&self, radiance: Rgb, last: Option<Last>, light_pdf: impl Fn(&Last) -> f64) -> Rgb {
        let Some(last) = last.filter(|_| radiance != [0.0; 3]) else { return radiance };
        let weight = match self.settings.light_sampling {
            LightSampling::Combined => power_heuristic(last.pdf, light_pdf(&last)),
            LightSampling::Surfaces => 1.0,
            // What no light proposes is found by surfaces alone.
            LightSampling::Lights => f64::from(u8::from(light_pdf(&last) == 0.0)),
        };
        radiance.map(|c| c * weight)
    }

    fn light_weight(&self, light_pdf: f64, surface_pdf: f64) -> f64 {
        match self.settings.light_sampling {
            LightSampling::Combined => power_heuristic(light_pdf, surface_pdf),
            LightSampling::Lights | LightSampling::Surfaces => 1.0,
        }
    }
}

/// own² / (own² + other²).
fn power_heuristic(own: f64, other: f64) -> f64 {
    let ratio = other / own;
    if own > 0.0 { 1.0 / (1.0 + ratio * ratio) } else { 0.0 }
}

/// Ends a path at random, or makes up for those that ended.
fn survives(throughput: &mut Rgb, u: f64) -> bool {
    let chance = throughput.iter().fold(0.0, |a, &b| f64::max(a, b)).min(SURVIVAL);
    let survives = u < chance;
    if survives {
        *throughput = throughput.map(|c| c / chance);
    }
    survives
}

fn first_hit(vertex: &Vertex) -> FirstHit {
    let side = if vertex.wo[2] < 0.0 { -1.0 } else { 1.0 };
    FirstHit {
        normal: vertex.frame.normal.map(|c| side * c),
        base_color: vertex.finish.base_color,
        distance: vertex.place.distance,
    }
}

fn times(a: Rgb, b: Rgb) -> Rgb {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

fn add(sum: &mut Rgb, throughput: Rgb, light: Rgb) {
    for c in 0..3 {
        sum[c] += throughput[c] * light[c];
    }
}
