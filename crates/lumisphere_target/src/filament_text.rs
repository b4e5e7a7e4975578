//! Filament's nine as text: nine lines of red, green and blue.
//!
//! Filament's loaders split the key `sh` of a KTX1 file at single white-space characters (filament 1.53.4,
//! `createIblFromKtx1`), so nothing else may stand between two numbers.

use crate::error::TargetError;
use crate::sh_json::{ShWindow, packed_radiance};
use lumisphere_sh::ShRgb;
use lumisphere_sh::packed::FilamentNine;

/// E/π of three bands of radiance.
pub(crate) fn filament_text(radiance: &ShRgb, window: ShWindow) -> Result<String, TargetError> {
    Ok(nine_text(&FilamentNine::from_radiance(&packed_radiance(radiance, window)?)))
}

/// The text of the key `sh` and of `sh.txt`: a line of red, green and blue for each of the nine, to nine decimals.
pub fn nine_text(nine: &FilamentNine) -> String {
    nine.values.iter().map(|[r, g, b]| format!("{r:.9} {g:.9} {b:.9}\n")).collect()
}
