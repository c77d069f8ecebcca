//! Lights and what they see, in the device's words.

use super::cloth::Cloth;
use crate::gpu_types::{Light, ShadowView};
use crate::math::bounds::Bounds;
use crate::precompute::environment::Environment;
use crate::scene::Scene;
use crate::scene::camera::Camera;
use crate::scene::features::Features;
use crate::scene::file::DebugView;
use crate::scene::light::{self, LightTable};
use crate::scene::light_reach::reaches;
use crate::scene::needs::{Need, any_needs};
use crate::scene::shadow::{self, shadow_views};
use crate::vulkan::{Buffer, Device, MemoryKind, VulkanError, vk};
use crate::yarn::flyaway::Flyaways;
use glam::{DMat4, DVec3};
use std::f64::consts::PI;
use std::sync::Arc;

/// What the pipelines and buffers of a scene have room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightRoom {
    /// Lights that shine.
    pub lights: usize,
    /// Whether point and spot lights may be among them.
    pub local: bool,
    /// Views of the shadow map; 0 without one.
    pub views: u32,
}

impl LightRoom {
    /// What these lights need.
    pub fn needed(tables: &[LightTable], shadows: bool) -> Self {
        let shining = || tables.iter().filter(|light| light.shines());
        let views = if shadows { shining().map(LightTable::shadow_view_count).sum() } else { 0 };
        Self { lights: shining().count(), local: shining().any(LightTable::is_local), views }
    }

    /// What a scene with these lights and fabrics needs.
    pub fn of(tables: &[LightTable], features: &[Features]) -> Self {
        let room = Self::needed(tables, any_needs(features, Need::ShadowMap));
        if any_needs(features, Need::Lights) { room } else { Self { lights: 0, ..room } }
    }

    /// One line that says why `needed` does not fit, if it does not.
    pub fn lacks(&self, needed: &Self) -> Option<String> {
        if needed.lights > self.lights {
            let (room, found) = (self.lights, needed.lights);
            return Some(format!("expected at most {room} that shine, as at first, found {found}"));
        }
        if needed.local && !self.local {
            return Some("expected directional lights alone, as at first, found another".to_owned());
        }
        (needed.views > self.views).then(|| {
            let (room, found) = (self.views, needed.views);
            format!("expected lights with at most {room} shadow views, as at first, found {found}")
        })
    }

    /// Buffers for the lights and for their views, where there are any.
    ///
    /// # Errors
    /// Those of the device.
    pub fn buffers(&self, device: &Arc<Device>) -> Result<[Option<Buffer>; 2], VulkanError> {
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let buffer = |name: &str, size: usize, count: usize| {
            let make = || Buffer::new(device, name, (size * count) as u64, storage, MemoryKind::Upload);
            (count > 0).then(make).transpose()
        };
        Ok([
            buffer("lights", size_of::<Light>(), self.lights)?,
            buffer("shadow views", size_of::<ShadowView>(), self.views as usize)?,
        ])
    }

    /// The lights that shine, as many as there is room for, each `scale` times as strong: the rest are dark.
    pub fn lights(&self, tables: &[LightTable], origin_mm: DVec3, scale: f64) -> Vec<Light> {
        let mut next_view = 0;
        let light = |table: &LightTable| {
            let light = light::Light::new(table, origin_mm);
            let views = if self.views > 0 { table.shadow_view_count() } else { 0 };
            next_view += views;
            Light {
                position: light.position.unwrap_or_default().as_vec3().to_array(),
                is_local: light.position.is_some().into(),
                toward: light.toward.as_vec3().to_array(),
                cone_scale: light.cone_scale as f32,
                strength: (scale * light.strength).as_vec3().to_array(),
                cone_offset: light.cone_offset as f32,
                shadow_view: next_view - views,
                shadow_view_count: views,
                angular_tangent: table.angular_tangent() as f32,
                padding: 0.0,
            }
        };
        let mut lights: Vec<Light> = tables.iter().filter(|table| table.shines()).map(light).collect();
        lights.resize(self.lights, Light::default());
        lights
    }

