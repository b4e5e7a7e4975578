//! One image of the file: PNG or WebP, told apart by their first bytes as browsers do.

use crate::error::{CodecError, FileFormat::Env};
use image_webp::WebPDecoder;
use std::io::Cursor;

/// Stored samples of a face of `side` x `side` texels, rows as the image has them. `what` names the face in errors.
pub(super) fn decode(bytes: &[u8], side: usize, what: &str) -> Result<Vec<[u8; 4]>, CodecError> {
    if bytes.starts_with(b"RIFF") {
        webp(bytes, side, what)
    } else {
        crate::png::decode_samples(bytes, side, side).map_err(|error| CodecError::damaged(Env, what, error))
    }
}

fn webp(bytes: &[u8], side: usize, what: &str) -> Result<Vec<[u8; 4]>, CodecError> {
    let damaged = |error| CodecError::damaged(Env, what, error);
    let check = |(width, height): (usize, usize)| {
        if (width, height) == (side, side) {
            return Ok(());
        }
        Err(CodecError::invalid(
            Env,
            format!("the size of {what}"),
            format!("{width} x {height}"),
            format!("{side} x {side}"),
        ))
    };
    // A lossy frame has a size of its own, for which the decoder allocates before it compares.
    if let Some(size) = lossy_frame_size(bytes) {
        check(size)?;
    }
    let mut decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    check((width as usize, height as usize))?;
    if decoder.is_animated() {
        return Err(CodecError::unsupported(Env, format!("an animation as {what}"), "a still image"));
    }
    let channels = if decoder.has_alpha() { 4 } else { 3 };
    let mut samples = vec![0; side * side * channels];
    decoder.read_image(&mut samples).map_err(damaged)?;
    let alpha = |s: &[u8]| if channels == 4 { s[3] } else { 255 };
    Ok(samples.chunks_exact(channels).map(|s| [s[0], s[1], s[2], alpha(s)]).collect())
}

/// The size that the first `VP8 ` chunk declares (RFC 6386, section 9.1), found as RFC 9649, section 2.3 lays chunks out.
fn lossy_frame_size(bytes: &[u8]) -> Option<(usize, usize)> {
    let mut rest = bytes.get(12..)?;
    loop {
        let (header, body) = rest.split_at_checked(8)?;
        let length = u32::from_le_bytes([header[4], header[5], header[6], header[7]]) as usize;
        if &header[..4] == b"VP8 " {
            // Three bytes of tag and three of start code; the two upper bits of each side are a scale.
            let side = |at: usize| Some(usize::from(u16::from_le_bytes([*body.get(at)?, *body.get(at + 1)?]) & 0x3fff));
            return Some((side(6)?, side(8)?));
        }
        rest = body.get(length.checked_add(length % 2)?..)?;
    }
}
