//! One path from the camera: the nearest fiber, every light with fiber-level shadows, the sky, and on.

use super::accel::{Accel, Hit, Ray};
use super::geometry::{Ignored, Place, Stored};
use super::material::{Material, Meeting};
use super::sky::Sky;
use crate::math::frame::any_perpendicular;
use crate::math::rng::Rng;
use crate::scene::Scene;
use crate::scene::camera::Camera;
use crate::scene::light::{Light, light_at};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// What of light transport is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraceSettings {
    /// Times that light goes on from fiber to fiber; 0 is single scattering, what the fast path draws. The diffuse
    /// lobe stands for these bounces: a scene that follows them has `shading.diffuse = false`.
    pub bounces: u32,
    /// Part of its own fiber that a ray ignores along it, both ways, in diameters, beyond what it goes through
    /// before it leaves the fiber.
    pub own_fiber_diameters: f64,
    /// Whether fibers take light from one another.
    pub shadows: bool,
}

impl Default for TraceSettings {
    fn default() -> Self {
        Self { bounces: 0, own_fiber_diameters: 2.0, shadows: true }
    }
}

/// What one sample of a pixel saw.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    /// Linear radiance; 0 beside the yarn.
    pub radiance: DVec3,
    /// Whether it met a fiber.
    pub covered: bool,
    /// Rays that it took.
    pub rays: u64,
}

/// A light and the half-angle it spans.
struct Lamp {
    light: Light,
    half_angle: f64,
}

/// Where a path meets a fiber.
struct Vertex<'a> {
    place: Place,
    position: DVec3,
    material: &'a Material,
    meeting: Meeting,
}

/// Everything a path needs.
pub struct Tracer<T> {
    accel: Accel<T>,
    materials: Vec<Material>,
    lamps: Vec<Lamp>,
    sky: Sky,
    camera: Camera,
    size: [u32; 2],
    seed: u64,
    settings: TraceSettings,
}

/// Diameters that a ray goes through its own fiber at most: real fibers bend away sooner.
const LONGEST_THROUGH: f64 = 32.0;
/// Diameters ignored at least: the ball at a joint reaches half of one back into the piece before it.
const LEAST_IGNORED: f64 = 0.51;
/// A path goes on by chance from this many bounces on.
const ROULETTE_AFTER: u32 = 3;
/// The most likely that a path goes on by chance.
const ROULETTE_MOST: f64 = 0.95;

impl<T: Stored> Tracer<T> {
    /// A tracer of pictures of `size` pixels.
    pub fn new(scene: &Scene, accel: Accel<T>, size: [u32; 2], settings: TraceSettings) -> Self {
        let lamps = scene.file.light().into_iter().filter(|table| table.shines()).map(|table| Lamp {
            light: Light::new(&table, scene.origin_mm),
            half_angle: 0.5 * table.angular_size_deg.to_radians(),
        });
        Self {
            lamps: lamps.collect(),
            materials: scene.fabrics.iter().map(|f| Material::new(&scene.file.shading, f)).collect(),
            sky: Sky::new(scene),
            camera: scene.camera(size),
            seed: scene.file.seed,
            accel,
            size,
            settings,
        }
    }

