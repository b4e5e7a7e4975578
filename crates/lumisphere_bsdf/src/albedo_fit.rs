//! The directional albedo as functions that need no table, for shaders: [`FITS`].
//!
//! Each function is written in what every shading language has, and its text is translated by
//! `lumisphere_target::fit_source`, so that what is tested here is what runs there.
//!
//! GGX: the loss of the height-correlated Smith model depends, for small α, on n·v/α alone and never vanishes near n·v = α. So both
//! functions are rational in t = n·v/(n·v + α), whose lines meet at the corner where n·v and α vanish. The bias is
//! total · (1 - c)⁵ with c the cosine that stands for v·h in Schlick's factor; fitting c keeps the steep power out of the polynomials.
//! The coefficients minimise the largest error over 8100 points (n·v from 1e-4 to 1, half of them below 0.1; p from 0 to 1 by 1/80)
//! by a sequence of linear programmes, started from a polynomial that was fitted by Lawson's reweighting. That of the average and of
//! the walls of Oren-Nayar are Lawson's alone.
//!
//! Left out, for no function of this size (19 coefficients) was within 2e-3: Charlie with the masking of Estevez and Kulla (1.4e-2
//! for p ≥ 0.3, where the masking's own fit has a kink), with Neubelt's (2.4e-3 there), and either below p = 0.3 (over 4e-3).

/// A function that stands for a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlbedoFit {
    /// The model it is of, "dfg" for the DFG table.
    pub of: &'static str,
    /// Its name.
    pub function: &'static str,
    /// The names of what it takes.
    pub arguments: &'static [&'static str],
    /// How many numbers it returns.
    pub result: FitResult,
    /// What it returns, in words.
    pub returns: &'static str,
    /// Where the error was measured, in words.
    pub domain: &'static str,
    /// The largest absolute error in the domain, rounding of f32 left out (tests in `tests/albedo_fit.rs`).
    pub error: f64,
}

/// What a function returns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FitResult {
    /// A number.
    One,
    /// Two numbers.
    Pair,
}

impl AlbedoFit {
    /// The statements of the function: `let name = expression;` each, and an expression at last. Only `+ - * / sqrt()`, numbers
    /// and names, and for [`FitResult::Pair`] brackets about the last.
    pub fn body(&self) -> String {
        let text = include_str!("albedo_fit.rs");
        let opening = format!("pub fn {}(", self.function);
        let function = text.split_once(&opening).map_or("", |parts| parts.1);
        let body = function.split_once("{\n").map_or("", |parts| parts.1);
        body.split_once("\n}\n").map_or("", |parts| parts.0).to_owned()
    }
}

/// Every fit.
pub const FITS: &[AlbedoFit] = &[
    AlbedoFit {
        of: "dfg",
        function: "ggx_albedo_pair",
        arguments: &["n_dot_v", "p"],
        result: FitResult::Pair,
        returns: "GGX with height-correlated Smith: (albedo for F0 = 0, for F0 = 1), both with F90 = 1; mix them by F0.",
        domain: "n_dot_v from 1e-4 to 1, perceptual roughness p from 0 to 1",
        error: 1.8e-3,
    },
    AlbedoFit {
        of: "dfg",
        function: "ggx_average_albedo",
        arguments: &["p"],
        result: FitResult::One,
        returns: "GGX with height-correlated Smith: the mean albedo over the cosine for F = 1.",
        domain: "Perceptual roughness p from 0 to 1",
        error: 1e-4,
    },
    AlbedoFit {
        of: "oren-nayar-improved",
        function: "oren_nayar_improved_albedo",
        arguments: &["n_dot_v", "sigma"],
        result: FitResult::One,
        returns: "Fujii's Oren-Nayar: directional albedo for albedo 1.",
        domain: "n_dot_v and sigma from 0 to 1",
        error: 1e-4,
    },
    AlbedoFit {
        of: "eon",
        function: "eon_albedo",
        arguments: &["n_dot_v", "sigma", "albedo"],
        result: FitResult::One,
        returns: "Energy-preserving Oren-Nayar: directional albedo, a channel at a time.",
        domain: "n_dot_v, sigma and albedo from 0 to 1",
        error: 1e-4,
    },
    AlbedoFit {
        of: "burley",
        function: "burley_albedo",
        arguments: &["n_dot_v", "p"],
        result: FitResult::One,
        returns: "Burley: directional albedo for albedo 1, in closed form.",
        domain: "n_dot_v and perceptual roughness p from 0 to 1",
        error: 1e-6,
    },
    AlbedoFit {
        of: "burley-renormalised",
        function: "burley_renormalised_albedo",
        arguments: &["n_dot_v", "p"],
        result: FitResult::One,
        returns: "Burley renormalised: directional albedo for albedo 1, in closed form.",
        domain: "n_dot_v and perceptual roughness p from 0 to 1",
        error: 1e-6,
    },
];

