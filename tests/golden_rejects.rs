//! The golden harness itself: what it must refuse, and the little it may accept.

#![expect(clippy::unwrap_used, reason = "the helpers of a test may fail it")]

mod support;

use std::path::PathBuf;

use support::golden::{Goldens, Tolerance, asks_to_bless};
use worsted::io::picture::{DisplayImage, LinearImage, read_png, write_png};
use worsted::math::rng::Rng;
use worsted::math::tone::Display;

const NAME: &str = "disc";
const SIDE: u32 = 64;

/// A harness in a folder of its own, which is removed with it.
struct Bench {
    folder: tempfile::TempDir,
    goldens: Goldens,
}

impl Bench {
    /// Goldens that lack [`NAME`].
    fn empty() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let goldens = Goldens {
            goldens: folder.path().join("golden"),
            failures: folder.path().join("failures"),
            bless: false,
        };
        Self { folder, goldens }
    }

    /// Goldens in which [`NAME`] is `picture`.
    fn with(picture: &DisplayImage) -> Self {
        let bench = Self::empty();
        std::fs::create_dir_all(&bench.goldens.goldens).unwrap();
        write_png(&bench.golden_file(), picture).unwrap();
        bench
    }

    fn golden_file(&self) -> PathBuf {
        self.goldens.goldens.join(format!("{NAME}.png"))
    }

    fn failure_file(&self, kind: &str) -> PathBuf {
        self.goldens.failures.join(format!("{NAME}.{kind}.png"))
    }

    /// Demands that `picture` be refused while the golden stays as it is; gives the message.
    fn refusal(&self, picture: &DisplayImage, tolerance: Tolerance) -> String {
        let before = std::fs::read(self.golden_file()).unwrap();
        let message = self.goldens.check(NAME, picture, tolerance).unwrap_err();
        assert_eq!(std::fs::read(self.golden_file()).unwrap(), before, "the golden was overwritten");
        message
    }
}

/// A disc of coloured stripes on an empty background.
fn linear_disc() -> LinearImage {
    let pixel = |index: u32| {
        let (x, y) = (f64::from(index % SIDE), f64::from(index / SIDE));
        let stripe = (0.35 + 0.25 * ((x + 0.5 * y) * 0.9).sin()) as f32;
        let inside = (x - 32.0).hypot(y - 32.0) < 22.0;
        if inside { [stripe, 0.6 * stripe, 0.2 * stripe, 1.0] } else { [0.0; 4] }
    };
    LinearImage { width: SIDE, height: SIDE, pixels: (0..SIDE * SIDE).map(pixel).collect() }
}

fn disc() -> DisplayImage {
    DisplayImage::from_linear(&linear_disc(), &Display::PLAIN).unwrap()
}

fn changed(change: impl Fn(usize, [u8; 4]) -> [u8; 4]) -> DisplayImage {
    let mut picture = disc();
    picture.pixels.iter_mut().enumerate().for_each(|(index, pixel)| *pixel = change(index, *pixel));
    picture
}

/// The disc with about one covered byte in `one_in` raised by one code value.
fn rounded_otherwise(one_in: u64) -> DisplayImage {
    let raise = |index: usize, pixel: [u8; 4]| {
        let mut rng = Rng::new(5, &[index as u64]);
        let mut raised = pixel;
        for value in &mut raised[..3] {
            *value += u8::from(pixel[3] > 0 && rng.next_u64().is_multiple_of(one_in));
        }
        raised
    };
    changed(raise)
}

#[test]
fn a_missing_golden_is_written_and_fails_once() {
    let bench = Bench::empty();
    let message = bench.goldens.check(NAME, &disc(), Tolerance::EXACT).unwrap_err();
    assert!(message.contains("was missing") && message.contains("disc.png"), "{message}");
    assert_eq!(read_png(&bench.golden_file()).unwrap(), disc());
    let figures = bench.goldens.check(NAME, &disc(), Tolerance::EXACT).unwrap();
    assert_eq!((figures.mean_flip, figures.bad_fraction, figures.mean_alpha), (0.0, 0.0, 0.0));
}

