//! Files of scenes.

use serde_json::Value;

/// A box, open to the front, and a block in it.
pub fn box_at(place: [f32; 3]) -> String {
    let corners = [
        [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]],
        [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]],
        [[-1, 0, -1], [1, 0, -1], [1, 2, -1], [-1, 2, -1]],
        [[-1, 0, 1], [-1, 0, -1], [-1, 2, -1], [-1, 2, 1]],
        [[1, 0, -1], [1, 0, 1], [1, 2, 1], [1, 2, -1]],
        [[-1, 1, 1], [0, 1, 1], [0, 1, 0], [-1, 1, 0]],
        [[-1, 0, 1], [0, 0, 1], [0, 1, 1], [-1, 1, 1]],
    ];
    let vertices = corners.as_flattened().iter().map(|corner| {
        let [x, y, z] = [0, 1, 2].map(|i| place[i] + corner[i] as f32);
        format!("v {x} {y} {z}\n")
    });
    let faces = (0..corners.len()).map(|face| {
        let [a, b, c, d] = [1, 2, 3, 4].map(|corner| 4 * face + corner);
        format!("f {a} {b} {c} {d}\n")
    });
    vertices.chain(faces).collect()
}

/// A glTF file of one triangle whose accessor claims `count` vertices in a view of `length` bytes.
pub fn gltf(count: u64, length: u64) -> String {
    let bytes = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    serde_json::json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [0.0, 1.0, 0.0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{
            "bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3",
            "min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 0.0],
        }],
        "bufferViews": [{"buffer": 0, "byteLength": length}],
        "buffers": [{
            "byteLength": 36,
            "uri": format!("data:application/octet-stream;base64,{bytes}"),
        }],
    })
    .to_string()
}

/// The same triangle as binary glTF: a header, a chunk of JSON and a chunk of bytes.
pub fn glb() -> Vec<u8> {
    let mut json: Value = serde_json::from_str(&gltf(3, 36)).expect("it is JSON");
    json["buffers"] = serde_json::json!([{"byteLength": 36}]);
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let vertices = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = vertices.into_iter().flat_map(f32::to_le_bytes).collect();
    let size = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
    let chunks = [
        &size(&text),
        b"JSON".as_slice(),
        &text,
        &size(&bytes),
        b"BIN\0",
        &bytes,
    ]
    .concat();
    let total = (12 + chunks.len() as u32).to_le_bytes();
    [b"glTF", &2_u32.to_le_bytes(), &total, &*chunks].concat()
}
