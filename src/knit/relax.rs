//! Tightens yarns until they rest on each other: a quadratic energy (stretch and bending of the
//! control points) under contact, by damped Gauss-Newton steps. Deterministic; lengths in the
//! caller's unit.
//!
//! The unknowns are a few base points; every control point of every strand is an image of one of
//! them (mirrored, turned by half a turn or shifted), so one quarter of a loop stands for a whole
//! periodic cloth, as in the relaxation of Kaldor, James & Marschner 2008 but on one cell.

use glam::DVec3;

use super::dense::SymmetricSystem;

/// A control point as `sign * base point + shift`, with signs of 1 or -1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Image {
    /// Index of the base point.
    pub(crate) base: usize,
    /// Factor of each coordinate.
    pub(crate) sign: DVec3,
    /// What is added.
    pub(crate) shift: DVec3,
}

impl Image {
    /// The control point for the given base points.
    pub(crate) fn at(&self, base: &[DVec3]) -> DVec3 {
        self.sign * base[self.base] + self.shift
    }
}

/// What is to be relaxed.
#[derive(Clone, Debug)]
pub(crate) struct Cloth {
    /// The unknowns.
    pub(crate) base: Vec<DVec3>,
    /// Which coordinates of each may move.
    pub(crate) free: Vec<[bool; 3]>,
    /// Catmull-Rom control points; the first and the last of a strand only shape its ends.
    pub(crate) strands: Vec<Vec<Image>>,
    /// The segments of strand 0 whose energy and contacts count (segment k runs from point k to k + 1).
    pub(crate) active: std::ops::Range<usize>,
}

/// How hard and for how long.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// Distance that centre lines keep.
    pub(crate) contact: f64,
    /// Weight of the squared first differences: tension.
    pub(crate) stretch: f64,
    /// Weight of the squared second differences: bending stiffness.
    pub(crate) bending: f64,
    /// Weight of the squared penetration.
    pub(crate) penalty: f64,
    /// Along the same strand, closer neighbours than this are no contact.
    pub(crate) arc_skip: f64,
    /// Newton steps.
    pub(crate) steps: usize,
}

/// Samples per segment at which contacts are sought.
const SAMPLES_PER_SEGMENT: usize = 8;

/// A linear combination of images.
type Form = Vec<(Image, f64)>;

/// Weights of the four control points of a Catmull-Rom segment at `t`.
pub(crate) fn catmull_rom_weights(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [-0.5 * t + t2 - 0.5 * t3, 1.0 - 2.5 * t2 + 1.5 * t3, 0.5 * t + 2.0 * t2 - 1.5 * t3, -0.5 * t2 + 0.5 * t3]
}

/// The finely sampled strands.
struct Samples {
    positions: Vec<Vec<DVec3>>,
}

/// The form of sample `index` of a strand; sample 0 lies on control point 1.
fn sample_form(strand: &[Image], index: usize) -> [(Image, f64); 4] {
    let segment = (index / SAMPLES_PER_SEGMENT).min(strand.len() - 4);
    let t = (index - segment * SAMPLES_PER_SEGMENT) as f64 / SAMPLES_PER_SEGMENT as f64;
    let w = catmull_rom_weights(t);
    std::array::from_fn(|k| (strand[segment + k], w[k]))
}

impl Samples {
    fn new(cloth: &Cloth) -> Self {
        let of = |strand: &Vec<Image>| {
            let count = (strand.len() - 3) * SAMPLES_PER_SEGMENT + 1;
            (0..count)
                .map(|i| sample_form(strand, i).iter().map(|(p, w)| p.at(&cloth.base) * *w).sum())
                .collect()
        };
        Self { positions: cloth.strands.iter().map(of).collect() }
    }
}

/// Every pair of an active sample and a locally nearest sample of some strand closer than `reach`.
fn contacts(cloth: &Cloth, samples: &Samples, reach: f64, arc_skip: f64) -> Vec<[(usize, usize); 2]> {
    let own = &samples.positions[0];
    let mut arc = vec![0.0; own.len()];
    for i in 1..own.len() {
        arc[i] = arc[i - 1] + own[i].distance(own[i - 1]);
    }
    let mut found = Vec::new();
    // Segment k of the strand starts at sample (k - 1) * SAMPLES_PER_SEGMENT.
    let first = (cloth.active.start - 1) * SAMPLES_PER_SEGMENT;
    let last = (cloth.active.end - 1) * SAMPLES_PER_SEGMENT;
    for i in first..=last {
        for (s, other) in samples.positions.iter().enumerate() {
            for j in 0..other.len() {
                let d2 = own[i].distance_squared(other[j]);
                if d2 >= reach * reach || (s == 0 && (arc[i] - arc[j]).abs() < arc_skip) {
                    continue;
                }
                let nearer = |k: usize| own[i].distance_squared(other[k]) < d2;
                if (j > 0 && nearer(j - 1)) || (j + 1 < other.len() && nearer(j + 1)) {
                    continue;
                }
                found.push([(0, i), (s, j)]);
            }
        }
    }
    found
}

