//! Reads the text back with a strict little parser: every attribute once, every array as long as it must be.

use super::*;
use glam::DVec3;

/// The text between the brackets of the one attribute `name`, and what follows up to the next attribute.
fn attribute<'a>(text: &'a str, name: &str) -> (&'a str, &'a str) {
    let head = format!("        {name} = [");
    assert_eq!(text.matches(&head).count(), 1, "{name}");
    let (values, rest) = text.split_once(&head).unwrap().1.split_once(']').unwrap();
    (values.trim(), rest.split_once("        ").map_or(rest, |(_, next)| next))
}

fn numbers<T: std::str::FromStr>(text: &str) -> Vec<T>
where
    T::Err: std::fmt::Debug,
{
    let plain: String = text.chars().map(|c| if "(),".contains(c) { ' ' } else { c }).collect();
    plain.split_whitespace().map(|word| word.parse().unwrap()).collect()
}

fn written(groups: &[FiberGroup<'_>]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.usda");
    write_usda(&path, groups, &|_| ()).unwrap();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    std::fs::read_to_string(&path).unwrap()
}

#[test]
fn every_array_is_as_long_as_the_counts_say_and_reads_back() {
    let points: Vec<DVec3> = (0..5).map(|i| DVec3::new(0.1, -7.3e-4, 1e6 / 3.0) * f64::from(i)).collect();
    let radii = [0.0123, 0.0123, 0.01, 0.005, 0.0];
    let run = |n: usize, closed, fiber| FiberRun {
        points: &points[..n],
        radii_mm: &radii[..n],
        closed,
        curve: 2,
        ply: 1,
        fiber,
    };
    let text = written(&[FiberGroup { runs: vec![run(5, false, 7), run(3, true, 8), run(2, false, 9)] }]);
    assert_eq!(text.matches('{').count(), text.matches('}').count());
    assert_eq!(text.matches('(').count(), text.matches(')').count());
    for line in [
        "#usda 1.0\n",
        "metersPerUnit = 0.001\n",
        "upAxis = \"Y\"\n",
        "type = \"linear\"\n",
        "wrap = \"nonperiodic\"\n",
    ] {
        assert_eq!(text.matches(line).count(), 1, "{line}");
    }
    assert!(text.starts_with("#usda 1.0\n") && text.ends_with("}\n"));

    let counts: Vec<usize> = numbers(attribute(&text, "int[] curveVertexCounts").0);
    assert_eq!(counts, [5, 4, 2], "a closed run repeats its first point");
    let total: usize = counts.iter().sum();
    let flat: Vec<f32> = numbers(attribute(&text, "point3f[] points").0);
    assert_eq!(flat.len(), 3 * total);
    let expected = [&points[..5], &points[..3], &points[..1], &points[..2]].concat();
    let exact = |p: &DVec3| p.as_vec3().to_array();
    assert_eq!(flat, expected.iter().flat_map(exact).collect::<Vec<f32>>());
    let (widths, interpolation) = attribute(&text, "float[] widths");
    let widths: Vec<f32> = numbers(widths);
    assert_eq!((widths.len(), widths[0], widths[8]), (total, 0.0246, 0.0246));
    assert!(interpolation.contains("\"vertex\""), "{interpolation}");
    for (name, values) in [("ply", [1, 1, 1]), ("fiber", [7, 8, 9]), ("curve", [2, 2, 2])] {
        let (found, interpolation) = attribute(&text, &format!("int[] primvars:{name}"));
        assert_eq!(numbers::<i32>(found), values, "{name}");
        assert!(interpolation.contains("\"uniform\""), "{name}: {interpolation}");
    }
}

#[test]
fn the_extent_holds_every_fiber_with_its_radius() {
    let points = [DVec3::new(-1.0, 2.0, 3.0), DVec3::new(4.0, -5.0, 6.0)];
    let run = FiberRun { points: &points, radii_mm: &[0.5, 0.25], closed: false, curve: 0, ply: 0, fiber: 0 };
    let text = written(&[FiberGroup { runs: vec![run] }]);
    let extent: Vec<f32> = numbers(attribute(&text, "float3[] extent").0);
    assert_eq!(extent, [-1.5, -5.25, 2.5, 4.25, 2.5, 6.25]);
}

#[test]
fn every_fabric_is_a_prim_and_none_is_no_number() {
    let points = [DVec3::ZERO, DVec3::X];
    let run = FiberRun { points: &points, radii_mm: &[0.5; 2], closed: false, curve: 0, ply: 0, fiber: 0 };
    let text =
        written(&[FiberGroup { runs: vec![run] }, FiberGroup::default(), FiberGroup { runs: vec![run] }]);
    for index in 0..3 {
        assert_eq!(text.matches(&format!("def BasisCurves \"fabric_{index}\"")).count(), 1);
    }
    assert!(!text.contains("inf") && !text.contains("NaN"));
    let folder = tempfile::tempdir().unwrap();
    assert!(write_usda(&folder.path().join("a.usda"), &[], &|_| ()).is_err());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
