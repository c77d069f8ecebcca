//! Which frames of moving fabrics are shown, and how fast.

use serde::{Deserialize, Serialize};

/// How moving fabrics are played. Frames are those of their files, counted from 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AnimationTable {
    /// The frame that a still picture shows, 0 to 1e9: 2.5 lies halfway between two. The model at rest when absent.
    pub frame: Option<f64>,
    /// How points move between two frames.
    pub interpolation: Interpolation,
    /// Pictures of a film in a second, 0.01 to 1000.
    pub frames_per_second: f64,
    /// Frames from one picture to the next, 1e-6 to 1e6: at 0.5 motion is half as fast.
    pub speed: f64,
    /// The first frame follows the last, again and again; without it nothing is shown behind the last.
    pub repeat: bool,
}

impl Default for AnimationTable {
    fn default() -> Self {
        Self {
            frame: None,
            interpolation: Interpolation::default(),
            frames_per_second: 24.0,
            speed: 1.0,
            repeat: false,
        }
    }
}

/// How points move between two frames. Both go through every frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Straight, at even speed.
    #[default]
    Linear,
    /// On a smooth curve (Catmull-Rom through four frames).
    CatmullRom,
}

impl AnimationTable {
    /// The frame that picture number `picture` of a film shows.
    pub fn frame_of_picture(&self, picture: u64) -> f64 {
        picture as f64 * self.speed
    }

    /// Pictures of a film of `frames` frames, each once.
    pub fn picture_count(&self, frames: u64) -> u64 {
        let pictures = match self.repeat {
            true => (frames as f64 / self.speed).ceil(),
            false => (frames.saturating_sub(1) as f64 / self.speed).floor() + 1.0,
        };
        // The rounded product must not lie behind the last frame.
        let fits =
            |count: &u64| self.repeat || self.frame_of_picture(count - 1) <= frames.saturating_sub(1) as f64;
        let count = (pictures as u64).max(1);
        if fits(&count) { count } else { count - 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_shows_every_frame_once_at_any_speed() {
        let count = |speed: f64, repeat: bool, frames: u64| {
            let table = AnimationTable { speed, repeat, ..Default::default() };
            let count = table.picture_count(frames);
            let last = table.frame_of_picture(count - 1);
            assert!(repeat || last <= (frames - 1) as f64, "{speed} {frames}: {last}");
            count
        };
        assert_eq!(count(1.0, false, 60), 60);
        assert_eq!(count(0.5, false, 60), 119);
        assert_eq!(count(2.0, false, 60), 30);
        assert_eq!(count(2.0, true, 60), 30);
        assert_eq!(count(0.1, false, 1), 1);
        assert_eq!(count(1e6, false, 60), 1);
        for speed in [0.1, 0.3, 0.7, 1.0 / 3.0, 1.1] {
            for frames in 1..100 {
                let pictures = count(speed, false, frames);
                let next = pictures as f64 * speed;
                assert!(next > (frames - 1) as f64 - 1e-9, "{speed} {frames}");
            }
        }
    }
}
