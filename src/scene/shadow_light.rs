//! Shadows between yarns (Wu & Yuksel 2019, Sec. 4.1): what a fiber makes of the shadow map; twin of
//! `glsl/shading/shadow_map.glsl`.

use super::shadow::ShadowView;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Largest cotangent of the angle between light and yarn for which a yarn's own tube is told from others.
pub const SHADOW_STEEPEST: f64 = 24.0;
/// How much nearer to the light than a fiber a tube's centre must be to hide it, in the fiber's yarn's radii:
/// tubes that touch are at least one apart where one lies on the other.
pub const SHADOW_BIAS: f64 = 0.5;
/// Most texels that a soft shadow is blurred over, to either side.
pub const SHADOW_WIDEST: f64 = 24.0;
/// Places at which a soft shadow is looked up, for the distance of what hides and for the share that is hidden.
pub const SHADOW_TAPS: u32 = 16;
/// Radians: the smaller part of a turn cut in the golden ratio.
pub const GOLDEN_ANGLE: f64 = PI * (3.0 - 2.236_067_977_499_79);
/// Least length of a piece, in mm, and least w of a clip position.
const LEAST: f64 = 1e-6;

/// Room around a yarn's own tube, for texels beside the one that a fiber falls on.
pub const SHADOW_MARGIN: f64 = 1.3;

/// Pieces of its own yarn, to either side, whose tube may lie between a fiber and the light without hiding it:
/// inside the tube, shadow is another table's matter. `along` is the cosine of the angle between light and yarn;
/// `radius` and `piece_length` are in mm.
pub fn shadow_window(along: f64, radius: f64, piece_length: f64) -> f64 {
    let across = (1.0 - along * along).max(0.0).sqrt();
    let cotangent = (along.abs() / across.max(LEAST)).min(SHADOW_STEEPEST);
    1.0 + 2.0 * radius * (1.0 + SHADOW_MARGIN * cotangent) / piece_length.max(LEAST)
}

/// Place in the map's texels (the first one's centre is at 0.5), and depth in mm away from the light.
pub fn shadow_place(view: &ShadowView, position: DVec3, resolution: f64) -> DVec3 {
    let clip = view.clip_from_world * position.extend(1.0);
    let place = (DVec2::splat(0.5) + 0.5 * clip.truncate().truncate() / clip.w.max(LEAST)) * resolution;
    place.extend(view.depth_axis.dot(position.extend(1.0)))
}

/// Which of a point light's six views ([`super::shadow::shadow_views`]) looks along `from_light`, of any length.
pub fn shadow_face(from_light: DVec3) -> u32 {
    let size = from_light.abs();
    let face = |axis: u32, along: f64| 2 * axis + u32::from(along <= 0.0);
    if size.x >= size.y && size.x >= size.z {
        face(0, from_light.x)
    } else if size.y >= size.z {
        face(1, from_light.y)
    } else {
        face(2, from_light.z)
    }
}

/// Whether what the map holds hides a fiber of piece `piece` (counted through all yarns) at `depth` mm. A texel is
/// the bits of a depth, and a piece's number plus one or 0 for nothing.
pub fn shadow_hides(texel: [u32; 2], depth: f64, piece: u32, window: f64) -> bool {
    let [bits, number] = texel;
    let Some(other) = number.checked_sub(1) else { return false };
    f64::from(f32::from_bits(bits)) < depth && f64::from(other.abs_diff(piece)) > window
}

