//! The ways to draw that are measured: the default, variations of it one by one, and useful combinations.

use crate::error::Error;
use crate::frame::sampling::Sampling;
use serde::{Deserialize, Serialize};

/// Samples a pixel of `worsted render` where nothing is said.
pub const DEFAULT_SAMPLES: u32 = 4;
/// Name of the way that all others are compared with.
pub const DEFAULT: &str = "default";
/// Draws every fiber and no core, at full detail: what level of detail approximates.
pub const EVERY_FIBER: &str = "debug.fibers=every";

/// One way to draw.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Setting {
    /// What it is called.
    pub name: String,
    /// Samples a pixel.
    pub samples: u32,
    /// Assignments to scene keys.
    pub sets: Vec<String>,
}

impl Setting {
    fn new(name: impl Into<String>, samples: u32, sets: &[&[&str]]) -> Self {
        let sets = sets.concat().into_iter().map(str::to_owned).collect();
        Self { name: name.into(), samples, sets }
    }

    /// As options of `worsted render`.
    pub fn as_options(&self) -> String {
        let sets = self.sets.iter().map(|set| format!(" --set '{set}'"));
        format!("--samples {}{}", self.samples, sets.collect::<String>())
    }
}

/// What is simplified, or what dims light, and how it is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Approximation {
    /// What it is called.
    pub name: &'static str,
    /// Assignments that leave it out.
    without: &'static [&'static str],
}

/// Approximations that are judged together: "alone" leaves out the others of the group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group {
    /// What is left when all of them are left out.
    pub bare: &'static str,
    /// Its members.
    pub members: &'static [Approximation],
}

/// Every approximation, by group.
pub const GROUPS: [Group; 2] = [
    Group {
        bare: "nothing simplified",
        members: &[
            Approximation { name: "level of detail and cores", without: &[EVERY_FIBER] },
            Approximation { name: "shading at vertices", without: &["quality.vertex_shaded_samples=0.0"] },
            Approximation {
                name: "coarse pieces",
                without: &["quality.subdivision_tolerance_px=0.05", "quality.max_subdivisions=64"],
            },
            Approximation {
                name: "small tables and map",
                without: &[
                    "shadow.resolution=4096",
                    "quality.scattering_entries=256",
                    "quality.self_shadow_texels=256",
                ],
            },
        ],
    },
    Group {
        bare: "nothing shadowed",
        members: &[
            Approximation { name: "shadow map", without: &["shadow.map=false"] },
            Approximation { name: "self-shadows", without: &["shadow.self=false"] },
            Approximation { name: "occlusion", without: &["occlusion.mode=none"] },
        ],
    },
];

impl Group {
    /// The way to draw without any of them.
    pub fn bare(&self, samples: u32) -> Setting {
        let all: Vec<&[&str]> = self.members.iter().map(|member| member.without).collect();
        Setting::new(self.bare, samples, &all)
    }

    /// The default without `member`.
    pub fn off(member: &Approximation, samples: u32) -> Setting {
        Setting::new(format!("{} off", member.name), samples, &[member.without])
    }

    /// The way to draw with `member` alone of them all.
    pub fn alone(&self, member: &Approximation, samples: u32) -> Setting {
        let others: Vec<&[&str]> =
            self.members.iter().filter(|other| *other != member).map(|other| other.without).collect();
        Setting::new(format!("{} alone", member.name), samples, &others)
    }
}

/// The default grid: every approximation off and alone, numbers of samples, and combinations for speed. At most 25.
pub fn grid(sample_counts: &[u32]) -> Vec<Setting> {
    let samples = DEFAULT_SAMPLES;
    let simple = &["shading.model=simple"][..];
    let coarse = &["quality.lod_threshold_samples=3.0", "quality.thin_fiber_samples=1.5"][..];
    let unshadowed = &["shadow.map=false", "shadow.self=false", "occlusion.mode=none"][..];
    let mut all = vec![Setting::new(DEFAULT, samples, &[])];
    let others = sample_counts.iter().filter(|count| **count != samples);
    all.extend(others.map(|count| Setting::new(plural(*count), *count, &[])));
    for group in &GROUPS {
        all.extend(group.members.iter().map(|member| Group::off(member, samples)));
        all.extend(group.members.iter().map(|member| group.alone(member, samples)));
        all.push(group.bare(samples));
    }
    all.push(Setting::new("occlusion by texture", samples, &[&["occlusion.mode=texture"]]));
    all.push(Setting::new("simple shading", samples, &[simple]));
    all.push(Setting::new("coarse detail", samples, &[coarse]));
    all.push(Setting::new("coarse detail, 1 sample", 1, &[coarse]));
    all.push(Setting::new("coarse detail, simple shading, 1 sample", 1, &[coarse, simple]));
    all.push(Setting::new(
        "coarse detail, simple shading, 1 sample, nothing shadowed",
        1,
        &[coarse, simple, unshadowed],
    ));
    all
}

/// A grid for a machine with little time: ratios of the default and what is next to it.
pub fn quick_grid() -> Vec<Setting> {
    let wanted = [
        DEFAULT,
        "1 sample",
        "level of detail and cores off",
        "shadow map off",
        "self-shadows off",
        "simple shading",
        "coarse detail, 1 sample",
    ];
    grid(&[1]).into_iter().filter(|setting| wanted.contains(&setting.name.as_str())).collect()
}

/// Checks numbers of samples as they were typed.
///
/// # Errors
/// One that is not to be had.
pub fn check_samples(counts: &[u32]) -> Result<(), Error> {
    counts.iter().try_for_each(|count| Sampling::new(*count).map(drop).map_err(Error::Arguments))
}

fn plural(count: u32) -> String {
    if count == 1 { "1 sample".to_owned() } else { format!("{count} samples") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::cloth::{Cloth, Model};
    use crate::scene::Scene;

    #[test]
    fn every_setting_is_a_scene_of_its_own_and_has_a_name_of_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let cloth = Cloth::Stockinette { wales: 2, courses: 2 };
        let model = Model::write(folder.path(), "worsted_3ply", cloth, Default::default()).unwrap();
        let grid = grid(&[1, 4, 16]);
        assert!((15..=25).contains(&grid.len()), "{}", grid.len());
        let mut seen = Vec::new();
        for setting in &grid {
            let scene = Scene::load(&model.path, &setting.sets).unwrap();
            let what = (format!("{:?}", scene.file), setting.samples);
            assert!(seen.iter().all(|(name, other)| *name != setting.name && *other != what), "{setting:?}");
            seen.push((setting.name.clone(), what));
        }
        assert_eq!((grid[0].name.as_str(), quick_grid().len()), (DEFAULT, 7));
        check_samples(&[1, 4, 16, 64]).unwrap();
        assert_eq!(check_samples(&[4, 5]).unwrap_err().exit_code(), 2);
    }

    #[test]
    fn alone_leaves_out_the_others() {
        let [simplified, _] = GROUPS;
        let alone = simplified.alone(&simplified.members[0], 4);
        assert!(!alone.sets.contains(&EVERY_FIBER.to_owned()) && alone.sets.len() == 6);
        assert_eq!(Group::off(&simplified.members[0], 4).sets, [EVERY_FIBER]);
        assert_eq!(simplified.bare(4).sets.len(), 7);
        assert_eq!(alone.as_options().matches("--set").count(), 6);
    }
}