/// [`crate::DfgTerms::multi_scatter_pair`] of GGX with height-correlated Smith, with 38 coefficients. The largest error is 1.5e-3 of
/// the first number and 1.4e-3 of the second (test `ggx_pair`); E = mix(first, second, F0) is as good for every F0.
pub fn ggx_albedo_pair(n_dot_v: f64, p: f64) -> [f64; 2] {
    let a = p * p + 0.000001;
    let t = n_dot_v / (n_dot_v + a);
    let r = sqrt(t);
    let loss_above = 0.15204
        + a * (0.725753 + a * (2.33554 - a * 0.197081))
        + r * (0.176348 + a * (-2.11082 - a * 1.96527) + r * (-0.364398 + a * 1.48151 + r * 0.0273389));
    let loss_below = 1.0
        + a * (-0.908789 + a * (0.223827 + a * 0.0481018))
        + r * (-0.0919848 + a * (2.77809 - a * 0.317564) + r * (-3.14507 - a * 2.08737 + r * 2.4775));
    let total = 1.0 - t * (1.0 - t) * loss_above / loss_below;
    let cosine_above = 8.77487
        + p * (4.51963 + p * (69.2282 - p * 24.8418))
        + t * (34.441 + p * (-17.8496 + p * 14.6902) + t * (-81.5305 + p * 6.39679 + t * 51.885));
    let cosine_below = 1.0
        + p * (18.1041 + p * (-6.69567 + p * 113.115))
        + t * (6.23881 + p * (57.0274 + p * 31.4091) + t * (4.98093 - p * 77.1156 + t * 1.30264));
    let m = 1.0 - (n_dot_v + a) * cosine_above / cosine_below;
    [total * m * m * m * m * m, total]
}

/// [`crate::dfg::ggx_average_albedo`] with height-correlated Smith.
pub fn ggx_average_albedo(p: f64) -> f64 {
    let p2 = p * p;
    1.0 - p2 * (-0.016166 + p * (0.400986 + p * (2.852366 + p * (-4.177391 + p * 1.531127))))
}

/// Fujii's Oren-Nayar for ρ = 1: (1 + σ g)/(1 + c₁ σ), as for EON (arXiv 2410.18026), with g fitted to 2.5e-5 by a root and a cubic.
pub fn oren_nayar_improved_albedo(n_dot_v: f64, sigma: f64) -> f64 {
    let s = sqrt((1.0 - n_dot_v) * (1.0 + n_dot_v));
    let g = s * (0.293448 - 0.0056796 * s + n_dot_v * (-0.317487 + n_dot_v * (-0.0068721 + n_dot_v * 0.031602)));
    (1.0 + sigma * g) / (1.0 + 0.2877934 * sigma)
}

/// EON: ρ E + ρ_m (1 - E) with the E of [`oren_nayar_improved_albedo`] and the ρ_m of the paper.
pub fn eon_albedo(n_dot_v: f64, sigma: f64, albedo: f64) -> f64 {
    let s = sqrt((1.0 - n_dot_v) * (1.0 + n_dot_v));
    let g = s * (0.293448 - 0.0056796 * s + n_dot_v * (-0.317487 + n_dot_v * (-0.0068721 + n_dot_v * 0.031602)));
    let single = (1.0 + sigma * g) / (1.0 + 0.2877934 * sigma);
    let average = (1.0 + 0.0724882 * sigma) / (1.0 + 0.2877934 * sigma);
    let multiple = albedo * average / (1.0 - albedo * (1.0 - average));
    albedo * (single + multiple * (1.0 - single))
}

/// Burley for ρ = 1: polynomials of n·v and p, by the moments of (1 - n·l)⁵ and the mean over the azimuth.
pub fn burley_albedo(n_dot_v: f64, p: f64) -> f64 {
    let base = p - 0.5;
    let along = p * n_dot_v;
    let across2 = 0.5 * p * p * (1.0 - n_dot_v * n_dot_v);
    let m = 1.0 - n_dot_v;
    let falloff = m * m * m * m * m;
    let linear = base / 21.0 + along / 84.0 + falloff * (base + along * 2.0 / 3.0);
    let square = base * base / 21.0 + base * along / 42.0 + along * along / 252.0 + across2 * 11.0 / 252.0;
    1.0 + linear + falloff * square
}

/// Burley renormalised for ρ = 1: as [`burley_albedo`] with its own base and factor.
pub fn burley_renormalised_albedo(n_dot_v: f64, p: f64) -> f64 {
    let base = 1.5 * p - 1.0;
    let along = p * n_dot_v;
    let across2 = 0.5 * p * p * (1.0 - n_dot_v * n_dot_v);
    let m = 1.0 - n_dot_v;
    let falloff = m * m * m * m * m;
    let linear = base / 21.0 + along / 84.0 + falloff * (base + along * 2.0 / 3.0);
    let square = base * base / 21.0 + base * along / 42.0 + along * along / 252.0 + across2 * 11.0 / 252.0;
    (1.0 - p + p / 1.51) * (1.0 + linear + falloff * square)
}

/// Called as shaders call it.
fn sqrt(x: f64) -> f64 {
    x.sqrt()
}
