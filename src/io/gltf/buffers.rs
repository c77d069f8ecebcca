//! The document of a glTF, and the bytes that it speaks of.

use super::{GLB_MAGIC, shortened};
use crate::io::error::{FileError, Place};
use crate::io::yarn_file::{excerpt, read_file_bytes};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::buffer::Source;
use gltf::json::validation::Checked;
use gltf::{Document, Gltf};
use std::path::{Path, PathBuf};

/// Bytes in front of the chunks of a GLB, its length at this place of them.
const GLB_HEADER: usize = 12;
const GLB_LENGTH_AT: usize = 8;
/// Bytes of a relative path to a buffer. Data that is spoiled in front looks like a longer one.
const LONGEST_PATH: usize = 512;

/// What a file's accessors read.
pub struct Buffers<'a> {
    /// The file, for errors.
    pub file: &'a Path,
    /// One for each buffer, as long as the document says.
    pub bytes: Vec<Vec<u8>>,
}

/// Reads the document, and the buffers in it and beside it.
///
/// # Errors
/// What is no glTF 2.0; buffers that are missing or shorter than stated.
pub fn read<'a>(file: &'a Path, bytes: &[u8]) -> Result<(Document, Buffers<'a>), FileError> {
    check_glb(file, bytes)?;
    let wrong = |error: gltf::Error| {
        let place = match &error {
            gltf::Error::Deserialize(error) if error.line() > 0 => Place::Line(error.line() as u64),
            _ => Place::File,
        };
        FileError::new(file, place, format!("expected a glTF 2.0, found: {}", shortened(&error.to_string())))
    };
    let Gltf { document, mut blob } = Gltf::from_slice_without_validation(bytes).map_err(wrong)?;
    check_attributes(file, &document)?;
    check_animations(file, &document)?;
    let document = Document::from_json(document.into_json()).map_err(wrong)?;
    let mut all = Vec::new();
    for buffer in document.buffers() {
        let error = |message: String| FileError::new(file, Place::Item("buffer", buffer.index()), message);
        let bytes = match buffer.source() {
            Source::Bin => {
                blob.take().ok_or_else(|| error("expected bytes in the file, found none".into()))?
            }
            Source::Uri(uri) => match uri.strip_prefix("data:") {
                Some(data) => decoded(data).map_err(error)?,
                None => read_file_bytes(&beside(file, uri).map_err(error)?)?,
            },
        };
        let (expected, found) = (buffer.length(), bytes.len());
        if found < expected {
            return Err(error(format!("expected {expected} bytes, found {found}")));
        }
        all.push(bytes);
    }
    Ok((document, Buffers { file, bytes: all }))
}

/// Whether the accessors of all attributes are there, which the crate's own validation follows unchecked.
fn check_attributes(file: &Path, document: &Document) -> Result<(), FileError> {
    let json = document.as_json();
    let count = json.accessors.len();
    for (index, mesh) in json.meshes.iter().enumerate() {
        let mut named = mesh.primitives.iter().flat_map(|primitive| primitive.attributes.values());
        if let Some(missing) = named.find(|accessor| accessor.value() >= count) {
            let message = format!(
                "expected an attribute in one of {count} accessors, found accessor {}",
                missing.value()
            );
            return Err(FileError::new(file, Place::Item("mesh", index), message));
        }
    }
    Ok(())
}

/// Whether what animations name is there and known: the crate's own validation does not look at their channels.
fn check_animations(file: &Path, document: &Document) -> Result<(), FileError> {
    let json = document.as_json();
    for (index, animation) in json.animations.iter().enumerate() {
        let wrong = |what: String| FileError::new(file, Place::Item("animation", index), what);
        for (number, channel) in animation.channels.iter().enumerate() {
            let (sampler, node) = (channel.sampler.value(), channel.target.node.value());
            if sampler >= animation.samplers.len() || node >= json.nodes.len() {
                let (samplers, nodes) = (animation.samplers.len(), json.nodes.len());
                return Err(wrong(format!(
                    "channel {number}: expected one of {samplers} samplers and {nodes} nodes, found {sampler} and {node}"
                )));
            }
            if matches!(channel.target.path, Checked::Invalid) {
                let expected = "translation, rotation, scale or weights";
                return Err(wrong(format!("channel {number}: expected a path of {expected}, found another")));
            }
        }
        for (number, sampler) in animation.samplers.iter().enumerate() {
            let accessors = [sampler.input.value(), sampler.output.value()];
            let known = !matches!(sampler.interpolation, Checked::Invalid);
            if !known || accessors.iter().any(|accessor| *accessor >= json.accessors.len()) {
                let count = json.accessors.len();
                return Err(wrong(format!(
                    "sampler {number}: expected LINEAR, STEP or CUBICSPLINE between two of {count} accessors, found others"
                )));
            }
        }
    }
    Ok(())
}

/// Whether the length that a GLB claims is that of a header and no more than there is, which its reader relies on.
fn check_glb(file: &Path, bytes: &[u8]) -> Result<(), FileError> {
    if !bytes.starts_with(&GLB_MAGIC) {
        return Ok(());
    }
    let claimed =
        bytes.get(GLB_LENGTH_AT..GLB_HEADER).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    match claimed {
        Some(claimed) if (GLB_HEADER..=bytes.len()).contains(&claimed) => Ok(()),
        _ => {
            let found =
                claimed.map_or_else(|| "no length".to_owned(), |claimed| format!("a claim of {claimed}"));
            let message =
                format!("expected a length of {GLB_HEADER} to {} bytes, found {found}", bytes.len());
            Err(FileError::new(file, Place::Byte(GLB_LENGTH_AT as u64), message))
        }
    }
}

fn decoded(data: &str) -> Result<Vec<u8>, String> {
    let found = || excerpt(data.as_bytes());
    let text = data.split_once(";base64,").map(|(_, text)| text);
    let text = text.ok_or_else(|| format!("expected data in base64, found \"{}\"", found()))?;
    STANDARD.decode(text).map_err(|e| format!("expected data in base64, found {}", shortened(&e.to_string())))
}

/// The file that a relative URI names.
fn beside(file: &Path, uri: &str) -> Result<PathBuf, String> {
    let wrong = || format!("expected a file beside this one, found \"{}\"", excerpt(uri.as_bytes()));
    let mut path = Vec::new();
    let mut bytes = uri.bytes();
    while let Some(byte) = bytes.next() {
        path.push(match byte {
            b'%' => {
                let digits = [bytes.next(), bytes.next()].map(|b| b.and_then(|b| char::from(b).to_digit(16)));
                let [Some(high), Some(low)] = digits else { return Err(wrong()) };
                (16 * high + low) as u8
            }
            _ => byte,
        });
    }
    let path = String::from_utf8(path).map_err(|_| wrong())?;
    let long = path.len() > LONGEST_PATH;
    if path.is_empty()
        || long
        || path.contains("://")
        || path.contains('\0')
        || Path::new(&path).is_absolute()
    {
        return Err(wrong());
    }
    Ok(file.parent().unwrap_or(Path::new("")).join(path))
}
