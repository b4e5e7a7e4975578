//! References: data URIs, and relative ones with percent-encoding (RFC 2397, RFC 3986).

use super::Resolve;
use crate::SceneError;
use base64::Engine;
use base64::engine::general_purpose::GeneralPurpose;
use base64::engine::{DecodePaddingMode, GeneralPurposeConfig};

/// The bytes that a URI stands for; `what` refers to it.
pub(super) fn fetch(what: &str, uri: &str, resolve: Resolve<'_>) -> Result<Vec<u8>, SceneError> {
    if let Some(data) = uri.strip_prefix("data:") {
        let Some((_, text)) = data.split_once(";base64,") else {
            return Err(SceneError::invalid(
                format!("{what}: uri"),
                "a data URI without base64",
                "data:...;base64,...",
            ));
        };
        let config = GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
        let engine = GeneralPurpose::new(&base64::alphabet::STANDARD, config);
        let damaged = |e: base64::DecodeError| SceneError::invalid(format!("{what}: uri"), e, "base64");
        return engine.decode(text).map_err(damaged);
    }
    let uri = percent_decoded(uri)
        .ok_or_else(|| SceneError::invalid(format!("{what}: uri"), format!("{uri:?}"), "percent-encoded UTF-8"))?;
    resolve(&uri).map_err(|source| SceneError::Unresolved { what: what.to_owned(), uri, source })
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut decoded = Vec::with_capacity(uri.len());
    let mut bytes = uri.bytes();
    while let Some(byte) = bytes.next() {
        if byte == b'%' {
            let mut digit = || char::from(bytes.next()?).to_digit(16);
            decoded.push((digit()? * 16 + digit()?) as u8);
        } else {
            decoded.push(byte);
        }
    }
    String::from_utf8(decoded).ok()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn references_are_decoded_and_data_stays_inside() {
        let mut asked = Vec::new();
        let mut resolve = |uri: &str| {
            asked.push(uri.to_owned());
            Ok(vec![1])
        };
        assert_eq!(fetch("x", "a%20b%C3%A9.bin", &mut resolve).unwrap(), [1]);
        assert_eq!(fetch("x", "data:application/octet-stream;base64,AAEC/w==", &mut resolve).unwrap(), [0, 1, 2, 255]);
        assert_eq!(fetch("x", "data:;base64,AAEC/w", &mut resolve).unwrap(), [0, 1, 2, 255]);
        for bad in ["data:text/plain,hello", "data:;base64,A", "data:;base64,????", "a%2", "a%zz", "%ff%fe"] {
            assert!(fetch("x", bad, &mut resolve).is_err(), "{bad}");
        }
        assert_eq!(asked, ["a b\u{e9}.bin"]);
    }
}
