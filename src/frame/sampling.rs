//! How many samples a pixel gets, and where.

use crate::vulkan::vk;
use glam::DVec2;
use std::str::FromStr;

/// Samples per pixel of one multisampled frame.
const PER_FRAME: u32 = 4;

/// Samples per pixel: 1, 4, or 4 n^2 as n x n jittered frames of 4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling(u32);

impl Sampling {
    /// One multisampled frame.
    pub const FOUR: Self = Self(PER_FRAME);

    /// `samples` per pixel: 1, 4, 16, 36, 64 ... 4 n^2 up to 4096.
    ///
    /// # Errors
    /// One line with the allowed numbers.
    pub fn new(samples: u32) -> Result<Self, String> {
        let side = (samples / PER_FRAME).isqrt();
        if samples == 1 || (samples <= 4096 && side > 0 && samples == PER_FRAME * side * side) {
            Ok(Self(samples))
        } else {
            Err(format!("samples = {samples}: allowed are 1, 4, 16, 36, 64 and so on (4 n^2), up to 4096"))
        }
    }

    /// Samples per pixel.
    pub fn count(self) -> u32 {
        self.0
    }

    /// Distance between a pixel's samples, in pixels, if they lay on a square grid.
    pub fn spacing_px(self) -> f64 {
        f64::from(self.0).sqrt().recip()
    }

    /// Distance between the places of a pixel at which one thing is shaded, in pixels: once a frame.
    pub fn frame_spacing_px(self) -> f64 {
        f64::from(self.side()).recip()
    }

    /// Frames of a picture.
    pub fn frames(self) -> usize {
        (self.side() * self.side()) as usize
    }

    /// Jittered frames along each axis.
    fn side(self) -> u32 {
        (self.0 / PER_FRAME).isqrt().max(1)
    }

    /// Samples of one frame.
    pub fn multisampling(self) -> vk::SampleCountFlags {
        if self.0 == 1 { vk::SampleCountFlags::TYPE_1 } else { vk::SampleCountFlags::TYPE_4 }
    }

    /// Offset in pixels of every frame. Standard 4x positions lie one to each quarter of the pixel; a
    /// regular grid of offsets half a pixel wide lets each of them sweep its own quarter of the area.
    pub fn jitters(self) -> Vec<DVec2> {
        let side = self.side();
        let at = |i: u32| 0.5 * ((f64::from(i) + 0.5) / f64::from(side) - 0.5);
        (0..side).flat_map(|y| (0..side).map(move |x| DVec2::new(at(x), at(y)))).collect()
    }
}

impl FromStr for Sampling {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let samples = text.parse().map_err(|_| format!("samples = {text}: expected a whole number"))?;
        Self::new(samples)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn allowed_counts_and_their_frames() {
        for (samples, frames) in [(1, 1), (4, 1), (16, 4), (36, 9), (64, 16)] {
            let jitters = Sampling::new(samples).unwrap().jitters();
            assert_eq!(jitters.len(), frames);
            assert_eq!(Sampling::new(samples).unwrap().frames(), frames);
            let mean: DVec2 = jitters.iter().sum::<DVec2>() / frames as f64;
            assert!(mean.length() < 1e-15, "the picture must not shift");
            assert!(jitters.iter().all(|j| j.abs().max_element() < 0.25));
        }
        for samples in [0, 2, 3, 5, 8, 15, 17, u32::MAX] {
            assert!(Sampling::new(samples).is_err(), "{samples}");
        }
        assert!("many".parse::<Sampling>().is_err());
    }
}