#[test]
fn an_equal_picture_is_accepted_and_leaves_nothing_behind() {
    let bench = Bench::with(&disc());
    bench.goldens.check(NAME, &disc(), Tolerance::EXACT).unwrap();
    bench.goldens.check_linear(NAME, &linear_disc(), 1.0, Tolerance::EXACT).unwrap();
    assert!(!bench.goldens.failures.exists());
}

#[test]
fn rounding_is_within_its_tolerance_but_not_exact() {
    let bench = Bench::with(&disc());
    let figures = bench.goldens.check(NAME, &rounded_otherwise(10), Tolerance::ROUNDING).unwrap();
    assert!(figures.mean_flip > 0.0, "the noise was not seen");
    bench.refusal(&rounded_otherwise(10), Tolerance::EXACT);
    // The smallest change there is: one byte, on a pixel that nothing covers.
    bench.refusal(&changed(|index, [r, g, b, a]| [r, g, b + u8::from(index == 0), a]), Tolerance::EXACT);
}

#[test]
fn another_size_is_refused_and_does_not_overwrite() {
    let bench = Bench::with(&disc());
    let half = DisplayImage { height: SIDE / 2, pixels: disc().pixels[..2048].to_vec(), ..disc() };
    let turned = DisplayImage { width: SIDE / 2, height: SIDE * 2, ..disc() };
    for picture in [half, turned] {
        let message = bench.refusal(&picture, Tolerance::ROUNDING);
        assert!(message.contains("expected 64 x 64"), "{message}");
        assert_eq!(read_png(&bench.failure_file("actual")).unwrap(), picture);
        assert!(!bench.failure_file("flip").exists());
    }
}

#[test]
fn wrong_pictures_are_refused_even_where_rounding_is_not() {
    let mut shifted = disc();
    shifted.pixels.rotate_right(1);
    let mut shifted_down = disc();
    shifted_down.pixels.rotate_right(SIDE as usize);
    let wrong = [
        ("shifted by a pixel", shifted),
        ("shifted down by a pixel", shifted_down),
        ("swapped channels", changed(|_, [r, g, b, a]| [b, g, r, a])),
        ("recoloured", changed(|_, [r, g, b, a]| [r, g, b.saturating_add(20 * u8::from(a > 0)), a])),
        ("all black", changed(|_, [_, _, _, a]| [0, 0, 0, a])),
        ("black and uncovered but for one pixel", changed(|i, _| [0, 0, 0, u8::from(i == 0)])),
        ("upside down", changed(|i, _| disc().pixels[(SIDE * SIDE) as usize - 1 - i])),
        ("half the coverage", changed(|_, [r, g, b, a]| [r, g, b, a / 2])),
        (
            "a few bright pixels",
            changed(|i, [r, g, b, a]| if i % 701 == 0 { [255, 255, 255, a] } else { [r, g, b, a] }),
        ),
    ];
    for (name, picture) in wrong {
        let bench = Bench::with(&disc());
        let message = bench.refusal(&picture, Tolerance::ROUNDING);
        let kept = [bench.failure_file("actual"), bench.failure_file("flip")];
        assert!(kept.iter().all(|file| message.contains(&file.display().to_string())), "{name}: {message}");
        assert!(message.contains("mean FLIP 0."), "{name}: {message}");
        assert_eq!(read_png(&kept[0]).unwrap(), picture, "{name}");
        let heatmap = read_png(&kept[1]).unwrap();
        assert_eq!((heatmap.width, heatmap.height), (SIDE, SIDE), "{name}");
    }
}

