//! Lights and ambient light: what a scene file says of them, and what arrives of a light at a place; twin of
//! `glsl/shading/light.glsl`.

use super::file::SceneFile;
use super::keys::KeyError;
use super::parameters::check_table;
use crate::math::frame::direction_or;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use toml::Table;

/// Most `[[light]]`s of a scene: every fragment looks at each of them.
pub const MAX_LIGHTS: usize = 256;
/// Radius of point and spot lights in mm: nearer than this they are as bright as at it, so that a fiber that
/// touches a light stays finite.
pub const LIGHT_RADIUS: f64 = 1.0;
/// Least difference of the halved squared chords of a spot's angles; below it the edge is sharp in f32.
const SHARPEST_EDGE: f64 = 1e-9;

/// One light. A key that its kind does not have is an error; one that is absent has the value of the method
/// that is named like it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LightTable {
    /// What kind of light.
    pub kind: LightKind,
    /// From the light to the scene, any length but 0 (directional, spot).
    pub direction: Option<[f64; 3]>,
    /// On a surface that faces the light, linear RGB, at least 0 (directional).
    pub irradiance: Option<[f64; 3]>,
    /// Irradiance on a surface that faces the light at a distance of one metre, linear RGB, at least 0; falls
    /// off with the distance's square (point, spot).
    pub intensity: Option<[f64; 3]>,
    /// Where the light is, in mm, as `camera.target_mm` (point, spot).
    pub position_mm: Option<[f64; 3]>,
    /// Angle from the axis up to which the light is undimmed, 0 to below the outer angle (spot).
    pub inner_angle_deg: Option<f64>,
    /// Angle from the axis beyond which there is no light, 0.01 to 90 (spot).
    pub outer_angle_deg: Option<f64>,
    /// Angle that the light spans as seen from the cloth, 0 to 60: how soft its shadows are.
    pub angular_size_deg: f64,
}

/// Kinds of light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightKind {
    /// Parallel light from infinitely far.
    #[default]
    Directional,
    /// From a point to everywhere.
    Point,
    /// From a point into a cone.
    Spot,
}

impl LightKind {
    /// Its name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Directional => "directional",
            Self::Point => "point",
            Self::Spot => "spot",
        }
    }

    /// The keys of this kind besides `kind` and `angular_size_deg`.
    pub fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Directional => &["direction", "irradiance"],
            Self::Point => &["position_mm", "intensity"],
            Self::Spot => &["position_mm", "direction", "intensity", "inner_angle_deg", "outer_angle_deg"],
        }
    }
}

impl LightTable {
    /// From the light to the scene, not normalised.
    pub fn direction(&self) -> DVec3 {
        DVec3::from_array(self.direction.unwrap_or([0.6, -0.7, -0.4]))
    }

    /// Linear RGB irradiance of a directional light, intensity of another.
    pub fn strength(&self) -> DVec3 {
        let given = if self.is_local() { self.intensity } else { self.irradiance };
        DVec3::from_array(given.unwrap_or([3.6, 3.5, 3.3]))
    }

    /// Inner and outer angle of a spot in degrees.
    pub fn angles_deg(&self) -> [f64; 2] {
        [self.inner_angle_deg.unwrap_or(0.0), self.outer_angle_deg.unwrap_or(45.0)]
    }

    /// Tangent of half the angle that the light spans.
    pub fn angular_tangent(&self) -> f64 {
        (0.5 * self.angular_size_deg.to_radians()).tan()
    }

    /// Views from which its shadow map is drawn.
    pub fn shadow_view_count(&self) -> u32 {
        if self.kind == LightKind::Point { 6 } else { 1 }
    }

    /// Whether the light is at a place.
    pub fn is_local(&self) -> bool {
        self.kind != LightKind::Directional
    }

    /// Whether anything arrives of it anywhere.
    pub fn shines(&self) -> bool {
        self.strength().max_element() > 0.0
    }

    /// Which keys are given, but for `kind`.
    fn given(&self) -> impl Iterator<Item = &'static str> {
        [
            ("direction", self.direction.is_some()),
            ("irradiance", self.irradiance.is_some()),
            ("intensity", self.intensity.is_some()),
            ("position_mm", self.position_mm.is_some()),
            ("inner_angle_deg", self.inner_angle_deg.is_some()),
            ("outer_angle_deg", self.outer_angle_deg.is_some()),
        ]
        .into_iter()
        .filter_map(|(key, given)| given.then_some(key))
    }

    /// Checks the `index`-th light of a scene.
    fn check(&self, index: usize) -> Result<(), KeyError> {
        let path = |key: &str| format!("light.{index}.{key}");
        let (kind, keys) = (self.kind.name(), self.kind.keys());
        if let Some(key) = self.given().find(|key| !keys.contains(key)) {
            let message = format!(": a {kind} light has no such key, only {}", keys.join(", "));
            return Err(KeyError::new(&path(key), message));
        }
        // What the inner angle may be depends on the outer one.
        let plain = Self { inner_angle_deg: None, ..self.clone() };
        let plain = Table::try_from(&plain).map_err(|e| KeyError::new("light", format!(": {e}")))?;
        check_table("light", &format!("light.{index}"), &plain)?;
        if self.is_local() && self.position_mm.is_none() {
            let message = format!(": expected where the {kind} light is, found nothing");
            return Err(KeyError::new(&path("position_mm"), message));
        }
        let [inner, outer] = self.angles_deg();
        if !(0.0..outer).contains(&inner) {
            let message = format!(" = {inner}: allowed is 0 to below outer_angle_deg = {outer}");
            return Err(KeyError::new(&path("inner_angle_deg"), message));
        }
        Ok(())
    }
}

