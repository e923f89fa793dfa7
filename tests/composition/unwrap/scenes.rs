//! Files to unwrap.

use serde_json::{Value, json};

use super::raw::number;
use crate::glb::{F32, Glb, U8, U16};

/// Positions and triangles of a wavy sheet of `n` by `n` squares.
pub(super) fn sheet(n: u32) -> (Vec<[f32; 3]>, Vec<u32>) {
    let at = |i: u32| i as f32 / n as f32 * 2.0 - 1.0;
    let positions = (0..=n)
        .flat_map(|j| (0..=n).map(move |i| (at(i), at(j))))
        .map(|(x, y)| [x, y, 0.3 * (3.0 * x).sin() * (2.0 * y).cos()])
        .collect();
    let corner = |i: u32, j: u32| j * (n + 1) + i;
    let indices = (0..n)
        .flat_map(|j| (0..n).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|p| corner(p.0, p.1));
            [a, b, c, a, c, d]
        })
        .collect();
    (positions, indices)
}

/// A closed tube around Z: seams must be cut.
pub(super) fn tube(n: u32) -> (Vec<[f32; 3]>, Vec<u32>) {
    let positions = (0..n * 8)
        .map(|i| {
            let angle = (i % n) as f32 * std::f32::consts::TAU / n as f32;
            [angle.cos(), angle.sin(), (i / n) as f32 * 0.4]
        })
        .collect();
    let indices = (0..n * 7)
        .flat_map(|i| {
            let (here, along) = (i, i / n * n + (i + 1) % n);
            [here, along, along + n, here, along + n, here + n]
        })
        .collect();
    (positions, indices)
}

/// A scene with every kind of thing that a file may hold.
pub(super) fn rich() -> Glb {
    let mut glb = Glb::new();
    let texels: Vec<[u8; 4]> = (0..16u8).map(|i| [i * 16, 255 - i, 90, 255]).collect();
    let texture = glb.texture(4, 4, &texels);
    let material = glb.unlit_texture(texture);
    let lit = glb.push("materials", json!({ "extras": { "of": [1.25, "x"] } }));
    let primitives = [tube_primitive(&mut glb, material)];
    let skinned = glb.push(
        "meshes",
        json!({ "primitives": primitives, "weights": [0.5] }),
    );
    let primitives = [
        strip(&mut glb, lit),
        fan(&mut glb, lit),
        lines(&mut glb, lit),
    ];
    let plain = glb.push(
        "meshes",
        json!({ "name": "plain", "primitives": primitives }),
    );
    glb.node(json!({ "mesh": plain, "scale": [0.2, 0.2, 0.2] }));
    add_animated(&mut glb, skinned);
    // Data that nothing refers to.
    glb.floats(&[[9.0f32, 9.0, 9.0]; 500]);
    glb.json["extras"] = json!({ "kept": 0.1 });
    glb.json["extensionsUsed"] = json!(["KHR_materials_unlit", "XYZ_notes"]);
    glb.json["extensions"] = json!({ "XYZ_notes": { "text": "hello" } });
    glb
}

