//! `sh.json`: the spherical harmonics, plain and in the layouts that engines take.

use crate::choices::ShWindowChoice;
use anyhow::{Result, bail};
use lumisphere::sh::packed::{FilamentNine, IrradianceMatrix, SevenVectors, form_factor, irradiance};
use lumisphere::sh::window::least_nonnegative_window;
use lumisphere::sh::{ShRgb, Window, WindowShape};
use serde::{Deserialize, Serialize};

/// Name of the file.
pub(crate) const FILE: &str = "sh.json";
/// What `kind` says.
pub(crate) const KIND: &str = "lumisphere spherical harmonics";
/// Bands from which the packed forms are made.
const PACKED_BANDS: usize = 3;

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ShFile {
    pub kind: String,
    /// Basis, order, frame.
    pub convention: String,
    pub band_count: usize,
    /// What the irradiance forms were filtered with.
    pub window: WindowRecord,
    /// L, never filtered.
    pub radiance: Coefficients,
    /// E.
    pub irradiance: Coefficients,
    /// E/π.
    pub form_factor: Coefficients,
    pub seven_vectors: Named<[[f32; 4]; 7]>,
    pub filament_nine: Named<[[f64; 3]; 9]>,
    pub irradiance_matrices: Named<[[[f64; 4]; 4]; 3]>,
}

/// RGB coefficients with a line on what they are.
pub(crate) type Coefficients = Named<Vec<[f64; 3]>>;

/// Values with a line on what they are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Named<T> {
    pub convention: String,
    pub values: T,
}

/// A window in numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct WindowRecord {
    pub choice: ShWindowChoice,
    /// What every band of the irradiance forms was multiplied by.
    pub band_factors: Vec<f64>,
}

fn named<T>(convention: &str, values: T) -> Named<T> {
    Named { convention: convention.to_owned(), values }
}

impl ShFile {
    /// All forms of a radiance.
    pub(crate) fn new(radiance: &ShRgb, choice: ShWindowChoice) -> Result<Self> {
        let window = window(radiance, choice)?;
        // Only three bands can be held to be nowhere negative.
        let bands = if choice == ShWindowChoice::Nonnegative { PACKED_BANDS } else { radiance.band_count() };
        let filtered = window.apply(&radiance.truncated(bands));
        Ok(Self {
            kind: KIND.to_owned(),
            convention: "real orthonormal basis with Condon-Shortley sign, polar axis +z; right-handed world, +Y up, \
                         -Z forward; coefficient (l, m) at l(l+1)+m; linear Rec.709 red, green, blue"
                .to_owned(),
            band_count: radiance.band_count(),
            window: WindowRecord { choice, band_factors: window.factors(filtered.band_count()) },
            radiance: named(
                "L(w) = sum of values times basis; the window is not applied here",
                radiance.values().to_vec(),
            ),
            irradiance: named(
                "E(n) = integral of L(w) max(n.w, 0) dw, no 1/pi inside",
                irradiance(&filtered).into_values(),
            ),
            form_factor: named("E(n)/pi: what a white diffuse surface reflects", form_factor(&filtered).into_values()),
            seven_vectors: named(
                "E(n)/pi in 7 vectors cAr cAg cAb cBr cBg cBb cC: dot(cA, (x,y,z,1)) + dot(cB, (xy,yz,zz,zx)) + cC (xx-yy)",
                SevenVectors::from_radiance(&filtered).vectors(),
            ),
            filament_nine: named(
                "E(n)/pi as Filament sums it: v0 + v1 y + v2 z + v3 x + v4 yx + v5 yz + v6 (3zz-1) + v7 zx + v8 (xx-yy)",
                FilamentNine::from_radiance(&filtered).values,
            ),
            irradiance_matrices: named(
                "E(n) = n^T M n with n = (x,y,z,1): 4x4 rows for red, green, blue",
                IrradianceMatrix::from_radiance(&filtered).channels,
            ),
        })
    }

    /// Reads what [`Self::new`] made.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self> {
        let file: Self = serde_json::from_slice(bytes)?;
        if file.kind != KIND {
            bail!("found {:?}, expected {KIND:?}", file.kind);
        }
        Ok(file)
    }

    /// The radiance of the file.
    pub(crate) fn radiance(&self) -> Result<ShRgb> {
        Ok(ShRgb::new(self.band_count, self.radiance.values.clone())?)
    }
}

fn window(radiance: &ShRgb, choice: ShWindowChoice) -> Result<Window> {
    let width = radiance.band_count() as f64;
    Ok(match choice {
        ShWindowChoice::None => Window::None,
        ShWindowChoice::Hann => Window::Hann(width),
        ShWindowChoice::Lanczos => Window::Lanczos(width),
        ShWindowChoice::Sinc4 => Window::Sinc4(width),
        ShWindowChoice::Nonnegative => {
            least_nonnegative_window(WindowShape::Hann, &irradiance(&radiance.truncated(PACKED_BANDS)))?
        }
    })
}
