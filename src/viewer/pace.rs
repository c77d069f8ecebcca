//! How large pictures are while something moves, so that they come often enough.

use std::time::Duration;

/// Time that a picture may take while something moves: twelve a second.
pub const TARGET_MS: f64 = 80.0;
/// Steps from nothing to the whole of a picture's sides, so that few sizes are ever used, and the least of them. Below it, and
/// below so many pixels on the longer side, nobody sees what is dragged.
const STEPS: u32 = 12;
const LEAST_STEP: f64 = 2.0;
const LEAST_SIDE_PX: f64 = 120.0;
/// Share by which one picture's time moves what is believed of the next one's.
const BELIEF: f64 = 0.5;

/// Learns how long pictures take.
#[derive(Clone, Debug)]
pub struct Pace {
    /// Milliseconds of a whole picture, if the time went with its pixels.
    whole_ms: f64,
}

impl Default for Pace {
    /// Of a slow device: what is shown first may be coarse, but not late.
    fn default() -> Self {
        Self { whole_ms: 16.0 * TARGET_MS }
    }
}

impl Pace {
    /// Whether whole pictures come often enough.
    pub fn whole_is_fast(&self) -> bool {
        self.whole_ms <= TARGET_MS
    }

    /// The size at which the next picture is likely to come in time while something moves.
    pub fn size(&self, whole: [u32; 2]) -> [u32; 2] {
        self.size_within(whole, TARGET_MS)
    }

    /// Whether a whole picture is likely to take so much longer than that one half as large on each side is worth drawing.
    pub fn is_slow(&self, whole: [u32; 2], than_ms: f64) -> bool {
        let [width, height] = self.size_within(whole, than_ms);
        2 * width <= whole[0] && 2 * height <= whole[1]
    }

    /// The size at which it is likely to come within so many milliseconds.
    pub fn size_within(&self, whole: [u32; 2], within_ms: f64) -> [u32; 2] {
        let share = (within_ms / self.whole_ms).sqrt().min(1.0);
        let longer = f64::from(whole[0].max(whole[1]).max(1));
        let least = (f64::from(STEPS) * LEAST_SIDE_PX / longer).ceil().clamp(LEAST_STEP, f64::from(STEPS));
        let step = (share * f64::from(STEPS)).floor().max(least);
        whole.map(|side| ((f64::from(side) * step / f64::from(STEPS)).round() as u32).max(1))
    }

    /// Takes note of what a picture of `size` took, of one that is `whole`.
    pub fn learn(&mut self, size: [u32; 2], whole: [u32; 2], taken: Duration) {
        let pixels = |size: [u32; 2]| f64::from(size[0]) * f64::from(size[1]);
        let found_ms = 1e3 * taken.as_secs_f64() * pixels(whole) / pixels(size).max(1.0);
        // In the logarithm: a picture may take a hundred times as long as another.
        let believed = self.whole_ms.ln() + BELIEF * (found_ms.max(1e-3).ln() - self.whole_ms.ln());
        self.whole_ms = believed.exp();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_settle_where_pictures_come_in_time() {
        let whole = [960, 720];
        // Half of the time does not go with the pixels.
        for microseconds_a_pixel in [0.01, 0.5, 3.0] {
            let time = |size: [u32; 2]| {
                let pixels = f64::from(size[0]) * f64::from(size[1]);
                Duration::from_secs_f64(1e-6 * microseconds_a_pixel * (pixels + 5000.0))
            };
            let mut pace = Pace::default();
            for _ in 0..30 {
                let size = pace.size(whole);
                pace.learn(size, whole, time(size));
            }
            let size = pace.size(whole);
            let last = 1e3 * time(size).as_secs_f64();
            let least = size == [160, 120];
            assert!(last < 1.3 * TARGET_MS || least, "{microseconds_a_pixel}: {size:?} {last}");
            let larger = size.map(|side| side + whole[0] / 4);
            assert!(
                size == whole || 1e3 * time(larger).as_secs_f64() > 0.8 * TARGET_MS,
                "{size:?} is too small"
            );
            assert_eq!(pace.whole_is_fast(), size == whole);
        }
    }

    #[test]
    fn the_slowest_device_still_gets_a_picture() {
        let mut pace = Pace::default();
        pace.learn([80, 60], [960, 720], Duration::from_secs(100));
        assert_eq!(pace.size([960, 720]), [160, 120]);
        assert_eq!(pace.size([360, 240]), [120, 80], "large enough to be seen");
        assert_eq!(pace.size([90, 1]), [90, 1], "not larger than the whole");
    }
}
