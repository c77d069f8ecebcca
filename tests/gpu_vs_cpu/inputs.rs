//! Arguments to try: random with a fixed seed, and extreme ones.

use crate::harness::{Row, Word};
use glam::DVec3;
use std::sync::OnceLock;
use worsted::math::rng::Rng;
use worsted::yarn::params::YarnParams;
use worsted::yarn::presets;

/// Random rows of each case.
pub const RANDOM_ROWS: usize = 2000;

/// Builds one row.
#[derive(Default)]
pub struct RowBuilder(Row);

impl RowBuilder {
    pub fn real(mut self, value: f64) -> Self {
        self.0.push(Word::Real(value as f32));
        self
    }

    pub fn bits(mut self, bits: u32) -> Self {
        self.0.push(Word::Bits(bits));
        self
    }

    pub fn vec3(self, v: DVec3) -> Self {
        self.real(v.x).real(v.y).real(v.z)
    }

    pub fn piece(self, p: &[DVec3; 4]) -> Self {
        p.iter().fold(self, |row, point| row.vec3(*point))
    }

    pub fn end(self) -> Row {
        self.0
    }
}

pub fn row() -> RowBuilder {
    RowBuilder::default()
}

/// The rows of a case: `make` draws one from the case's own stream of random numbers.
pub fn random_rows(function: &str, make: impl Fn(&mut Random) -> Row) -> Vec<Row> {
    let mut random = Random::of(function);
    (0..RANDOM_ROWS).map(|_| make(&mut random)).collect()
}

/// A stream of random arguments.
pub struct Random(Rng);

impl Random {
    /// The stream with this name.
    pub fn of(name: &str) -> Self {
        let hash = name.bytes().fold(0_u64, |hash, byte| hash.wrapping_mul(257).wrapping_add(byte.into()));
        Self(Rng::new(20, &[hash]))
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.uniform()
    }

    /// Uniform in the logarithm.
    pub fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    pub fn below(&mut self, count: u32) -> u32 {
        (self.0.uniform() * f64::from(count)) as u32
    }

    pub fn bits(&mut self) -> u32 {
        (self.0.next_u64() >> 32) as u32
    }

    pub fn unit(&mut self) -> DVec3 {
        let z = self.between(-1.0, 1.0);
        let (sin, cos) = self.between(0.0, std::f64::consts::TAU).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cos, radius * sin, z)
    }

    /// A unit vector perpendicular to the unit `axis`.
    pub fn unit_around(&mut self, axis: DVec3) -> DVec3 {
        let side = axis.any_orthonormal_vector();
        let (sin, cos) = self.between(0.0, std::f64::consts::TAU).sin_cos();
        cos * side + sin * axis.cross(side)
    }

    /// A direction at an angle to `axis` that is often small: down to 1e-7 radians, either way round.
    pub fn unit_near(&mut self, axis: DVec3) -> DVec3 {
        let angle = self.magnitude(1e-7, 1.5);
        let (sin, cos) = angle.sin_cos();
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        (sign * cos * axis + sin * self.unit_around(axis)).normalize()
    }

    /// Four control points of a yarn: steps of one size in directions that differ by up to a right
    /// angle or so, from 1e-6 to 1e6 mm, up to a hundred steps away from the origin.
    pub fn piece(&mut self) -> [DVec3; 4] {
        let step = self.magnitude(1e-6, 1e4);
        let mut at = self.unit() * step * self.magnitude(1e-2, 1e2);
        let direction = self.unit();
        std::array::from_fn(|_| {
            let here = at;
            at += step * (direction + 0.8 * self.between(0.0, 1.0) * self.unit());
            here
        })
    }

    /// A place on a piece: often an end or the middle.
    pub fn t(&mut self) -> f64 {
        match self.below(8) {
            0 => 0.0,
            1 => 1.0,
            2 => 0.5,
            _ => self.between(0.0, 1.0),
        }
    }
}

/// Unit vectors that are special to some formula.
pub fn special_units() -> Vec<DVec3> {
    let diagonal = DVec3::splat(1.0).normalize();
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let near_pole = DVec3::new(1e-4, -2e-4, -1.0).normalize();
    axes.into_iter().flat_map(|v| [v, -v]).chain([diagonal, -diagonal, near_pole]).collect()
}

/// Pieces with a cusp, a hairpin, no length at all, and sizes at both ends of what is allowed.
pub fn special_pieces() -> Vec<[DVec3; 4]> {
    let [x, y, z, zero] = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ZERO];
    let wave = [zero, DVec3::new(1.0, 2.0, 0.5), DVec3::new(2.0, -1.0, 0.25), DVec3::new(3.0, 0.5, 1.0)];
    vec![
        [zero; 4],
        [DVec3::splat(7.0); 4],
        [zero, x, x, zero],
        [zero, x, zero, x],
        [zero, x + y, y, x],
        [zero, zero, zero, x],
        [x, zero, zero, zero],
        [zero, zero, y, y],
        [zero, x, 2.0 * x, 3.0 * x],
        [-z, zero, z, 2.0 * z],
        wave,
        wave.map(|p| 1e-6 * p),
        wave.map(|p| 3e5 * p),
        wave.map(|p| p + DVec3::new(1e3, -1e3, 1e3)),
        wave.map(|p| p + DVec3::splat(1e6)),
    ]
}

/// Places on a piece that are special.
pub const SPECIAL_T: [f64; 5] = [0.0, 1.0, 0.5, 0.499_999_97, 1e-6];

/// A yarn whose parameters that matter a case replaces; parsed once.
pub fn some_yarn() -> YarnParams {
    static SOME: OnceLock<YarnParams> = OnceLock::new();
    SOME.get_or_init(|| presets::yarn(presets::DEFAULT_YARN).expect("the default preset exists")).clone()
}
