//! The scene file's keys and their defaults. Every key has one, so a bare yarn file is a scene.

use super::animation::AnimationTable;
use super::light::{AmbientTable, LightTable};
use super::shadow::ShadowTable;
use crate::bsdf::khungurn::tabulated::DEFAULT_ENTRIES;
use crate::math::tone::{Display, Tone};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor, value};
use serde::{Deserialize, Serialize};

/// A scene file as typed; see the README for the keys.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SceneFile {
    /// Seed of everything random.
    pub seed: u64,
    /// One table or several.
    #[serde(deserialize_with = "one_or_many")]
    pub fabric: Vec<FabricTable>,
    /// Yarn parameters of every fabric that does not override them: `preset` and any of
    /// [`crate::yarn::params::YarnParams`].
    pub yarn: toml::Table,
    /// The look of fibers, likewise: `preset` and any of [`crate::bsdf::params::FiberParams`].
    pub fiber: toml::Table,
    /// Lights; one directional light when the key is absent.
    pub light: Option<Vec<LightTable>>,
    /// Light from everywhere.
    pub ambient: AmbientTable,
    /// Where the picture is taken from.
    pub camera: CameraTable,
    /// How fibers are shaded.
    pub shading: ShadingTable,
    /// Shadows between yarns and inside of them.
    pub shadow: ShadowTable,
    /// Ambient occlusion inside the yarn, and by other yarns.
    pub occlusion: OcclusionTable,
    /// What is traded for time.
    pub quality: QualityTable,
    /// Which frames of moving fabrics are shown, and how fast.
    pub animation: AnimationTable,
    /// What an EXR picture holds besides its light.
    pub layers: LayersTable,
    /// From radiance to the displayed picture.
    pub display: DisplayTable,
    /// Views that show something else than light.
    pub debug: DebugTable,
}

/// One piece of cloth.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FabricTable {
    /// Yarn file, relative to the scene file.
    pub model: String,
    /// Millimetres per unit of the file; estimated from the yarns' contact when absent.
    pub mm_per_unit: Option<f64>,
    /// Frames of its motion, relative to the scene file: raw (`frames.f32`) or numbered files (`cloth.%04d.bcc`).
    pub motion: Option<String>,
    /// Yarn parameters that differ from the scene's.
    pub yarn: toml::Table,
    /// Parameters of the fibers' look that differ from the scene's.
    pub fiber: toml::Table,
}

/// Where the picture is taken from. At angles 0 the camera looks along -Z.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CameraTable {
    /// Turn about the vertical.
    pub yaw_deg: f64,
    /// Rise above the horizon, -90 to 90. When absent 0, or 90 for a cloth that lies flat on the ground.
    pub pitch_deg: Option<f64>,
    /// From the target; chosen so that everything is in view when absent.
    pub distance_mm: Option<f64>,
    /// What the camera looks at; the model's centre when absent.
    pub target_mm: Option<[f64; 3]>,
    /// Vertical field of view, 1 to 170.
    pub fov_y_deg: f64,
    /// Choose distance and target so that everything is in view, whatever they say.
    pub fit: bool,
}

impl Default for CameraTable {
    fn default() -> Self {
        Self {
            yaw_deg: 0.0,
            pitch_deg: None,
            distance_mm: None,
            target_mm: None,
            fov_y_deg: 35.0,
            fit: false,
        }
    }
}

/// How fibers are shaded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ShadingTable {
    /// The scattering model.
    pub model: ShadingModel,
    /// Highlights: the simple model's lobe, or what the physical model reflects and transmits.
    pub specular: bool,
    /// Diffuse reflection.
    pub diffuse: bool,
    /// Light from everywhere.
    pub ambient: bool,
    /// Factor of how much light the fibers take from one another inside a yarn, 0 to 1000. At 1 it is what follows
    /// from their number and diameter.
    pub extinction_scale: f64,
}

