//! One moment of an animation.

use std::collections::HashMap;

use glam::{DQuat, DVec3};
use gltf::animation::{Channel, Interpolation, Property};

use super::{File, accessor};
use crate::error::Error;

/// What the animation says of the nodes at one moment.
#[derive(Default)]
pub(super) struct Pose {
    pub nodes: HashMap<usize, Moved>,
    /// Morph weights by node.
    pub weights: HashMap<usize, Vec<f32>>,
}

/// The animated parts of a node's transform.
#[derive(Clone, Copy, Default)]
pub(super) struct Moved {
    pub translation: Option<DVec3>,
    pub rotation: Option<DQuat>,
    pub scale: Option<DVec3>,
}

/// The pose at the time that is asked for; empty for the rest pose.
pub(super) fn pose(file: &File) -> Result<Pose, Error> {
    let mut pose = Pose::default();
    let Some(time) = file.options.time else {
        return Ok(pose);
    };
    let Some(animation) = chosen(file)? else {
        return Ok(pose);
    };
    for (i, channel) in animation.channels().enumerate() {
        let place = format!("animations[{}].channels[{i}]", animation.index());
        let node = channel.target().node().index();
        let moved = pose.nodes.entry(node).or_default();
        match channel.target().property() {
            Property::Translation => {
                moved.translation = sample::<3>(file, &place, &channel, time)?.map(vector);
            }
            Property::Scale => {
                moved.scale = sample::<3>(file, &place, &channel, time)?.map(vector);
            }
            Property::Rotation => {
                moved.rotation = rotation(file, &place, &channel, time)?;
            }
            Property::MorphTargetWeights => {
                let weights = morph_weights(file, &place, &channel, time)?;
                pose.weights.insert(node, weights);
            }
        }
    }
    Ok(pose)
}

/// The animation by name or index; `None` if the file has none and none was named.
fn chosen<'a>(file: &'a File) -> Result<Option<gltf::Animation<'a>>, Error> {
    let mut animations = file.document.animations();
    let Some(wanted) = &file.options.animation else {
        return Ok(animations.next());
    };
    let index: Option<usize> = wanted.parse().ok();
    let names: Vec<&str> = file
        .document
        .animations()
        .filter_map(|a| a.name())
        .collect();
    animations
        .find(|a| a.name() == Some(wanted) || Some(a.index()) == index)
        .map(Some)
        .ok_or_else(|| Error::Setting {
            setting: "--animation",
            detail: format!(
                "no animation '{wanted}' in {}; it has {} ({})",
                file.path.display(),
                file.document.animations().len(),
                names.join(", ")
            ),
        })
}

fn vector(v: [f64; 3]) -> DVec3 {
    DVec3::from(v)
}

/// Two keys about a moment and the fraction of the way between them.
#[derive(Clone, Copy)]
struct Span {
    before: usize,
    after: usize,
    fraction: f64,
    seconds: f64,
}

impl Span {
    /// `None` without keys. Before the first key and past the last, the nearest one holds.
    fn at(times: &[[f32; 1]], time: f64) -> Option<Self> {
        let last = times.len().checked_sub(1)?;
        let after = times.partition_point(|t| f64::from(t[0]) <= time);
        let (before, after) = (after.saturating_sub(1), after.min(last));
        let (start, end) = (f64::from(times[before][0]), f64::from(times[after][0]));
        let seconds = end - start;
        let fraction = if seconds > 0.0 {
            ((time - start) / seconds).clamp(0.0, 1.0)
        } else {
            0.0
        };
        Some(Self {
            before,
            after,
            fraction,
            seconds,
        })
    }
}

/// Samples a channel of `N` components componentwise.
fn sample<const N: usize>(
    file: &File,
    place: &str,
    channel: &Channel,
    time: f64,
) -> Result<Option<[f64; N]>, Error> {
    let sampler = channel.sampler();
    let times = accessor::read_f32::<1>(file, &sampler.input())?;
    let values = accessor::read_f32::<N>(file, &sampler.output())?;
    let Some(span) = Span::at(&times, time) else {
        return Ok(None);
    };
    let keys = Keys {
        values: &values,
        stride: 1,
        interpolation: sampler.interpolation(),
    };
    keys.check(file, place, times.len())?;
    Ok(Some(std::array::from_fn(|c| {
        keys.component(span, 0, |v| f64::from(v[c]))
    })))
}

