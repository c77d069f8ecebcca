//! What every field of a query may be: the one table that checks, help and tests read.

use crate::bsdf::params::NARROWEST_DEG;
use crate::yarn::ranges::{Allowed, find};
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;

/// Farthest coordinate or part of a vector, in whatever unit the query's lengths have.
const FAR: f64 = 1e7;
/// Largest azimuth or phase in radians, either sign.
const TURNED: f64 = 1e3;
/// Widest lobe in degrees.
pub const WIDEST_LOBE_DEG: f64 = 89.0;

/// One field of a query.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Its keys from the object's top, joined by dots: `yarn.ply_count`.
    pub path: &'static str,
    /// What it may be.
    pub domain: Domain,
}

/// What a field may be; bounds belong to the domain.
#[derive(Clone, Copy, Debug)]
pub enum Domain {
    /// A number.
    Number(f64, f64),
    /// So many numbers.
    Numbers(usize, f64, f64),
    /// Four points of three coordinates each.
    Points(f64, f64),
    /// `"catmull_rom"` or `"bezier"`.
    Basis,
    /// One number, or three for red, green and blue.
    Color,
    /// What the yarn parameter of this name may be; a pitch is `null` where nothing turns, and negative where
    /// it turns clockwise.
    Yarn(&'static str),
    /// A whole number from 0 to one less than the most that this yarn parameter may be.
    IndexBelow(&'static str),
}

/// A rest length along the yarn: up to a thousand kilometres in mm.
pub const LENGTH: Domain = Domain::Number(-1e9, 1e9);
/// A place on a piece, from its start to its end.
pub const SHARE: Domain = Domain::Number(0.0, 1.0);
/// An angle to the fiber's cross-section; f32's nearest to pi/2 belongs to it.
pub const THETA: Domain = Domain::Number(-FRAC_PI_2, FRAC_PI_2);
/// An azimuth or a phase.
pub const PHI: Domain = Domain::Number(-TURNED, TURNED);
/// Width of a lobe, radians.
pub const WIDTH: Domain = Domain::Number(NARROWEST_DEG / 180.0 * PI, WIDEST_LOBE_DEG / 180.0 * PI);
/// Width of the simple model's lobe, radians.
pub const SIMPLE_WIDTH: Domain = Domain::Number(NARROWEST_DEG / 180.0 * PI, FRAC_PI_2);
/// Twist of a fiber along its yarn, radians.
pub const TWIST: Domain = Domain::Number(-1e9, 1e9);
/// k_s.
pub const STRENGTH: Domain = Domain::Number(0.0, 1e3);
/// A width in the picture.
pub const PIXELS: Domain = Domain::Number(0.0, 1e6);
/// Extinction per length and density.
pub const EXTINCTION: Domain = Domain::Number(0.0, 1e3);
/// Four control points.
pub const POINTS: Domain = Domain::Points(-FAR, FAR);
/// A vector of three.
pub const VECTOR: Domain = Domain::Numbers(3, -FAR, FAR);
/// A place in a cross-section.
pub const PLACE: Domain = Domain::Numbers(2, -FAR, FAR);

/// A row of a function's table of fields.
pub const fn field(path: &'static str, domain: Domain) -> Field {
    Field { path, domain }
}

impl fmt::Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(low, high) => write!(f, "a number from {low} to {high}"),
            Self::Numbers(count, low, high) => write!(f, "{count} numbers from {low} to {high}"),
            Self::Points(low, high) => write!(f, "4 points of 3 numbers from {low} to {high}"),
            Self::Basis => f.write_str("\"catmull_rom\" or \"bezier\""),
            Self::Color => f.write_str("a number from 0 to 1, or 3 of them"),
            Self::Yarn(key) => match allowed(key) {
                Allowed::Count(low, high) => write!(f, "a whole number from {low} to {high}"),
                Allowed::Pitch(low, high) => write!(f, "null, or {low} to {high} of either sign"),
                other => write!(f, "a number from {other}"),
            },
            Self::IndexBelow(key) => write!(f, "a whole number from 0 to {}", most(key) - 1),
        }
    }
}

/// What the yarn's own table allows; nothing where it has no such parameter.
pub fn allowed(key: &str) -> Allowed {
    find(key).map_or(Allowed::Flag, |parameter| parameter.allowed)
}

fn most(key: &str) -> u32 {
    if let Allowed::Count(_, high) = allowed(key) { high } else { 1 }
}

