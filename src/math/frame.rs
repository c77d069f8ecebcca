//! Directions and frames that stay finite; twin of `glsl/lib/frame.glsl`.

use glam::DVec3;

/// Below this squared length a vector has no direction.
pub const NO_DIRECTION: f64 = 1e-24;

/// Packs a unit vector into two 16-bit snorms (octahedral map, Meyer et al. 2010); error below 7e-5 rad.
pub fn octahedral_from_unit(v: DVec3) -> u32 {
    let scale = v.x.abs() + v.y.abs() + v.z.abs();
    if scale.is_nan() || scale <= 0.0 {
        return octahedral_from_unit(DVec3::Z);
    }
    let (mut x, mut y) = (v.x / scale, v.y / scale);
    if v.z < 0.0 {
        let folded = ((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y));
        (x, y) = folded;
    }
    let pack = |c: f64| u32::from((c.clamp(-1.0, 1.0) * 32767.0).round() as i16 as u16);
    pack(x) | (pack(y) << 16)
}

/// Steps of the packed numbers, either way, among which [`octahedral_from_normal`] looks.
const NORMAL_SEARCH: i32 = 2;

/// Packs the unit `normal` of a curve with the unit `tangent` as [`octahedral_from_unit`] does, in those of the
/// nearest steps that turn it least about the tangent: error below 4e-5 rad about it, below 4e-4 rad toward it, which
/// whoever reads it takes off.
pub fn octahedral_from_normal(normal: DVec3, tangent: DVec3) -> u32 {
    let nearest = octahedral_from_unit(normal);
    let across = tangent.cross(normal);
    let [x, y] = [nearest as u16 as i16, (nearest >> 16) as u16 as i16].map(i32::from);
    let steps = -NORMAL_SEARCH..=NORMAL_SEARCH;
    let candidates = steps.clone().flat_map(|i| steps.clone().map(move |j| [x + i, y + j]));
    let packed = candidates
        // Steps over the square's edge would come back elsewhere.
        .filter(|c| c.iter().all(|c| c.abs() <= 32767))
        .map(|[x, y]| u32::from(x as i16 as u16) | (u32::from(y as i16 as u16) << 16));
    // Squared, so that no length is divided by: points are packed by the million.
    let turned = |bits: u32| {
        let found = along_octahedral(bits);
        let (length_squared, toward) = (found.length_squared(), found.dot(normal));
        // Beyond a fold a step may lead far away.
        if toward < 0.0 || toward * toward < 0.998 * length_squared {
            return f64::INFINITY;
        }
        let across = found.dot(across);
        across * across / length_squared
    };
    let key = |bits: u32| (turned(bits), bits);
    packed.map(key).fold(key(nearest), |best, found| if found.0 < best.0 { found } else { best }).1
}

/// The unit vector that [`octahedral_from_unit`] packed.
pub fn unit_from_octahedral(bits: u32) -> DVec3 {
    along_octahedral(bits).normalize()
}

/// A vector along the one that [`octahedral_from_unit`] packed.
fn along_octahedral(bits: u32) -> DVec3 {
    let x = f64::from(bits as u16 as i16) / 32767.0;
    let y = f64::from((bits >> 16) as u16 as i16) / 32767.0;
    let mut v = DVec3::new(x, y, 1.0 - x.abs() - y.abs());
    let fold = (-v.z).max(0.0);
    v.x += if v.x >= 0.0 { -fold } else { fold };
    v.y += if v.y >= 0.0 { -fold } else { fold };
    v
}

/// Some unit vector perpendicular to the unit vector `v`: never degenerate (Duff et al. 2017).
pub fn any_perpendicular(v: DVec3) -> DVec3 {
    let s = if v.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (s + v.z);
    DVec3::new(1.0 + s * v.x * v.x * a, s * v.x * v.y * a, -s * v.x)
}