/// The values of a channel, `stride` elements a key.
struct Keys<'a, T> {
    values: &'a [T],
    stride: usize,
    interpolation: Interpolation,
}

impl<T> Keys<'_, T> {
    fn check(&self, file: &File, place: &str, keys: usize) -> Result<(), Error> {
        let parts = match self.interpolation {
            Interpolation::CubicSpline => 3,
            Interpolation::Linear | Interpolation::Step => 1,
        };
        let needed = keys * self.stride * parts;
        if self.values.len() >= needed {
            return Ok(());
        }
        Err(file.error(
            place,
            format!(
                "has {} values for {keys} keys, and needs {needed}",
                self.values.len()
            ),
        ))
    }

    /// One component at a moment; glTF 2.0, Appendix C.
    fn component(&self, span: Span, offset: usize, get: impl Fn(&T) -> f64) -> f64 {
        let n = self.stride;
        let plain = |key: usize| get(&self.values[key * n + offset]);
        let t = span.fraction;
        match self.interpolation {
            Interpolation::Step if t < 1.0 => plain(span.before),
            Interpolation::Step => plain(span.after),
            Interpolation::Linear => plain(span.before) * (1.0 - t) + plain(span.after) * t,
            Interpolation::CubicSpline => {
                let part =
                    |key: usize, part: usize| get(&self.values[(key * 3 + part) * n + offset]);
                let (t2, t3) = (t * t, t * t * t);
                (2.0 * t3 - 3.0 * t2 + 1.0) * part(span.before, 1)
                    + span.seconds * (t3 - 2.0 * t2 + t) * part(span.before, 2)
                    + (-2.0 * t3 + 3.0 * t2) * part(span.after, 1)
                    + span.seconds * (t3 - t2) * part(span.after, 0)
            }
        }
    }
}

fn rotation(
    file: &File,
    place: &str,
    channel: &Channel,
    time: f64,
) -> Result<Option<DQuat>, Error> {
    let sampler = channel.sampler();
    if sampler.interpolation() != Interpolation::Linear {
        let sampled = sample::<4>(file, place, channel, time)?;
        return Ok(sampled.map(|q| DQuat::from_array(q).normalize()));
    }
    let times = accessor::read_f32::<1>(file, &sampler.input())?;
    let values = accessor::read_f32::<4>(file, &sampler.output())?;
    let Some(span) = Span::at(&times, time) else {
        return Ok(None);
    };
    let keys = Keys {
        values: &values,
        stride: 1,
        interpolation: Interpolation::Linear,
    };
    keys.check(file, place, times.len())?;
    let quaternion = |key: usize| DQuat::from_array(values[key].map(f64::from)).normalize();
    Ok(Some(slerp(
        quaternion(span.before),
        quaternion(span.after),
        span.fraction,
    )))
}

/// Spherical interpolation the short way round, the same to the bit on every machine.
///
/// Shoemake 1985, "Animating Rotation with Quaternion Curves"; glTF 2.0, Appendix C.4.
fn slerp(a: DQuat, b: DQuat, t: f64) -> DQuat {
    let dot = a.dot(b);
    let b = if dot < 0.0 { -b } else { b };
    let angle = libm::acos(dot.abs().min(1.0));
    let sine = libm::sin(angle);
    if sine < 1e-9 {
        return (a * (1.0 - t) + b * t).normalize();
    }
    (a * (libm::sin((1.0 - t) * angle) / sine) + b * (libm::sin(t * angle) / sine)).normalize()
}

fn morph_weights(
    file: &File,
    place: &str,
    channel: &Channel,
    time: f64,
) -> Result<Vec<f32>, Error> {
    let sampler = channel.sampler();
    let times = accessor::read_f32::<1>(file, &sampler.input())?;
    let values = accessor::read_f32::<1>(file, &sampler.output())?;
    let Some(span) = Span::at(&times, time) else {
        return Ok(Vec::new());
    };
    let parts = match sampler.interpolation() {
        Interpolation::CubicSpline => 3,
        Interpolation::Linear | Interpolation::Step => 1,
    };
    let keys = Keys {
        values: &values,
        stride: values.len() / (times.len() * parts),
        interpolation: sampler.interpolation(),
    };
    keys.check(file, place, times.len())?;
    Ok((0..keys.stride)
        .map(|target| keys.component(span, target, |v| f64::from(v[0])) as f32)
        .collect())
}