/// Adds one scalar term of the objective with the given gradient of its argument: `slope` and `weight`
/// are the term's first and second derivative by that argument.
fn add_rank_one(system: &mut SymmetricSystem, gradient: &[(usize, f64)], slope: f64, weight: f64) {
    for &(i, gi) in gradient {
        system.rhs[i] -= slope * gi;
        for &(j, gj) in gradient {
            system.add(i, j, weight * gi * gj);
        }
    }
}

/// The free unknowns of a form along coordinate-wise factors `n`.
fn gradient_of(cloth: &Cloth, form: &[(Image, f64)], n: DVec3) -> Vec<(usize, f64)> {
    let mut gradient: Vec<(usize, f64)> = Vec::with_capacity(3 * form.len());
    for (image, w) in form {
        for c in 0..3 {
            let g = w * image.sign[c] * n[c];
            if g != 0.0 && cloth.free[image.base][c] {
                gradient.push((3 * image.base + c, g));
            }
        }
    }
    gradient
}

/// First and second differences of the active control points, with their weights.
fn energy_forms(cloth: &Cloth, settings: &Settings) -> Vec<(Form, f64)> {
    let strand = &cloth.strands[0];
    let mut forms = Vec::new();
    for k in cloth.active.clone() {
        forms.push((vec![(strand[k], -1.0), (strand[k + 1], 1.0)], settings.stretch));
    }
    for k in cloth.active.start..=cloth.active.end {
        // The ends of the active range are shared with the part beyond, which is not summed.
        let share = if k == cloth.active.start || k == cloth.active.end { 0.5 } else { 1.0 };
        let form = vec![(strand[k - 1], 1.0), (strand[k], -2.0), (strand[k + 1], 1.0)];
        forms.push((form, settings.bending * share));
    }
    forms
}

/// The Newton system at the present state.
fn newton_system(
    cloth: &Cloth,
    settings: &Settings,
    energy: &[(Form, f64)],
    damping: f64,
) -> SymmetricSystem {
    let mut system = SymmetricSystem::new(3 * cloth.base.len());
    for (b, free) in cloth.free.iter().enumerate() {
        for (c, &is_free) in free.iter().enumerate() {
            system.add(3 * b + c, 3 * b + c, if is_free { damping } else { 1.0 });
        }
    }
    for (form, weight) in energy {
        let value: DVec3 = form.iter().map(|(p, w)| p.at(&cloth.base) * *w).sum();
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let gradient = gradient_of(cloth, form, axis);
            add_rank_one(&mut system, &gradient, weight * value.dot(axis), *weight);
        }
    }
    let samples = Samples::new(cloth);
    for [(_, i), (s, j)] in contacts(cloth, &samples, settings.contact, settings.arc_skip) {
        let apart = samples.positions[0][i] - samples.positions[s][j];
        let distance = apart.length();
        let Some(n) = apart.try_normalize() else { continue };
        let mut form = sample_form(&cloth.strands[0], i).to_vec();
        form.extend(sample_form(&cloth.strands[s], j).iter().map(|(p, w)| (*p, -w)));
        let weight = settings.penalty / SAMPLES_PER_SEGMENT as f64;
        add_rank_one(
            &mut system,
            &gradient_of(cloth, &form, n),
            weight * (distance - settings.contact),
            weight,
        );
    }
    system
}

/// What the steps lower: energy plus penetration.
fn objective(cloth: &Cloth, settings: &Settings, energy: &[(Form, f64)]) -> f64 {
    let value =
        |form: &Form| form.iter().map(|(p, w)| p.at(&cloth.base) * *w).sum::<DVec3>().length_squared();
    let elastic: f64 = energy.iter().map(|(form, weight)| 0.5 * weight * value(form)).sum();
    let samples = Samples::new(cloth);
    let weight = settings.penalty / SAMPLES_PER_SEGMENT as f64;
    let pressed: f64 = contacts(cloth, &samples, settings.contact, settings.arc_skip)
        .into_iter()
        .map(|[(a, i), (b, j)]| settings.contact - samples.positions[a][i].distance(samples.positions[b][j]))
        .map(|depth| 0.5 * weight * depth * depth)
        .sum();
    elastic + pressed
}

