use super::*;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

/// A document over f32 and u16 in one buffer: four points on a square, indices 0 1 1 2 2 3, two keys.
fn document() -> Value {
    let points: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.5]];
    let mut bytes: Vec<u8> = points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([0u16, 1, 1, 2, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    bytes.extend([0.0f32, 2.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0].iter().flat_map(|x| x.to_le_bytes()));
    let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&bytes));
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "children": [1], "translation": [0, 10, 0] }, { "mesh": 0, "scale": [2, 2, 2] }],
        "meshes": [{ "primitives": [{ "mode": 1, "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "animations": [{
            "samplers": [{ "input": 2, "output": 3 }],
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }],
        }],
        "buffers": [{ "byteLength": bytes.len(), "uri": uri }],
        "bufferViews": [{ "buffer": 0, "byteLength": bytes.len() }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4, "min": [0, 0, 0], "max": [1, 1, 1] },
            { "bufferView": 0, "byteOffset": 48, "componentType": 5123, "type": "SCALAR", "count": 6 },
            { "bufferView": 0, "byteOffset": 60, "componentType": 5126, "type": "SCALAR", "count": 2, "min": [0], "max": [2] },
            { "bufferView": 0, "byteOffset": 68, "componentType": 5126, "type": "VEC3", "count": 2 },
        ],
    })
}

fn model(document: &Value) -> Result<Model, FileError> {
    Model::new(Path::new("a.gltf"), document.to_string().as_bytes())
}

fn curves(document: &Value) -> Vec<(usize, bool)> {
    model(document).unwrap().curves().collect()
}

#[test]
fn segments_are_chained_and_nodes_place_and_move_them() {
    let model = model(&document()).unwrap();
    assert_eq!(model.curves().collect::<Vec<_>>(), [(4, false)]);
    assert_eq!(model.duration(), Some(2.0));
    let place = |x: f64, y: f64, z: f64, by: DVec3| 2.0 * DVec3::new(x, y, z) + by;
    for (seconds, by) in [
        (None, DVec3::Y * 10.0),
        (Some(0.0), DVec3::ZERO),
        (Some(0.5), DVec3::X),
        (Some(2.0), DVec3::X * 4.0),
        (Some(9.0), DVec3::X * 4.0),
    ] {
        let expected = [
            place(0.0, 0.0, 0.0, by),
            place(1.0, 0.0, 0.0, by),
            place(1.0, 1.0, 0.0, by),
            place(0.0, 1.0, 0.5, by),
        ];
        assert_eq!(model.points(seconds).unwrap(), expected, "{seconds:?}");
    }
    let loaded = parse_gltf(Path::new("a.gltf"), document().to_string().as_bytes()).unwrap();
    assert!(loaded.moves && loaded.mm_per_unit == Some(1000.0) && loaded.curves.curves.len() == 1);
}

#[test]
fn every_kind_of_primitive_gives_its_curves() {
    for (mode, indices, expected) in [
        (1, true, vec![(4, false)]),
        (1, false, vec![(2, false), (2, false)]),
        (2, false, vec![(4, true)]),
        (3, false, vec![(4, false)]),
        // Edges: the two triangles of a strip of four share one.
        (4, false, vec![(3, true)]),
        (5, false, vec![(2, false), (3, false), (3, false)]),
    ] {
        let mut document = document();
        let primitive = &mut document["meshes"][0]["primitives"][0];
        primitive["mode"] = json!(mode);
        if !indices {
            primitive.as_object_mut().unwrap().remove("indices");
        }
        let mut found = curves(&document);
        found.sort_unstable();
        let points: usize = found.iter().map(|(points, _)| points).sum();
        if mode == 5 {
            assert_eq!((points, found.len()), (8, 3), "{found:?}");
        } else {
            assert_eq!(found, expected, "mode {mode}");
        }
        let notes = model(&document).unwrap().notes().join(";");
        assert_eq!(notes.contains("edges of triangles"), mode > 3, "{notes}");
    }
    let mut points = document();
    points["meshes"][0]["primitives"][0]["mode"] = json!(0);
    assert!(model(&points).unwrap_err().message.contains("expected at least one mesh with lines"));
}