    /// The fibers.
    pub fn accel(&self) -> &Accel<T> {
        &self.accel
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Sample `index` of a pixel: the same whoever asks, and when.
    pub fn sample(&self, [x, y]: [u32; 2], index: u64) -> Seen {
        let pixel = u64::from(y) * u64::from(self.size[0]) + u64::from(x);
        let mut rng = Rng::new(self.seed, &[pixel, index]);
        let place = DVec2::new(f64::from(x) + rng.uniform(), f64::from(y) + rng.uniform());
        self.follow(self.camera_ray(place), &mut rng)
    }

    /// The ray through a place of the picture, in pixels from its upper left, from the near plane on.
    fn camera_ray(&self, place: DVec2) -> Ray {
        let size = DVec2::new(self.size[0].into(), self.size[1].into());
        let clip = 2.0 * place / size - 1.0;
        let in_view =
            DVec3::new(clip.x * self.camera.half_extent.x, -clip.y * self.camera.half_extent.y, -1.0);
        let through = self.camera.world_from_view * in_view;
        let origin = self.camera.eye_world + self.camera.near_mm * through;
        Ray { origin, direction: through.normalize() }
    }

    fn follow(&self, mut ray: Ray, rng: &mut Rng) -> Seen {
        let mut seen = Seen { rays: 1, ..Default::default() };
        let mut share = DVec3::ONE;
        let mut next_hit = self.accel.nearest(&ray, &Ignored::NONE);
        seen.covered = next_hit.is_some();
        for bounce in 0.. {
            let Some(hit) = next_hit else { break };
            let Some(vertex) = self.vertex(&ray, &hit) else { break };
            seen.radiance += share * self.lit(&vertex, rng, &mut seen.rays);
            let is_last = bounce >= self.settings.bounces;
            if is_last && self.sky.is_black() {
                break;
            }
            let u = std::array::from_fn(|_| rng.uniform());
            let Some((direction, pdf)) = vertex.material.sample(&vertex.meeting, &self.sky, u) else { break };
            ray = Ray { origin: vertex.position, direction };
            let ignored = self.ignored(&vertex, direction);
            seen.rays += 1;
            next_hit = None;
            let escapes = if is_last {
                !self.settings.shadows || !self.accel.is_blocked(&ray, f64::INFINITY, &ignored)
            } else {
                next_hit = self.accel.nearest(&ray, &ignored);
                next_hit.is_none()
            };
            if escapes {
                let scattered = vertex.material.scatter_sky(&vertex.meeting, direction) / pdf;
                seen.radiance += share * scattered * self.sky.radiance(direction);
            }
            if escapes || is_last {
                break;
            }
            share *= vertex.material.scatter(&vertex.meeting, direction) / pdf;
            if bounce >= ROULETTE_AFTER {
                let goes_on = share.max_element().min(ROULETTE_MOST);
                if rng.uniform() >= goes_on {
                    break;
                }
                share /= goes_on;
            }
        }
        seen
    }

    /// What a ray met. Rays go on from there, not from the fiber's axis, which may lie inside another fiber.
    fn vertex(&self, ray: &Ray, hit: &Hit) -> Option<Vertex<'_>> {
        let position = ray.origin + hit.distance * ray.direction;
        let surface = self.accel.geometry().surface(hit.place, position);
        let material = self.materials.get(surface.fabric)?;
        let meeting = Meeting { tangent: surface.tangent, normal: surface.normal, to_eye: -ray.direction };
        Some(Vertex { place: hit.place, position, material, meeting })
    }

    /// What a ray that leaves the vertex does not see of its own fiber: what it goes through before it comes out
    /// on the far side (the scattering model is one of whole fibers), and so many diameters more.
    fn ignored(&self, vertex: &Vertex<'_>, direction: DVec3) -> Ignored {
        let Meeting { tangent, normal, .. } = vertex.meeting;
        let diameter = vertex.material.diameter_mm;
        let inward = (-normal.dot(direction)).max(0.0);
        let across_squared = tangent.cross(direction).length_squared();
        let through = diameter * inward * tangent.dot(direction).abs() / across_squared;
        // `min` makes a number of what is none: along the tangent, 0 / 0.
        let through = through.min(LONGEST_THROUGH * diameter);
        let more = self.settings.own_fiber_diameters.max(LEAST_IGNORED) * diameter;
        self.accel.geometry().around(vertex.place, through + more)
    }

    /// Radiance toward the eye of all lights.
    fn lit(&self, vertex: &Vertex<'_>, rng: &mut Rng, rays: &mut u64) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for lamp in &self.lamps {
            let arriving = light_at(&lamp.light, vertex.position);
            let (to_light, spread) = toward(arriving.to_light, lamp.half_angle, rng);
            if arriving.irradiance == DVec3::ZERO {
                continue;
            }
            let scattered = vertex.material.scatter(&vertex.meeting, to_light) * arriving.irradiance * spread;
            if scattered.max_element() <= 0.0 {
                continue;
            }
            let end = lamp.light.position.map_or(f64::INFINITY, |place| place.distance(vertex.position));
            *rays += u64::from(self.settings.shadows);
            let ray = Ray { origin: vertex.position, direction: to_light };
            let ignored = self.ignored(vertex, to_light);
            if !self.settings.shadows || !self.accel.is_blocked(&ray, end, &ignored) {
                sum += scattered;
            }
        }
        sum
    }
}

/// A direction to a disk of equal radiance that spans `half_angle` about `middle`, and its factor on the
/// irradiance: directions are drawn by their cosine to the middle, so that what faces the light gets all of it.
fn toward(middle: DVec3, half_angle: f64, rng: &mut Rng) -> (DVec3, f64) {
    if half_angle <= 0.0 {
        return (middle, 1.0);
    }
    let sine = half_angle.sin() * rng.uniform().sqrt();
    let (s, c) = (TAU * rng.uniform()).sin_cos();
    let side = any_perpendicular(middle);
    let cosine = (1.0 - sine * sine).sqrt();
    (cosine * middle + sine * (c * side + s * middle.cross(side)), 1.0 / cosine)
}

#[cfg(test)]
#[path = "integrator_tests.rs"]
mod tests;