impl Default for ShadingTable {
    fn default() -> Self {
        Self {
            model: ShadingModel::default(),
            specular: true,
            diffuse: true,
            ambient: true,
            extinction_scale: 1.0,
        }
    }
}

/// Scattering models.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ShadingModel {
    /// Reflection and transmission by Khungurn et al. 2017, and a diffuse lobe (Wu & Yuksel 2019, Sec. 4.3).
    #[default]
    Physical,
    /// Wu & Yuksel 2019, Eq. 5.
    Simple,
}

/// Ambient occlusion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OcclusionTable {
    /// How it is worked out inside the yarn.
    pub mode: OcclusionMode,
    /// Other yarns hide parts of the sky as well; not with mode "none".
    pub yarns: bool,
}

impl Default for OcclusionTable {
    fn default() -> Self {
        Self { mode: OcclusionMode::default(), yarns: true }
    }
}

/// Ways to work out ambient occlusion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OcclusionMode {
    /// A cubic of the distance from the yarn's centre.
    #[default]
    Distance,
    /// A texture over the yarn's cross-section.
    Texture,
    /// Not at all.
    None,
}

/// What is traded for time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct QualityTable {
    /// Leave out pieces of yarn outside the picture.
    pub culling: bool,
    /// Draw fewer fibers, and thicker cores, where they are small in the picture.
    pub level_of_detail: bool,
    /// Width of a fiber above which nothing is simplified, and of a ply below which only its core fiber is drawn
    /// (Wu & Yuksel 2019, Eq. 4), in distances between a pixel's samples, 0.01 to 10000: what samples cannot
    /// tell apart need not be drawn. 1.5 is three quarters of a pixel at 4 samples.
    pub lod_threshold_samples: f64,
    /// Narrowest that level of detail draws a fiber, in distances between a pixel's samples, 0.01 to 10: of
    /// thinner ones some are dropped and the rest drawn this wide, so that they cover as much.
    pub thin_fiber_samples: f64,
    /// Width of a ply below which level of detail shades its fibers at their vertices, not at every pixel, in
    /// distances between a pixel's samples, 0 (never) to 1000.
    pub vertex_shaded_samples: f64,
    /// A core fiber always stands for the innermost fibers of a ply, as many as make up no more than this
    /// share of what is seen of the ply, 0 to 1.
    pub core_visible_share: f64,
    /// Texels across a core fiber's texture, 8 to 512.
    pub core_texture_rows: u32,
    /// Entries of the tables of each of the physical model's lobes, 4 to 1024.
    pub scattering_entries: u32,
    /// Texels across the table of light inside the yarn, four times its slices by the light's angle, 8 to 512;
    /// 128 when absent.
    pub self_shadow_texels: Option<u32>,
    /// Texels across the texture of ambient light inside the yarn, 8 to 1024; 256 when absent.
    pub occlusion_texels: Option<u32>,
    /// How far the straight pieces of a fiber may depart from its curve, in pixels, 0.001 to 100.
    pub subdivision_tolerance_px: f64,
    /// Most pieces a fiber is cut into over one piece of yarn, 1 to 64.
    pub max_subdivisions: u32,
    /// Patches per draw call; the device's own limit when absent.
    pub patches_per_draw: Option<u32>,
    /// Fiber curves handed to the device at once, at least 1: between them a user hears of progress.
    pub curves_per_submission: u64,
    /// Control points of a fabric in one buffer: the rest goes into another one.
    pub points_per_buffer: u32,
}

impl Default for QualityTable {
    fn default() -> Self {
        Self {
            culling: true,
            level_of_detail: true,
            lod_threshold_samples: 2.0,
            thin_fiber_samples: 0.5,
            vertex_shaded_samples: 12.0,
            core_visible_share: 0.02,
            core_texture_rows: 64,
            scattering_entries: DEFAULT_ENTRIES,
            self_shadow_texels: None,
            occlusion_texels: None,
            subdivision_tolerance_px: 0.2,
            max_subdivisions: 32,
            patches_per_draw: None,
            curves_per_submission: 2_000_000,
            points_per_buffer: 4 << 20,
        }
    }
}

