//! A glTF's lines at any time.

use super::accessor::Reader;
use super::animation::{Channel, Moved, rotation, vector};
use super::buffers;
use super::checked;
use super::shapes::Shape;
use crate::io::error::{FileError, Place};
use glam::{DMat4, DQuat, DVec3};
use gltf::Document;
use gltf::scene::Transform;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A node, after its parent in the order of [`Model::nodes`].
#[derive(Debug)]
struct Node {
    /// Its number in the file.
    index: usize,
    /// Place of its parent.
    parent: Option<usize>,
    local: Local,
    /// Weights of its mesh's morph targets.
    weights: Vec<f64>,
}

/// Where a node is, seen from its parent.
#[derive(Clone, Copy, Debug)]
enum Local {
    Matrix(DMat4),
    Parts { translation: DVec3, rotation: DQuat, scale: DVec3 },
}

impl Local {
    fn matrix(&self) -> DMat4 {
        match *self {
            Self::Matrix(matrix) => matrix,
            Self::Parts { translation, rotation, scale } => {
                DMat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }
}

/// A shape where a node shows it.
#[derive(Debug)]
struct Shown {
    shape: Arc<Shape>,
    /// Place of the node.
    node: usize,
    skin: Option<usize>,
}

/// Joints that move vertices.
#[derive(Debug)]
struct Skin {
    /// Places of nodes.
    joints: Vec<usize>,
    /// To each joint's own axes at the time of binding.
    inverse_bind: Vec<DMat4>,
}

/// All of a file that its lines and their motion need.
#[derive(Debug)]
pub struct Model {
    file: PathBuf,
    nodes: Vec<Node>,
    shown: Vec<Shown>,
    /// Those that the file has, whose joints are all in the scene.
    skins: Vec<Option<Skin>>,
    channels: Vec<Channel>,
    notes: Vec<String>,
}

impl Model {
    /// Reads a `.gltf` or `.glb`.
    ///
    /// # Errors
    /// As [`super::parse_gltf`].
    pub fn new(file: &Path, bytes: &[u8]) -> Result<Self, FileError> {
        let (document, buffers) = buffers::read(file, bytes)?;
        let reader = Reader { buffers: &buffers };
        let room = buffers.bytes.iter().map(Vec::len).sum::<usize>() + bytes.len();
        let nodes = nodes(file, &document)?;
        let mut places = vec![None; document.nodes().len()];
        for (place, node) in nodes.iter().enumerate() {
            places[node.index] = Some(place);
        }
        let (shown, mut notes) = shown(reader, &document, &places, room)?;
        let skins = skins(reader, &document, &places)?;
        let model =
            Self { file: file.to_owned(), nodes, shown, skins, channels: Vec::new(), notes: Vec::new() };
        model.check_skins()?;
        let mut channels = Vec::new();
        let animations = document.animations().len();
        for (index, channel) in document.animations().next().iter().flat_map(|a| a.channels()).enumerate() {
            let channel = Channel::read(reader, index, &channel)?;
            model.check_channel(index, &channel, &places)?;
            channels.push(channel);
        }
        if animations > 1 {
            notes.push(format!("{animations} animations: the first is played"));
        }
        // Channels name nodes by their place from here on; those of nodes that are not shown move nothing.
        channels.retain_mut(|channel| {
            let place = places[channel.node];
            channel.node = place.unwrap_or(0);
            place.is_some()
        });
        Ok(Self { channels, notes, ..model })
    }

    /// Oddities, one line each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Points of every curve, and whether it is closed, in the order of [`Self::points`].
    pub fn curves(&self) -> impl Iterator<Item = (usize, bool)> {
        self.shown
            .iter()
            .flat_map(|shown| &shown.shape.chains)
            .map(|chain| (chain.vertices.len(), chain.closed))
    }

    /// Length of the motion in seconds; none where nothing moves.
    pub fn duration(&self) -> Option<f64> {
        self.channels.iter().map(Channel::end).reduce(f64::max)
    }

    /// The points of all curves at a time of the motion in seconds, or as the file has them without it.
    ///
    /// # Errors
    /// A point that is not finite; `place` in errors is the file as a whole.
    pub fn points(&self, seconds: Option<f64>) -> Result<Vec<DVec3>, FileError> {
        let (mut locals, mut weights): (Vec<Local>, Vec<Vec<f64>>) =
            self.nodes.iter().map(|node| (node.local, node.weights.clone())).unzip();
        if let Some(seconds) = seconds {
            for channel in &self.channels {
                let value = channel.at(seconds);
                move_node(&mut locals[channel.node], &mut weights[channel.node], channel.moved, value);
            }
        }
        let mut globals: Vec<DMat4> = Vec::with_capacity(self.nodes.len());
        for (node, local) in self.nodes.iter().zip(&locals) {
            let parent = node.parent.map_or(DMat4::IDENTITY, |parent| globals[parent]);
            globals.push(parent * local.matrix());
        }
        let mut points = Vec::with_capacity(self.shown.iter().map(|shown| shown.shape.point_count()).sum());
        for shown in &self.shown {
            let placed = self.placed(shown, &weights[shown.node], &globals);
            points.extend(shown.shape.chains.iter().flat_map(|chain| &chain.vertices).map(|i| placed[*i]));
        }
        checked(&self.file, Place::File, points)
    }

    /// All vertices of a shape.
    fn placed(&self, shown: &Shown, weights: &[f64], globals: &[DMat4]) -> Vec<DVec3> {
        let shape = &shown.shape;
        let wide = |p: &[f32; 3]| DVec3::from_array(p.map(f64::from));
        let mut points: Vec<DVec3> = shape.positions.iter().map(wide).collect();
        for (target, weight) in shape.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            points.iter_mut().zip(target).for_each(|(point, moved)| *point += *weight * wide(moved));
        }
        let skin = shown.skin.and_then(|skin| self.skins[skin].as_ref()).filter(|_| !shape.joints.is_empty());
        let Some(skin) = skin else {
            let world = globals[shown.node];
            return points.into_iter().map(|p| world.transform_point3(p)).collect();
        };
        let joint = |(place, inverse): (&usize, &DMat4)| globals[*place] * *inverse;
        let matrices: Vec<DMat4> = skin.joints.iter().zip(&skin.inverse_bind).map(joint).collect();
        let skinned = |(vertex, p): (usize, DVec3)| {
            let (mut sum, mut whole) = (DVec3::ZERO, 0.0);
            for (joints, weights) in shape.joints.iter().zip(&shape.weights) {
                for (joint, weight) in joints[vertex].iter().zip(weights[vertex]) {
                    let weight = f64::from(weight);
                    sum += weight * matrices[*joint as usize].transform_point3(p);
                    whole += weight;
                }
            }
            // Weights should add up to 1, and do not quite.
            if whole > 0.0 { sum / whole } else { globals[shown.node].transform_point3(p) }
        };
        points.into_iter().enumerate().map(skinned).collect()
    }

    /// Whether every vertex names joints that its skin has.
    fn check_skins(&self) -> Result<(), FileError> {
        for shown in &self.shown {
            let Some(skin) = shown.skin.and_then(|skin| self.skins[skin].as_ref()) else { continue };
            let most = skin.joints.len() as u32;
            let named = shown.shape.joints.iter().flatten().flatten();
            if let Some(joint) = named.into_iter().find(|joint| **joint >= most) {
                let place = Place::Item("mesh", shown.shape.mesh);
                return Err(FileError::new(
                    &self.file,
                    place,
                    format!("expected a joint below {most}, found {joint}"),
                ));
            }
        }
        Ok(())
    }

    /// Whether a channel of weights has one for each morph target of its node's mesh.
    fn check_channel(
        &self,
        index: usize,
        channel: &Channel,
        places: &[Option<usize>],
    ) -> Result<(), FileError> {
        let Some(place) = places[channel.node].filter(|_| channel.moved == Moved::Weights) else {
            return Ok(());
        };
        let shapes = self.shown.iter().filter(|shown| shown.node == place);
        let mut counts = shapes.map(|shown| shown.shape.targets.len());
        let Some(expected) = counts.find(|count| *count != channel.width()) else { return Ok(()) };
        let found = channel.width();
        let message =
            format!("channel {index}: expected a weight for each of {expected} targets, found {found}");
        Err(FileError::new(&self.file, Place::Item("animation", 0), message))
    }
}

fn move_node(local: &mut Local, weights: &mut Vec<f64>, moved: Moved, value: Vec<f64>) {
    if moved == Moved::Weights {
        *weights = value;
        return;
    }
    if let Local::Matrix(matrix) = *local {
        let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
        *local = Local::Parts { translation, rotation, scale };
    }
    if let Local::Parts { translation, rotation: turn, scale } = local {
        match moved {
            Moved::Translation => *translation = vector(&value),
            Moved::Rotation => *turn = rotation(&value),
            _ => *scale = vector(&value),
        }
    }
}

/// The nodes of the default scene, or of the first; of a file without scenes those that are nobody's children. Parents
/// come first.
fn nodes(file: &Path, document: &Document) -> Result<Vec<Node>, FileError> {
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let mut open: Vec<(gltf::Node<'_>, Option<usize>)> = match scene {
        Some(scene) => scene.nodes().map(|node| (node, None)).collect(),
        None => {
            let mut is_child = vec![false; document.nodes().len()];
            document
                .nodes()
                .flat_map(|node| node.children())
                .for_each(|child| is_child[child.index()] = true);
            document.nodes().filter(|node| !is_child[node.index()]).map(|node| (node, None)).collect()
        }
    };
    open.reverse();
    let mut seen = vec![false; document.nodes().len()];
    let mut nodes = Vec::new();
    while let Some((node, parent)) = open.pop() {
        let index = node.index();
        if std::mem::replace(&mut seen[index], true) {
            let message = "expected one parent at most, found it twice in the scene".to_owned();
            return Err(FileError::new(file, Place::Item("node", index), message));
        }
        let local = match node.transform() {
            Transform::Matrix { matrix } => {
                Local::Matrix(DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from))))
            }
            Transform::Decomposed { translation, rotation: turn, scale } => Local::Parts {
                translation: DVec3::from_array(translation.map(f64::from)),
                rotation: rotation(&turn.map(f64::from)),
                scale: DVec3::from_array(scale.map(f64::from)),
            },
        };
        let weights = node.weights().or_else(|| node.mesh().and_then(|mesh| mesh.weights()));
        let weights = weights.unwrap_or_default().iter().map(|weight| f64::from(*weight)).collect();
        let place = nodes.len();
        nodes.push(Node { index, parent, local, weights });
        let children: Vec<_> = node.children().map(|child| (child, Some(place))).collect();
        open.extend(children.into_iter().rev());
    }
    Ok(nodes)
}

