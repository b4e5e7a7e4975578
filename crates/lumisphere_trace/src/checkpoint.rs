//! The state of a picture as bytes: little-endian, with a digest of what it is a picture of and one of itself.

use crate::TraceError;
use crate::film::{PIXEL_NUMBERS, Pixel};
use crate::settings::{Target, TraceSettings};
use crate::world::World;
use lumisphere_scene::Camera;
use std::fmt::{Debug, Write};

/// Name and version.
const MAGIC: [u8; 8] = *b"LSTRACE1";
/// Magic, digest, samples, pixels.
const HEADER: usize = 8 + 8 + 4 + 8;
/// The digest at the end.
const TRAILER: usize = 8;

pub(crate) fn write(digest: u64, samples: u32, pixels: &[Pixel]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER + pixels.len() * PIXEL_NUMBERS * 8 + TRAILER);
    bytes.extend(MAGIC);
    bytes.extend(digest.to_le_bytes());
    bytes.extend(samples.to_le_bytes());
    bytes.extend((pixels.len() as u64).to_le_bytes());
    for number in pixels.iter().flat_map(Pixel::numbers) {
        bytes.extend(number.to_le_bytes());
    }
    let own = Digest::new().with_bytes(&bytes).0;
    bytes.extend(own.to_le_bytes());
    bytes
}

/// Samples and pixels.
pub(crate) fn read(bytes: &[u8], digest: u64, pixels: usize) -> Result<(u32, Vec<Pixel>), TraceError> {
    let refuse = |found: String, expected: &str| TraceError::Checkpoint { found, expected: expected.to_owned() };
    let expected = HEADER + pixels * PIXEL_NUMBERS * 8 + TRAILER;
    if !bytes.starts_with(&MAGIC) {
        return Err(refuse("another file".into(), "one that begins with LSTRACE1"));
    }
    if bytes.len() != expected {
        let expected = format!("{expected} bytes for {pixels} pixels");
        return Err(TraceError::Checkpoint { found: format!("{} bytes", bytes.len()), expected });
    }
    let (body, own) = bytes.split_at(expected - TRAILER);
    if u64_at(own, 0) != Digest::new().with_bytes(body).0 {
        return Err(refuse("damaged bytes".into(), "those that were written"));
    }
    if u64_at(body, 8) != digest {
        return Err(refuse("another scene, camera, size or settings".into(), "those it was written with"));
    }
    let samples = u64_at(body, 16) as u32;
    if u64_at(body, 20) != pixels as u64 {
        return Err(refuse(format!("{} pixels", u64_at(body, 20)), "as many as the picture has"));
    }
    let pixel = |i: usize| {
        let number = |k: usize| f64::from_bits(u64_at(body, HEADER + 8 * (i * PIXEL_NUMBERS + k)));
        Pixel::from_numbers(std::array::from_fn(number))
    };
    Ok((samples, (0..pixels).map(pixel).collect()))
}

/// Of all that decides what the samples of a picture are.
pub(crate) fn digest(world: &World, camera: &Camera, size: [usize; 2], settings: &TraceSettings) -> u64 {
    let (scene, any) = (world.scene(), Target { samples: 1, seconds: None, error: None });
    let mut digest = Digest::new();
    digest.add(&(camera, size, TraceSettings { target: any, ..*settings }));
    digest.add(&(&scene.instances, &scene.materials, &scene.lights));
    for mesh in &scene.meshes {
        let lengths = [&mesh.uv[0], &mesh.uv[1]].map(Vec::len);
        digest.add(&(mesh.positions.len(), lengths, mesh.tangents.len(), mesh.colors.len()));
        let numbers = mesh.positions.iter().chain(&mesh.normals).flatten().chain(mesh.uv.iter().flatten().flatten());
        let numbers = numbers.chain(mesh.tangents.iter().flatten()).chain(mesh.colors.iter().flatten());
        digest = digest.with_words(numbers.map(|x| u64::from(x.to_bits())));
        digest = digest.with_words(mesh.triangles.iter().flatten().map(|&i| u64::from(i)));
    }
    for texture in &scene.textures {
        digest.add(&(texture.width(), texture.height()));
        let (width, height) = (texture.width(), texture.height());
        let texels = (0..width * height).flat_map(|i| texture.texel(i % width, i / width));
        digest = digest.with_words(texels.map(|c| u64::from(c.to_bits())));
    }
    if let Some(environment) = world.environment() {
        digest.add(&(environment.filter(), environment.world_from_local(), environment.picture().grid()));
        digest = digest.with_words(environment.picture().texels().iter().flatten().map(|c| u64::from(c.to_bits())));
    }
    digest.0
}

/// As FNV-1a (G. Fowler, L. C. Noll and K.-P. Vo), by bytes or by words, with a turn so that the upper bits of words reach the lower.
struct Digest(u64);

impl Digest {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn with_words(self, words: impl Iterator<Item = u64>) -> Self {
        Self(words.fold(self.0, |sum, word| (sum ^ word).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(5)))
    }

    fn with_bytes(self, bytes: &[u8]) -> Self {
        self.with_words(bytes.iter().map(|&b| u64::from(b)))
    }

    /// By the text of `Debug`, which prints numbers so that they can be read back exactly.
    fn add(&mut self, value: &impl Debug) {
        // Writing to a digest cannot fail.
        let _ = write!(self, "{value:?}");
    }
}

impl Write for Digest {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        *self = Self(self.0).with_bytes(text.as_bytes());
        Ok(())
    }
}

/// The eight bytes at an offset, which are there.
fn u64_at(bytes: &[u8], offset: usize) -> u64 {
    let mut word = [0; 8];
    let there = &bytes[offset.min(bytes.len())..];
    let count = there.len().min(8);
    word[..count].copy_from_slice(&there[..count]);
    u64::from_le_bytes(word)
}