#[test]
fn each_limit_refuses_by_itself() {
    let any = Tolerance { max_mean_flip: 1.0, bad_flip: 1.0, max_bad_fraction: 1e9, max_mean_alpha: 1.0 };
    let dimmer = changed(|_, [r, g, b, a]| [r - r / 20, g - g / 20, b - b / 20, a - a / 20]);
    let bench = Bench::with(&disc());
    bench.goldens.check(NAME, &dimmer, any).unwrap();
    let limits = [
        Tolerance { max_mean_flip: 0.01, ..any },
        Tolerance { bad_flip: 0.01, max_bad_fraction: 0.5, ..any },
        Tolerance { max_mean_alpha: 0.01, ..any },
        Tolerance { max_mean_flip: f64::NAN, ..any },
    ];
    for tolerance in limits {
        bench.refusal(&dimmer, tolerance);
    }
}

#[test]
fn a_picture_that_covers_nothing_is_refused_and_never_becomes_a_golden() {
    let nothing = changed(|_, [r, g, b, _]| [r, g, b, 0]);
    Bench::with(&disc()).refusal(&nothing, Tolerance::ROUNDING);
    let mut bench = Bench::empty();
    for bless in [false, true] {
        bench.goldens.bless = bless;
        let message = bench.goldens.check(NAME, &nothing, Tolerance::ROUNDING).unwrap_err();
        assert!(message.contains("covered by yarn"), "{message}");
        assert!(!bench.golden_file().exists());
    }
}

#[test]
fn a_nan_or_an_infinity_is_refused_and_never_becomes_a_golden() {
    for value in [f32::NAN, f32::INFINITY] {
        for channel in 0..4 {
            let mut picture = linear_disc();
            picture.pixels[130][channel] = value;
            for bench in [Bench::with(&disc()), Bench::empty()] {
                let existed = bench.golden_file().exists();
                let result = bench.goldens.check_linear(NAME, &picture, 1.0, Tolerance::ROUNDING);
                assert!(result.unwrap_err().contains("pixel (2, 2)"));
                assert_eq!(bench.golden_file().exists(), existed);
            }
        }
    }
}

#[test]
fn a_damaged_golden_is_refused_and_stays() {
    let bench = Bench::with(&disc());
    let bytes = std::fs::read(bench.golden_file()).unwrap();
    for damaged in [&bytes[..bytes.len() / 2], b"", b"not a picture"] {
        std::fs::write(bench.golden_file(), damaged).unwrap();
        let message = bench.refusal(&disc(), Tolerance::ROUNDING);
        assert!(message.contains("disc.png: cannot read"), "{message}");
    }
}

#[test]
fn blessing_writes_says_so_and_still_fails() {
    let mut bench = Bench::with(&disc());
    bench.goldens.bless = true;
    let other = changed(|_, [r, g, b, a]| [b, g, r, a]);
    let message = bench.goldens.check(NAME, &other, Tolerance::EXACT).unwrap_err();
    assert!(message.contains("blessed") && message.contains("WORSTED_BLESS=1"), "{message}");
    assert_eq!(read_png(&bench.golden_file()).unwrap(), other);
    bench.goldens.bless = false;
    bench.goldens.check(NAME, &other, Tolerance::EXACT).unwrap();
}

#[test]
fn only_1_asks_to_bless() {
    assert!(asks_to_bless(Some("1")));
    for value in [None, Some(""), Some("0"), Some("true"), Some("11")] {
        assert!(!asks_to_bless(value), "{value:?}");
    }
}

#[test]
fn a_name_cannot_leave_the_folder() {
    let bench = Bench::empty();
    for name in ["", "../disc", "a/b", "disc.png", "C:disc"] {
        assert!(bench.goldens.check(name, &disc(), Tolerance::EXACT).is_err(), "{name}");
    }
    assert_eq!(std::fs::read_dir(bench.folder.path()).unwrap().count(), 0);
}

#[test]
fn the_entry_points_of_tests_fail_on_a_refusal() {
    // A name that is refused before anything is written: these use the repository's own folder.
    let fails = |call: fn()| std::panic::catch_unwind(call).is_err();
    assert!(fails(|| support::golden::golden("not/a/name", &disc(), Tolerance::ROUNDING)));
    assert!(fails(|| support::golden::golden_linear("not/a/name", &linear_disc(), 1.0, Tolerance::ROUNDING)));
}
