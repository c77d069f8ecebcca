//! Every key of a scene that a person may edit: what it is, what it may be, how it is shown. The one table that checks
//! scene files and that panels are made of.

mod check;
mod cloth;
mod light;
mod picture;
mod quality;

pub use check::{check_table, check_value};

use crate::yarn::ranges;
use std::sync::LazyLock;

/// Largest component of radiance, irradiance and intensity.
const MOST_STRENGTH: f64 = 1e6;
/// Farthest that anything may be from anything, in mm.
const FARTHEST_MM: f64 = 1e9;
/// Most degrees that something may be turned by.
const MOST_TURNED_DEG: f64 = 1e6;

/// One key of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Table that it stands in; empty for a key of the scene itself. `fabric` and `light` stand for each of theirs.
    pub table: &'static str,
    /// Its key in that table.
    pub key: &'static str,
    /// What it is shown with.
    pub group: Group,
    /// What it may be.
    pub kind: Kind,
    /// Whether it may be absent, which then means something of its own; any other key has a default.
    pub optional: bool,
    /// What it is measured in; empty for counts, shares and flags.
    pub unit: &'static str,
    /// What a paper calls it; empty where none has a letter for it.
    pub symbol: &'static str,
    /// That paper.
    pub paper: &'static str,
    /// Lowest and highest that a slider offers, within what is allowed.
    pub usual: (f64, f64),
    /// Whether a slider's steps are shares of the value.
    pub logarithmic: bool,
    /// What it is, in one line.
    pub about: &'static str,
}

/// What a parameter may be; bounds belong to the range.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// True or false.
    Switch,
    /// A number.
    Number(f64, f64),
    /// A whole number.
    Count(u64, u64),
    /// A power of two.
    PowerOfTwo(u64, u64),
    /// One of these names.
    Name(&'static [&'static str]),
    /// The name of a preset of the parameter's table.
    Preset(fn() -> Vec<&'static str>),
    /// Linear RGB of 0 to this much each.
    Rgb(f64),
    /// Three numbers, each within these bounds.
    Vector(f64, f64),
    /// Three numbers, not all 0; the length says nothing.
    Direction,
    /// A number, or `"untwisted"`.
    Pitch(f64, f64),
    /// `[mean, deviation]`: the mean within these bounds, the deviation from 0 to the upper one.
    Spread(f64, f64),
    /// A file's path, relative to the scene file.
    File,
}

/// Parameters that are shown together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// The cloth and where it comes from.
    Fabric,
    /// The inside of yarns.
    Yarn,
    /// The look of fibers.
    Fiber,
    /// Each light.
    Light,
    /// Light from everywhere.
    Ambient,
    /// Where the picture is taken from.
    Camera,
    /// How fibers are shaded.
    Shading,
    /// Shadows between yarns and inside of them.
    Shadow,
    /// Ambient occlusion.
    Occlusion,
    /// What is traded for time.
    Quality,
    /// From radiance to the displayed picture.
    Display,
    /// Views that show something else than light.
    Debug,
    /// Which frames of moving fabrics are shown.
    Animation,
    /// What an EXR holds beside light.
    Layers,
}

impl Group {
    /// All of them, in the order in which they are shown.
    pub const ALL: [Self; 14] = [
        Self::Yarn,
        Self::Fiber,
        Self::Light,
        Self::Ambient,
        Self::Camera,
        Self::Shading,
        Self::Shadow,
        Self::Occlusion,
        Self::Quality,
        Self::Display,
        Self::Debug,
        Self::Animation,
        Self::Layers,
        Self::Fabric,
    ];

    /// The table of a scene that holds its keys.
    pub const fn table(self) -> &'static str {
        match self {
            Self::Fabric => "fabric",
            Self::Yarn => "yarn",
            Self::Fiber => "fiber",
            Self::Light => "light",
            Self::Ambient => "ambient",
            Self::Camera => "camera",
            Self::Shading => "shading",
            Self::Shadow => "shadow",
            Self::Occlusion => "occlusion",
            Self::Quality => "quality",
            Self::Display => "display",
            Self::Debug => "debug",
            Self::Animation => "animation",
            Self::Layers => "layers",
        }
    }

    /// Its heading.
    pub fn title(self) -> String {
        let table = self.table();
        format!("{}{}", table[..1].to_uppercase(), &table[1..])
    }
}

