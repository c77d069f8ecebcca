//! Fiber migration; twin of `glsl/yarn/migration.glsl`.

/// Distance from the ply's centre as a share of its ellipse, and its derivative by the phase.
/// Wu & Yuksel 2019, Eq. 2, with a migration phase m_i of its own for each fiber in place of theta_i
/// (as printed, s = 1 would shift every ply sideways). `phase` = s theta + m_i, radians.
pub fn migration_radius(radius: f64, phase: f64, migration_min: f64, migration_max: f64) -> (f64, f64) {
    let middle = 0.5 * radius * (migration_max + migration_min);
    let swing = 0.5 * radius * (migration_max - migration_min);
    (middle + swing * phase.cos(), -swing * phase.sin())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn stays_between_its_bounds() {
        assert!((migration_radius(0.5, 0.0, 0.8, 1.0).0 - 0.5).abs() < 1e-15);
        assert!((migration_radius(0.5, PI, 0.8, 1.0).0 - 0.4).abs() < 1e-15);
        let h = 1e-6;
        let slope = (migration_radius(0.5, 1.0 + h, 0.8, 1.0).0 - migration_radius(0.5, 1.0 - h, 0.8, 1.0).0)
            / (2.0 * h);
        assert!((migration_radius(0.5, 1.0, 0.8, 1.0).1 - slope).abs() < 1e-9);
    }
}
