//! Baked tables as images and buffers of a device.

use super::bake::Bakes;
use crate::precompute::chord_shadow::ChordShadow;
use crate::precompute::core_texture::{CoreMip, CoreTexture, Moments};
use crate::precompute::occlusion_table::OcclusionTable;
use crate::precompute::scattering_table::ScatteringTable;
use crate::precompute::self_shadow::SelfShadowTable;
use crate::vulkan::{Buffer, Device, Image, ImageInfo, ImageState, VulkanError, vk};
use half::f16;
use std::sync::{Arc, Mutex, PoisonError};

const READ: vk::ImageUsageFlags = vk::ImageUsageFlags::from_raw(
    vk::ImageUsageFlags::SAMPLED.as_raw() | vk::ImageUsageFlags::TRANSFER_DST.as_raw(),
);

/// A fabric's tables on a device; absent where nothing was baked. Clones share them.
#[derive(Clone)]
pub struct DeviceTables {
    /// The core texture: normals, shape and spread.
    pub core: Option<[Image; 3]>,
    /// The physical model's tables, R and then TT: four floats an entry.
    pub scattering: Option<Buffer>,
    /// Optical depth over the yarn's cross-section, by the light's angle: a volume.
    pub self_shadow: Option<Image>,
    /// Ambient light over the yarn's cross-section.
    pub occlusion: Option<Image>,
}

impl DeviceTables {
    fn new(device: &Arc<Device>, bakes: &Bakes) -> Result<Self, VulkanError> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let scattering =
            |table: &ScatteringTable| Buffer::upload(device, "scattering table", usage, &table.values);
        let (self_shadow, chords) = (bakes.self_shadow.as_ref(), bakes.chord_shadow.as_ref());
        let occlusion = bakes.occlusion_texture.as_ref();
        Ok(Self {
            core: bakes.core.as_ref().map(|core| core_images(device, core)).transpose()?,
            scattering: bakes.scattering.as_ref().map(scattering).transpose()?,
            self_shadow: self_shadow
                .map(|table| self_shadow_image(device, table))
                .or_else(|| chords.map(|table| chord_shadow_image(device, table)))
                .transpose()?,
            occlusion: occlusion.map(|table| occlusion_image(device, table)).transpose()?,
        })
    }
}

/// Tables where they were uploaded last: renderers of the same tables share them there.
#[derive(Default)]
pub struct Uploaded(Mutex<Option<(Arc<Device>, DeviceTables)>>);

impl Uploaded {
    /// What was uploaded of these to this device; uploads it where nothing was.
    ///
    /// # Errors
    /// Those of the device.
    pub fn get(&self, device: &Arc<Device>, bakes: &Bakes) -> Result<DeviceTables, VulkanError> {
        let mut uploaded = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, tables)) = uploaded.as_ref().filter(|(of, _)| Arc::ptr_eq(of, device)) {
            return Ok(tables.clone());
        }
        let tables = DeviceTables::new(device, bakes)?;
        *uploaded = Some((device.clone(), tables.clone()));
        Ok(tables)
    }
}

/// The table of light inside the yarn, as a volume.
fn self_shadow_image(device: &Arc<Device>, table: &SelfShadowTable) -> Result<Image, VulkanError> {
    half_image(device, "self-shadow table", table.size.extent(), true, &table.depths)
}

/// The table of a ply's chords, as a volume of one slice.
fn chord_shadow_image(device: &Arc<Device>, table: &ChordShadow) -> Result<Image, VulkanError> {
    half_image(device, "self-shadow table", ChordShadow::EXTENT, true, &table.rests)
}

/// The texture of ambient light inside the yarn.
fn occlusion_image(device: &Arc<Device>, table: &OcclusionTable) -> Result<Image, VulkanError> {
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
fn core_images(device: &Arc<Device>, core: &CoreTexture) -> Result<[Image; 3], VulkanError> {
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