/// Checks all lights of a scene.
///
/// # Errors
/// Too many; keys that a kind does not have or lacks; values out of range.
pub fn check_lights(lights: &[LightTable]) -> Result<(), KeyError> {
    if lights.len() > MAX_LIGHTS {
        let message = format!(": expected at most {MAX_LIGHTS} [[light]]s, found {}", lights.len());
        return Err(KeyError::new("light", message));
    }
    lights.iter().enumerate().try_for_each(|(index, light)| light.check(index))
}

impl SceneFile {
    /// The scene's lights: its own, or the default one when the key is absent.
    pub fn light(&self) -> Vec<LightTable> {
        self.light.clone().unwrap_or_else(|| vec![LightTable::default()])
    }
}

/// Light from everywhere: the same, or a picture of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AmbientTable {
    /// The same from everywhere, linear RGB; not together with `environment`.
    pub radiance: Option<[f64; 3]>,
    /// Picture of the light from everywhere, relative to the scene file: EXR, HDR (both linear) or PNG (sRGB);
    /// latitude-longitude, twice as wide as high, +Y up, its middle toward -Z and its right quarter toward +X.
    pub environment: Option<String>,
    /// Factor on the picture's radiance, 0 to 1e6.
    pub environment_scale: f64,
    /// Turn of the picture about the vertical: its middle is where a camera with this `yaw_deg` looks.
    pub environment_yaw_deg: f64,
}

impl Default for AmbientTable {
    fn default() -> Self {
        Self { radiance: None, environment: None, environment_scale: 1.0, environment_yaw_deg: 0.0 }
    }
}

impl AmbientTable {
    /// Linear RGB that arrives from everywhere alike; 0 where a picture says what arrives.
    pub fn radiance(&self) -> DVec3 {
        match (&self.environment, self.radiance) {
            (Some(_), _) => DVec3::ZERO,
            (None, given) => DVec3::from_array(given.unwrap_or([0.2, 0.22, 0.26])),
        }
    }

    /// The picture's file, if it gives light.
    pub fn picture(&self) -> Option<&str> {
        self.environment.as_deref().filter(|_| self.environment_scale > 0.0)
    }

    /// Checks what the types cannot.
    pub(super) fn check(&self) -> Result<(), KeyError> {
        if self.radiance.is_some() && self.environment.is_some() {
            let message = ": expected this or ambient.radiance, found both";
            return Err(KeyError::new("ambient.environment", message.into()));
        }
        let values = Table::try_from(self).map_err(|e| KeyError::new("ambient", format!(": {e}")))?;
        check_table("ambient", "ambient", &values)
    }
}

/// A light as shading takes it; twin of `Light` in `glsl/shared/layouts.glsl`. World space: mm, relative to the
/// scene's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is; `None` infinitely far.
    pub position: Option<DVec3>,
    /// Unit: toward a directional light; against a spot's axis.
    pub toward: DVec3,
    /// Irradiance of a directional light, or irradiance at one metre.
    pub strength: DVec3,
    /// Falloff from the axis: the share is `offset - scale v`, clamped and squared, where v is half the squared
    /// chord from the axis (1 - cos of the angle). It is KHR_lights_punctual's, which writes it in cosines;
    /// their differences lose all digits in narrow cones.
    pub cone_scale: f64,
    /// See `cone_scale`.
    pub cone_offset: f64,
}

impl Light {
    /// The light that a checked table speaks of, around `origin_mm`.
    pub fn new(table: &LightTable, origin_mm: DVec3) -> Self {
        let half_squared_chord = |angle_deg: f64| 2.0 * (0.5 * angle_deg.to_radians()).sin().powi(2);
        let [inner, outer] = table.angles_deg().map(half_squared_chord);
        let (cone_scale, cone_offset) = match table.kind {
            LightKind::Spot => {
                let edge = (outer - inner).max(SHARPEST_EDGE);
                (edge.recip(), outer / edge)
            }
            LightKind::Directional | LightKind::Point => (0.0, 1.0),
        };
        Self {
            position: table.position_mm.map(|position| DVec3::from_array(position) - origin_mm),
            toward: -direction_or(table.direction(), DVec3::NEG_Y),
            strength: table.strength(),
            cone_scale,
            cone_offset,
        }
    }
}

/// What arrives of a light: the unit direction toward it, and the irradiance on a surface that faces it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arriving {
    /// Unit.
    pub to_light: DVec3,
    /// Linear RGB.
    pub irradiance: DVec3,
}

/// What arrives of a light at `position` (mm, relative to the scene's origin). Nearer than [`LIGHT_RADIUS`] a
/// light is as bright as at it.
pub fn light_at(light: &Light, position: DVec3) -> Arriving {
    let Some(place) = light.position else {
        return Arriving { to_light: light.toward, irradiance: light.strength };
    };
    let offset = place - position;
    let to_light = direction_or(offset, light.toward);
    let distance_m = 1e-3 * offset.length().max(LIGHT_RADIUS);
    let half_squared_chord = 0.5 * (to_light - light.toward).length_squared();
    let share = (light.cone_offset - light.cone_scale * half_squared_chord).clamp(0.0, 1.0);
    Arriving { to_light, irradiance: light.strength * (share / distance_m).powi(2) }
}

#[cfg(test)]
#[path = "light_tests.rs"]
mod tests;
