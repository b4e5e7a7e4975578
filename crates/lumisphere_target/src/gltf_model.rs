//! glTF 2.0 assets that more can be added to, without a change to anything they hold.
//!
//! Indices are what refers to things in glTF, also inside extensions that nobody here knows. So nothing is renumbered and
//! nothing moves: what is added comes behind what was there, in each list and in the bytes of the first buffer.
//!
//! Source: Khronos, glTF 2.0 Specification, sections 3.6 (buffers, data URIs) and 4.4 (the binary form).

use crate::error::TargetError;
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use lumisphere_codec::Encoded;
use serde_json::{Map, Value, json};

/// A model to put a light into.
pub struct GltfModel<'a> {
    /// A `.glb` or the text of a `.gltf`.
    pub bytes: &'a [u8],
    /// Gives the bytes of a file that the model refers to, by the model's own relative URI without percent-encoding.
    ///
    /// The URI is the model's, so it may be hostile: the caller opens none that leaves the model's folder (absolute ones,
    /// ones with `..` or with a scheme such as `https:`) and gives `None` for them. `data:` URIs are never asked for.
    pub resolve: &'a dyn Fn(&str) -> Option<Vec<u8>>,
}

const MAGIC: &[u8; 4] = b"glTF";
const JSON_CHUNK: u32 = 0x4e4f_534a;
const BIN_CHUNK: u32 = 0x004e_4942;
/// Some writers leave the padding out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// An asset that stands alone: no file beside it is needed for its buffers and images.
pub(crate) struct Asset {
    /// All of it but `bytes`.
    pub(crate) json: Map<String, Value>,
    /// The buffer that grows. The first one is the BIN chunk; any other is written as a data URI.
    home: usize,
    /// Its bytes.
    bytes: Vec<u8>,
    /// Chunks of kinds unknown here, with their headers.
    other_chunks: Vec<u8>,
}

impl Asset {
    /// An asset of one scene with one empty node: readers such as the crate `gltf` refuse scenes without nodes.
    pub(crate) fn of_one_scene(name: &str) -> Self {
        let json = json!({
            "asset": { "version": "2.0", "generator": "lumisphere" },
            "buffers": [{}],
            "nodes": [{ "name": name }],
            "scene": 0,
            "scenes": [{ "name": name, "nodes": [0] }],
        });
        let json = if let Value::Object(json) = json { json } else { Map::new() };
        Self { json, home: 0, bytes: Vec::new(), other_chunks: Vec::new() }
    }

    /// Reads a model and takes the files in that it refers to.
    ///
    /// # Errors
    /// [`TargetError::Model`].
    pub(crate) fn read(model: &GltfModel) -> Result<Self, TargetError> {
        let chunks = if model.bytes.starts_with(MAGIC) {
            Chunks::read(model.bytes)?
        } else {
            Chunks { json: model.bytes, bin: None, others: Vec::new() }
        };
        let json = serde_json::from_slice(chunks.json).map_err(|e| wrong("its JSON", e, "a JSON object"))?;
        let mut asset = Self { json, home: 0, bytes: Vec::new(), other_chunks: chunks.others };
        asset.check_version()?;
        asset.take_in_buffers(chunks.bin, model)?;
        asset.take_in_images(model)?;
        Ok(asset)
    }

    fn check_version(&self) -> Result<(), TargetError> {
        let version = self.json.get("asset").and_then(|a| a.get("version"));
        if version.and_then(Value::as_str).is_some_and(|v| v.starts_with("2.")) {
            return Ok(());
        }
        Err(wrong("asset.version", excerpt(version), "\"2.0\""))
    }

    fn take_in_buffers(&mut self, bin: Option<&[u8]>, model: &GltfModel) -> Result<(), TargetError> {
        let buffers = self.list("buffers")?;
        let mut home = (0, Vec::new());
        for (i, buffer) in buffers.iter_mut().enumerate() {
            let what = format!("buffers[{i}]");
            let buffer = object(buffer, &what)?;
            let length = integer(buffer.get("byteLength"), &format!("{what}.byteLength"))?;
            match (uri(buffer, &what)?, bin) {
                (None, Some(bin)) if i == 0 => home.1 = cut(bin.to_vec(), length, &what)?,
                // Its bytes come from an extension, so they are no home for others.
                (None, _) if i == 0 => home.0 = usize::MAX,
                (None, _) => {}
                (Some(uri), _) if i == 0 => {
                    home.1 = cut(fetch(&uri, model)?, length, &what)?;
                    buffer.remove("uri");
                }
                (Some(uri), _) if uri.starts_with("data:") => {}
                (Some(uri), _) => {
                    let data = cut(fetch(&uri, model)?, length, &what)?;
                    buffer.insert("uri".to_owned(), data_uri(&data));
                }
            }
        }
        if buffers.is_empty() || home.0 > 0 {
            home.0 = buffers.len();
            buffers.push(json!({}));
        }
        (self.home, self.bytes) = home;
        Ok(())
    }

