//! Loads the files of the target `bevy` with Bevy's own loader: `lumisphere-engine-bevy FOLDER [axes]`.
//!
//! Bevy draws on a GPU, which is not assumed here. Held are: what the loader makes of each file, every texel against our own
//! reading of it, and, for `builtin:axes`, the colours where Bevy's shader looks for the axes of the world: it turns round
//! the z of a direction before it fetches (`bevy_pbr` 0.20.1, `light_probe/environment_map.wesl`).

mod texels;

use anyhow::{Context, Result, bail, ensure};
use bevy_asset::RenderAssetUsages;
use bevy_image::{CompressedImageFormats, Image, ImageSampler, ImageType};
use lumisphere_codec::{Limits, decode_texture};
use lumisphere_image::{Builtin, DEFAULT_BUILTIN_HEIGHT, sample_nearest};
use lumisphere_sphere::cube;
use std::path::Path;
use wgpu_types::TextureViewDimension;

/// What `EnvironmentMapLight` and `Skybox` are given.
const FILES: [&str; 3] = ["specular.ktx2", "diffuse.ktx2", "skybox.ktx2"];
/// Formats keep 8 bits or more of the brightest channel, 0.8.
const COLOUR: f32 = 0.004;
/// The share of texels of a face of 256 that the edges of faces, rims and strokes cross, with a margin.
const EDGES: f64 = 0.12;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let folder = arguments.first().context("no folder")?;
    for file in FILES {
        let path = Path::new(folder).join(file);
        let found = check(&path, file, arguments.get(1).is_some_and(|word| word == "axes"));
        println!("bevy {file}: {}", found.with_context(|| path.display().to_string())?);
    }
    Ok(())
}

/// What the loader made of a file, in a line.
fn check(path: &Path, file: &str, is_axes: bool) -> Result<String> {
    let bytes = std::fs::read(path)?;
    let image = Image::from_buffer(
        &bytes,
        ImageType::Extension("ktx2"),
        CompressedImageFormats::NONE,
        false,
        ImageSampler::Default,
        RenderAssetUsages::default(),
    )?;
    let ours = decode_texture(&bytes, &Limits::default())?;
    let shape = &image.texture_descriptor;
    let dimension = image.texture_view_descriptor.as_ref().and_then(|view| view.dimension);
    ensure!(dimension == Some(TextureViewDimension::Cube), "found the view {dimension:?}, expected a cube");
    let found = (shape.size.width, shape.size.height, shape.size.depth_or_array_layers, shape.mip_level_count);
    let expected = (ours.width as u32, ours.height as u32, 6, ours.levels.len() as u32);
    ensure!(found == expected, "found width, height, layers and levels {found:?}, expected {expected:?}");
    let theirs = texels::decode(image.data.as_deref().context("the loader gave no texels")?, shape.format)?;
    let all: Vec<[f32; 3]> = ours.levels.iter().flatten().map(|t| [t[0], t[1], t[2]]).collect();
    ensure!(theirs.len() == all.len(), "found {} texels, expected {}", theirs.len(), all.len());
    if let Some(at) = (0..all.len()).find(|&i| theirs[i] != all[i]) {
        bail!("texel {at} is {:?}, expected {:?}", theirs[at], all[at]);
    }
    if is_axes && file != "diffuse.ktx2" {
        check_axes(&theirs, ours.width)?;
    }
    Ok(format!("{:?}, {} levels, {} texels as ours", shape.format, ours.levels.len(), all.len()))
}

/// Where Bevy looks for each direction of the world lies what `builtin:axes` shows there, labels included.
fn check_axes(texels: &[[f32; 3]], size: usize) -> Result<()> {
    let world = Builtin::Axes.render(DEFAULT_BUILTIN_HEIGHT);
    let mut wrong = 0;
    for (index, found) in texels[..6 * size * size].iter().enumerate() {
        let (face, y, x) = (index / (size * size), index / size % size, index % size);
        let centre = |at: usize| (at as f64 + 0.5) / size as f64;
        let [dx, dy, dz] = cube::direction(face, centre(x), centre(y));
        let expected = sample_nearest(&world, [dx, dy, -dz]);
        wrong += usize::from((0..3).any(|c| (found[c] - expected[c]).abs() > COLOUR));
    }
    let share = wrong as f64 / (6 * size * size) as f64;
    ensure!(share < EDGES, "{:.1} % of the directions show something else than the world", 100.0 * share);
    Ok(())
}
