//! The functions that can be probed: their fields, what they return, and both ways to evaluate them.

use super::entries::Entries;
use super::fields::{Field, Values};
use super::{curve, inside, scattering};
use crate::precompute::chord_shadow::ChordShadow;
use crate::precompute::occlusion_table::OcclusionTable;
use crate::precompute::self_shadow::SelfShadowTable;

/// One function.
pub struct Function {
    /// As it is typed.
    pub name: &'static str,
    /// What it returns and where its formula comes from.
    pub about: &'static str,
    /// What a query holds.
    pub fields: &'static [Field],
    /// What an answer holds.
    pub results: &'static [(&'static str, Shape)],
    /// What the fields must be together.
    pub check: fn(Values<'_>) -> Result<(), String>,
    /// The truth: f64, and no tables.
    pub exact: fn(Values<'_>) -> Vec<f64>,
    /// The device's side.
    pub device: OnDevice,
}

/// What one part of an answer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A number.
    Number,
    /// Three numbers.
    Vector,
    /// Three numbers, or one where the query's colors are single numbers.
    Color,
}

impl Shape {
    /// Numbers that a function gives for it.
    pub fn numbers(self) -> usize {
        if self == Self::Number { 1 } else { 3 }
    }
}

/// How the device evaluates a function.
pub struct OnDevice {
    /// The kernel, under `glsl/`.
    pub kernel: &'static str,
    /// The kernel's arguments for a query.
    pub words: fn(Values<'_>, &Entries) -> Vec<u32>,
    /// Numbers that the kernel gives.
    pub given: usize,
    /// The answer from what the kernel gave.
    pub finish: fn(Values<'_>, &[f32]) -> Vec<f64>,
    /// The table that the kernel reads, if any.
    pub table: Option<TableOf>,
}

/// A table that depends on a query's first numbers.
#[derive(Clone, Copy)]
pub struct TableOf {
    /// How many of them.
    pub numbers: usize,
    /// Bakes it, as the renderer does, or says in one line why none is good enough.
    pub bake: fn(Values<'_>) -> Result<Table, String>,
}

/// A baked table.
pub enum Table {
    /// Optical depth inside a yarn.
    SelfShadow(SelfShadowTable),
    /// The same ply by ply.
    Chords(ChordShadow),
    /// Ambient light inside a yarn.
    Occlusion(OcclusionTable),
}

/// Every function, in the order of the pipeline.
pub const FUNCTIONS: &[Function] = &[
    curve::CURVE_POINT,
    curve::FIBER_POINT,
    curve::MIGRATION_RADIUS,
    curve::LOD_FACTOR,
    inside::FIBER_DENSITY,
    inside::SELF_SHADOW_DEPTH,
    inside::AMBIENT_OCCLUSION,
    scattering::SIMPLE_SPECULAR,
    scattering::LONGITUDINAL_NORMALISER,
    scattering::AZIMUTHAL_TT,
    scattering::BCSDF,
    scattering::BCSDF_COS,
    scattering::AMBIENT_SCATTERING,
];

/// The function of that name, or `None`.
pub fn find(name: &str) -> Option<&'static Function> {
    FUNCTIONS.iter().find(|function| function.name == name)
}

impl Function {
    /// Where the numbers of a field begin among those of a query, and how many they are; `None` without such a field.
    pub fn place_of(&self, path: &str) -> Option<std::ops::Range<usize>> {
        let index = self.fields.iter().position(|field| field.path == path)?;
        let start = self.fields[..index].iter().map(|field| field.domain.numbers()).sum();
        Some(start..start + self.fields[index].domain.numbers())
    }

    /// Numbers that the function gives.
    pub fn result_numbers(&self) -> usize {
        self.results.iter().map(|(_, shape)| shape.numbers()).sum()
    }
}

/// Nothing to check beside each field.
pub fn any(_: Values<'_>) -> Result<(), String> {
    Ok(())
}

/// What the kernel gave is the answer.
pub fn as_given(_: Values<'_>, given: &[f32]) -> Vec<f64> {
    given.iter().map(|value| f64::from(*value)).collect()
}

/// Words of numbers, each rounded to f32.
pub fn words(numbers: impl IntoIterator<Item = f64>) -> Vec<u32> {
    numbers.into_iter().map(|number| (number as f32).to_bits()).collect()
}

/// Every function with its fields, their domains and what it returns, for help.
pub fn described() -> String {
    let line = |function: &Function| {
        let fields: Vec<String> =
            function.fields.iter().map(|f| format!("      {}: {}\n", f.path, f.domain)).collect();
        let results: Vec<&str> = function.results.iter().map(|(name, _)| *name).collect();
        format!("  {} -> {{{}}}: {}\n{}", function.name, results.join(", "), function.about, fields.concat())
    };
    let functions: Vec<String> = FUNCTIONS.iter().map(line).collect();
    format!(
        "Functions, their fields and what these may be (radians; lengths in one unit):\n{}",
        functions.concat()
    )
}