    fn take_in_images(&mut self, model: &GltfModel) -> Result<(), TargetError> {
        let Some(mut images) = self.json.remove("images") else { return Ok(()) };
        for (i, image) in images.as_array_mut().into_iter().flatten().enumerate() {
            let what = format!("images[{i}]");
            let image = object(image, &what)?;
            let Some(uri) = uri(image, &what)?.filter(|uri| !uri.starts_with("data:")) else { continue };
            let bytes = fetch(&uri, model)?;
            if !image.contains_key("mimeType") {
                let kind = media_type(&bytes)
                    .ok_or_else(|| wrong(&what, format!("an unknown kind of file, {uri:?}"), "a PNG or JPEG"))?;
                image.insert("mimeType".to_owned(), json!(kind));
            }
            image.remove("uri");
            image.insert("bufferView".to_owned(), json!(self.push_view(&bytes)?));
        }
        self.json.insert("images".to_owned(), images);
        Ok(())
    }

    /// A list of the asset, made if it is not there. glTF has no empty lists: what is made wants an element.
    pub(crate) fn list(&mut self, key: &str) -> Result<&mut Vec<Value>, TargetError> {
        let list = self.json.entry(key).or_insert_with(|| json!([]));
        if !list.is_array() {
            return Err(wrong(key, excerpt(Some(list)), "a list"));
        }
        list.as_array_mut().ok_or_else(|| wrong(key, "something else", "a list"))
    }

    /// Adds an element to a list and gives its index.
    pub(crate) fn push(&mut self, key: &str, element: Value) -> Result<usize, TargetError> {
        let list = self.list(key)?;
        list.push(element);
        Ok(list.len() - 1)
    }

    /// Adds bytes and gives the index of the buffer view of them.
    pub(crate) fn push_view(&mut self, bytes: &[u8]) -> Result<usize, TargetError> {
        pad(&mut self.bytes, 0);
        let view = json!({ "buffer": self.home, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        self.bytes.extend_from_slice(bytes);
        self.push("bufferViews", view)
    }

    /// The asset as a `.glb`.
    ///
    /// # Errors
    /// [`TargetError::Model`] for more than 4 GiB.
    pub(crate) fn into_glb(mut self, clamped: usize) -> Result<Encoded, TargetError> {
        pad(&mut self.bytes, 0);
        let (home, bytes) = (self.home, std::mem::take(&mut self.bytes));
        if let Some(buffer) = self.list("buffers")?.get_mut(home).and_then(Value::as_object_mut) {
            buffer.insert("byteLength".to_owned(), json!(bytes.len()));
            if home > 0 {
                buffer.insert("uri".to_owned(), data_uri(&bytes));
            }
        }
        let mut text = serde_json::to_vec(&self.json)?;
        pad(&mut text, b' ');
        let bin = if home == 0 { 8 + bytes.len() } else { 0 };
        let mut file = MAGIC.to_vec();
        file.extend(2u32.to_le_bytes());
        file.extend(length_field(12 + 8 + text.len() + bin + self.other_chunks.len())?);
        push_chunk(&mut file, JSON_CHUNK, &text)?;
        if home == 0 {
            push_chunk(&mut file, BIN_CHUNK, &bytes)?;
        }
        file.extend(self.other_chunks);
        Ok(Encoded { bytes: file, clamped })
    }
}

/// What a `.glb` is made of.
struct Chunks<'a> {
    json: &'a [u8],
    bin: Option<&'a [u8]>,
    others: Vec<u8>,
}

impl<'a> Chunks<'a> {
    /// Takes a file apart that starts with the magic.
    fn read(file: &'a [u8]) -> Result<Self, TargetError> {
        let field = |at: usize| file.get(at..).and_then(<[u8]>::first_chunk).map(|b| u32::from_le_bytes(*b));
        let (Some(version), Some(length)) = (field(4), field(8)) else {
            return Err(wrong("its header", format!("{} bytes", file.len()), "12 bytes"));
        };
        if version != 2 {
            return Err(wrong("the version of its header", version, "2"));
        }
        let body = file
            .get(12..length as usize)
            .ok_or_else(|| wrong("the length in its header", length, format!("12 to the file's {}", file.len())))?;
        let (json, mut rest) = match chunk(body)? {
            (JSON_CHUNK, json, rest) => (json, rest),
            (kind, ..) => return Err(wrong("its first chunk", format!("of kind {kind:#x}"), "JSON")),
        };
        let mut bin = None;
        if !rest.is_empty()
            && let (BIN_CHUNK, bytes, behind) = chunk(rest)?
        {
            (bin, rest) = (Some(bytes), behind);
        }
        let others = rest.to_vec();
        while !rest.is_empty() {
            rest = chunk(rest)?.2;
        }
        Ok(Self { json, bin, others })
    }
}

/// Kind, content and what follows.
fn chunk(bytes: &[u8]) -> Result<(u32, &[u8], &[u8]), TargetError> {
    let (header, rest) = bytes
        .split_first_chunk::<8>()
        .ok_or_else(|| wrong("the header of a chunk", format!("{} bytes", bytes.len()), "8 bytes"))?;
    let [a, b, c, d, kind @ ..] = *header;
    let length = u32::from_le_bytes([a, b, c, d]) as usize;
    let (content, rest) = rest
        .split_at_checked(length)
        .ok_or_else(|| wrong("the length of a chunk", length, format!("at most the {} left", rest.len())))?;
    Ok((u32::from_le_bytes(kind), content, rest))
}

fn push_chunk(file: &mut Vec<u8>, kind: u32, content: &[u8]) -> Result<(), TargetError> {
    file.extend(length_field(content.len())?);
    file.extend(kind.to_le_bytes());
    file.extend_from_slice(content);
    Ok(())
}

fn length_field(length: usize) -> Result<[u8; 4], TargetError> {
    let length = u32::try_from(length).map_err(|_| wrong("the whole", format!("{length} bytes"), "less than 4 GiB"))?;
    Ok(length.to_le_bytes())
}

/// To a multiple of 4, as chunks and buffer views of images want to start.
fn pad(bytes: &mut Vec<u8>, with: u8) {
    bytes.resize(bytes.len().next_multiple_of(4), with);
}

/// A buffer's own part of what may be longer.
fn cut(mut data: Vec<u8>, length: u64, what: &str) -> Result<Vec<u8>, TargetError> {
    match usize::try_from(length) {
        Ok(length) if length <= data.len() => data.truncate(length),
        _ => return Err(wrong(what, format!("{} bytes", data.len()), format!("byteLength, {length}"))),
    }
    Ok(data)
}

fn uri(holder: &Map<String, Value>, what: &str) -> Result<Option<String>, TargetError> {
    match holder.get("uri") {
        None => Ok(None),
        Some(Value::String(uri)) => Ok(Some(uri.clone())),
        other => Err(wrong(&format!("{what}.uri"), excerpt(other), "text")),
    }
}

/// The bytes that a URI stands for.
fn fetch(uri: &str, model: &GltfModel) -> Result<Vec<u8>, TargetError> {
    let shown = || uri.chars().take(60).collect::<String>();
    if let Some(data) = uri.strip_prefix("data:") {
        let base64 = data.split_once(',').filter(|(head, _)| head.ends_with(";base64"));
        let (_, base64) = base64.ok_or_else(|| wrong("a data URI", shown(), "one in base64"))?;
        return BASE64.decode(base64).map_err(|e| wrong("a data URI", e, "base64"));
    }
    let name = percent_decoded(uri).ok_or_else(|| wrong("a URI", shown(), "UTF-8 with percent-encoding"))?;
    (model.resolve)(&name).ok_or_else(|| wrong("a file it refers to", format!("no {:?}", shown()), "that file"))
}

/// RFC 3986, section 2.1.
fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, behind @ ..] = rest {
        rest = behind;
        if *first == b'%' {
            let (code, behind) = rest.split_at_checked(2)?;
            let digit = |c: u8| char::from(c).to_digit(16);
            bytes.push((digit(code[0])? * 16 + digit(code[1])?) as u8);
            rest = behind;
        } else {
            bytes.push(*first);
        }
    }
    String::from_utf8(bytes).ok()
}

