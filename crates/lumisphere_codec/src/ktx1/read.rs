//! From a file to texels.

use super::header::{GlFormat, Header, LENGTH, MAGIC, NATIVE_ORDER, gl_format, row_bytes, stored_format};
use crate::error::{CodecError, FileFormat::Ktx1};
use crate::limits::Limits;
use crate::texture::{DecodedTexture, Faces, Shape, TexelFormat, section, unpack_images};
use std::borrow::Cow;

/// Decodes a 2D or cube texture of either byte order in one of the plain [`TexelFormat`]s.
///
/// The format is that of `glType` and `glFormat`, in which the texels are stored. The header that cmgen writes, with the
/// internal format in the place of the type, is read too.
///
/// # Errors
/// [`CodecError::Unsupported`] for other formats, arrays and volumes; [`CodecError::TooLarge`] if all levels need more than
/// `limits` allows at 16 bytes a texel; [`CodecError::Truncated`], [`CodecError::Invalid`], [`CodecError::Damaged`].
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<DecodedTexture, CodecError> {
    let file = File::open(bytes)?;
    let header = file.header()?;
    let (format, shape) = check_header(&header)?;
    shape.check(Ktx1, limits)?;
    let metadata = file.metadata(header.key_value_bytes)?;
    let mut levels = Vec::with_capacity(shape.level_count);
    let mut at = LENGTH as u64 + u64::from(header.key_value_bytes);
    for k in 0..shape.level_count {
        let (data, end) = file.level(at, k, format, &shape)?;
        levels.push(unpack_images(Ktx1, &data, format, shape.side(k))?);
        at = end;
    }
    let Shape { width, height, faces, .. } = shape;
    Ok(DecodedTexture { container: Ktx1, format, width, height, faces, levels, metadata })
}

fn check_header(header: &Header) -> Result<(TexelFormat, Shape), CodecError> {
    let format = stored_format(header.gl).ok_or_else(|| {
        let GlFormat { kind, format, internal, .. } = header.gl;
        let what = format!("glType {kind:#x} with glFormat {format:#x} and glInternalFormat {internal:#x}");
        let plain = TexelFormat::ALL.into_iter().filter_map(|f| gl_format(f).map(|_| format!("{f:?}")));
        CodecError::unsupported(Ktx1, what, format!("one of {}", plain.collect::<Vec<_>>().join(", ")))
    })?;
    if header.height == 0 || header.depth > 1 || header.array_elements != 0 {
        let (height, depth, layers) = (header.height, header.depth, header.array_elements);
        let what = format!("a texture of height {height}, depth {depth} and {layers} array elements");
        return Err(CodecError::unsupported(Ktx1, what, "a 2D or cube texture that is no array"));
    }
    let faces = match header.faces {
        1 => Faces::One,
        6 => Faces::Cube,
        count => return Err(CodecError::invalid(Ktx1, "the face count", count, "1 or 6")),
    };
    let (width, height) = (header.width as usize, header.height as usize);
    // No levels: the loader is asked to make them from the one that is stored.
    Ok((format, Shape { width, height, faces, level_count: header.levels.max(1) as usize }))
}

/// A file and its byte order.
struct File<'a> {
    bytes: &'a [u8],
    word: fn([u8; 4]) -> u32,
}

impl<'a> File<'a> {
    fn open(bytes: &'a [u8]) -> Result<Self, CodecError> {
        if section(Ktx1, bytes, "the header", 0, LENGTH as u64)?[..12] != MAGIC {
            return Err(CodecError::invalid(Ktx1, "the identifier", bytes[..12].escape_ascii(), "that of KTX 1.1"));
        }
        let order = [bytes[12], bytes[13], bytes[14], bytes[15]];
        let orders: [fn([u8; 4]) -> u32; 2] = [u32::from_le_bytes, u32::from_be_bytes];
        let word = orders.into_iter().find(|word| word(order) == NATIVE_ORDER);
        let word = word.ok_or_else(|| CodecError::invalid(Ktx1, "the byte order", format!("{order:?}"), "1 to 4"))?;
        Ok(Self { bytes, word })
    }

    fn word(&self, what: &str, at: u64) -> Result<u32, CodecError> {
        let b = section(Ktx1, self.bytes, what, at, 4)?;
        Ok((self.word)([b[0], b[1], b[2], b[3]]))
    }

    fn header(&self) -> Result<Header, CodecError> {
        let mut words = [0; 12];
        for (i, word) in words.iter_mut().enumerate() {
            *word = self.word("the header", 16 + 4 * i as u64)?;
        }
        Ok(Header::from_words(words))
    }

    /// Keys and values; a value loses the NUL that ends text.
    fn metadata(&self, length: u32) -> Result<Vec<(String, Vec<u8>)>, CodecError> {
        let what = "the key/value data";
        let data = section(Ktx1, self.bytes, what, LENGTH as u64, length.into())?;
        let mut pairs = Vec::new();
        let mut at = 0_u64;
        while at < data.len() as u64 {
            let size = section(Ktx1, data, what, at, 4)?;
            let size = u64::from((self.word)([size[0], size[1], size[2], size[3]]));
            let pair = section(Ktx1, data, what, at + 4, size)?;
            let end = pair.iter().position(|b| *b == 0);
            let end = end.ok_or_else(|| CodecError::damaged(Ktx1, what, "a key without NUL"))?;
            let (key, value) = (String::from_utf8_lossy(&pair[..end]).into_owned(), &pair[end + 1..]);
            pairs.push((key, value.strip_suffix(b"\0").unwrap_or(value).to_vec()));
            at += 4 + size.next_multiple_of(4);
        }
        Ok(pairs)
    }

    /// The packed texels of level `k`, whose size stands at `at`, in little-endian order and without padding, and where
    /// the next level starts.
    fn level(&self, at: u64, k: usize, format: TexelFormat, shape: &Shape) -> Result<(Cow<'a, [u8]>, u64), CodecError> {
        let what = format!("level {k}");
        let (width, height) = shape.side(k);
        let stride = row_bytes(format, width);
        let image_size = self.word(&what, at)?;
        if u64::from(image_size) != (stride * height) as u64 {
            return Err(CodecError::invalid(Ktx1, format!("imageSize of {what}"), image_size, stride * height));
        }
        let stored = (stride * height * shape.faces.count()) as u64;
        let data = section(Ktx1, self.bytes, &what, at + 4, stored)?;
        let row = width * format.block_bytes();
        let mut data = match row == stride {
            true => Cow::Borrowed(data),
            false => data.chunks_exact(stride).flat_map(|line| &line[..row]).copied().collect(),
        };
        let unit = gl_format(format).map_or(1, |gl| gl.kind_size as usize);
        // The byte order of texels is that of the fields.
        if (self.word)([1, 2, 3, 4]) != u32::from_le_bytes([1, 2, 3, 4]) {
            data.to_mut().chunks_exact_mut(unit).for_each(<[u8]>::reverse);
        }
        Ok((data, at + 4 + stored))
    }
}
