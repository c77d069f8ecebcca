//! Golden pictures: `tests/golden/NAME.png` is what a test must draw, judged by FLIP.
//!
//! A missing golden is written and the test fails, so that somebody looks at it before it is committed. A
//! golden of another size is a failure too and stays as it is. Goldens are replaced only with `WORSTED_BLESS=1`
//! in the environment, and a run that did so fails as well: nobody blesses by accident, least of all in CI.

use std::path::{Path, PathBuf};

use worsted::io::picture::{DisplayImage, LinearImage, read_png, write_png};
use worsted::math::tone::Display;
use worsted::metrics::coverage::Coverage;
use worsted::metrics::flip::FlipMap;

/// How far a picture may be from its golden. All limits are inclusive.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// Largest mean FLIP, in [0, 1], over the pixels covered in either picture.
    pub max_mean_flip: f64,
    /// The FLIP, in [0, 1], above which a pixel counts as bad.
    pub bad_flip: f64,
    /// Largest number of bad pixels anywhere, as a fraction of the covered ones.
    pub max_bad_fraction: f64,
    /// Largest mean difference of coverage, in [0, 1], over the pixels covered in either picture.
    pub max_mean_alpha: f64,
}

impl Tolerance {
    /// The same picture: one code value of one pixel, covered or not, is too much.
    pub const EXACT: Self =
        Self { max_mean_flip: 0.0, bad_flip: 0.0, max_bad_fraction: 0.0, max_mean_alpha: 0.0 };
    /// The same picture from another driver or processor: some bytes off by one, no pixel visibly wrong.
    pub const ROUNDING: Self =
        Self { max_mean_flip: 0.01, bad_flip: 0.1, max_bad_fraction: 0.001, max_mean_alpha: 0.002 };
}

/// What a comparison with a golden found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Mean FLIP over the covered pixels.
    pub mean_flip: f64,
    /// Bad pixels as a fraction of the covered ones.
    pub bad_fraction: f64,
    /// Mean difference of coverage over the covered pixels.
    pub mean_alpha: f64,
    /// Pixels covered in either picture.
    pub covered: usize,
}

/// Where goldens lie and what is done about a wrong one.
#[derive(Clone, Debug)]
pub struct Goldens {
    /// The folder of `NAME.png`.
    pub goldens: PathBuf,
    /// Where `NAME.actual.png` and `NAME.flip.png` of a mismatch go.
    pub failures: PathBuf,
    /// Whether goldens are replaced instead of compared.
    pub bless: bool,
}

impl Goldens {
    /// The repository's own goldens; blessed if `WORSTED_BLESS` is 1.
    pub fn of_repository() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        Self {
            goldens: root.join("tests/golden"),
            failures: root.join("target/golden-failures"),
            bless: asks_to_bless(std::env::var("WORSTED_BLESS").ok().as_deref()),
        }
    }

    /// Compares `picture` with the golden `name` (letters, digits, `-` and `_`). The error is the message that
    /// the test should fail with.
    pub fn check(&self, name: &str, picture: &DisplayImage, tolerance: Tolerance) -> Result<Figures, String> {
        let sound = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if name.is_empty() || !name.chars().all(sound) {
            return Err(format!("golden {name:?}: expected a name of letters, digits, - and _"));
        }
        // No golden may come from a picture that covers nothing or has no sensible size.
        Coverage::of_display(picture, picture).map_err(|e| format!("golden {name}: not a picture: {e}"))?;
        let file = self.goldens.join(format!("{name}.png"));
        if self.bless {
            return Err(written(&file, picture, "blessed, as WORSTED_BLESS=1 asks; run again without it"));
        }
        // Only what is certainly absent is written: a golden that cannot be read is an error below.
        if file.try_exists().map_err(|e| format!("{}: {e}", file.display()))? {
            self.compare(name, &file, picture, tolerance)
        } else {
            Err(written(&file, picture, "was missing and is now written; look at it, then commit it"))
        }
    }

    /// [`Self::check`] of what [`DisplayImage::from_linear`] makes of radiance; refuses a NaN or an infinity,
    /// which no byte could show.
    pub fn check_linear(
        &self,
        name: &str,
        picture: &LinearImage,
        exposure: f64,
        tolerance: Tolerance,
    ) -> Result<Figures, String> {
        let display = Display { exposure, ..Display::PLAIN };
        let shown =
            DisplayImage::from_linear(picture, &display).map_err(|e| format!("golden {name}: {e}"))?;
        self.check(name, &shown, tolerance)
    }

    fn compare(
        &self,
        name: &str,
        file: &Path,
        picture: &DisplayImage,
        tolerance: Tolerance,
    ) -> Result<Figures, String> {
        let golden = read_png(file).map_err(|e| e.to_string())?;
        let (figures, flip) = match measure(picture, &golden, tolerance) {
            Ok(measured) => measured,
            Err(e) => return Err(format!("golden {name}: {e}; {}", self.keep(name, picture, None))),
        };
        // Written so that a NaN in any figure would be a mismatch.
        let within = figures.mean_flip <= tolerance.max_mean_flip
            && figures.bad_fraction <= tolerance.max_bad_fraction
            && figures.mean_alpha <= tolerance.max_mean_alpha;
        if within {
            return Ok(figures);
        }
        Err(format!(
            "golden {name}: mean FLIP {:.5} (at most {:.5}), pixels above FLIP {}: {:.5} of the covered (at \
             most {:.5}), mean coverage difference {:.5} (at most {:.5}), {} pixels covered; {}",
            figures.mean_flip,
            tolerance.max_mean_flip,
            tolerance.bad_flip,
            figures.bad_fraction,
            tolerance.max_bad_fraction,
            figures.mean_alpha,
            tolerance.max_mean_alpha,
            figures.covered,
            self.keep(name, picture, Some(&flip))
        ))
    }

    /// Keeps the picture and its heatmap for whoever looks into the failure; says where, or why not.
    fn keep(&self, name: &str, picture: &DisplayImage, flip: Option<&FlipMap>) -> String {
        let actual = self.failures.join(format!("{name}.actual.png"));
        let heatmap = self.failures.join(format!("{name}.flip.png"));
        // A heatmap of an earlier failure would mislead.
        let _ = std::fs::remove_file(&heatmap);
        let mut message = format!("actual: {}", wrote(&actual, picture));
        if let Some(flip) = flip {
            message += &format!(", heatmap: {}", wrote(&heatmap, &flip.heatmap()));
        }
        message
    }
}

