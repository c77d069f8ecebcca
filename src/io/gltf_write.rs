//! Curves as a glTF in one file, with morph targets or a skin that move them. Of what [`super::gltf`] reads.

use super::curves::{Basis, CurveSet, UpAxis};
use super::error::{FileError, Place};
use super::gltf::GLTF_MM_PER_UNIT;
use super::whole::write_whole;
use super::yarn_file::coordinate_fault;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DMat4, DQuat, DVec3};
use serde_json::{Value, json};
use std::path::Path;

/// What moves all points of some curves, which are counted curve by curve. Lengths are mm.
#[derive(Clone, Debug, PartialEq)]
pub enum Moves {
    /// Targets that add to the points by their weights.
    Morph {
        /// For each target what it adds to every point.
        targets: Vec<Vec<DVec3>>,
        /// Times in seconds, ever later, with a weight for each target.
        keys: Vec<(f64, Vec<f64>)>,
    },
    /// Joints that the points hang on.
    Skin {
        /// Where the joints are at rest, each the next one's parent.
        joints: Vec<DVec3>,
        /// For each point four joints and their weights, which add up to 1.
        weights: Vec<([u16; 4], [f32; 4])>,
        /// Times in seconds, ever later, with a turn of each joint.
        keys: Vec<(f64, Vec<DQuat>)>,
    },
}

/// Component types of accessors.
const F32: u32 = 5126;
const U16: u32 = 5123;

/// The binary part, and the views and accessors over it.
#[derive(Default)]
struct Bin {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Bin {
    /// An accessor over elements of `width` f32, and its number. Positions must state their bounds.
    fn floats(&mut self, kind: &str, values: &[f32], width: usize, bounded: bool) -> usize {
        let mut accessor = json!({ "componentType": F32, "type": kind, "count": values.len() / width });
        if bounded {
            let fold = |f: fn(f32, f32) -> f32| -> Vec<f32> {
                let of =
                    |axis: usize| values.iter().skip(axis).step_by(width).copied().reduce(f).unwrap_or(0.0);
                (0..width).map(of).collect()
            };
            accessor["min"] = json!(fold(f32::min));
            accessor["max"] = json!(fold(f32::max));
        }
        self.add(accessor, values.iter().flat_map(|x| x.to_le_bytes()))
    }

