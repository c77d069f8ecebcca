//! What differs between two scene files: what has to be made anew.

use crate::scene::SceneFile;
use crate::scene::parameters::Group;

/// Groups of parameters in which two scene files differ.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    groups: Vec<Group>,
}

impl Changes {
    /// From one scene file to another. What a fabric says of its yarn is yarn; the seed is fabric.
    pub fn between(before: &SceneFile, after: &SceneFile) -> Self {
        let each = |differ: &dyn Fn(usize) -> bool| (0..before.fabric.len()).any(differ);
        let other = before.fabric.len() != after.fabric.len();
        let fabrics = |i: usize| (&before.fabric[i], &after.fabric[i]);
        let yarn = !other && each(&|i| fabrics(i).0.yarn != fabrics(i).1.yarn);
        let fiber = !other && each(&|i| fabrics(i).0.fiber != fabrics(i).1.fiber);
        let cloth = other
            || each(&|i| {
                let (a, b) = fabrics(i);
                (&a.model, a.mm_per_unit, &a.motion) != (&b.model, b.mm_per_unit, &b.motion)
            });
        let differs = |group: &Group| match group {
            Group::Fabric => cloth || before.seed != after.seed,
            Group::Yarn => yarn || before.yarn != after.yarn,
            Group::Fiber => fiber || before.fiber != after.fiber,
            Group::Light => before.light() != after.light(),
            Group::Ambient => before.ambient != after.ambient,
            Group::Camera => before.camera != after.camera,
            Group::Shading => before.shading != after.shading,
            Group::Shadow => before.shadow != after.shadow,
            Group::Occlusion => before.occlusion != after.occlusion,
            Group::Quality => before.quality != after.quality,
            Group::Display => before.display != after.display,
            Group::Debug => before.debug != after.debug,
            Group::Animation => before.animation != after.animation,
            Group::Layers => before.layers != after.layers,
        };
        Self { groups: Group::ALL.into_iter().filter(differs).collect() }
    }

    /// Whether nothing differs.
    pub fn is_nothing(&self) -> bool {
        self.groups.is_empty()
    }

    /// Whether this group differs.
    pub fn touches(&self, group: Group) -> bool {
        self.groups.contains(&group)
    }

    /// Whether something differs, and nothing outside of these groups.
    pub fn is_only(&self, groups: &[Group]) -> bool {
        !self.is_nothing() && self.groups.iter().all(|group| groups.contains(group))
    }

    /// The groups that differ, in the order of [`Group::ALL`].
    pub fn groups(&self) -> &[Group] {
        &self.groups
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::overrides::apply;
    use crate::scene::parameters::{Kind, parameters};
    use toml::Table;

    const TWO: &str = "[[fabric]]\nmodel = 'a'\n[[fabric]]\nmodel = 'b'\n";

    fn with(set: &str) -> SceneFile {
        let mut table: Table = toml::from_str(TWO).unwrap();
        apply(&mut table, set).unwrap();
        table.try_into().unwrap()
    }

    #[test]
    fn every_parameter_changes_its_group_alone() {
        let before: SceneFile = toml::from_str(TWO).unwrap();
        assert!(Changes::between(&before, &before).is_nothing());
        for row in parameters().iter().filter(|row| row.group != Group::Light) {
            let values: &[&str] = match row.kind {
                Kind::Switch => &["true", "false"],
                Kind::Name(names) => names,
                Kind::Preset(_) | Kind::File => &["other"],
                Kind::Rgb(_) | Kind::Vector(..) | Kind::Direction => &["[0.5,0.5,0.5]"],
                Kind::Spread(..) => &["[0.5,0.5]"],
                Kind::Number(..) | Kind::Pitch(..) | Kind::Count(..) | Kind::PowerOfTwo(..) => &["5"],
            };
            let changes = values
                .iter()
                .map(|value| Changes::between(&before, &with(&format!("{}={value}", row.path()))));
            let changes: Vec<_> = changes.filter(|changes| !changes.is_nothing()).collect();
            assert!(!changes.is_empty() && changes.iter().all(|c| c.is_only(&[row.group])), "{}", row.path());
        }
    }

    #[test]
    fn fabrics_and_lights_are_compared_by_what_they_say() {
        let before: SceneFile = toml::from_str(TWO).unwrap();
        let between = |set: &str| Changes::between(&before, &with(set));
        assert_eq!(between("fabric.1.yarn.ply_count=2").groups(), [Group::Yarn]);
        assert_eq!(between("fabric.1.fiber.preset=silk").groups(), [Group::Fiber]);
        assert_eq!(between("fabric.1.model=c").groups(), [Group::Fabric]);
        assert!(between("light=[{}]").is_nothing(), "the default one, spelled out");
        assert!(between("light=[{}, {}]").touches(Group::Light));
        assert!(between("fabric=[{model = 'a'}]").is_only(&[Group::Fabric]));
        assert!(!between("camera.yaw_deg=3").is_only(&[Group::Light]));
    }
}