fn data_uri(data: &[u8]) -> Value {
    json!(format!("data:application/octet-stream;base64,{}", BASE64.encode(data)))
}

/// By the first bytes: the kinds of glTF, and those that its extensions for textures add.
fn media_type(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => Some("image/png"),
        [0xff, 0xd8, 0xff, ..] => Some("image/jpeg"),
        [0xab, b'K', b'T', b'X', b' ', b'2', b'0', ..] => Some("image/ktx2"),
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Some("image/webp"),
        [_, _, _, _, b'f', b't', b'y', b'p', b'a', b'v', b'i', b'f', ..] => Some("image/avif"),
        [b'D', b'D', b'S', b' ', ..] => Some("image/vnd-ms.dds"),
        _ => None,
    }
}

/// An object inside the asset.
pub(crate) fn object<'v>(value: &'v mut Value, what: &str) -> Result<&'v mut Map<String, Value>, TargetError> {
    if !value.is_object() {
        return Err(wrong(what, excerpt(Some(value)), "an object"));
    }
    value.as_object_mut().ok_or_else(|| wrong(what, "something else", "an object"))
}

/// glTF allows a whole number to be written with a fraction of 0.
fn integer(value: Option<&Value>, what: &str) -> Result<u64, TargetError> {
    let float = |v: &Value| v.as_f64().filter(|f| f.fract() == 0.0 && (0.0..1e15).contains(f)).map(|f| f as u64);
    value
        .and_then(|v| v.as_u64().or_else(|| float(v)))
        .ok_or_else(|| wrong(what, excerpt(value), "a whole number from 0"))
}

/// The start of a value is enough to know it by.
fn excerpt(value: Option<&Value>) -> String {
    value.map_or("missing".to_owned(), |value| value.to_string().chars().take(60).collect())
}

pub(crate) fn wrong(what: &str, found: impl std::fmt::Display, expected: impl Into<String>) -> TargetError {
    TargetError::Model { what: what.to_owned(), found: found.to_string(), expected: expected.into() }
}
