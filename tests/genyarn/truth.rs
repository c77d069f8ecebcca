//! Fibers to compare with, and the yarn that they are of.

use crate::equations;
use glam::DVec3;
use std::collections::HashMap;
use std::path::PathBuf;
use worsted::math::rng::Rng;
use worsted::yarn::params::YarnParams;
use worsted::yarn::presets;

const MM_PER_CM: f64 = 10.0;

/// Fibers of a straight yarn along z.
#[derive(Clone)]
pub struct Truth {
    pub name: String,
    pub yarn: YarnParams,
    /// Points in mm of each fiber, ply by ply.
    pub fibers: Vec<Vec<DVec3>>,
}

/// A file of the shared data, or why there is none.
fn shared(path: &str) -> Result<String, String> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(path);
    std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))
}

impl Truth {
    /// The reference generator's fibers and the parameters it made them with.
    ///
    /// # Errors
    /// Why the data is not at hand. Data that is there but not as expected panics.
    pub fn read(file: &str, yarn: &str) -> Result<Self, String> {
        let table = shared("zhao-yarn-params/all.csv")?;
        let text = shared(&format!("genyarn-fibers/{file}.txt"))?;
        let yarn = yarn_of(&row(&table, "step2", yarn), yarn);
        let fibers = fibers(&text);
        assert_eq!(fibers.len(), yarn.fiber_count() as usize, "{file}");
        for fiber in &fibers {
            assert_eq!(fiber.len(), 300, "{file}");
            for (i, p) in fiber.iter().enumerate() {
                assert!((p.z - (-15.0 + 0.1 * i as f64)).abs() < 1e-9, "{file}: point {i} at z = {}", p.z);
            }
        }
        Ok(Self { name: file.to_owned(), yarn, fibers })
    }

    /// The same from plain equations: 300 points from -15 mm in steps of 0.1 mm, six digits in cm.
    pub fn from_equations(name: &str, yarn: &YarnParams, seed: u64) -> Self {
        let mut rng = Rng::new(seed, &[]);
        let fiber = |ply: u32| {
            let radius = rng.uniform().sqrt();
            let [angle, phase] = [(); 2].map(|()| std::f64::consts::TAU * rng.uniform());
            let at = |i: u32| {
                let z = -15.0 + 0.1 * f64::from(i);
                let [x, y] = equations::fiber_at(yarn, ply, [radius, angle, phase], z).map(six_digits);
                DVec3::new(x, y, z)
            };
            (0..300).map(at).collect()
        };
        let plies = (0..yarn.ply_count).flat_map(|ply| (0..yarn.fibers_per_ply).map(move |_| ply));
        Self { name: name.to_owned(), yarn: yarn.clone(), fibers: plies.map(fiber).collect() }
    }

    /// The ply of a fiber.
    pub fn ply(&self, fiber: usize) -> u32 {
        fiber as u32 / self.yarn.fibers_per_ply
    }
}

/// What is left of a coordinate in mm after the reference generator wrote it in cm.
fn six_digits(mm: f64) -> f64 {
    MM_PER_CM * format!("{:.5e}", mm / MM_PER_CM).parse::<f64>().expect("a number as Rust writes it")
}

/// The generator's text: how many fibers, then for each how many points and their coordinates in cm.
fn fibers(text: &str) -> Vec<Vec<DVec3>> {
    let mut words = text.split_ascii_whitespace();
    let mut number = || words.next().expect("more numbers").parse::<f64>().expect("a number");
    let fibers = (0..number() as usize)
        .map(|_| {
            let count = number() as usize;
            (0..count).map(|_| MM_PER_CM * DVec3::new(number(), number(), number())).collect()
        })
        .collect();
    assert!(words.next().is_none(), "numbers are left over");
    fibers
}

/// The row of a parameter set by its headings.
fn row<'a>(table: &'a str, set: &str, maps_to: &str) -> HashMap<&'a str, &'a str> {
    let mut lines = table.lines();
    let headings: Vec<_> = lines.next().expect("headings").split(',').collect();
    lines
        .map(|line| headings.iter().copied().zip(line.split(',')).collect::<HashMap<_, _>>())
        .find(|row| row["set"] == set && row["maps_to"] == maps_to)
        .expect("the set has that yarn")
}

/// Every parameter that decides where a regular fiber lies.
fn yarn_of(row: &HashMap<&str, &str>, preset: &str) -> YarnParams {
    let number = |key: &str| row[key].parse::<f64>().expect("a number");
    assert_eq!(number("R_max"), 1.0, "R is a share of the ply's ellipse");
    YarnParams {
        ply_count: number("ply_num") as u32,
        fibers_per_ply: number("fiber_num") as u32,
        yarn_radius_mm: MM_PER_CM * number("yarn_radius"),
        ply_pitch_mm: Some(MM_PER_CM * number("yarn_alpha")),
        ply_clockwise: number("yarn_clock_wise") == 1.0,
        fiber_pitch_mm: Some(MM_PER_CM * number("alpha")),
        fiber_clockwise: number("fiber_clock_wise") == 1.0,
        ellipse_short_mm: MM_PER_CM * number("ellipse_short"),
        ellipse_long_mm: MM_PER_CM * number("ellipse_long"),
        migration_min: number("rho_min"),
        migration_max: number("rho_max"),
        migration_rate: number("s_i"),
        ..presets::yarn(preset).expect("the preset exists")
    }
}