/// Every parameter, group by group.
pub fn parameters() -> &'static [Parameter] {
    static ALL: LazyLock<Vec<Parameter>> = LazyLock::new(|| {
        let rows = [cloth::FABRIC, cloth::YARN, cloth::FIBER, light::ROWS, picture::ROWS, quality::ROWS];
        let mut all: Vec<Parameter> = rows.into_iter().flatten().copied().collect();
        let yarn = all.iter().rposition(|row| row.group == Group::Yarn).map_or(0, |last| last + 1);
        all.splice(yarn..yarn, ranges::PARAMETERS.iter().map(Parameter::of_yarn));
        all
    });
    &ALL
}

/// The parameters of one table of a scene.
pub fn of_table(table: &str) -> impl Iterator<Item = &'static Parameter> + Clone {
    parameters().iter().filter(move |parameter| parameter.table == table)
}

/// The parameter at a dotted path, or `None`. Numbers of lights and fabrics may stand in it or not, and a fabric's
/// `fabric.0.yarn.ply_count` is `yarn.ply_count`.
pub fn find(path: &str) -> Option<&'static Parameter> {
    let steps: Vec<&str> = path.split('.').filter(|step| step.parse::<usize>().is_err()).collect();
    let (table, key) = match steps[..] {
        [key] => ("", key),
        [table, key] | ["fabric", table @ ("yarn" | "fiber"), key] => (table, key),
        _ => return None,
    };
    parameters().iter().find(|parameter| parameter.table == table && parameter.key == key)
}

impl Parameter {
    /// The dotted path, without numbers of lights and fabrics.
    pub fn path(&self) -> String {
        if self.table.is_empty() { self.key.to_owned() } else { format!("{}.{}", self.table, self.key) }
    }

    /// Lowest and highest number allowed, of kinds that have such; a color's and a vector's are each component's.
    pub fn range(&self) -> Option<(f64, f64)> {
        match self.kind {
            Kind::Number(low, high) | Kind::Vector(low, high) => Some((low, high)),
            Kind::Pitch(low, high) | Kind::Spread(low, high) => Some((low, high)),
            Kind::Count(low, high) | Kind::PowerOfTwo(low, high) => Some((low as f64, high as f64)),
            Kind::Rgb(most) => Some((0.0, most)),
            _ => None,
        }
    }

    const fn new(group: Group, key: &'static str, kind: Kind, about: &'static str) -> Self {
        let usual = match kind {
            Kind::Number(low, high) => (low, high),
            Kind::Count(low, high) | Kind::PowerOfTwo(low, high) => (low as f64, high as f64),
            _ => (0.0, 1.0),
        };
        let (unit, symbol, paper) = ("", "", "");
        let (optional, logarithmic, table) = (false, false, group.table());
        Self { table, key, group, kind, optional, unit, symbol, paper, usual, logarithmic, about }
    }

    const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    const fn optional(self) -> Self {
        Self { optional: true, ..self }
    }

    const fn symbol(self, paper: &'static str, symbol: &'static str) -> Self {
        Self { paper, symbol, ..self }
    }

    const fn slide(self, low: f64, high: f64) -> Self {
        Self { usual: (low, high), ..self }
    }

    const fn slide_shares(self, low: f64, high: f64) -> Self {
        Self { usual: (low, high), logarithmic: true, ..self }
    }

    /// The row of a yarn's parameter.
    fn of_yarn(row: &ranges::Parameter) -> Self {
        let kind = match row.allowed {
            ranges::Allowed::Flag => Kind::Switch,
            ranges::Allowed::Count(low, high) => Kind::Count(low.into(), high.into()),
            ranges::Allowed::Number(low, high) => Kind::Number(low, high),
            ranges::Allowed::Pitch(low, high) => Kind::Pitch(low, high),
            ranges::Allowed::Spread(low, high) => Kind::Spread(low, high),
        };
        let ranges::Parameter { key, symbol, paper, unit, usual, logarithmic, about, .. } = *row;
        Self { symbol, paper, unit, usual, logarithmic, ..Self::new(Group::Yarn, key, kind, about) }
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
