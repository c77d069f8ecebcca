//! Keys of a glTF's animation, and what they say between two of them.

use super::accessor::Reader;
use crate::io::error::{FileError, Place};
use glam::{DQuat, DVec3};
use gltf::animation::{Interpolation, Property};

/// Which property of which node a channel moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moved {
    /// Its translation.
    Translation,
    /// Its rotation.
    Rotation,
    /// Its scale.
    Scale,
    /// The weights of its mesh's morph targets.
    Weights,
}

/// One property of one node over time.
#[derive(Debug)]
pub struct Channel {
    /// The node.
    pub node: usize,
    /// The property.
    pub moved: Moved,
    interpolation: Interpolation,
    /// In seconds, ever later.
    times: Vec<f32>,
    /// For each key `width` numbers; three times as many where they are cubic: arriving slope, value, leaving slope.
    values: Vec<f32>,
    width: usize,
}

impl Channel {
    /// Reads channel `index` of animation 0.
    ///
    /// # Errors
    /// What accessors refuse; times that do not grow; numbers of values that do not fit.
    pub fn read(
        reader: Reader<'_>,
        index: usize,
        channel: &gltf::animation::Channel<'_>,
    ) -> Result<Self, FileError> {
        let error = |message: String| {
            FileError::new(
                reader.buffers.file,
                Place::Item("animation", 0),
                format!("channel {index}: {message}"),
            )
        };
        let (target, sampler) = (channel.target(), channel.sampler());
        let (moved, width) = match target.property() {
            Property::Translation => (Moved::Translation, 3),
            Property::Rotation => (Moved::Rotation, 4),
            Property::Scale => (Moved::Scale, 3),
            Property::MorphTargetWeights => (Moved::Weights, 0),
        };
        if sampler.input().view().is_none() || sampler.output().view().is_none() {
            return Err(error("expected keys in a buffer, found none".into()));
        }
        let times: Vec<f32> =
            reader.floats::<1>(&sampler.input(), usize::MAX)?.into_iter().map(|[t]| t).collect();
        let grow = times.windows(2).all(|pair| pair[0] < pair[1]);
        if times.is_empty() || !grow || times[0] < 0.0 {
            return Err(error("expected times from 0 on, ever later, found others".into()));
        }
        let output = sampler.output();
        let values: Vec<f32> = match width {
            4 => reader.floats::<4>(&output, usize::MAX)?.into_iter().flatten().collect(),
            3 => reader.floats::<3>(&output, usize::MAX)?.into_iter().flatten().collect(),
            _ => reader.floats::<1>(&output, usize::MAX)?.into_iter().flatten().collect(),
        };
        let interpolation = sampler.interpolation();
        let parts = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let keys = parts * times.len();
        let found = values.len() / keys;
        if !values.len().is_multiple_of(keys) || found == 0 || width != 0 && width != found {
            let message = format!("expected numbers for {} keys, found {}", times.len(), values.len());
            return Err(error(message));
        }
        Ok(Self { node: target.node().index(), moved, interpolation, times, values, width: found })
    }

    /// The last key's time in seconds.
    pub fn end(&self) -> f64 {
        self.times.last().copied().map_or(0.0, f64::from)
    }

    /// Numbers of a value.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Part `part` of `parts` of the value at key `key`.
    fn key(&self, key: usize, part: usize, parts: usize) -> Vec<f64> {
        let start = (key * parts + part) * self.width;
        self.values[start..start + self.width].iter().map(|x| f64::from(*x)).collect()
    }

    /// The value at a time in seconds: the first key's before it, the last key's behind it.
    pub fn at(&self, seconds: f64) -> Vec<f64> {
        let parts = if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let value = parts / 2;
        let next = self.times.partition_point(|time| f64::from(*time) <= seconds);
        if next == 0 || next == self.times.len() {
            return self.key(next.saturating_sub(1), value, parts);
        }
        let [from, to] = [next - 1, next].map(|key| f64::from(self.times[key]));
        let (span, t) = (to - from, (seconds - from) / (to - from));
        let (a, b) = (self.key(next - 1, value, parts), self.key(next, value, parts));
        match self.interpolation {
            Interpolation::Step => a,
            Interpolation::Linear if self.moved == Moved::Rotation => {
                let turn = rotation(&a).slerp(rotation(&b), t);
                turn.to_array().to_vec()
            }
            Interpolation::Linear => a.iter().zip(&b).map(|(a, b)| a + (b - a) * t).collect(),
            Interpolation::CubicSpline => {
                let (leaving, arriving) = (self.key(next - 1, 2, 3), self.key(next, 0, 3));
                let (t2, t3) = (t * t, t * t * t);
                let of = |i: usize| {
                    (2.0 * t3 - 3.0 * t2 + 1.0) * a[i]
                        + span * (t3 - 2.0 * t2 + t) * leaving[i]
                        + (3.0 * t2 - 2.0 * t3) * b[i]
                        + span * (t3 - t2) * arriving[i]
                };
                (0..self.width).map(of).collect()
            }
        }
    }
}

/// A unit quaternion from four numbers; none at all are no turn.
pub fn rotation(xyzw: &[f64]) -> DQuat {
    let q = DQuat::from_xyzw(xyzw[0], xyzw[1], xyzw[2], xyzw[3]);
    let length = q.length();
    if length > 1e-12 && length.is_finite() { q * length.recip() } else { DQuat::IDENTITY }
}

/// A vector from three numbers.
pub fn vector(xyz: &[f64]) -> DVec3 {
    DVec3::new(xyz[0], xyz[1], xyz[2])
}