/// v / |v|, where v has a direction.
pub fn direction_of(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    (largest * largest > NO_DIRECTION).then(|| (v / largest).normalize())
}

/// v / |v|, or `fallback` where v has no direction.
pub fn direction_or(v: DVec3, fallback: DVec3) -> DVec3 {
    direction_of(v).unwrap_or(fallback)
}

/// The part of `normal` perpendicular to the unit `tangent`, as a unit vector. Where the two are nearly
/// parallel the difference is rounding that may point anywhere, along the tangent too: what is left of
/// its direction after a second subtraction is perpendicular, or too short to be used.
pub fn normal_perpendicular_to(tangent: DVec3, normal: DVec3) -> DVec3 {
    let across = |v: DVec3| v - tangent * tangent.dot(v);
    let found = direction_of(across(normal)).map(across).filter(|n| n.length_squared() > 0.5);
    found.map_or_else(|| any_perpendicular(tangent), DVec3::normalize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Rng;

    fn random_unit(rng: &mut Rng) -> DVec3 {
        let z = 2.0 * rng.uniform() - 1.0;
        let (s, c) = (std::f64::consts::TAU * rng.uniform()).sin_cos();
        DVec3::new(c * (1.0 - z * z).sqrt(), s * (1.0 - z * z).sqrt(), z)
    }

    #[test]
    fn octahedral_round_trip_is_within_its_stated_error() {
        let mut rng = Rng::new(3, &[]);
        let axes = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
        let random = (0..10_000).map(|_| random_unit(&mut rng));
        for v in axes.into_iter().chain(random) {
            let w = unit_from_octahedral(octahedral_from_unit(v));
            assert!(v.cross(w).length() < 7e-5 && v.dot(w) > 0.0, "{v} became {w}");
        }
    }

    #[test]
    fn normals_packed_about_their_tangent_keep_to_their_stated_error() {
        let mut rng = Rng::new(5, &[]);
        let (mut worst, mut plain): (f64, f64) = (0.0, 0.0);
        for _ in 0..20_000 {
            let tangent = random_unit(&mut rng);
            let normal = normal_perpendicular_to(tangent, random_unit(&mut rng));
            let read =
                |bits| normal_perpendicular_to(tangent, unit_from_octahedral(bits)).cross(normal).length();
            let bits = octahedral_from_normal(normal, tangent);
            worst = worst.max(read(bits));
            plain = plain.max(read(octahedral_from_unit(normal)));
            assert!(unit_from_octahedral(bits).cross(normal).length() < 4e-4, "{normal}");
        }
        println!("{worst:.1e} rad about the tangent, {plain:.1e} without the search");
        assert!(worst < 4e-5 && plain > 5e-5, "{worst} {plain}");
        for normal in [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z] {
            let bits = octahedral_from_normal(normal, normal.any_orthonormal_vector());
            assert!(unit_from_octahedral(bits).dot(normal) > 0.999_999, "{normal}");
        }
    }

    #[test]
    fn perpendiculars_are_unit_and_perpendicular() {
        let mut rng = Rng::new(4, &[]);
        for v in (0..10_000).map(|_| random_unit(&mut rng)).chain([DVec3::Z, -DVec3::Z]) {
            let p = any_perpendicular(v);
            assert!(p.dot(v).abs() < 1e-14 && (p.length() - 1.0).abs() < 1e-14);
            let n = normal_perpendicular_to(v, v * 2.0);
            assert!(n.dot(v).abs() < 1e-12 && (n.length() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn tiny_and_huge_vectors_keep_their_direction() {
        for scale in [1e-11, 1.0, 1e200] {
            assert!(
                (direction_or(DVec3::new(3.0, 4.0, 0.0) * scale, DVec3::Z) - DVec3::new(0.6, 0.8, 0.0))
                    .length()
                    < 1e-14
            );
        }
        assert_eq!(direction_or(DVec3::ZERO, DVec3::Z), DVec3::Z);
    }
}