    fn add(&mut self, mut accessor: Value, bytes: impl Iterator<Item = u8>) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - start;
        self.views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": length }));
        accessor["bufferView"] = json!(self.views.len() - 1);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

fn units(points: &[DVec3]) -> Vec<f32> {
    points.iter().flat_map(|p| (*p / GLTF_MM_PER_UNIT).as_vec3().to_array()).collect()
}

/// Writes curves (mm) and what moves them, under a temporary name, then renamed.
///
/// # Errors
/// Curves that a glTF cannot hold: none, B-splines and Bezier curves, another axis up than Y, points that are not finite;
/// what the file system says.
pub fn write_gltf(path: &Path, set: &CurveSet, moves: Option<&Moves>) -> Result<(), FileError> {
    check(path, set)?;
    let mut bin = Bin::default();
    let mut primitives = Vec::new();
    let mut first = 0;
    for curve in &set.curves {
        let range = first..first + curve.points.len();
        first = range.end;
        let position = bin.floats("VEC3", &units(&curve.points), 3, true);
        let mut primitive =
            json!({ "mode": if curve.closed { 2 } else { 3 }, "attributes": { "POSITION": position } });
        match moves {
            Some(Moves::Morph { targets, .. }) => {
                let target =
                    |target: &Vec<DVec3>| bin.floats("VEC3", &units(&target[range.clone()]), 3, true);
                let targets: Vec<usize> = targets.iter().map(target).collect();
                primitive["targets"] = targets.iter().map(|target| json!({ "POSITION": target })).collect();
            }
            Some(Moves::Skin { weights, .. }) => {
                let of_curve = &weights[range.clone()];
                let accessor = json!({ "componentType": U16, "type": "VEC4", "count": range.len() });
                let joints =
                    of_curve.iter().flat_map(|(joints, _)| joints).flat_map(|joint| joint.to_le_bytes());
                primitive["attributes"]["JOINTS_0"] = json!(bin.add(accessor, joints));
                let shares: Vec<f32> = of_curve.iter().flat_map(|(_, shares)| *shares).collect();
                primitive["attributes"]["WEIGHTS_0"] = json!(bin.floats("VEC4", &shares, 4, false));
            }
            None => {}
        }
        primitives.push(primitive);
    }
    let mut document = json!({
        "asset": { "version": "2.0", "generator": concat!("worsted ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "name": "yarns" }],
        "meshes": [{ "primitives": primitives }],
    });
    match moves {
        Some(Moves::Morph { targets, keys }) => morph(&mut document, &mut bin, targets.len(), keys),
        Some(Moves::Skin { joints, keys, .. }) => skin(&mut document, &mut bin, joints, keys),
        None => {}
    }
    let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&bin.bytes));
    document["buffers"] = json!([{ "byteLength": bin.bytes.len(), "uri": uri }]);
    document["bufferViews"] = json!(bin.views);
    document["accessors"] = json!(bin.accessors);
    write_whole(path, |out| Ok(serde_json::to_writer(out, &document)?))
}

fn check(path: &Path, set: &CurveSet) -> Result<(), FileError> {
    let wrong = |place, message: &str| Err(FileError::new(path, place, message));
    if set.curves.iter().all(|curve| curve.points.len() < 2) {
        return wrong(Place::File, "expected at least one curve of two points to write, found none");
    }
    if matches!(set.basis, Basis::BSpline | Basis::Bezier) || set.up_axis.is_some_and(|up| up != UpAxis::Y) {
        return wrong(Place::File, "expected curves through their points with Y up, found others");
    }
    let fault = |(index, p): (usize, &DVec3)| coordinate_fault(*p).map(|fault| (index, fault));
    let points =
        set.curves.iter().enumerate().flat_map(|(i, curve)| curve.points.iter().map(move |p| (i, p)));
    match points.into_iter().find_map(fault) {
        Some((curve, fault)) => wrong(Place::Curve(curve), &fault),
        None => Ok(()),
    }
}

fn times<T>(bin: &mut Bin, keys: &[(f64, T)]) -> usize {
    let times: Vec<f32> = keys.iter().map(|(time, _)| *time as f32).collect();
    bin.floats("SCALAR", &times, 1, true)
}

fn morph(document: &mut Value, bin: &mut Bin, targets: usize, keys: &[(f64, Vec<f64>)]) {
    document["meshes"][0]["weights"] = json!(vec![0.0; targets]);
    let input = times(bin, keys);
    let weights: Vec<f32> =
        keys.iter().flat_map(|(_, weights)| weights).map(|weight| *weight as f32).collect();
    let output = bin.floats("SCALAR", &weights, 1, false);
    document["animations"] = json!([{
        "samplers": [{ "input": input, "interpolation": "LINEAR", "output": output }],
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "weights" } }],
    }]);
}

fn skin(document: &mut Value, bin: &mut Bin, joints: &[DVec3], keys: &[(f64, Vec<DQuat>)]) {
    let at = |i: usize| joints[i] / GLTF_MM_PER_UNIT;
    let inverse: Vec<f32> =
        (0..joints.len()).flat_map(|i| DMat4::from_translation(-at(i)).as_mat4().to_cols_array()).collect();
    let inverse = bin.floats("MAT4", &inverse, 16, false);
    // Node 0 shows the mesh, and joint i is node i + 1.
    let mut nodes = vec![json!({ "mesh": 0, "skin": 0, "name": "yarns" })];
    for i in 0..joints.len() {
        let from = if i == 0 { DVec3::ZERO } else { at(i - 1) };
        let mut node =
            json!({ "translation": (at(i) - from).as_vec3().to_array(), "name": format!("joint {i}") });
        if i + 1 < joints.len() {
            node["children"] = json!([i + 2]);
        }
        nodes.push(node);
    }
    document["nodes"] = json!(nodes);
    document["scenes"][0]["nodes"] = json!([0, 1]);
    let numbers: Vec<usize> = (1..=joints.len()).collect();
    document["skins"] = json!([{ "joints": numbers, "inverseBindMatrices": inverse }]);
    let input = times(bin, keys);
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    for i in 0..joints.len() {
        let turns: Vec<f32> = keys.iter().flat_map(|(_, turns)| turns[i].as_quat().to_array()).collect();
        let output = bin.floats("VEC4", &turns, 4, false);
        samplers.push(json!({ "input": input, "interpolation": "LINEAR", "output": output }));
        channels.push(json!({ "sampler": i, "target": { "node": i + 1, "path": "rotation" } }));
    }
    document["animations"] = json!([{ "samplers": samplers, "channels": channels }]);
}
