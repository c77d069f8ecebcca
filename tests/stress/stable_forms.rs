//! Each stable form has a reason: with what the papers print in its place the sweep fails.

use crate::{device, glsl};
use std::collections::BTreeMap;
use std::path::Path;
use worsted::shaders::ShaderSet;
use worsted::stress::sweep_with;
use worsted::vulkan::DeviceChoice;

/// What is published of a form, the function whose sweep must notice, and the change: a text under `glsl/`, what stands
/// there exactly once, and the published form.
struct Published {
    what: &'static str,
    function: &'static str,
    kernel: &'static str,
    file: &'static str,
    stable: &'static str,
    published: &'static str,
}

const PUBLISHED: [Published; 6] = [
    Published {
        what: "N_TT with exp(-k) and exp(-k cos phi), which leave f32's range from 6 degrees down",
        function: "azimuthal_tt",
        kernel: "test/functions/azimuthal_tt.comp",
        file: "bsdf/khungurn.glsl",
        stable: "return n_tt * exp(-2.0 * k * cos_half_phi * cos_half_phi);",
        published: "return n_tt * exp(-k) * exp(-k * (2.0 * cos_half_phi * cos_half_phi - 1.0));",
    },
    Published {
        what: "cos theta_i as sqrt(1 - sin^2)",
        function: "bcsdf_cos",
        kernel: "probe/bcsdf_cos.comp",
        file: "bsdf/khungurn.glsl",
        stable: "float cos_i = min(1.0, length(across_i));",
        published: "float cos_i = sqrt(max(0.0, 1.0 - dot(tangent, to_light) * dot(tangent, to_light)));",
    },
    Published {
        what: "G in closed form over all angles, which is twice as much at the pole",
        function: "longitudinal_normaliser",
        kernel: "probe/longitudinal_normaliser.comp",
        file: "probe/longitudinal_normaliser.comp",
        stable: "gaussian_normaliser(cos_theta, width) * ratio",
        published: "0.5 * (1.0 + exp(-2.0 * width * width) * (2.0 * cos_theta * cos_theta - 1.0))",
    },
    Published {
        what: "F with a minus",
        function: "bcsdf",
        kernel: "probe/bcsdf.comp",
        file: "bsdf/khungurn.glsl",
        stable: "r = (s.c_r + rest * schlick(cos_i))",
        published: "r = (s.c_r - rest * schlick(cos_i))",
    },
    Published {
        what: "the smallest rotation of a normal with its division, which has a pole where yarn doubles back",
        function: "fiber_point",
        kernel: "probe/fiber_point.comp",
        file: "yarn/fiber.glsl",
        stable: "return more * (normal + 2.0 * along * to) - (along + dot(normal, to)) * (from + to);",
        published: "return normal - dot(normal, to) / more * (from + to);",
    },
    Published {
        what: "the density's e - e^R as it is printed, which cancels at the rim",
        function: "fiber_density",
        kernel: "test/functions/fiber_density.comp",
        file: "yarn/density.glsl",
        stable: "one_minus_exp(1.0 - radius) * (1.0 / 0.63212055882855767)",
        published: "(exp(1.0) - exp(radius)) * (1.0 / 1.7182818284590451)",
    },
];

/// The kernel with one text changed; an error where that does not stand in it exactly once.
fn changed(case: &Published) -> Result<ShaderSet, String> {
    let read = |path: &str| -> Result<String, String> {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl").join(path);
        let text = std::fs::read_to_string(file).map_err(|e| e.to_string())?;
        Ok(if path == case.file { text.replace(case.stable, case.published) } else { text })
    };
    let whole = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl").join(case.file));
    let found = whole.map_err(|e| e.to_string())?.matches(case.stable).count();
    if found != 1 {
        return Err(format!("{}: expected `{}` once, found it {found} times", case.file, case.stable));
    }
    let stage = glsl::stage_of(case.kernel).expect("a stage's extension");
    let words = glsl::compile(case.kernel, stage, &read)?;
    if worsted::shaders::get(case.kernel) == Some(&words) {
        return Err(format!("{}: no shader is altered", case.what));
    }
    Ok(ShaderSet::replacing(BTreeMap::from([(case.kernel.to_owned(), words)])))
}

#[test]
fn the_published_forms_fail_where_the_stable_ones_hold() {
    let device = device::shared(DeviceChoice::Auto);
    let mut unnoticed = Vec::new();
    for case in &PUBLISHED {
        let intact = sweep_with(device, case.function, &ShaderSet::default()).unwrap();
        assert!(intact.iter().all(|row| row.holds()), "{}: {intact:#?}", case.function);
        let shaders = changed(case).unwrap_or_else(|error| panic!("{}: {error}", case.what));
        let rows = sweep_with(device, case.function, &shaders).unwrap();
        let bad: Vec<_> = rows.iter().filter(|row| !row.holds()).collect();
        println!("{}: {} of {} rows fail", case.what, bad.len(), rows.len());
        if let Some(row) = bad.first() {
            println!("    by {}: {}", row.swept, row.faults.join("; "));
        } else {
            unnoticed.push(case.what);
        }
    }
    assert!(unnoticed.is_empty(), "nothing notices: {unnoticed:#?}");
}

#[test]
fn a_form_that_is_not_there_is_an_error() {
    let case = Published { stable: "no such text", ..PUBLISHED[0] };
    assert!(changed(&case).unwrap_err().contains("found it 0 times"));
    let same = Published { published: PUBLISHED[0].stable, ..PUBLISHED[0] };
    assert!(changed(&same).unwrap_err().contains("no shader is altered"));
}
