//! Writes the first inputs of each target: tiny pictures and scenes, one for each branch of a format, and files that lie.
//!
//! `cargo run --example seeds` fills `corpus/<reader>/` and `regressions/<reader>/`.

mod crc;
mod dds;
mod env;
mod exr;
mod exr_raw;
mod gltf;
mod hdr;
mod ktx1;
mod ktx2;
mod png;
mod textures;

use std::path::Path;

/// Names and files.
type Seeds = Vec<(String, Vec<u8>)>;

fn main() -> std::io::Result<()> {
    let readers = [
        ("hdr", hdr::seeds(), hdr::hostile()),
        ("exr", exr::seeds(), exr_raw::hostile()),
        ("png", png::seeds(), png::hostile()),
        ("ktx1", ktx1::seeds(), ktx1::hostile()),
        ("ktx2", ktx2::seeds(), ktx2::hostile()),
        ("dds", dds::seeds(), dds::hostile()),
        ("env", env::seeds(), env::hostile()),
        ("gltf", gltf::seeds(), gltf::hostile()),
    ];
    for (reader, seeds, hostile) in readers {
        write(&Path::new("corpus").join(reader), "seed-", &seeds)?;
        write(&Path::new("regressions").join(reader), "made-", &hostile)?;
    }
    Ok(())
}

fn write(folder: &Path, prefix: &str, files: &Seeds) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    files.iter().try_for_each(|(name, bytes)| std::fs::write(folder.join(format!("{prefix}{name}")), bytes))
}

/// Texels with runs, with a wide range and with neighbours that differ.
fn texels(count: usize) -> Vec<[f32; 3]> {
    (0..count).map(|i| if i % 5 < 3 { [0.5; 3] } else { [i as f32 / 16.0, 1.0, (i * i % 31) as f32] }).collect()
}