impl Field {
    /// The numbers of this field in `query`, each rounded to f32 and at least one: a basis by its number in
    /// `glsl/lib/curve.glsl`, a color as three numbers and 1 where it was a single one, an absent pitch as
    /// infinity.
    ///
    /// # Errors
    /// A field that is missing, of the wrong type or outside its domain, in one line.
    pub fn read(&self, query: &Value, into: &mut Vec<f64>) -> Result<(), String> {
        let value = self.path.split('.').try_fold(query, |value, key| value.get(key));
        let value = value.ok_or_else(|| format!("{}: missing, expected {}", self.path, self.domain))?;
        self.domain.read(value, into).ok_or_else(|| {
            let shown: String = value.to_string().chars().take(60).collect();
            format!("{} = {shown}: expected {}", self.path, self.domain)
        })
    }
}

impl Domain {
    /// How many numbers a field of this domain becomes.
    pub fn numbers(&self) -> usize {
        match self {
            Self::Numbers(count, ..) => *count,
            Self::Points(..) => 12,
            Self::Color => 4,
            Self::Number(..) | Self::Basis | Self::Yarn(_) | Self::IndexBelow(_) => 1,
        }
    }

    fn read(&self, value: &Value, into: &mut Vec<f64>) -> Option<()> {
        match *self {
            Self::Number(low, high) => into.push(number(value, low, high)?),
            Self::Numbers(count, low, high) => into.extend(numbers(value, count, low, high)?),
            Self::Points(low, high) => {
                let points = value.as_array().filter(|points| points.len() == 4)?;
                for point in points {
                    into.extend(numbers(point, 3, low, high)?);
                }
            }
            Self::Basis => into.push(match value.as_str()? {
                "catmull_rom" => 0.0,
                "bezier" => 2.0,
                _ => return None,
            }),
            Self::Color => match number(value, 0.0, 1.0) {
                Some(grey) => into.extend([grey, grey, grey, 1.0]),
                None => into.extend(numbers(value, 3, 0.0, 1.0)?.into_iter().chain([0.0])),
            },
            Self::Yarn(key) => into.push(match allowed(key) {
                Allowed::Count(low, high) => whole(value, low, high)?,
                Allowed::Number(low, high) => number(value, low, high)?,
                Allowed::Pitch(..) if value.is_null() => f64::INFINITY,
                Allowed::Pitch(low, high) => {
                    number(value, -high, high).filter(|pitch| pitch.abs() >= f64::from(low as f32))?
                }
                Allowed::Flag | Allowed::Spread(..) => return None,
            }),
            Self::IndexBelow(key) => into.push(whole(value, 0, most(key) - 1)?),
        }
        Some(())
    }
}

/// A number within bounds, all rounded to f32: what the device sees of an end belongs to the domain.
fn number(value: &Value, low: f64, high: f64) -> Option<f64> {
    let rounded = value.as_f64()? as f32;
    (low as f32..=high as f32).contains(&rounded).then(|| f64::from(rounded))
}

fn numbers(value: &Value, count: usize, low: f64, high: f64) -> Option<Vec<f64>> {
    let values = value.as_array().filter(|values| values.len() == count)?;
    values.iter().map(|value| number(value, low, high)).collect()
}

fn whole(value: &Value, low: u32, high: u32) -> Option<f64> {
    number(value, low.into(), high.into())
        .filter(|found| Some(*found) == value.as_f64() && found.fract() == 0.0)
}

/// The numbers of a query, field by field.
#[derive(Clone, Copy)]
pub struct Values<'a>(&'a [f64]);

impl<'a> Values<'a> {
    /// From the first field on.
    pub fn new(values: &'a [f64]) -> Self {
        Self(values)
    }

    /// The next number; 0 past the end, which no function's table reaches.
    pub fn real(&mut self) -> f64 {
        let (first, rest) = self.0.split_first().unwrap_or((&0.0, &[]));
        self.0 = rest;
        *first
    }

    /// The next number as a count or an index.
    pub fn whole(&mut self) -> u32 {
        self.real() as u32
    }

    /// The next two.
    pub fn vec2(&mut self) -> glam::DVec2 {
        glam::DVec2::new(self.real(), self.real())
    }

    /// The next three.
    pub fn vec3(&mut self) -> glam::DVec3 {
        glam::DVec3::new(self.real(), self.real(), self.real())
    }

    /// The next color, without whether it was a single number.
    pub fn color(&mut self) -> glam::DVec3 {
        let color = self.vec3();
        self.real();
        color
    }

    /// The next four points.
    pub fn points(&mut self) -> [glam::DVec3; 4] {
        std::array::from_fn(|_| self.vec3())
    }
}
