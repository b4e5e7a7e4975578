//! `sh.json`: the spherical harmonics, plain and in the layouts that engines take.

use crate::error::TargetError;
use lumisphere_sh::packed::{FilamentNine, IrradianceMatrix, SevenVectors, form_factor, irradiance};
use lumisphere_sh::window::least_nonnegative_window;
use lumisphere_sh::{ShRgb, Window, WindowShape};
use lumisphere_sphere::AxisTurn;
use serde::{Deserialize, Serialize};

/// What [`ShJson::kind`] says.
pub const SH_KIND: &str = "lumisphere spherical harmonics";
/// Bands from which the packed forms are made.
const PACKED_BANDS: usize = 3;

/// Filter of the irradiance forms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShWindow {
    /// None.
    None,
    /// Hann, as wide as the bands exported.
    Hann,
    /// Lanczos, as wide as the bands exported.
    Lanczos,
    /// The fourth power of sinc, as wide as the bands exported.
    Sinc4,
    /// The weakest Hann window that leaves no negative irradiance.
    Nonnegative,
}

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShJson {
    /// [`SH_KIND`].
    pub kind: String,
    /// Basis, order, frame.
    pub convention: String,
    /// How the world was turned: the file's direction d is the world's turn(d).
    #[serde(default = "no_turn")]
    pub turn: String,
    /// Bands of the radiance.
    pub band_count: usize,
    /// What the irradiance forms were filtered with.
    pub window: WindowRecord,
    /// L, never filtered.
    pub radiance: Coefficients,
    /// E.
    pub irradiance: Coefficients,
    /// E/π.
    pub form_factor: Coefficients,
    /// E/π for two dot products and a term, Unity's and others'.
    pub seven_vectors: Named<[[f32; 4]; 7]>,
    /// E/π, Filament's.
    pub filament_nine: Named<[[f64; 3]; 9]>,
    /// E as quadratic forms.
    pub irradiance_matrices: Named<[[[f64; 4]; 4]; 3]>,
}

/// RGB coefficients with a line on what they are.
pub type Coefficients = Named<Vec<[f64; 3]>>;

/// Values with a line on what they are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Named<T> {
    /// The line.
    pub convention: String,
    /// The values.
    pub values: T,
}

/// A window in numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WindowRecord {
    /// Its name.
    pub choice: ShWindow,
    /// What every band of the irradiance forms was multiplied by.
    pub band_factors: Vec<f64>,
}

fn no_turn() -> String {
    AxisTurn::IDENTITY.to_string()
}

fn named<T>(convention: &str, values: T) -> Named<T> {
    Named { convention: convention.to_owned(), values }
}

impl ShJson {
    /// All forms of a radiance.
    ///
    /// # Errors
    /// [`TargetError::Harmonics`] for a window that the bands cannot have.
    pub fn new(radiance: &ShRgb, turn: AxisTurn, choice: ShWindow) -> Result<Self, TargetError> {
        let window = window(radiance, choice)?;
        // Only three bands can be held to be nowhere negative.
        let bands = if choice == ShWindow::Nonnegative { PACKED_BANDS } else { radiance.band_count() };
        let filtered = window.apply(&radiance.truncated(bands));
        Ok(Self {
            kind: SH_KIND.to_owned(),
            convention: "real orthonormal basis with Condon-Shortley sign, polar axis +z; right-handed world, +Y up, \
                         -Z forward, then turned: direction d here is the world's turn(d); coefficient (l, m) at l(l+1)+m; \
                         linear Rec.709 red, green, blue"
                .to_owned(),
            turn: turn.to_string(),
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

    /// The radiance of the file.
    ///
    /// # Errors
    /// [`TargetError::Harmonics`] if the number of coefficients is not that of the bands.
    pub fn radiance(&self) -> Result<ShRgb, TargetError> {
        Ok(ShRgb::new(self.band_count, self.radiance.values.clone())?)
    }
}

/// Radiance from which irradiance is packed: three bands, filtered.
pub(crate) fn packed_radiance(radiance: &ShRgb, choice: ShWindow) -> Result<ShRgb, TargetError> {
    Ok(window(radiance, choice)?.apply(&radiance.truncated(PACKED_BANDS)))
}

fn window(radiance: &ShRgb, choice: ShWindow) -> Result<Window, TargetError> {
    let width = radiance.band_count() as f64;
    Ok(match choice {
        ShWindow::None => Window::None,
        ShWindow::Hann => Window::Hann(width),
        ShWindow::Lanczos => Window::Lanczos(width),
        ShWindow::Sinc4 => Window::Sinc4(width),
        ShWindow::Nonnegative => {
            least_nonnegative_window(WindowShape::Hann, &irradiance(&radiance.truncated(PACKED_BANDS)))?
        }
    })
}