/// What an EXR picture holds besides its light: of what is seen at the centre of each pixel.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LayersTable {
    /// How far it moves in the picture to the frame after, and to the frame before.
    pub motion: bool,
    /// Which fabric it is, and which of its yarns.
    pub id: bool,
}

impl LayersTable {
    /// Whether there is any layer.
    pub fn any(&self) -> bool {
        self.motion || self.id
    }
}

/// From radiance to the displayed picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DisplayTable {
    /// Factor of two per stop.
    pub exposure_stops: f64,
    /// Radiance behind the cloth, linear RGB; not in the EXR, whose alpha is the yarn's coverage.
    pub background: [f64; 3],
    /// The tone curve.
    pub tone: ToneCurve,
    /// The yarn alone, without background: the PNG's alpha is its coverage.
    pub transparent: bool,
}

impl Default for DisplayTable {
    fn default() -> Self {
        Self {
            exposure_stops: 0.0,
            background: [0.055, 0.06, 0.07],
            tone: ToneCurve::Neutral,
            transparent: false,
        }
    }
}

impl DisplayTable {
    /// The same as measures take it, which see the yarn over black.
    pub fn measured(&self) -> Display {
        let tone = match self.tone {
            ToneCurve::Neutral => Tone::Neutral,
            ToneCurve::Filmic => Tone::Filmic,
        };
        Display { exposure: self.exposure_stops.exp2(), tone }
    }
}

/// Tone curves. The numbers are those of `glsl/passes/tonemap.comp`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ToneCurve {
    /// Identity up to 0.8: [`crate::math::tone::tone_neutral`].
    #[default]
    Neutral = 0,
    /// More contrast, highlights that fade to white: [`crate::math::tone::tone_filmic`].
    Filmic = 1,
}

/// Views that show something else than light.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DebugTable {
    /// What fibers are coloured by.
    pub view: DebugView,
    /// Which fibers are drawn.
    pub fibers: FibersShown,
}

/// Which fibers are drawn (Wu & Yuksel 2019, Fig. 9).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FibersShown {
    /// Core fibers, and regular fibers around them.
    #[default]
    Both,
    /// Core fibers alone.
    Core,
    /// Regular fibers alone, without those that the core stands for.
    Regular,
    /// Every fiber and no core, at full detail: what the others approximate.
    Every,
}

/// What fibers are coloured by. The numbers are those of `glsl/passes/fibers.frag`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DebugView {
    /// Light.
    #[default]
    Shaded = 0,
    /// Normal in world space.
    Normal = 1,
    /// Direction of the fiber in world space.
    Tangent = 2,
    /// Share of ambient light let through.
    Occlusion = 3,
    /// Ply.
    Ply = 4,
    /// Migration, loop or hair (Wu & Yuksel 2019, Fig. 4).
    Kind = 5,
    /// Stripes where the yarn's frame points: its normal red, its binormal green.
    Frame = 6,
    /// Rest length along the yarn: the colours repeat every 10 mm, with a dark ring at every one.
    Length = 7,
    /// Share of its fibers that a yarn is drawn with: red all, blue the cores alone (Wu & Yuksel 2019,
    /// Fig. 11).
    LevelOfDetail = 8,
}

/// Accepts `[fabric]` and `[[fabric]]` alike.
fn one_or_many<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<FabricTable>, D::Error> {
    struct OneOrMany;
    impl<'de> Visitor<'de> for OneOrMany {
        type Value = Vec<FabricTable>;
        fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            f.write_str("[fabric] or [[fabric]]")
        }
        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
            FabricTable::deserialize(value::MapAccessDeserializer::new(map)).map(|one| vec![one])
        }
        fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
            let mut many = Vec::new();
            while let Some(one) = seq.next_element()? {
                many.push(one);
            }
            Ok(many)
        }
    }
    deserializer.deserialize_any(OneOrMany)
}