/// Fails the test unless `picture` is the golden `name` of the repository within `tolerance`.
#[track_caller]
pub fn golden(name: &str, picture: &DisplayImage, tolerance: Tolerance) {
    fail_on(Goldens::of_repository().check(name, picture, tolerance));
}

/// [`golden`] of radiance, which must be finite everywhere, shown at `exposure`.
#[track_caller]
pub fn golden_linear(name: &str, picture: &LinearImage, exposure: f64, tolerance: Tolerance) {
    fail_on(Goldens::of_repository().check_linear(name, picture, exposure, tolerance));
}

/// Whether this value of `WORSTED_BLESS` asks for goldens to be replaced: `1` and nothing else.
pub fn asks_to_bless(value: Option<&str>) -> bool {
    value == Some("1")
}

#[track_caller]
#[expect(clippy::panic, reason = "a failing test is what this is for")]
fn fail_on(result: Result<Figures, String>) {
    if let Err(message) = result {
        panic!("{message}");
    }
}

fn measure(
    test: &DisplayImage,
    golden: &DisplayImage,
    tolerance: Tolerance,
) -> Result<(Figures, FlipMap), String> {
    let coverage = Coverage::of_display(test, golden).map_err(|e| e.to_string())?;
    let flip = FlipMap::new(test, golden).map_err(|e| e.to_string())?;
    let (mean_flip, _) = flip.mean_and_max(&coverage).map_err(|e| e.to_string())?;
    let covered = coverage.count();
    let alpha = |i: usize| f64::from(test.pixels[i][3].abs_diff(golden.pixels[i][3])) / 255.0;
    // Bad pixels are counted everywhere: a stray fiber's glow lies on what should be empty.
    let bad = flip.errors().iter().filter(|error| f64::from(**error) > tolerance.bad_flip).count();
    let figures = Figures {
        mean_flip,
        bad_fraction: bad as f64 / covered as f64,
        mean_alpha: coverage.indices().map(alpha).sum::<f64>() / covered as f64,
        covered,
    };
    Ok((figures, flip))
}

/// Writes a golden and gives the message that the test fails with.
fn written(file: &Path, picture: &DisplayImage, why: &str) -> String {
    match write_with_folder(file, picture) {
        Ok(()) => format!("golden {}: {why}", file.display()),
        Err(e) => format!("golden {}: cannot be written: {e}", file.display()),
    }
}

fn wrote(file: &Path, picture: &DisplayImage) -> String {
    match write_with_folder(file, picture) {
        Ok(()) => file.display().to_string(),
        Err(e) => format!("not written ({e})"),
    }
}

fn write_with_folder(file: &Path, picture: &DisplayImage) -> Result<(), String> {
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    write_png(file, picture).map_err(|e| e.to_string())
}
