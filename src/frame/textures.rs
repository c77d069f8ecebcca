//! Baked tables as images.

use crate::precompute::chord_shadow::ChordShadow;
use crate::precompute::core_texture::{CoreMip, CoreTexture, Moments};
use crate::precompute::occlusion_table::OcclusionTable;
use crate::precompute::self_shadow::SelfShadowTable;
use crate::vulkan::{Device, Image, ImageInfo, ImageState, VulkanError, vk};
use half::f16;
use std::sync::Arc;

const READ: vk::ImageUsageFlags = vk::ImageUsageFlags::from_raw(
    vk::ImageUsageFlags::SAMPLED.as_raw() | vk::ImageUsageFlags::TRANSFER_DST.as_raw(),
);

/// The table of light inside the yarn, as a volume.
///
/// # Errors
/// Those of the device.
pub fn self_shadow_image(device: &Arc<Device>, table: &SelfShadowTable) -> Result<Image, VulkanError> {
    half_image(device, "self-shadow table", table.size.extent(), true, &table.depths)
}

/// The table of a ply's chords, as a volume of one slice.
///
/// # Errors
/// Those of the device.
pub fn chord_shadow_image(device: &Arc<Device>, table: &ChordShadow) -> Result<Image, VulkanError> {
    half_image(device, "self-shadow table", ChordShadow::EXTENT, true, &table.rests)
}

/// The texture of ambient light inside the yarn.
///
/// # Errors
/// Those of the device.
pub fn occlusion_image(device: &Arc<Device>, table: &OcclusionTable) -> Result<Image, VulkanError> {
    half_image(device, "occlusion texture", [table.across, table.across, 1], false, &table.visibilities)
}

fn half_image(
    device: &Arc<Device>,
    name: &str,
    extent: [u32; 3],
    volume: bool,
    texels: &[f16],
) -> Result<Image, VulkanError> {
    let format = vk::Format::R16_SFLOAT;
    let info = ImageInfo { name, format, extent, volume, usage: READ, ..Default::default() };
    let image = Image::new(device, &info)?;
    image.upload_mips(&[texels], ImageState::SAMPLED_GRAPHICS)?;
    Ok(image)
}

/// The three images of a core texture.
///
/// # Errors
/// Those of the device.
pub fn core_images(device: &Arc<Device>, core: &CoreTexture) -> Result<[Image; 3], VulkanError> {
    let (mips, layers) = (&core.mips[..], core.layers);
    let image = |name, part: fn(&Moments) -> [f64; 4]| {
        let image = Image::new(
            device,
            &ImageInfo {
                name,
                format: vk::Format::R16G16B16A16_SFLOAT,
                extent: [mips[0].columns, mips[0].rows, 1],
                layers,
                mip_levels: mips.len() as u32,
                usage: READ,
                ..Default::default()
            },
        )?;
        let halves = |mip: &CoreMip| -> Vec<[f16; 4]> {
            mip.texels.iter().map(|texel| part(texel).map(f16::from_f64)).collect()
        };
        let levels: Vec<Vec<[f16; 4]>> = mips.iter().map(halves).collect();
        let levels: Vec<&[[f16; 4]]> = levels.iter().map(Vec::as_slice).collect();
        image.upload_mips(&levels, ImageState::SAMPLED_GRAPHICS)?;
        Ok(image)
    };
    Ok([
        image("core normals", |texel| texel.normals)?,
        image("core shape", |texel| texel.shape)?,
        image("core spread", |texel| texel.spread)?,
    ])
}