/// The `tap`-th of [`SHADOW_TAPS`] places on a disk of radius 1, equally dense, turned by `turn` radians (Vogel
/// 1979).
pub fn shadow_tap(tap: u32, turn: f64) -> DVec2 {
    let radius = ((f64::from(tap) + 0.5) / f64::from(SHADOW_TAPS)).sqrt();
    radius * DVec2::from_angle(f64::from(tap) * GOLDEN_ANGLE + turn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Rng;
    use crate::scene::camera::Camera;
    use crate::scene::file::CameraTable;
    use crate::scene::light::{LightKind, LightTable};
    use crate::scene::shadow::shadow_views;
    use std::f64::consts::{FRAC_PI_2, TAU};

    const RESOLUTION: u32 = 256;
    const LIGHT: DVec3 = DVec3::new(1.0, -2.0, 3.0);

    fn views_of(kind: LightKind) -> Vec<ShadowView> {
        let light = LightTable {
            kind,
            position_mm: (kind != LightKind::Directional).then(|| LIGHT.to_array()),
            ..Default::default()
        };
        let cloth = (DVec3::splat(-20.0), DVec3::splat(20.0));
        let corners = [cloth.0, cloth.1].into_iter();
        let camera = Camera::new(&CameraTable::default(), [300, 300], DVec3::ZERO, corners, 1.0);
        shadow_views(&light, DVec3::ZERO, &camera, cloth, RESOLUTION)
    }

    fn random_unit(rng: &mut Rng) -> DVec3 {
        let z = 2.0 * rng.uniform() - 1.0;
        DVec2::from_angle(TAU * rng.uniform()).extend(0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
    }

    #[test]
    fn the_window_grows_as_the_light_grazes_and_is_bounded() {
        let (radius, length) = (0.4, 0.2);
        let at = |angle: f64| shadow_window(angle.cos(), radius, length);
        // Light from the side passes the tube over its width, and no more.
        assert!((at(FRAC_PI_2) - (1.0 + 2.0 * radius / length)).abs() < 1e-9);
        for i in 1..=1000 {
            let angle = FRAC_PI_2 * f64::from(i) / 1000.0;
            assert!(at(angle) <= at(0.999 * angle), "{angle}");
            assert!((at(angle) - at(PI - angle)).abs() < 1e-9 * at(angle), "either way along the yarn");
            // What light passes of the tube along the yarn: the tube's width over the tangent.
            let passed = 2.0 * radius / angle.tan() / length;
            assert!(at(angle) >= passed.min(2.0 * radius * SHADOW_STEEPEST / length), "{angle}");
        }
        let most = 1.0 + 2.0 * radius * (1.0 + SHADOW_MARGIN * SHADOW_STEEPEST) / length;
        for along in [1.0, -1.0, 1.000_000_1, 0.999_999_999] {
            assert!((shadow_window(along, radius, length) - most).abs() < 1e-9, "{along}");
        }
        assert!(shadow_window(1.0, 1e3, 0.0).is_finite());
        assert!((shadow_window(0.3, radius, 1e9) - 1.0).abs() < 1e-6, "at least the neighbours");
    }

    #[test]
    fn a_place_is_the_texel_whose_centre_it_is() {
        for kind in [LightKind::Directional, LightKind::Point] {
            let view = &views_of(kind)[0];
            let world_from_clip = view.clip_from_world.inverse();
            for (x, y) in [(0, 0), (17, 200), (RESOLUTION - 1, RESOLUTION - 1)] {
                let centre = |i: u32| (2.0 * f64::from(i) + 1.0) / f64::from(RESOLUTION) - 1.0;
                let position = world_from_clip.project_point3(DVec3::new(centre(x), centre(y), 0.5));
                let place = shadow_place(view, position, RESOLUTION.into());
                let expected = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                assert!((place.truncate() - expected).length() < 1e-9, "{kind:?}: {place}");
            }
        }
    }

    #[test]
    fn depth_is_in_mm_along_the_view() {
        let view = &views_of(LightKind::Point)[0];
        let place = shadow_place(view, LIGHT + DVec3::new(7.0, 1.0, -2.0), RESOLUTION.into());
        assert!((place.z - 7.0).abs() < 1e-12, "{place}");
        let behind = shadow_place(view, LIGHT - DVec3::X, RESOLUTION.into());
        assert!(behind.is_finite() && behind.z < 0.0, "{behind}");
    }

    #[test]
    fn a_face_is_the_view_whose_clip_volume_holds_the_point() {
        let views = views_of(LightKind::Point);
        let inside = |view: &ShadowView, p: DVec3| {
            let clip = view.clip_from_world * p.extend(1.0);
            clip.w > 0.0 && clip.truncate().truncate().abs().max_element() <= clip.w
        };
        let mut rng = Rng::new(7, &[]);
        let diagonals = [DVec3::ONE, DVec3::new(-1.0, 1.0, 0.0), DVec3::new(0.5, -1.0, -1.0)];
        let axes = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
        let directions = (0..2000).map(|_| random_unit(&mut rng)).chain(diagonals).chain(axes);
        let mut seen = [0; 6];
        for direction in directions {
            let face = shadow_face(direction) as usize;
            let held: Vec<bool> = views.iter().map(|view| inside(view, LIGHT + 5.0 * direction)).collect();
            assert!(held[face], "{direction}: face {face}, inside {held:?}");
            // Away from the seams, which views share, no other view will do.
            let mut sizes = direction.abs().to_array();
            sizes.sort_by(f64::total_cmp);
            let alone = held.iter().filter(|&&held| held).count() == 1;
            assert!(alone || sizes[1] > 0.98 * sizes[2], "{direction}: {held:?}");
            seen[face] += 1;
        }
        assert!(seen.iter().all(|&count| count > 200), "{seen:?}");
        assert!(shadow_face(DVec3::ZERO) < 6);
    }

    #[test]
    fn another_piece_hides_where_it_is_nearer_and_nothing_else_does() {
        let texel = |depth: f32, piece: u32| [depth.to_bits(), piece + 1];
        let (depth, piece, window) = (10.0, 100, 3.5);
        let hides = |texel| shadow_hides(texel, depth, piece, window);
        // Its own yarn's pieces nearby never do, how near to the light they may be.
        for other in 97..=103 {
            assert!(!hides(texel(0.0, other)), "{other}");
        }
        // Those farther along do, to either side, the first piece of all as well.
        for other in [96, 104, 0, 5000, u32::MAX - 1] {
            assert!(hides(texel(9.0, other)), "{other}");
            assert!(!hides(texel(10.0, other)) && !hides(texel(11.0, other)), "{other}: not nearer");
        }
        // Where nothing is, nothing hides, whatever its depth says.
        for depth in [0.0, -1e30, f32::NAN] {
            assert!(!hides([depth.to_bits(), 0]), "{depth}");
        }
        // The number is one more than the piece: of neighbours that the window tells apart, one hides.
        assert!(!shadow_hides(texel(1.0, 7), 2.0, 7, 0.0) && shadow_hides(texel(1.0, 7), 2.0, 8, 0.0));
    }

    #[test]
    fn taps_are_equally_dense_on_the_disk() {
        let golden: f64 = 0.5 * (1.0 + 5.0_f64.sqrt());
        assert!((GOLDEN_ANGLE - TAU / (golden * golden)).abs() < 1e-14);
        for turn in [0.0, 1.0, 4.0] {
            let taps: Vec<DVec2> = (0..SHADOW_TAPS).map(|tap| shadow_tap(tap, turn)).collect();
            let count = f64::from(SHADOW_TAPS);
            assert!(taps.iter().all(|tap| tap.length() <= 1.0));
            let mean = taps.iter().sum::<DVec2>() / count;
            assert!(mean.length() < 0.05, "{mean}");
            for i in 1..=10 {
                let radius = f64::from(i) / 10.0;
                let share = taps.iter().filter(|tap| tap.length() <= radius).count() as f64 / count;
                assert!((share - radius * radius).abs() <= 0.5 / count + 1e-12, "{radius}: {share}");
            }
            // By direction as by distance: a half disk any way holds half of them, but for two.
            for way in (0..32).map(|i| DVec2::from_angle(TAU * f64::from(i) / 32.0)) {
                let ahead = taps.iter().filter(|tap| tap.dot(way) > 0.0).count() as f64;
                assert!((ahead - 0.5 * count).abs() <= 2.0, "{way}: {ahead}");
            }
            let first = shadow_tap(3, 0.0);
            assert!((DVec2::from_angle(turn).rotate(first) - taps[3]).length() < 1e-12);
        }
    }
}
