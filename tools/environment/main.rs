//! Writes textures/overcast.exr: an environment by a formula, for scenes and tests. `environment [FILE]`.

use glam::DVec3;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::process::ExitCode;
use worsted::io::error::FileError;
use worsted::io::picture::{LinearImage, write_exr};

/// Where it is kept.
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/textures/overcast.exr");
/// Rows; twice as many columns.
const HEIGHT: u32 = 32;

fn main() -> ExitCode {
    let file = std::env::args().nth(1).unwrap_or_else(|| FILE.to_owned());
    match write(Path::new(&file)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("environment: {error}");
            ExitCode::from(worsted::error::EXIT_BAD_INPUT)
        }
    }
}

fn write(file: &Path) -> Result<(), FileError> {
    write_exr(file, &picture())
}

/// Radiance from a unit direction: an overcast sky (Moon & Spencer 1942: three times as bright above as at the
/// horizon) that fades into a dark ground, and a low, warm, soft window to the right of the middle.
fn radiance(direction: DVec3) -> DVec3 {
    let up = direction.y;
    let sky = DVec3::new(0.36, 0.39, 0.44) * (1.0 + 2.0 * up.max(0.0)) / 3.0;
    let ground = DVec3::new(0.045, 0.04, 0.035);
    let horizon = (0.5 + 3.0 * up).clamp(0.0, 1.0);
    let share = horizon * horizon * (3.0 - 2.0 * horizon);
    let window = DVec3::new(0.8, 0.35, -0.5).normalize();
    let glow = (6.0 * (direction.dot(window) - 1.0)).exp();
    ground + share * (sky - ground) + 1.6 * glow * DVec3::new(1.0, 0.78, 0.52)
}

/// The picture. Rounded to steps of 1/1024: they pack better, and hide the last bits of a processor's sine.
fn picture() -> LinearImage {
    let mut image = LinearImage::filled(2 * HEIGHT, HEIGHT, [1.0; 4]);
    for (index, pixel) in (0_u32..).zip(&mut image.pixels) {
        let (row, column) = (index / image.width, index % image.width);
        let (sin, cos) = (PI * (f64::from(row) + 0.5) / f64::from(HEIGHT)).sin_cos();
        let around = TAU * ((f64::from(column) + 0.5) / f64::from(image.width) - 0.5);
        let direction = DVec3::new(sin * around.sin(), cos, -sin * around.cos());
        let [r, g, b] = radiance(direction).to_array().map(|c| ((c * 1024.0).round() / 1024.0) as f32);
        *pixel = [r, g, b, 1.0];
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;
    use worsted::io::environment::read_environment;

    #[test]
    fn the_kept_picture_is_what_the_formula_gives() {
        assert_eq!(read_environment(Path::new(FILE)), Ok(picture()), "run `cargo run --example environment`");
        let bytes = std::fs::metadata(FILE).map(|file| file.len());
        assert!(bytes.as_ref().is_ok_and(|&bytes| bytes < 30_000), "{bytes:?}");
    }

    #[test]
    fn it_is_bright_above_dark_below_and_warm_on_the_right() {
        let image = picture();
        let at = |column: usize, row: usize| image.pixels[row * 64 + column];
        assert!(at(10, 0)[1] > 4.0 * at(10, 31)[1]);
        // The window: a quarter to the right of the middle, a little above the horizon; warm.
        let [r, _, b, _] = at(42, 12);
        assert!(r > 3.0 * at(10, 12)[0] && r > b, "{r} {b}");
    }
}
