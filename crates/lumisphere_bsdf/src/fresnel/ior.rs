//! Index of refraction and reflectance at normal incidence.

use crate::BsdfError;

/// F0 = ((n - 1) / (n + 1))² of a dielectric with relative index `ior`; n and 1/n give the same.
///
/// # Errors
/// [`BsdfError::ParameterValue`] unless `ior` is positive and finite.
pub fn f0_of_ior(ior: f64) -> Result<f64, BsdfError> {
    if ior > 0.0 && ior.is_finite() {
        let r = (ior - 1.0) / (ior + 1.0);
        Ok(r * r)
    } else {
        Err(BsdfError::ParameterValue { parameter: "ior", found: ior, expected: "a positive number".to_owned() })
    }
}

/// The index n = (1 + √F0) / (1 - √F0) ≥ 1 of a dielectric that reflects `f0` at normal incidence.
///
/// # Errors
/// [`BsdfError::ParameterValue`] unless `f0` is in [0, 1): what reflects everything has no index.
pub fn ior_of_f0(f0: f64) -> Result<f64, BsdfError> {
    if (0.0..1.0).contains(&f0) {
        let r = f0.sqrt();
        Ok((1.0 + r) / (1.0 - r))
    } else {
        Err(BsdfError::ParameterValue { parameter: "f0", found: f0, expected: "0 or more, less than 1".to_owned() })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::fresnel::dielectric;

    #[test]
    fn there_and_back() {
        for ior in [1.0, 1.0001, 1.31, 1.5, 2.42, 100.0] {
            let f0 = f0_of_ior(ior).unwrap();
            // The root of a small F0 keeps the digits of n - 1.
            assert!((ior_of_f0(f0).unwrap() - ior).abs() < 1e-12 * ior, "{ior}");
            assert!((f0 - dielectric(1.0, ior)).abs() < 1e-15, "{ior}");
            assert!((f0_of_ior(1.0 / ior).unwrap() - f0).abs() < 1e-15, "{ior}");
        }
        assert!((f0_of_ior(1.5).unwrap() - 0.04).abs() < 1e-16);
    }

    #[test]
    fn what_has_no_index_is_refused() {
        for ior in [0.0, -1.5, f64::NAN, f64::INFINITY] {
            assert!(f0_of_ior(ior).unwrap_err().to_string().starts_with("ior is"), "{ior}");
        }
        for f0 in [-1e-9, 1.0, 1.0219, f64::NAN] {
            assert!(ior_of_f0(f0).unwrap_err().to_string().starts_with("f0 is"), "{f0}");
        }
    }
}