    /// What the lights see of the cloth that the camera sees, in the order of their views.
    pub fn views(
        &self,
        scene: &Scene,
        tables: &[LightTable],
        camera: &Camera,
        cloth: &Cloth,
    ) -> Vec<ShadowView> {
        if self.views == 0 {
            return Vec::new();
        }
        let resolution = scene.file.shadow.resolution;
        let shining = tables.iter().filter(|light| light.shines());
        shining
            .flat_map(|light| {
                let near = cloth.near(camera, Some(light));
                shadow_views(light, scene.origin_mm, camera, near, resolution)
            })
            .map(|view| gpu_view(&view))
            .collect()
    }
}

/// The scene's lights that shine and of which something may arrive at cloth in this box, and the places in the scene of
/// those of which nothing does.
pub fn lights_that_reach(scene: &Scene, (low, high): Bounds) -> (Vec<LightTable>, Vec<usize>) {
    // Hairs stand out of the box.
    let reach = scene.fabrics.iter().map(|f| Flyaways::new(&f.yarn).reach_mm).fold(0.0, f64::max);
    let around = (low - DVec3::splat(reach), high + DVec3::splat(reach));
    let shining = scene.file.light().into_iter().enumerate().filter(|(_, light)| light.shines());
    let (reaching, missing): (Vec<_>, Vec<_>) =
        shining.partition(|(_, light)| reaches(light, scene.origin_mm, around));
    (reaching.into_iter().map(|(_, light)| light).collect(), missing.into_iter().map(|(i, _)| i).collect())
}

/// Brightest light between which half floats hold what yarn sends back as they are: all of its highlights, and a
/// thousandth of its brightest.
const HELD_AS_IT_IS: std::ops::RangeInclusive<f64> = 0.5..=32.0;

/// What light is multiplied with before frames hold it as half floats, which have no more digits below 6e-5 and end
/// at 65504, and divided by when frames are added up: a power of two that brings the brightest light near 1, or 1
/// where it needs none and in views that show no light.
pub fn light_scale(scene: &Scene, environment: &Environment, cloth: Bounds) -> f64 {
    let brightest = brightest(scene, environment, cloth);
    let shaded = scene.file.debug.view == DebugView::Shaded;
    if !shaded || brightest <= 0.0 || HELD_AS_IT_IS.contains(&brightest) {
        return 1.0;
    }
    // Within f32's own range, whatever a scene says.
    (-brightest.log2().round()).clamp(-60.0, 60.0).exp2()
}

/// The largest irradiance on the cloth's box or in its middle, of all lights together.
fn brightest(scene: &Scene, environment: &Environment, cloth: Bounds) -> f64 {
    let (low, high) = cloth;
    let corner = |i: u32| {
        let share = DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
        low + share * (high - low)
    };
    let places: Vec<DVec3> = (0..8).map(corner).chain([0.5 * (low + high)]).collect();
    let tables = scene.file.light();
    let of_light = |table: &LightTable| {
        let light = light::Light::new(table, scene.origin_mm);
        let at = |place: &DVec3| light::light_at(&light, *place).irradiance.max_element();
        places.iter().map(at).filter(|irradiance| irradiance.is_finite()).fold(0.0, f64::max)
    };
    let lights: f64 = tables.iter().filter(|table| table.shines()).map(of_light).sum();
    let from_everywhere = scene.file.ambient.radiance().max_element().max(environment[0].max_element());
    lights + PI * from_everywhere
}

fn gpu_view(view: &shadow::ShadowView) -> ShadowView {
    let columns = |m: DMat4| m.as_mat4().to_cols_array_2d();
    ShadowView {
        clip_from_world: columns(view.clip_from_world),
        depth_axis: view.depth_axis.as_vec4().to_array(),
        toward: view.toward.as_vec4().to_array(),
        texel: view.texel as f32,
        padding: [0; 3],
    }
}
