//! The header, and how it names the texel formats.

use crate::texture::TexelFormat;

/// The first bytes of the file.
pub(super) const MAGIC: [u8; 12] = *b"\xabKTX 11\xbb\r\n\x1a\n";
/// Bytes of the header, with the first bytes.
pub(super) const LENGTH: usize = 64;
/// The field `endianness` as a reader of the file's own byte order sees it.
pub(super) const NATIVE_ORDER: u32 = 0x0403_0201;

/// The fields after `endianness`, in file order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) gl: GlFormat,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) depth: u32,
    pub(super) array_elements: u32,
    pub(super) faces: u32,
    pub(super) levels: u32,
    pub(super) key_value_bytes: u32,
}

impl Header {
    pub(super) fn from_words(w: [u32; 12]) -> Self {
        let gl = GlFormat { kind: w[0], kind_size: w[1], format: w[2], internal: w[3], base: w[4] };
        let [width, height, depth, array_elements, faces, levels, key_value_bytes] =
            [5, 6, 7, 8, 9, 10, 11].map(|i| w[i]);
        Self { gl, width, height, depth, array_elements, faces, levels, key_value_bytes }
    }

    pub(super) fn to_words(self) -> [u32; 12] {
        let GlFormat { kind, kind_size, format, internal, base } = self.gl;
        let Self { width, height, depth, array_elements, faces, levels, key_value_bytes, .. } = self;
        [kind, kind_size, format, internal, base, width, height, depth, array_elements, faces, levels, key_value_bytes]
    }
}

/// The five fields that describe texels, as arguments of `glTexImage2D` (OpenGL 4.6 core, tables 8.2, 8.3, 8.12).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct GlFormat {
    /// `glType`.
    pub(super) kind: u32,
    /// `glTypeSize`: bytes that a machine of the other byte order swaps.
    pub(super) kind_size: u32,
    /// `glFormat`.
    pub(super) format: u32,
    /// `glInternalFormat`.
    pub(super) internal: u32,
    /// `glBaseInternalFormat`.
    pub(super) base: u32,
}

const FLOAT: u32 = 0x1406;
const HALF_FLOAT: u32 = 0x140b;
/// The value of the OpenGL ES 2 extension.
const HALF_FLOAT_OES: u32 = 0x8d61;
const RGB: u32 = 0x1907;
const RGBA: u32 = 0x1908;
const RG: u32 = 0x8227;

/// The fields for a format; `None` for those that KTX1 is not used for here.
pub(super) fn gl_format(format: TexelFormat) -> Option<GlFormat> {
    let (kind, kind_size, format, internal) = match format {
        TexelFormat::Rgba32F => (FLOAT, 4, RGBA, 0x8814),
        TexelFormat::Rgba16F => (HALF_FLOAT, 2, RGBA, 0x881a),
        TexelFormat::Rgb32F => (FLOAT, 4, RGB, 0x8815),
        TexelFormat::Rgb16F => (HALF_FLOAT, 2, RGB, 0x881b),
        TexelFormat::Rgb9e5 => (0x8c3e, 4, RGB, 0x8c3d),
        TexelFormat::B10g11r11 => (0x8c3b, 4, RGB, 0x8c3a),
        TexelFormat::Rg32F => (FLOAT, 4, RG, 0x8230),
        TexelFormat::Rg16F => (HALF_FLOAT, 2, RG, 0x822f),
        TexelFormat::Bc6hUfloat | TexelFormat::UastcHdr4x4 | TexelFormat::Rgbd8 => return None,
    };
    Some(GlFormat { kind, kind_size, format, internal, base: format })
}

/// The format that the texels are stored in.
///
/// `glType` and `glFormat` say it. cmgen writes the internal format in the place of the type (and 1 as its size, and the
/// internal format again as the base format): then the internal format says it.
pub(super) fn stored_format(gl: GlFormat) -> Option<TexelFormat> {
    let kind = if gl.kind == HALF_FLOAT_OES { HALF_FLOAT } else { gl.kind };
    TexelFormat::ALL.into_iter().find(|f| {
        gl_format(*f).is_some_and(|own| {
            let by_type = (own.kind, own.format) == (kind, gl.format);
            let by_internal_format = gl.kind == gl.internal && own.internal == gl.internal;
            by_type || by_internal_format
        })
    })
}

/// Bytes of a row, which is padded to 4 (`GL_UNPACK_ALIGNMENT`).
pub(super) fn row_bytes(format: TexelFormat, width: usize) -> usize {
    (width * format.block_bytes()).next_multiple_of(4)
}
