//! Files made to break a reader. Whatever the bytes: no panic, no allocation that the file's size does
//! not justify, and an error that is one line naming the file and a place.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;

use glam::DVec3;
use worsted::io::bcc::{parse_bcc, read_bcc, write_bcc};
use worsted::io::curves::{Basis, Curve, CurveSet, UpAxis};
use worsted::io::error::{FileError, Place};
use worsted::io::obj::parse_obj;
use worsted::io::yarn_file::{Loaded, load_yarn_file, parse_yarn_file};
use worsted::math::rng::Rng;

/// Counts what each thread asks for, so that tests running side by side do not disturb each other.
struct Counting;

thread_local! {
    static ALLOCATED: Cell<usize> = const { Cell::new(0) };
}

fn count(bytes: usize) {
    // Fails only while the thread shuts down, when nobody is measuring.
    let _ = ALLOCATED.try_with(|total| total.set(total.get().saturating_add(bytes)));
}

// SAFETY: every call goes on to the system allocator unchanged; counting allocates nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: the caller's promises about `layout` are passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, ptr: *mut u8, layout: Layout) {
        // SAFETY: `ptr` came from `System` above with this layout.
        unsafe { System.dealloc(ptr, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: the caller's promises about `layout` are passed on.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, ptr: *mut u8, layout: Layout, new_size: usize) -> *mut u8 {
        count(new_size);
        // SAFETY: `ptr` came from `System` with this layout, and the caller vouches for `new_size`.
        unsafe { System.realloc(ptr, layout, new_size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The result of `work` and the bytes that this thread asked for meanwhile, freed or not.
fn allocated<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = ALLOCATED.get();
    let result = work();
    (result, ALLOCATED.get() - before)
}

const BCC: &str = "hostile.bcc";
const OBJ: &str = "hostile.obj";

fn bcc(bytes: &[u8]) -> Result<Loaded, FileError> {
    parse_yarn_file(Path::new(BCC), bytes)
}

fn obj(bytes: &[u8]) -> Result<Loaded, FileError> {
    parse_yarn_file(Path::new(OBJ), bytes)
}

/// Why an error is not fit to be shown, if it is not.
fn error_fault(error: &FileError, file: &str) -> Option<String> {
    let spoken = error.message.contains("expected") && error.message.contains("found");
    let line = error.to_string();
    if spoken { line_fault(&line, error.place, file) } else { Some(line) }
}

/// Why `line`, said of `place` of `file`, is not fit to be shown, if it is not.
fn line_fault(line: &str, place: Place, file: &str) -> Option<String> {
    let rest = line.strip_prefix(file).and_then(|rest| rest.strip_prefix(": "));
    let placed = match place {
        // The whole file is a place only where no byte or line is to blame.
        Place::File => line.contains("expected at least one"),
        Place::Byte(at) => rest.is_some_and(|r| r.starts_with(&format!("byte {at}: "))),
        Place::Line(at) => rest.is_some_and(|r| r.starts_with(&format!("line {at}: "))),
        Place::Curve(at) => rest.is_some_and(|r| r.starts_with(&format!("curve {at}: "))),
        Place::Frame(at) => rest.is_some_and(|r| r.starts_with(&format!("frame {at}: "))),
        Place::Item(kind, at) => rest.is_some_and(|r| r.starts_with(&format!("{kind} {at}: "))),
    };
    let plain = line.len() < 200 && !line.contains(|c: char| c.is_control());
    (rest.is_none() || !placed || !plain).then(|| line.to_owned())
}

fn assert_clear(error: &FileError, file: &str) {
    assert_eq!(error_fault(error, file), None);
}

fn refused(bytes: &[u8]) -> FileError {
    let error = bcc(bytes).expect_err("the bytes are bad");
    assert_clear(&error, BCC);
    error
}

/// Two curves, an open one of 4 points and a closed one of 6, valid in every basis.
fn small_set(basis: Basis) -> CurveSet {
    let at = |i: usize| DVec3::new(i as f64, (i * i) as f64 * 0.25, -1.0);
    let curve = |n, closed| Curve { points: (0..n).map(at).collect(), closed };
    CurveSet { basis, up_axis: Some(UpAxis::Z), curves: vec![curve(4, false), curve(6, true)] }
}

fn small_bcc(basis: Basis) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("the temporary folder is ours to use");
    let path = folder.path().join("small.bcc");
    write_bcc(&path, &small_set(basis)).expect("the temporary folder is ours to use");
    std::fs::read(path).expect("the temporary folder is ours to use")
}

/// The small file with the bytes at `at` replaced.
fn with(at: usize, bytes: &[u8]) -> Vec<u8> {
    let mut file = small_bcc(Basis::CatmullRom);
    file[at..at + bytes.len()].copy_from_slice(bytes);
    file
}

const SMALL_OBJ: &str = "# two strands\nv 0 0 0\nv 1 0.5 0\nv 2 0 -1e0\nv 3 1 1\nl 1 2\nl 2 3\nl -1 -4\n";

#[test]
fn the_checker_of_error_lines_rejects_bad_ones() {
    let error = |place, message: &str| FileError::new(Path::new(BCC), place, message);
    let good = "expected 3, found 4";
    assert_eq!(error_fault(&error(Place::Byte(7), good), BCC), None);
    for bad in [
        error(Place::Byte(7), "went wrong"),
        error(Place::File, good),
        error(Place::Byte(7), &format!("{good}{}", "!".repeat(300))),
        FileError::new(Path::new("other"), Place::Byte(7), good),
    ] {
        assert!(error_fault(&bad, BCC).is_some(), "{bad}");
    }
    // An error shows control characters as others; a line that did not is caught all the same.
    assert_eq!(error_fault(&error(Place::Byte(7), "expected 3,\nfound 4"), BCC), None);
    assert_eq!(line_fault("hostile.bcc: byte 7: expected 3, found 4", Place::Byte(7), BCC), None);
    assert!(line_fault("hostile.bcc: byte 7: expected 3,\nfound 4", Place::Byte(7), BCC).is_some());
}

#[test]
fn the_counter_of_allocations_counts() {
    let (block, bytes) = allocated(|| vec![1u8; 1 << 21]);
    assert!(bytes >= block.len() && bytes < block.len() + 4096, "{bytes}");
}

#[test]
fn good_files_load() {
    for basis in [Basis::CatmullRom, Basis::BSpline, Basis::Bezier, Basis::Polyline] {
        let loaded = bcc(&small_bcc(basis)).unwrap();
        assert_eq!(loaded.curves, small_set(basis));
        assert!(loaded.repairs.is_empty() && loaded.notes.is_empty() && loaded.kept_points.is_none());
    }
    assert_eq!(obj(SMALL_OBJ.as_bytes()).unwrap().curves.point_count(), 4);
}

#[test]
fn bcc_cut_anywhere_is_refused() {
    for basis in [Basis::CatmullRom, Basis::Bezier] {
        let whole = small_bcc(basis);
        for length in 0..whole.len() {
            refused(&whole[..length]);
        }
    }
}

/// A cut OBJ is often a shorter valid one; whatever it is, it is judged in one line.
#[test]
fn obj_cut_anywhere_is_judged() {
    let mut refusals = 0;
    for length in 0..SMALL_OBJ.len() {
        if let Err(error) = obj(&SMALL_OBJ.as_bytes()[..length]) {
            assert_clear(&error, OBJ);
            refusals += 1;
        }
    }
    // All cuts before the first complete `l`, where there is nothing to draw.
    assert!(refusals >= SMALL_OBJ.find("l 1 2").unwrap(), "{refusals}");
}

#[test]
fn counts_that_lie_are_refused() {
    let place = |bytes: &[u8]| refused(bytes).place;
    let curves = |n: u64| with(8, &n.to_le_bytes());
    let points = |n: u64| with(16, &n.to_le_bytes());
    for n in [0, 3, 1 << 31, 1 << 63, u64::MAX] {
        assert_eq!(place(&curves(n)), Place::Byte(8), "{n} curves");
    }
    // One curve of the two: fewer points than promised, the rest would be bytes after the data.
    assert_eq!(place(&curves(1)), Place::Byte(16));
    assert_eq!(place(&points(9)), Place::Byte(16));
    for n in [11, 1 << 31, 1 << 63, u64::MAX] {
        assert_eq!(place(&points(n)), Place::Byte(8), "{n} points");
    }
    for n in [i32::MIN, i32::MIN + 1, i32::MAX, -11, 11] {
        let error = refused(&with(64, &n.to_le_bytes()));
        assert_eq!(error.place, Place::Byte(64));
        assert!(error.message.ends_with(&format!("a count of {n}")), "{error}");
    }
    // Counts that fit, but shift what follows or disagree with the sum.
    for n in [0i32, 1, 3, 5, -5] {
        refused(&with(64, &n.to_le_bytes()));
    }
}

#[test]
fn header_fields_out_of_range_are_refused_with_what_was_found() {
    for (at, byte, found) in [
        (0, b'X', "found \"XCC\""),
        (3, 0x48, "found 4-byte integers, 8-byte floats"),
        (3, 0x84, "found 8-byte integers, 4-byte floats"),
        (4, b'C' + 1, "found \"D0\""),
        (5, 0xff, "found \"C\\xff\""),
        (6, 2, "found 2"),
    ] {
        let error = refused(&with(at, &[byte]));
        assert!(error.message.ends_with(found), "{error}");
    }
}

#[test]
fn coordinates_that_are_no_place_are_refused() {
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -2e15] {
        let error = refused(&with(64 + 4 + 12 + 4, &x.to_le_bytes()));
        assert_eq!(error.place, Place::Byte(64 + 4 + 12));
        assert!(error.message.starts_with("curve 0, point 1: "), "{error}");
    }
    for x in ["nan", "inf", "-inf", "1e400", "1e16"] {
        let error = obj(SMALL_OBJ.replace("0.5", x).as_bytes()).unwrap_err();
        assert_clear(&error, OBJ);
        assert_eq!(error.place, Place::Line(3));
    }
}

/// A BCC file of the given signed counts, each point somewhere else.
fn bcc_of(kind: &[u8; 2], counts: &[i32]) -> Vec<u8> {
    let points: u64 = counts.iter().map(|n| u64::from(n.unsigned_abs())).sum();
    let mut file = [b"BCC\x44", &kind[..], b"\x03\x01"].concat();
    file.extend_from_slice(&(counts.len() as u64).to_le_bytes());
    file.extend_from_slice(&points.to_le_bytes());
    file.extend_from_slice(&[0xee; 40]);
    for &n in counts {
        file.extend_from_slice(&n.to_le_bytes());
        let coordinates = (0..3 * n.unsigned_abs()).map(|i| (i * i) as f32);
        file.extend(coordinates.flat_map(f32::to_le_bytes));
    }
    file
}

#[test]
fn curves_too_short_are_dropped_or_refused() {
    for kind in [b"C0", b"BS", b"BZ", b"PL"] {
        for counts in [&[0][..], &[1], &[-1], &[0, 1, -1]] {
            assert!(refused(&bcc_of(kind, counts)).message.contains("all too short"));
        }
        let loaded = bcc(&bcc_of(kind, &[1, 4, 0])).unwrap();
        assert_eq!((loaded.curves.curves.len(), loaded.repairs.len()), (1, 2));
        assert_eq!(loaded.kept_points.unwrap(), [1, 2, 3, 4]);
    }
    for n in [2, 3, 5, 6, -2, -4, -7] {
        assert!(refused(&bcc_of(b"BZ", &[n])).message.contains("Bezier"), "{n}");
    }
    refused(&bcc_of(b"C0", &[]));
}

#[test]
fn bytes_after_the_data_and_unknown_axes_are_notes() {
    let mut file = with(7, &[9]);
    file.extend_from_slice(b"more");
    let loaded = bcc(&file).unwrap();
    assert_eq!(loaded.curves.up_axis, None);
    assert_eq!(loaded.notes.len(), 2, "{:?}", loaded.notes);
    assert!(loaded.notes.iter().any(|n| n.starts_with("4 bytes after the data")), "{:?}", loaded.notes);
}

#[test]
fn flipped_bytes_never_panic() {
    let files = [small_bcc(Basis::CatmullRom), small_bcc(Basis::Bezier), SMALL_OBJ.as_bytes().to_vec()];
    let mut refusals = 0;
    for round in 0..30_000u64 {
        let mut rng = Rng::new(0x5eed, &[round]);
        let mut file = files[(round % 3) as usize].clone();
        for _ in 0..=rng.next_u64() % 4 {
            let at = (rng.next_u64() % file.len() as u64) as usize;
            file[at] = rng.next_u64() as u8;
        }
        for (name, result) in
            [(BCC, parse_bcc(Path::new(BCC), &file)), (OBJ, parse_obj(Path::new(OBJ), &file))]
        {
            if let Err(error) = result {
                assert_clear(&error, name);
                refusals += 1;
            }
        }
        let name = if round % 3 == 2 { OBJ } else { BCC };
        if let Ok(loaded) = parse_yarn_file(Path::new(name), &file) {
            let points = loaded.curves.curves.iter().flat_map(|c| &c.points);
            assert!(points.into_iter().all(|p| p.is_finite()));
            assert!(loaded.curves.curves.iter().all(|c| c.points.len() >= 2));
        }
    }
    assert!(refusals > 30_000, "every file is wrong as at least one format: {refusals}");
}

/// 1 MiB and eight times the file bounds what any claim in it may cost.
#[test]
fn claims_do_not_allocate() {
    let lies = [
        with(16, &(1u64 << 63).to_le_bytes()),
        with(16, &u64::MAX.to_le_bytes()),
        with(8, &(1u64 << 31).to_le_bytes()),
        with(8, &(1u64 << 63).to_le_bytes()),
        with(64, &i32::MIN.to_le_bytes()),
        with(64, &i32::MAX.to_le_bytes()),
        bcc_of(b"C0", &[0; 1000]),
        b"v 0 0 0\nl 1 9223372036854775807\n".to_vec(),
        b"v 0 0 0\nl 1 4294967295\n".to_vec(),
    ];
    for file in lies {
        for parse in [parse_bcc, parse_obj, parse_yarn_file] {
            let (_, bytes) = allocated(|| parse(Path::new(BCC), &file));
            assert!(bytes < (1 << 20) + 8 * file.len(), "{bytes} bytes for a file of {}", file.len());
        }
    }
}

/// From disk as from memory, and with nothing else left in the folder.
#[test]
fn files_on_disk_round_trip_exactly_to_f32() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("round.bcc");
    let mut rng = Rng::new(11, &[]);
    let mut set = small_set(Basis::CatmullRom);
    for p in set.curves.iter_mut().flat_map(|c| &mut c.points) {
        *p = DVec3::new(rng.uniform(), -1e10 * rng.uniform(), 1e-30 * rng.uniform());
    }
    write_bcc(&path, &set).unwrap();
    write_bcc(&path, &set).unwrap();
    for p in set.curves.iter_mut().flat_map(|c| &mut c.points) {
        *p = p.as_vec3().as_dvec3();
    }
    assert_eq!(read_bcc(&path).unwrap().curves, set);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    let error = write_bcc(&folder.path().join("no/such.bcc"), &set).unwrap_err();
    assert!(error.message.starts_with("cannot write"), "{error}");
    assert!(load_yarn_file(Path::new("/dev/null")).is_err());
}
