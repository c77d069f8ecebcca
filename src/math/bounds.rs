//! Boxes around points.

use glam::DVec3;

/// Low and high corner of a box along the axes.
pub type Bounds = (DVec3, DVec3);

/// The smallest box around all points; from infinity down to minus infinity around none.
pub fn bounds(points: impl Iterator<Item = DVec3>) -> Bounds {
    let nothing = (DVec3::splat(f64::INFINITY), DVec3::splat(f64::NEG_INFINITY));
    points.fold(nothing, |(low, high), p| (low.min(p), high.max(p)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holds_every_point_and_nothing_around_none() {
        let points = [DVec3::new(1.0, -2.0, 3.0), DVec3::new(-1.0, 5.0, 3.0)];
        let found = bounds(points.into_iter());
        assert_eq!(found, (DVec3::new(-1.0, -2.0, 3.0), DVec3::new(1.0, 5.0, 3.0)));
        assert!(!bounds(std::iter::empty()).0.is_finite());
    }
}