/// A tube with every kind of attribute.
fn tube_primitive(glb: &mut Glb, material: usize) -> Value {
    let (positions, indices) = tube(12);
    let count = positions.len();
    let like = |glb: &mut Glb, bytes: Vec<u8>, component, kind| {
        glb.accessor(&bytes, component, kind, count)
    };
    let position = glb.floats(&positions);
    let normals: Vec<[f32; 3]> = positions.iter().map(|p| [p[0], p[1], 0.0]).collect();
    let normal = glb.floats(&normals);
    let st: Vec<[f32; 2]> = positions.iter().map(|p| [p[0], p[2]]).collect();
    let st = glb.floats(&st);
    // Three bytes an element, in rows of four.
    let colors: Vec<u8> = (0..count * 4).map(|i| (i * 7) as u8).collect();
    let colors = like(glb, colors, U8, "VEC3");
    glb.json["accessors"][colors]["normalized"] = json!(true);
    glb.json["accessors"][colors]["name"] = json!("tint");
    let view = glb.json["accessors"][colors]["bufferView"].clone();
    glb.json["bufferViews"][number(&view)]["byteStride"] = json!(4);
    let joints: Vec<u8> = (0..count).flat_map(|i| [(i % 2) as u8, 1, 0, 0]).collect();
    let joints = like(glb, joints, U8, "VEC4");
    let weights = glb.floats(&vec![[0.75f32, 0.25, 0.0, 0.0]; count]);
    let heat: Vec<u8> = (0..count).flat_map(|i| (i as u16).to_le_bytes()).collect();
    let heat = like(glb, heat, U16, "SCALAR");
    // A morph target of which three displacements are stored.
    let at = glb.view(&[1, 0, 5, 0, 40, 0]);
    let values: Vec<u8> = (0..9)
        .flat_map(|i| (i as f32 * 0.01).to_le_bytes())
        .collect();
    let values = glb.view(&values);
    let moved = glb.push(
        "accessors",
        json!({
            "componentType": F32, "type": "VEC3", "count": count,
            "sparse": { "count": 3, "indices": { "bufferView": at, "componentType": U16 },
                        "values": { "bufferView": values } },
        }),
    );
    let indices = glb.indices(&indices);
    json!({
        "attributes": {
            "POSITION": position, "NORMAL": normal, "TEXCOORD_0": st, "COLOR_0": colors, "JOINTS_0": joints,
            "WEIGHTS_0": weights, "_HEAT": heat,
        },
        "targets": [{ "POSITION": moved }],
        "indices": indices, "material": material, "extras": { "id": 7 },
    })
}

fn strip(glb: &mut Glb, material: usize) -> Value {
    let corners: Vec<[f32; 3]> = (0..10)
        .map(|i| [(i / 2) as f32, (i % 2) as f32, (i / 2 % 2) as f32 * 0.5])
        .collect();
    json!({ "attributes": { "POSITION": glb.floats(&corners) }, "mode": 5, "material": material })
}

fn fan(glb: &mut Glb, material: usize) -> Value {
    let mut corners = vec![[0.0, 0.0, 2.0]];
    corners.extend((0..6).map(|i| [(i as f32).cos(), (i as f32).sin(), 2.3]));
    json!({ "attributes": { "POSITION": glb.floats(&corners) }, "mode": 6, "material": material })
}

fn lines(glb: &mut Glb, material: usize) -> Value {
    let corners = glb.floats(&[[0.0, 0.0, 3.0], [1.0, 0.0, 3.0], [1.0, 1.0, 3.0]]);
    let order = glb.indices(&[0, 1, 2]);
    json!({ "attributes": { "POSITION": corners }, "mode": 3, "indices": order, "material": material })
}

/// A node that shows a mesh, bound to two joints, and an animation of both.
fn add_animated(glb: &mut Glb, mesh: usize) {
    let joints = [
        glb.node(json!({ "name": "hip" })),
        glb.node(json!({ "translation": [0, 0, 1] })),
    ];
    let identity = glam::Mat4::IDENTITY.to_cols_array();
    let matrices: Vec<u8> = [identity; 2]
        .concat()
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let matrices = glb.accessor(&matrices, F32, "MAT4", 2);
    let skin = glb.push(
        "skins",
        json!({ "joints": joints, "inverseBindMatrices": matrices }),
    );
    let node = glb.node(json!({ "mesh": mesh, "skin": skin }));
    let times = glb.floats(&[[0.0], [1.5]]);
    let turns = glb.floats(&[[0.0, 0.0, 0.0, 1.0], [0.0, 0.6, 0.0, 0.8]]);
    let weights = glb.floats(&[[0.0], [1.0]]);
    glb.push(
        "animations",
        json!({
            "name": "turn",
            "channels": [
                { "sampler": 0, "target": { "node": joints[0], "path": "rotation" } },
                { "sampler": 1, "target": { "node": node, "path": "weights" } },
            ],
            "samplers": [{ "input": times, "output": turns }, { "input": times, "output": weights }],
        }),
    );
}

/// A file with one mesh of these positions and triangles, and one node for each of `nodes`.
pub(super) fn placed(meshes: &[(&[[f32; 3]], &[u32])], nodes: &[Value]) -> Glb {
    let mut glb = Glb::new();
    for (positions, indices) in meshes {
        let (positions, indices) = (glb.floats(positions), glb.indices(indices));
        let primitive = json!({ "attributes": { "POSITION": positions }, "indices": indices });
        glb.push("meshes", json!({ "primitives": [primitive] }));
    }
    for node in nodes {
        glb.node(node.clone());
    }
    glb
}
