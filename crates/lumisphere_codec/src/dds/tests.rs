#![allow(clippy::unwrap_used)]
use super::*;
use crate::{Faces, LevelTexels, Limits, TexelFormat, Texture, decode_picture};
use lumisphere_sphere::Projection;

fn texels(count: usize) -> Vec<[f32; 3]> {
    (0..count).map(|i| [1.0 + (i % 8) as f32 / 8.0, 1.5, i as f32]).collect()
}

fn levels() -> Vec<Vec<[f32; 3]>> {
    [4, 2, 1].iter().map(|n| texels(6 * n * n)).collect()
}

fn cube(levels: &[Vec<[f32; 3]>]) -> Texture<'_> {
    Texture { width: 4, height: 4, faces: Faces::Cube, levels: levels.iter().map(|l| LevelTexels::Rgb(l)).collect() }
}

fn words(file: &[u8], count: usize) -> Vec<u32> {
    file[..4 * count].chunks_exact(4).map(|b| u32::from_le_bytes(b.try_into().unwrap())).collect()
}

#[test]
fn headers_are_those_of_the_guide() {
    let levels = levels();
    // Words: "DDS ", size, flags, height, width, pitch, depth, levels; 11 reserved; pixel format of 8; caps, caps2, 3 spare.
    let mut expected = vec![0x2053_4444, 124, 0x2_100f, 4, 4, 32, 0, 3];
    expected.extend([0; 11]);
    expected.extend([32, 4, u32::from_le_bytes(*b"DX10"), 0, 0, 0, 0, 0]);
    expected.extend([0x40_1008, 0xfe00, 0, 0, 0]);
    expected.extend([10, 3, 4, 1, 0]);
    let file = encode(&cube(&levels), TexelFormat::Rgba16F, DdsHeader::Dx10).unwrap().bytes;
    assert_eq!(words(&file, 37), expected);
    assert_eq!(file.len(), 148 + 6 * (16 + 4 + 1) * 8);

    expected.truncate(32);
    expected[21] = 113;
    let file = encode(&cube(&levels), TexelFormat::Rgba16F, DdsHeader::Legacy).unwrap().bytes;
    assert_eq!(words(&file, 32), expected);

    let flat = texels(12);
    let texture = Texture { width: 4, height: 3, faces: Faces::One, levels: vec![LevelTexels::Rgb(&flat)] };
    let file = words(&encode(&texture, TexelFormat::Rgba32F, DdsHeader::Dx10).unwrap().bytes, 37);
    assert_eq!((file[5], file[7], file[27], file[28]), (64, 1, 0x1000, 0));
    assert_eq!(file[32..], [2, 3, 0, 1, 0]);
}

#[test]
fn faces_come_first_then_levels() {
    let levels = levels();
    let file = encode(&cube(&levels), TexelFormat::Rgba32F, DdsHeader::Dx10).unwrap().bytes;
    let blue = |at: usize| f32::from_le_bytes(file[at + 8..at + 12].try_into().unwrap());
    let face_bytes = 21 * 16;
    for face in 0..6 {
        let start = 148 + face * face_bytes;
        assert_eq!([0, 16, 20].map(|texel| blue(start + 16 * texel)), [16, 4, 1].map(|n| (face * n) as f32));
    }
    let picture = decode_picture(&file, &Limits::default()).unwrap();
    assert_eq!((picture.width, picture.height, picture.projection), (4, 24, Some(Projection::Cube)));
    assert_eq!(picture.texels, levels[0]);
}