#[test]
fn steps_and_cubic_keys_are_as_the_file_says() {
    let mut step = document();
    step["animations"][0]["samplers"][0]["interpolation"] = json!("STEP");
    let first = |document: &Value, seconds| model(document).unwrap().points(Some(seconds)).unwrap()[0].x;
    assert_eq!([0.0, 1.9, 2.0].map(|seconds| first(&step, seconds)), [0.0, 0.0, 4.0]);
    // Two keys of value 0 and 4 with slopes of 0: smoothstep.
    let mut cubic = document();
    let keys = [0.0f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let bytes: Vec<u8> = keys.iter().flat_map(|x| x.to_le_bytes()).collect();
    cubic["buffers"].as_array_mut().unwrap().push(json!({
        "byteLength": bytes.len(), "uri": format!("data:a/b;base64,{}", STANDARD.encode(&bytes)),
    }));
    cubic["bufferViews"].as_array_mut().unwrap().push(json!({ "buffer": 1, "byteLength": bytes.len() }));
    cubic["accessors"][3] = json!({ "bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 6 });
    cubic["animations"][0]["samplers"][0]["interpolation"] = json!("CUBICSPLINE");
    for seconds in [0.0, 0.5, 1.0, 1.7, 2.0] {
        let t = seconds / 2.0;
        assert!((first(&cubic, seconds) - 4.0 * t * t * (3.0 - 2.0 * t)).abs() < 1e-9, "{seconds}");
    }
}

/// What is changed, and what the error must say.
type Spoiled = (&'static str, fn(&mut Value), &'static str);

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let spoiled: [Spoiled; 22] = [
        (
            "joints",
            |d| {
                let accessors = d["accessors"].as_array_mut().unwrap();
                let first = accessors.len();
                for kind in [5123, 5126] {
                    let none = json!({ "bufferView": 0, "componentType": kind, "count": 0, "type": "VEC4" });
                    accessors.push(none);
                }
                let attributes = &mut d["meshes"][0]["primitives"][0]["attributes"];
                attributes["JOINTS_0"] = json!(first);
                attributes["WEIGHTS_0"] = json!(first + 1);
            },
            "expected 4 vertices in every attribute, found 0",
        ),
        (
            "scheme",
            |d| d["buffers"][0]["uri"] = json!(format!("d!ta:x;base64,{}", "AAA/".repeat(200))),
            "buffer 0: expected a file beside",
        ),
        (
            "path",
            |d| d["animations"][0]["channels"][0]["target"]["path"] = json!("weight"),
            "animation 0: channel 0: expected a path of translation",
        ),
        (
            "sampler",
            |d| d["animations"][0]["channels"][0]["sampler"] = json!(9),
            "animation 0: channel 0: expected one of",
        ),
        (
            "node",
            |d| d["animations"][0]["channels"][0]["target"]["node"] = json!(9),
            "animation 0: channel 0: expected one of",
        ),
        (
            "interpolation",
            |d| d["animations"][0]["samplers"][0]["interpolation"] = json!("CUBIC"),
            "animation 0: sampler 0: expected LINEAR",
        ),
        (
            "attribute",
            |d| d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(7),
            "mesh 0: expected an attribute in one of",
        ),
        (
            "accessors",
            |d| d["accessors"] = json!([]),
            "mesh 0: expected an attribute in one of 0 accessors, found accessor 0",
        ),
        (
            "index",
            |d| d["accessors"][1]["byteOffset"] = json!(60),
            "mesh 0: primitive 0: expected an index below 4",
        ),
        ("count", |d| d["accessors"][0]["count"] = json!(400), "accessor 0: expected 400 elements"),
        ("huge", |d| d["accessors"][0]["count"] = json!(u64::MAX), "accessor 0: expected"),
        ("offset", |d| d["accessors"][0]["byteOffset"] = json!(u64::MAX - 3), "accessor 0: expected"),
        ("type", |d| d["accessors"][0]["type"] = json!("VEC2"), "accessor 0: expected elements of 3"),
        ("view", |d| d["accessors"][0]["bufferView"] = json!(7), "expected a glTF 2.0"),
        ("length", |d| d["buffers"][0]["byteLength"] = json!(4000), "buffer 0: expected 4000 bytes"),
        ("uri", |d| d["buffers"][0]["uri"] = json!("data:x,abc"), "buffer 0: expected data in base64"),
        (
            "base64",
            |d| d["buffers"][0]["uri"] = json!("data:x;base64,!"),
            "buffer 0: expected data in base64",
        ),
        ("web", |d| d["buffers"][0]["uri"] = json!("https://x/y"), "buffer 0: expected a file beside"),
        ("root", |d| d["buffers"][0]["uri"] = json!("/etc/passwd"), "buffer 0: expected a file beside"),
        ("cycle", |d| d["nodes"][1]["children"] = json!([1]), "node 1: expected one parent"),
        ("times", |d| d["accessors"][2]["byteOffset"] = json!(64), "channel 0: expected times"),
        ("keys", |d| d["accessors"][3]["count"] = json!(1), "channel 0: expected numbers for 2 keys"),
    ];
    for (name, spoil, expected) in spoiled {
        let mut document = document();
        spoil(&mut document);
        let error = model(&document).unwrap_err().to_string();
        assert!(error.starts_with("a.gltf: ") && error.contains(expected), "{name}: {error}");
        assert!(error.contains("found") && !error.contains('\n') && error.len() < 250, "{name}: {error}");
    }
    let mut nan = document();
    nan["nodes"][1]["scale"] = json!([1e38, 1e38, 1e38]);
    assert!(
        model(&nan)
            .unwrap()
            .points(None)
            .unwrap_err()
            .message
            .contains("expected a finite coordinate within")
    );
}

#[test]
fn many_nodes_that_show_one_mesh_are_no_bomb() {
    let mut document = document();
    let nodes: Vec<Value> = (0..3000).map(|_| json!({ "mesh": 0 })).collect();
    document["scenes"][0]["nodes"] = json!((0..3000).collect::<Vec<usize>>());
    document["nodes"] = json!(nodes);
    document["animations"] = json!([]);
    assert_eq!(curves(&document).len(), 3000, "of few points each");
    let points = 4000;
    let zeros = STANDARD.encode(vec![0; 12 * points]);
    document["buffers"][0] =
        json!({ "byteLength": 12 * points, "uri": format!("data:application/octet-stream;base64,{zeros}") });
    document["bufferViews"][0] = json!({ "buffer": 0, "byteLength": 12 * points });
    document["accessors"][0]["count"] = json!(points);
    document["meshes"][0]["primitives"][0] = json!({ "mode": 3, "attributes": { "POSITION": 0 } });
    let error = model(&document).unwrap_err().to_string();
    assert!(error.contains("node ") && error.contains("expected at most"), "{error}");
}

#[test]
fn binary_files_with_lying_lengths_are_refused() {
    let document = document().to_string();
    let chunk = document.len().next_multiple_of(4);
    let mut glb = b"glTF".to_vec();
    glb.extend(2u32.to_le_bytes());
    glb.extend((20 + chunk as u32).to_le_bytes());
    glb.extend((chunk as u32).to_le_bytes());
    glb.extend(b"JSON");
    glb.extend(document.bytes());
    glb.resize(20 + chunk, b' ');
    let read = |bytes: &[u8]| Model::new(Path::new("a.glb"), bytes);
    assert_eq!(read(&glb).unwrap().curves().count(), 1);
    for length in 0..20 {
        assert!(read(&glb[..length.max(4)]).is_err());
    }
    for (at, word) in [(8, 0u32), (8, 11), (8, u32::MAX), (12, 0), (12, u32::MAX), (4, 1)] {
        let mut spoiled = glb.clone();
        spoiled[at..at + 4].copy_from_slice(&word.to_le_bytes());
        assert!(read(&spoiled).is_err(), "{at} {word}");
    }
}
