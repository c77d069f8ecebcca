//! LDR-FLIP (Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"), as implemented by
//! its authors and wrapped by `nv-flip`.
//!
//! FLIP judges what a display shows, so it takes [`DisplayImage`] pairs: the wrapper accepts nothing finer than
//! sRGB bytes, and the renderer's own pictures end as such bytes. Rounding both sides to bytes is itself seen:
//! measured against the same FLIP on floats, over noisy mid-tone stripes, it turns a mean of .0019 into .0054,
//! .0043 into .0089, .0103 into .0139, .0171 into .0195, .0338 into .0349 and .0555 into .0561. Means below
//! about .01 therefore say little more than "equal up to rounding".

use nv_flip::{FlipImageFloat, FlipImageRgb8};

use crate::io::picture::DisplayImage;
use crate::metrics::coverage::Coverage;
use crate::metrics::{MetricError, check_display};

/// Pixels per degree of visual angle: the FLIP paper's default, a 4K display of 0.7 m seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f32 = 67.0;

/// FLIP of every pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct FlipMap {
    width: u32,
    height: u32,
    errors: Vec<f32>,
}

impl FlipMap {
    /// FLIP of `test` against `reference` at [`PIXELS_PER_DEGREE`]; alpha is not looked at.
    ///
    /// Memory: about 100 bytes per pixel while it runs.
    pub fn new(test: &DisplayImage, reference: &DisplayImage) -> Result<Self, MetricError> {
        check_display(test, reference)?;
        let errors = nv_flip::flip(rgb(reference), rgb(test), PIXELS_PER_DEGREE).to_vec();
        Ok(Self { width: test.width, height: test.height, errors })
    }

    /// Pixels per row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// `width * height` errors in [0, 1], row 0 on top.
    pub fn errors(&self) -> &[f32] {
        &self.errors
    }

    /// Mean and largest error over the covered pixels; an error where the coverage is of another size.
    pub fn mean_and_max(&self, coverage: &Coverage) -> Result<(f64, f64), MetricError> {
        coverage.check_total(self.errors.len())?;
        let (mut sum, mut max) = (0.0, 0.0_f64);
        for error in coverage.indices().map(|index| f64::from(self.errors[index])) {
            sum += error;
            max = max.max(error);
        }
        Ok((sum / coverage.count() as f64, max))
    }

    /// The error in the magma colours of the FLIP paper, from black (0) to pale yellow (1), opaque.
    pub fn heatmap(&self) -> DisplayImage {
        let colored = FlipImageFloat::with_data(self.width, self.height, &self.errors)
            .apply_color_lut(&nv_flip::magma_lut())
            .to_vec();
        let pixels = colored.as_chunks().0.iter().map(|&[r, g, b]| [r, g, b, 255]).collect();
        DisplayImage { width: self.width, height: self.height, pixels }
    }
}

fn rgb(image: &DisplayImage) -> FlipImageRgb8 {
    let bytes: Vec<u8> = image.pixels.iter().flat_map(|p| [p[0], p[1], p[2]]).collect();
    FlipImageRgb8::with_data(image.width, image.height, &bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn everywhere(test: &DisplayImage, reference: &DisplayImage) -> (f64, f64) {
        let coverage = Coverage::everywhere(test.pixels.len()).unwrap();
        FlipMap::new(test, reference).unwrap().mean_and_max(&coverage).unwrap()
    }

    fn stripes(width: u32, height: u32, shift: u32) -> DisplayImage {
        let dark = |i: u32| ((i % width + shift) / 4).is_multiple_of(2);
        let at = |i: u32| if dark(i) { [60, 90, 30, 255] } else { [200, 120, 60, 255] };
        DisplayImage { width, height, pixels: (0..width * height).map(at).collect() }
    }

    #[test]
    fn equal_pictures_have_no_error_and_black_against_white_all_of_it() {
        let (white, black) =
            (DisplayImage::filled(40, 30, [255; 4]), DisplayImage::filled(40, 30, [0, 0, 0, 255]));
        assert_eq!(everywhere(&stripes(40, 30, 0), &stripes(40, 30, 0)), (0.0, 0.0));
        let (mean, max) = everywhere(&black, &white);
        assert!(mean > 0.95 && max <= 1.0, "mean {mean}, max {max}");
    }

    #[test]
    fn a_shift_by_one_pixel_shows_and_by_two_shows_more() {
        let still = stripes(64, 32, 0);
        let (one, _) = everywhere(&stripes(64, 32, 1), &still);
        let (two, _) = everywhere(&stripes(64, 32, 2), &still);
        assert!(one > 0.02 && two > 1.2 * one, "one {one}, two {two}");
    }

    #[test]
    fn the_error_lies_where_the_pictures_differ() {
        let reference = DisplayImage::filled(80, 60, [90, 90, 90, 255]);
        let mut test = reference.clone();
        test.pixels[10 * 80 + 70] = [255, 0, 0, 255];
        let map = FlipMap::new(&test, &reference).unwrap();
        let worst = map.errors().iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
        assert_eq!((worst % map.width() as usize, worst / map.width() as usize), (70, 10));
        assert_eq!(map.errors()[50 * 80 + 10], 0.0, "an error far from the difference");
        assert_eq!(map.height(), 60);
    }

    #[test]
    fn the_heatmap_is_dark_without_error_and_bright_with_it() {
        let (white, black) = (DisplayImage::filled(9, 8, [255; 4]), DisplayImage::filled(9, 8, [0; 4]));
        let brightness = |test, reference| {
            let pixel = FlipMap::new(test, reference).unwrap().heatmap().pixels[40];
            assert_eq!(pixel[3], 255);
            pixel[..3].iter().map(|&v| u32::from(v)).sum::<u32>()
        };
        assert!(brightness(&white, &white) < 10);
        assert!(brightness(&black, &white) > 600);
    }

    #[test]
    fn one_code_value_everywhere_costs_about_a_hundredth() {
        let reference = stripes(64, 64, 0);
        let mut test = reference.clone();
        for (index, pixel) in test.pixels.iter_mut().enumerate() {
            pixel[index % 3] += (index * index % 7 % 2) as u8;
        }
        let (mean, _) = everywhere(&test, &reference);
        assert!(mean > 0.003 && mean < 0.015, "{mean}");
    }

    #[test]
    fn refuses_other_sizes_senseless_shapes_and_a_foreign_coverage() {
        let a = DisplayImage::filled(8, 8, [1; 4]);
        assert!(FlipMap::new(&a, &DisplayImage::filled(4, 16, [1; 4])).is_err());
        assert!(FlipMap::new(&a, &DisplayImage { pixels: vec![[0; 4]; 3], ..a.clone() }).is_err());
        let empty = DisplayImage::filled(0, 0, [0; 4]);
        assert!(FlipMap::new(&empty, &empty).is_err());
        let foreign = Coverage::everywhere(63).unwrap();
        assert!(FlipMap::new(&a, &a).unwrap().mean_and_max(&foreign).is_err());
    }
}