/// `ddsfile` finds the same fields and the same texels.
#[test]
fn another_reader_agrees() {
    let levels = levels();
    for (format, dxgi) in [
        (TexelFormat::Rgba32F, ddsfile::DxgiFormat::R32G32B32A32_Float),
        (TexelFormat::Rgb32F, ddsfile::DxgiFormat::R32G32B32_Float),
        (TexelFormat::Rgba16F, ddsfile::DxgiFormat::R16G16B16A16_Float),
        (TexelFormat::B10g11r11, ddsfile::DxgiFormat::R11G11B10_Float),
        (TexelFormat::Rgb9e5, ddsfile::DxgiFormat::R9G9B9E5_SharedExp),
    ] {
        let file = encode(&cube(&levels), format, DdsHeader::Dx10).unwrap().bytes;
        let other = ddsfile::Dds::read(&file[..]).unwrap();
        assert_eq!(other.get_dxgi_format(), Some(dxgi));
        assert_eq!((other.get_width(), other.get_height(), other.get_num_mipmap_levels()), (4, 4, 3));
        assert_eq!(other.get_num_array_layers(), 6);
        let start = 148 + 2 * 21 * format.block_bytes();
        assert_eq!(other.get_data(2).unwrap(), &file[start..start + 21 * format.block_bytes()]);

        // And what it writes is read here.
        let mut bytes = Vec::new();
        other.write(&mut bytes).unwrap();
        assert_eq!(decode(&bytes, &Limits::default()).unwrap(), decode(&file, &Limits::default()).unwrap());
    }
    for (format, d3d) in [
        (TexelFormat::Rgba32F, ddsfile::D3DFormat::A32B32G32R32F),
        (TexelFormat::Rgba16F, ddsfile::D3DFormat::A16B16G16R16F),
    ] {
        let file = encode(&cube(&levels), format, DdsHeader::Legacy).unwrap().bytes;
        assert_eq!(ddsfile::Dds::read(&file[..]).unwrap().get_d3d_format(), Some(d3d));
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let levels = levels();
    let fault = |format, header| encode(&cube(&levels), format, header).unwrap_err().to_string();
    assert!(fault(TexelFormat::Rgb16F, DdsHeader::Dx10).contains("Dx10"));
    assert!(fault(TexelFormat::Rgb9e5, DdsHeader::Legacy).contains("Legacy"));
    assert!(fault(TexelFormat::Rg16F, DdsHeader::Dx10).contains("expected 2"));
}

#[test]
fn damaged_files_are_refused_before_they_cost_memory() {
    let levels = levels();
    let dx10 = encode(&cube(&levels), TexelFormat::Rgba16F, DdsHeader::Dx10).unwrap().bytes;
    let legacy = encode(&cube(&levels), TexelFormat::Rgba16F, DdsHeader::Legacy).unwrap().bytes;
    let says = |file: &[u8], change: &dyn Fn(&mut Vec<u8>), text: &str| {
        let mut file = file.to_vec();
        change(&mut file);
        let error = decode(&file, &Limits::default()).unwrap_err().to_string();
        assert!(error.contains(text), "{error}");
    };
    says(&dx10, &|f| f.truncate(f.len() - 1), "ends in the texels");
    says(&dx10, &|f| f.truncate(147), "ends in the DX10 header");
    says(&dx10, &|f| f.truncate(100), "ends in the header");
    says(&dx10, &|f| f[4] = 123, "the size of the header");
    says(&dx10, &|f| f[76] = 0, "the size of the pixel format");
    says(&dx10, &|f| f[12..20].fill(0x7f), "EiB");
    says(&dx10, &|f| f[12..20].fill(0xff), "EiB");
    says(&dx10, &|f| f[12..20].fill(0), "0 x 0");
    says(&dx10, &|f| f[12] = 2, "a square");
    says(&dx10, &|f| f[28] = 4, "at most 3");
    says(&dx10, &|f| f[28..32].fill(0xff), "at most 3");
    says(&dx10, &|f| f[128] = 28, "DXGI format 28");
    says(&dx10, &|f| f[132] = 4, "dimension 4");
    says(&dx10, &|f| f[140] = 2, "2 array elements");
    says(&dx10, &|f| f[12..20].copy_from_slice(&[0, 32, 0, 0, 0, 32, 0, 0]), "limit is 1 GiB");
    says(&legacy, &|f| f[84] = 114, "FourCC 114");
    says(&legacy, &|f| f[84..88].copy_from_slice(b"DXT5"), "FourCC DXT5");
    says(&legacy, &|f| f[80] = 0x40, "flags 0x40");
    says(&legacy, &|f| f[113] = 0x7e, "a cube with 5 faces");
    says(&legacy, &|f| f[114] = 0x20, "a volume");
}

/// Fields that other writers leave out do not matter.
#[test]
fn harmless_faults_are_read() {
    let levels = levels();
    let file = encode(&cube(&levels), TexelFormat::Rgba16F, DdsHeader::Dx10).unwrap().bytes;
    let good = decode(&file, &Limits::default()).unwrap();
    let changes: [fn(&mut Vec<u8>); 5] =
        [|f| f[8..12].fill(0), |f| f[20..24].fill(0), |f| f[108..116].fill(0), |f| f[140] = 0, |f| f.extend([0; 7])];
    for change in changes {
        let mut file = file.clone();
        change(&mut file);
        assert_eq!(decode(&file, &Limits::default()).unwrap(), good);
    }
}
