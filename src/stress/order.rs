//! Which results only rise, or only fall, as a parameter grows.

use crate::bsdf::params::NARROWEST_DEG;
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, PI};

/// A result's order along one parameter.
pub struct Order {
    /// The function.
    pub function: &'static str,
    /// The parameter's path.
    pub path: &'static str,
    /// Between which values of it, in the surroundings of a query.
    pub range: fn(&Value) -> [f64; 2],
    /// Whether the result rises.
    pub rising: bool,
    /// How far it may move the other way, as a share of its largest: what f32 rounds, and tables where they are read.
    pub slack: f64,
}

/// What arithmetic in f32 rounds.
const ROUNDING: f64 = 2e-6;
/// What the table of normalisers adds.
const TABLE: f64 = 5e-5;

const fn order(
    function: &'static str,
    path: &'static str,
    rising: bool,
    slack: f64,
    range: fn(&Value) -> [f64; 2],
) -> Order {
    Order { function, path, range, rising, slack }
}

const ORDERS: &[Order] = &[
    order("migration_radius", "radius", true, ROUNDING, |_| [0.0, 1.0]),
    order("lod_factor", "width_fiber", true, ROUNDING, |q| [0.0, 2.0 * number(q, "width_lod")]),
    order("lod_factor", "width_ply", true, ROUNDING, |q| {
        [number(q, "width_fiber"), 100.0 * number(q, "width_lod")]
    }),
    order("lod_factor", "width_lod", false, ROUNDING, |q| {
        [0.5 * number(q, "width_fiber"), 2.0 * number(q, "width_ply")]
    }),
    order("fiber_density", "radius", false, ROUNDING, |_| [0.0, 1.0]),
    order("fiber_density", "beta", false, ROUNDING, |_| [0.0, 20.0]),
    order("simple_specular", "strength", true, ROUNDING, |_| [0.0, 1e3]),
    order("simple_specular", "theta_h", false, ROUNDING, |_| [0.0, FRAC_PI_2]),
    order("simple_specular", "width", true, ROUNDING, |_| [NARROWEST_DEG.to_radians(), FRAC_PI_2]),
    order("simple_specular", "phi", false, ROUNDING, |_| [0.0, PI]),
    order("longitudinal_normaliser", "theta", false, TABLE, |_| [0.0, FRAC_PI_2]),
    order("azimuthal_tt", "phi", true, ROUNDING, |_| [0.0, PI]),
    order("bcsdf", "theta_o", false, ROUNDING, |q| [-number(q, "theta_i"), FRAC_PI_2]),
    order("bcsdf", "phi", true, ROUNDING, |_| [0.0, PI]),
    order("ambient_scattering", "fiber.c_tt", true, ROUNDING, |_| [0.0, 1.0]),
];

fn number(query: &Value, key: &str) -> f64 {
    query.get(key).and_then(Value::as_f64).unwrap_or(0.0)
}

/// The orders along one parameter of a function.
pub fn orders(function: &str, path: &str) -> impl Iterator<Item = &'static Order> {
    ORDERS.iter().filter(move |order| order.function == function && order.path == path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probe::fields::Values;
    use crate::probe::{find, parse};
    use crate::stress::{queries, sweep};

    #[test]
    fn f64_keeps_to_every_order_and_none_holds_the_other_way() {
        for order in ORDERS {
            let function = find(order.function).unwrap();
            assert!(function.place_of(order.path).is_some(), "{} {}", order.function, order.path);
            let mut moved = false;
            for base in queries::random(order.function, 6) {
                let [low, high] = (order.range)(&base);
                let at = |i: u32| {
                    let mut query = base.clone();
                    sweep::set(&mut query, order.path, Value::from(low + (high - low) * f64::from(i) / 40.0));
                    let numbers = parse(function, &query.to_string()).unwrap();
                    (function.exact)(Values::new(&numbers)).iter().sum::<f64>()
                };
                let values: Vec<f64> = (0..=40).map(at).collect();
                let sign = if order.rising { 1.0 } else { -1.0 };
                let most = values.iter().copied().fold(0.0, f64::max);
                let wrong = values.windows(2).any(|w| sign * (w[1] - w[0]) < -1e-9 * most);
                assert!(!wrong, "{} along {}: {values:?}", order.function, order.path);
                moved |= values[0] != values[40];
            }
            assert!(moved, "{} does not move along {}", order.function, order.path);
        }
    }
}
