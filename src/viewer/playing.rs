//! What moves by itself: an animation that plays, and a camera that goes around.

use crate::scene::animation::AnimationTable;
use std::time::{Duration, Instant};

/// Seconds of a turntable's turn.
const TURN_SECONDS: f64 = 12.0;

/// The frame that an animation shows, as time passes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Playing {
    /// Since when it plays, and from which frame on.
    since: Option<(Instant, f64)>,
    /// Since when the camera goes around, and from which yaw on.
    turning: Option<(Instant, f64)>,
    /// Factor on the speed of the animation, as in `animation.speed`.
    pub speed: f64,
}

impl Playing {
    /// Nothing moves.
    pub fn new() -> Self {
        Self { speed: 1.0, ..Self::default() }
    }

    /// Whether an animation plays.
    pub fn plays(&self) -> bool {
        self.since.is_some()
    }

    /// Whether the camera goes around.
    pub fn turns(&self) -> bool {
        self.turning.is_some()
    }

    /// Plays from a frame on.
    pub fn play(&mut self, from: f64, now: Instant) {
        self.since = Some((now, from));
    }

    /// Stops playing.
    pub fn pause(&mut self) {
        self.since = None;
    }

    /// Lets the camera go around from a yaw in degrees on, or stand still.
    pub fn turn(&mut self, from_deg: Option<f64>, now: Instant) {
        self.turning = from_deg.map(|from_deg| (now, from_deg));
    }

    /// The yaw of a camera that goes around, in degrees.
    pub fn yaw_deg(&self, now: Instant) -> Option<f64> {
        let (since, from) = self.turning?;
        Some((from + 360.0 * seconds(now, since) / TURN_SECONDS).rem_euclid(360.0))
    }

    /// The frame of one that plays, of `count`: it begins again where it repeats, and ends at the last otherwise.
    pub fn frame(&self, animation: &AnimationTable, count: u64, now: Instant) -> Option<f64> {
        let (since, from) = self.since?;
        let frame = from + seconds(now, since) * animation.frames_per_second * animation.speed * self.speed;
        Some(if animation.repeat { frame.rem_euclid(count.max(1) as f64) } else { frame.min(last(count)) })
    }
}

/// The last frame of `count`.
pub fn last(count: u64) -> f64 {
    count.saturating_sub(1) as f64
}

fn seconds(now: Instant, since: Instant) -> f64 {
    now.checked_duration_since(since).unwrap_or(Duration::ZERO).as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_follow_the_clock_and_end_or_begin_again() {
        let start = Instant::now();
        let mut playing = Playing::new();
        let mut animation = AnimationTable { frames_per_second: 10.0, speed: 0.5, ..Default::default() };
        assert_eq!(playing.frame(&animation, 60, start), None);
        playing.play(3.0, start);
        let after = |seconds| start + Duration::from_secs(seconds);
        assert_eq!(playing.frame(&animation, 60, after(2)), Some(13.0));
        assert_eq!(playing.frame(&animation, 60, after(100)), Some(59.0));
        animation.repeat = true;
        assert_eq!(playing.frame(&animation, 60, after(12)), Some(3.0));
        playing.speed = 2.0;
        assert_eq!(playing.frame(&animation, 60, after(2)), Some(23.0));
        playing.pause();
        assert!(!playing.plays());
    }

    #[test]
    fn a_turntable_comes_around() {
        let start = Instant::now();
        let mut playing = Playing::new();
        playing.turn(Some(350.0), start);
        assert_eq!(playing.yaw_deg(start + Duration::from_secs(1)), Some(20.0));
        playing.turn(None, start);
        assert_eq!(playing.yaw_deg(start), None);
    }
}
