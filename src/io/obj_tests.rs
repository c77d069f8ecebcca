use super::*;

fn parse_text(text: &str) -> Loaded {
    parse_obj(Path::new("a.obj"), text.as_bytes()).unwrap()
}

fn error_of(bytes: &[u8]) -> String {
    let line = parse_obj(Path::new("a.obj"), bytes).unwrap_err().to_string();
    assert!(!line.contains('\n') && line.len() < 200, "{line}");
    line
}

/// The x coordinates of each curve, which the tests below use as names of vertices.
fn names(loaded: &Loaded) -> Vec<(Vec<f64>, bool)> {
    let curves = &loaded.curves.curves;
    curves.iter().map(|c| (c.points.iter().map(|p| p.x).collect(), c.closed)).collect()
}

const FIVE: &str = "v 1 0 0\nv 2 0 0 1.0\nv 3 0 0 0.5 0.5 0.5\nv 4 1e-3 -.5\r\nv 5 0 0\n";

#[test]
fn edges_chain_whatever_their_order_and_direction() {
    let loaded = parse_text(&format!("{FIVE}l 3 4\nl 3 2\nl 5 4\nl 1 2\n"));
    assert_eq!(names(&loaded), [(vec![1.0, 2.0, 3.0, 4.0, 5.0], false)]);
    assert_eq!(loaded.curves.curves[0].points[3], DVec3::new(4.0, 1e-3, -0.5));
}

#[test]
fn a_chain_that_returns_to_its_start_is_closed() {
    let loop_of_four = vec![1.0, 2.0, 3.0, 4.0];
    assert_eq!(
        names(&parse_text(&format!("{FIVE}l 1 2\nl 2 3\nl 3 4\nl 4 1"))),
        [(loop_of_four.clone(), true)]
    );
    assert_eq!(names(&parse_text(&format!("{FIVE}l 1 2 3\nl 1 4 3"))), [(loop_of_four.clone(), true)]);
    assert_eq!(names(&parse_text(&format!("{FIVE}l 1 2 3 4 1"))), [(loop_of_four, true)]);
}

#[test]
fn long_elements_negative_and_textured_indices_and_continued_lines() {
    let loaded = parse_text(&format!("{FIVE}l 1/1 2/7 \\\n  3/ \\\n 4 # end\nl -1 -2"));
    assert_eq!(names(&loaded), [(vec![1.0, 2.0, 3.0, 4.0, 5.0], false)]);
    // A negative index counts from the line it stands on, a positive one may look ahead.
    let loaded = parse_text("v 1 0 0\nl -1 2\nv 2 0 0");
    assert_eq!(names(&loaded), [(vec![1.0, 2.0], false)]);
}

#[test]
fn curves_end_at_junctions() {
    let loaded = parse_text(&format!("{FIVE}l 1 2 3\nl 3 4\nl 3 5\nf 1 2 3"));
    let expected = [(vec![1.0, 2.0, 3.0], false), (vec![3.0, 4.0], false), (vec![3.0, 5.0], false)];
    assert_eq!(names(&loaded), expected);
    assert!(
        loaded.notes[0].contains("1 vertices") && loaded.notes[1] == "1 faces ignored",
        "{:?}",
        loaded.notes
    );
}

#[test]
fn other_elements_and_bytes_that_are_no_text_are_passed_over() {
    let mut bytes = b"# caf\xe9\nmtllib \xff\no \x80\nvt 0 x\nusemtl (null)\n".to_vec();
    bytes.extend_from_slice(FIVE.as_bytes());
    bytes.extend_from_slice(b"p 1\nl 1 2\n");
    assert_eq!(names(&parse_obj(Path::new("a.obj"), &bytes).unwrap()), [(vec![1.0, 2.0], false)]);
}

#[test]
fn errors_name_the_line() {
    assert_eq!(error_of(b""), "a.obj: expected at least one `l` element, found none");
    assert_eq!(error_of(b"\nv 1 2\n"), "a.obj: line 2: expected 3 numbers after `v`, found 2");
    assert_eq!(error_of(b"v 1 \xff 2"), "a.obj: line 1: expected a number after `v`, found \"\\xff\"");
    assert!(error_of(b"v 1 2 nan").ends_with("found z = NaN"));
    assert!(error_of(b"v 1 -inf 0").ends_with("found y = -inf"));
    assert!(error_of(b"v 1 1e16 0").ends_with("found y = 1e16"));
    assert_eq!(error_of(b"v 1 2 3\nl 1"), "a.obj: line 2: expected 2 or more indices after `l`, found 1");
    assert!(error_of(b"v 1 2 3\nl 0 1").contains("line 2: expected indices from 1"));
    assert!(error_of(b"v 1 2 3\nl -2 1").contains("line 2: expected an index of at most 1 vertices back"));
    // The line is that of the element at fault, not of the last one.
    let late = error_of(b"v 1 2 3\nl 1 \\\n 2\nl 1 1\n");
    assert_eq!(late, "a.obj: line 2: expected an index of at most 1, found 2");
    assert!(error_of(b"v 1 2 3\nl 1 9223372036854775807").ends_with("found 9223372036854775807"));
    assert!(error_of(b"v 1 2 3\nl 1 -9223372036854775808").ends_with("found -9223372036854775808"));
    assert!(error_of(b"v 1 2 3\nl 1 99999999999999999999").contains("expected a vertex index"));
    assert!(error_of(b"v 1 2 3\nl 1 /2").contains("expected a vertex index"));
}

#[test]
fn absurdly_long_lines_are_clipped_in_errors_and_harmless_elsewhere() {
    let mut bytes = b"v 1 2 ".to_vec();
    bytes.resize(1 << 20, b'x');
    assert!(error_of(&bytes).len() < 120);
    let long = vec![b'#'; 1 << 20];
    assert!(error_of(&long).contains("found none"));
    let continued = b"\\\n".repeat(1 << 18);
    assert!(error_of(&continued).contains("found none"));
}