/// Relaxes the base points in place; returns the number of steps taken.
///
/// Levenberg-Marquardt: the damping falls while steps lower the objective and grows when one does not.
pub(crate) fn relax(cloth: &mut Cloth, settings: &Settings) -> usize {
    let energy = energy_forms(cloth, settings);
    // A step longer than this could carry one strand through another.
    let longest = 0.1 * settings.contact;
    let mut damping = 0.01 * settings.penalty;
    let mut present = objective(cloth, settings, &energy);
    for step in 0..settings.steps {
        let Some(x) = newton_system(cloth, settings, &energy, damping).solve() else { return step };
        let largest = x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let scale = if largest > longest { longest / largest } else { 1.0 };
        let before = cloth.base.clone();
        for (b, p) in cloth.base.iter_mut().enumerate() {
            *p += DVec3::new(x[3 * b], x[3 * b + 1], x[3 * b + 2]) * scale;
        }
        let next = objective(cloth, settings, &energy);
        if next < present {
            let gained = present - next;
            present = next;
            damping = (damping * 0.3).max(1e-9 * settings.penalty);
            if gained < 1e-9 * next {
                return step;
            }
        } else {
            cloth.base = before;
            damping *= 5.0;
            if damping > 1e3 * settings.penalty {
                return step;
            }
        }
    }
    settings.steps
}

/// The smallest distance of the active samples from any other, no farther than `reach`.
pub(crate) fn closest(cloth: &Cloth, reach: f64, arc_skip: f64) -> f64 {
    let samples = Samples::new(cloth);
    contacts(cloth, &samples, reach, arc_skip)
        .into_iter()
        .map(|[(a, i), (b, j)]| samples.positions[a][i].distance(samples.positions[b][j]))
        .fold(reach, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETTINGS: Settings =
        Settings { contact: 1.0, stretch: 1.0, bending: 0.01, penalty: 1e4, arc_skip: 2.0, steps: 100 };

    /// A yarn along X, held at both ends at height `held`, whose middle passes over or under a fixed
    /// yarn along Y at the origin; its free points start at height `start`.
    fn crossing(held: f64, start: f64) -> Cloth {
        let mut base: Vec<DVec3> = (-4..=4).map(|i| DVec3::new(f64::from(i), 0.0, held)).collect();
        base[2..7].iter_mut().for_each(|p| p.z = start);
        let free = (0..9).map(|i| [(2..7).contains(&i); 3]).chain([[false; 3]]).collect();
        base.push(DVec3::ZERO);
        let along_y = |i: i32| Image { base: 9, sign: DVec3::ONE, shift: DVec3::Y * 0.5 * f64::from(i) };
        let own = (0..9).map(|base| Image { base, sign: DVec3::ONE, shift: DVec3::ZERO }).collect();
        Cloth { base, free, strands: vec![own, (-8..=8).map(along_y).collect()], active: 1..7 }
    }

    #[test]
    fn a_taut_yarn_comes_to_rest_on_the_one_it_crosses() {
        let mut cloth = crossing(0.0, 2.5);
        assert!(closest(&cloth, 3.0, 2.0) > 2.0);
        assert!(relax(&mut cloth, &SETTINGS) < SETTINGS.steps);
        let distance = closest(&cloth, 3.0, 2.0);
        assert!((0.99..1.0).contains(&distance), "{distance}");
        assert!(cloth.base[4].z > 0.9, "still on its own side: {:?}", cloth.base[4]);
        assert_eq!(cloth.base[0], DVec3::new(-4.0, 0.0, 0.0));
    }

    #[test]
    fn a_yarn_that_touches_nothing_becomes_straight() {
        let mut cloth = crossing(3.0, 4.0);
        relax(&mut cloth, &SETTINGS);
        assert!(
            cloth.base[..9].iter().all(|p| (p.z - 3.0).abs() < 1e-4 && p.y.abs() < 1e-9),
            "{:?}",
            cloth.base
        );
    }

    #[test]
    fn strands_that_already_enter_each_other_are_pushed_apart() {
        let mut cloth = crossing(0.0, 0.4);
        assert!(closest(&cloth, 3.0, 2.0) < 0.5);
        relax(&mut cloth, &SETTINGS);
        assert!(closest(&cloth, 3.0, 2.0) > 0.99);
    }
}