/// The lines of every node, node by node, or where there are none the edges of triangles; and notes.
fn shown(
    reader: Reader<'_>,
    document: &Document,
    places: &[Option<usize>],
    room: usize,
) -> Result<(Vec<Shown>, Vec<String>), FileError> {
    let file = reader.buffers.file;
    for triangles in [false, true] {
        let mut meshes: Vec<Vec<Arc<Shape>>> = Vec::new();
        for mesh in document.meshes() {
            let mut shapes = Vec::new();
            for primitive in mesh.primitives() {
                shapes.extend(Shape::read(reader, mesh.index(), &primitive, triangles)?.map(Arc::new));
            }
            meshes.push(shapes);
        }
        let mut nodes: Vec<_> =
            document.nodes().filter_map(|node| Some((places[node.index()]?, node))).collect();
        nodes.sort_by_key(|(place, _)| *place);
        let mut shown = Vec::new();
        let (mut points, mut junctions) = (0, 0);
        for (place, node) in nodes {
            for shape in node.mesh().iter().flat_map(|mesh| &meshes[mesh.index()]) {
                points += 1 + shape.positions.len().max(shape.point_count());
                junctions += shape.junctions;
                shown.push(Shown {
                    shape: shape.clone(),
                    node: place,
                    skin: node.skin().map(|skin| skin.index()),
                });
            }
            if points > room {
                let message =
                    format!("expected at most {room} points, one for each byte, found more up to here");
                return Err(FileError::new(file, Place::Item("node", node.index()), message));
            }
        }
        if shown.iter().any(|shown| !shown.shape.chains.is_empty()) {
            let mut notes = Vec::new();
            if triangles {
                notes.push("no lines: the edges of triangles are taken as yarns".to_owned());
            }
            if junctions > 0 {
                notes.push(format!("curves end at {junctions} vertices where three or more line ends meet"));
            }
            return Ok((shown, notes));
        }
    }
    Err(FileError::new(file, Place::File, "expected at least one mesh with lines in the scene, found none"))
}

fn skins(
    reader: Reader<'_>,
    document: &Document,
    places: &[Option<usize>],
) -> Result<Vec<Option<Skin>>, FileError> {
    let mut skins = Vec::new();
    for skin in document.skins() {
        let joints: Option<Vec<usize>> = skin.joints().map(|joint| places[joint.index()]).collect();
        let Some(joints) = joints else {
            skins.push(None);
            continue;
        };
        let inverse_bind = match skin.inverse_bind_matrices() {
            Some(accessor) => {
                let found = reader.floats::<16>(&accessor, joints.len())?;
                found.iter().map(|m| DMat4::from_cols_array(&m.map(f64::from))).collect()
            }
            None => vec![DMat4::IDENTITY; joints.len()],
        };
        if inverse_bind.len() != joints.len() {
            let (expected, found) = (joints.len(), inverse_bind.len());
            let message = format!("expected a matrix for each of {expected} joints, found {found}");
            return Err(FileError::new(reader.buffers.file, Place::Item("skin", skin.index()), message));
        }
        skins.push(Some(Skin { joints, inverse_bind }));
    }
    Ok(skins)
}
