//! From texels to a file.

use super::header::{GlFormat, Header, MAGIC, NATIVE_ORDER, gl_format, row_bytes};
use crate::encoded::Encoded;
use crate::error::{CodecError, FileFormat::Ktx1};
use crate::texture::{TexelFormat, Texture};

/// The first row is the top one, the first column the left one.
const ORIENTATION: (&str, &str) = ("KTXorientation", "S=r,T=d");

/// Writes a texture, little-endian. `metadata` are keys and text values, kept in their order after `KTXorientation`, which
/// is added.
///
/// Packing is that of [`pack`](crate::pack); [`Encoded::clamped`] counts over all levels. The 32-bit formats keep every value.
///
/// # Errors
/// [`CodecError::Unwritable`] for block formats and for sizes, levels, keys or texels that do not go with the format.
pub fn encode(texture: &Texture<'_>, format: TexelFormat, metadata: &[(&str, &str)]) -> Result<Encoded, CodecError> {
    encode_as(texture, format, checked(format)?, metadata)
}

/// Writes a texture as Filament loads it: [`encode`], but for `R11F_G11F_B10F` the header has that number, 0x8C3A, where the
/// specification wants the type of its words, 0x8C3B. Filament (1.53, `Ktx1Reader`) knows the format by no other, and its web
/// build aborts on the specification's.
///
/// # Errors
/// As [`encode`].
pub fn encode_for_filament(
    texture: &Texture<'_>,
    format: TexelFormat,
    metadata: &[(&str, &str)],
) -> Result<Encoded, CodecError> {
    let gl = checked(format)?;
    let kind = if format == TexelFormat::B10g11r11 { gl.internal } else { gl.kind };
    encode_as(texture, format, GlFormat { kind, ..gl }, metadata)
}

fn checked(format: TexelFormat) -> Result<GlFormat, CodecError> {
    gl_format(format)
        .ok_or_else(|| CodecError::unwritable(Ktx1, "the texel format", format!("{format:?}"), "one without blocks"))
}

fn encode_as(
    texture: &Texture<'_>,
    format: TexelFormat,
    gl: GlFormat,
    metadata: &[(&str, &str)],
) -> Result<Encoded, CodecError> {
    let key_values = key_value_data(metadata)?;
    let packed = texture.pack(Ktx1, format)?;
    let shape = packed.shape;
    let header = Header {
        gl,
        width: shape.width as u32,
        height: shape.height as u32,
        depth: 0,
        array_elements: 0,
        faces: shape.faces.count() as u32,
        levels: shape.level_count as u32,
        key_value_bytes: length_field("the key/value data", key_values.len())?,
    };
    let mut bytes = MAGIC.to_vec();
    bytes.extend(NATIVE_ORDER.to_le_bytes());
    bytes.extend(header.to_words().into_iter().flat_map(u32::to_le_bytes));
    bytes.extend(key_values);
    for (k, level) in packed.levels.iter().enumerate() {
        let (width, height) = shape.side(k);
        let stride = row_bytes(format, width);
        bytes.extend(length_field("the size of a face", stride * height)?.to_le_bytes());
        if stride * height * shape.faces.count() == level.len() {
            bytes.extend_from_slice(level);
            continue;
        }
        for row in level.chunks_exact(width * format.block_bytes()) {
            bytes.extend_from_slice(row);
            bytes.resize(bytes.len().next_multiple_of(4), 0);
        }
    }
    Ok(Encoded { bytes, clamped: packed.clamped })
}

/// Entries: length, key, NUL, text, NUL, padding to 4 bytes.
fn key_value_data(metadata: &[(&str, &str)]) -> Result<Vec<u8>, CodecError> {
    let mut bytes = Vec::new();
    for (i, (key, value)) in [ORIENTATION].iter().chain(metadata).enumerate() {
        let reserved = i > 0 && key.get(..3).is_some_and(|k| k.eq_ignore_ascii_case("ktx"));
        if key.is_empty() || reserved || key.contains('\0') || value.contains('\0') {
            let found = format!("\"{}\"", key.escape_debug());
            let expected = "text without NUL that does not start with KTX";
            return Err(CodecError::unwritable(Ktx1, "a metadata key", found, expected));
        }
        if metadata[..i.saturating_sub(1)].iter().any(|(earlier, _)| earlier == key) {
            return Err(CodecError::unwritable(Ktx1, "the metadata", format!("\"{key}\" twice"), "each key once"));
        }
        bytes.extend(length_field("a metadata entry", key.len() + value.len() + 2)?.to_le_bytes());
        for text in [key, value] {
            bytes.extend_from_slice(text.as_bytes());
            bytes.push(0);
        }
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    Ok(bytes)
}

fn length_field(what: &str, length: usize) -> Result<u32, CodecError> {
    u32::try_from(length).map_err(|_| CodecError::unwritable(Ktx1, what, format!("{length} bytes"), "less than 4 GiB"))
}
