use super::*;
use crate::io::bcc::write_bcc;
use crate::io::curves::{Basis, Curve, CurveSet};

fn set(shift: f64, counts: &[(usize, bool)]) -> CurveSet {
    let at = |i: usize| DVec3::new(i as f64 + shift, (i * i) as f64 * 0.25, -1.0);
    let curve = |&(n, closed): &(usize, bool)| Curve { points: (0..n).map(at).collect(), closed };
    CurveSet { basis: Basis::CatmullRom, up_axis: None, curves: counts.iter().map(curve).collect() }
}

const REST: [(usize, bool); 2] = [(4, false), (6, true)];

fn points(set: &CurveSet) -> Vec<DVec3> {
    set.curves.iter().flat_map(|curve| curve.points.clone()).collect()
}

fn raw(frames: &[CurveSet]) -> Vec<u8> {
    let all = frames.iter().flat_map(points).flat_map(|p| p.as_vec3().to_array());
    all.flat_map(f32::to_le_bytes).collect()
}

#[test]
fn raw_frames_come_in_any_order() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frames.f32");
    let frames: Vec<CurveSet> = (0..5).map(|i| set(f64::from(i), &REST)).collect();
    std::fs::write(&path, raw(&frames)).unwrap();
    let mut source = FrameSource::open(&path, &CurveLayout::of(&frames[0]), 24.0).unwrap();
    assert_eq!((source.count(), source.first_file()), (5, path));
    for frame in [4, 0, 2, 2, 1] {
        assert_eq!(source.read(frame).unwrap(), points(&frames[frame as usize]));
    }
    let error = source.read(5).unwrap_err();
    assert_eq!(
        (error.place, error.message.as_str()),
        (Place::Frame(5), "expected a frame of 0 to 4, found none")
    );
}

#[test]
fn raw_frames_of_other_sizes_are_refused_with_the_frame() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frames.f32");
    let layout = CurveLayout::of(&set(0.0, &REST));
    let bytes = raw(&[set(0.0, &REST), set(1.0, &REST)]);
    for (length, frame) in [(0, 0), (100, 0), (bytes.len() - 1, 1), (bytes.len() - 12, 1)] {
        std::fs::write(&path, &bytes[..length]).unwrap();
        let error = FrameSource::open(&path, &layout, 24.0).unwrap_err();
        assert_eq!(error.place, Place::Frame(frame));
        assert!(
            error.to_string().contains("frames.f32: frame") && error.message.contains("10 points"),
            "{error}"
        );
    }
    let mut spoiled = bytes.clone();
    spoiled[120 + 4..120 + 8].copy_from_slice(&f32::NAN.to_le_bytes());
    std::fs::write(&path, &spoiled).unwrap();
    let mut source = FrameSource::open(&path, &layout, 24.0).unwrap();
    assert!(source.read(0).is_ok());
    let error = source.read(1).unwrap_err();
    assert!(error.to_string().contains("frame 1: point 0: expected a finite"), "{error}");
    std::fs::write(&path, &bytes[..120]).unwrap();
    assert!(source.read(1).unwrap_err().to_string().contains("frame 1: cannot read"), "cut meanwhile");
    assert!(FrameSource::open(folder.path(), &layout, 24.0).is_err());
}

#[test]
fn numbered_files_are_frames_from_the_least_number_on() {
    let folder = tempfile::tempdir().unwrap();
    let pattern = folder.path().join("cloth.%03d.bcc");
    let layout = CurveLayout::of(&set(0.0, &REST));
    let file = |number: u64| NumberedPath::new(&pattern).unwrap().file(number);
    let error = FrameSource::open(&pattern, &layout, 24.0).unwrap_err();
    assert!(error.message.contains("at least one"), "{error}");
    for number in [7, 8, 9] {
        write_bcc(&file(number), &set(number as f64, &REST)).unwrap();
    }
    let mut source = FrameSource::open(&pattern, &layout, 24.0).unwrap();
    assert_eq!((source.count(), source.first_file()), (3, file(7)));
    for frame in [2, 0, 1] {
        assert_eq!(source.read(frame).unwrap(), points(&set(7.0 + frame as f64, &REST)));
    }
    assert_eq!(source.read(3).unwrap_err().place, Place::Frame(3));

    // Another topology, and a broken file.
    for (counts, what) in [
        (&[(4, false), (5, true)][..], "curve 1: expected 6 points, closed"),
        (&[(4, true), (6, true)], "curve 0: expected 4 points, open"),
        (&[(4, false)], "expected 2 curves"),
    ] {
        write_bcc(&file(8), &set(0.0, counts)).unwrap();
        let error = source.read(1).unwrap_err();
        assert_eq!(error.place, Place::Frame(1));
        assert!(
            error.to_string().contains("cloth.008.bcc: frame 1: ") && error.message.contains(what),
            "{error}"
        );
    }
    std::fs::write(file(8), b"BCC\x44C0").unwrap();
    let error = source.read(1).unwrap_err().to_string();
    assert!(error.contains("cloth.008.bcc") && error.contains("frame 1: "), "{error}");

    std::fs::remove_file(file(8)).unwrap();
    let error = FrameSource::open(&pattern, &layout, 24.0).unwrap_err();
    assert_eq!((error.place, error.file), (Place::Frame(1), file(8)));
}

#[test]
fn other_names_are_refused() {
    let layout = CurveLayout::of(&set(0.0, &REST));
    for bad in ["frames.txt", "a%04.bcc", "a%d%d.bcc"] {
        let error = FrameSource::open(Path::new(bad), &layout, 24.0).unwrap_err();
        assert!(error.message.contains("expected") && error.message.contains("found"), "{error}");
    }
    assert!(
        FrameSource::open(Path::new("away.f32"), &layout, 24.0).unwrap_err().message.contains("cannot read")
    );
}
