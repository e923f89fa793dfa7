//! Morph targets and skins, applied to the vertices.

use glam::{DMat4, Mat3, Mat4, Vec3};

use super::nodes::Tree;
use super::primitive::{Place, attribute};
use super::{File, accessor};
use crate::error::Error;
use crate::scene::Primitive;

/// Weights of the morph targets: the animation's, the node's or the mesh's, in this order.
pub(super) fn morph_weights(
    node: &gltf::Node,
    mesh: &gltf::Mesh,
    animated: Option<&Vec<f32>>,
) -> Vec<f32> {
    animated
        .cloned()
        .or_else(|| node.weights().map(<[f32]>::to_vec))
        .or_else(|| mesh.weights().map(<[f32]>::to_vec))
        .unwrap_or_default()
}

/// Adds the weighted displacements of the morph targets.
pub(super) fn morph(
    file: &File,
    place: Place,
    source: &gltf::Primitive,
    weights: &[f32],
    made: &mut Primitive,
) -> Result<(), Error> {
    for (target, &weight) in source.morph_targets().zip(weights) {
        if weight == 0.0 {
            continue;
        }
        let vertices = made.positions.len();
        let displacements = |accessor: Option<gltf::Accessor>, name: &str| {
            accessor
                .map(|a| attribute(file, place, name, &a, vertices))
                .transpose()
        };
        if let Some(moves) = displacements(target.positions(), "targets.POSITION")? {
            for (p, d) in made.positions.iter_mut().zip(moves) {
                *p += Vec3::from(d) * weight;
            }
        }
        if let (Some(normals), Some(moves)) = (
            &mut made.normals,
            displacements(target.normals(), "targets.NORMAL")?,
        ) {
            for (n, d) in normals.iter_mut().zip(moves) {
                *n += Vec3::from(d) * weight;
            }
        }
        if let (Some(tangents), Some(moves)) = (
            &mut made.tangents,
            displacements(target.tangents(), "targets.TANGENT")?,
        ) {
            for (t, d) in tangents.iter_mut().zip(moves) {
                *t += (Vec3::from(d) * weight).extend(0.0);
            }
        }
    }
    for normal in made.normals.iter_mut().flatten() {
        *normal = normal.normalize_or_zero();
    }
    Ok(())
}

/// Moves the vertices with the joints of the node's skin, into the world.
pub(super) fn skin(
    file: &File,
    place: Place,
    node: &gltf::Node,
    source: &gltf::Primitive,
    tree: &Tree,
    made: &mut Primitive,
) -> Result<(), Error> {
    let Some(skin) = node.skin() else {
        return Ok(());
    };
    let joints = joint_matrices(file, &skin, tree)?;
    let vertices = made.positions.len();
    let mut blended = vec![Mat4::ZERO; vertices];
    let mut total = vec![0f32; vertices];
    for set in 0.. {
        let (Some(indices), Some(weights)) = (
            source.get(&gltf::Semantic::Joints(set)),
            source.get(&gltf::Semantic::Weights(set)),
        ) else {
            break;
        };
        let indices = accessor::read_u32::<4>(file, &indices)?;
        let weights: Vec<[f32; 4]> = attribute(file, place, "WEIGHTS", &weights, vertices)?;
        for (vertex, (indices, weights)) in indices.iter().zip(&weights).enumerate().take(vertices)
        {
            for (&joint, &weight) in indices.iter().zip(weights) {
                if weight == 0.0 {
                    continue;
                }
                let matrix = joints.get(joint as usize).ok_or_else(|| {
                    file.error(
                        place.attribute("JOINTS"),
                        format!("joint {joint}, and the skin has {}", joints.len()),
                    )
                })?;
                blended[vertex] += *matrix * weight;
                total[vertex] += weight;
            }
        }
    }
    for (vertex, (matrix, total)) in blended.iter().zip(total).enumerate() {
        // A vertex without weights stays with its node.
        let matrix = if total > 0.0 {
            *matrix * (1.0 / total)
        } else {
            tree.world(node.index()).as_mat4()
        };
        made.positions[vertex] = matrix.transform_point3(made.positions[vertex]);
        let linear = Mat3::from_mat4(matrix);
        if let Some(normals) = &mut made.normals {
            normals[vertex] = (cofactors(linear) * normals[vertex]).normalize_or_zero();
        }
        if let Some(tangents) = &mut made.tangents {
            let tangent = tangents[vertex];
            tangents[vertex] = (linear * tangent.truncate())
                .normalize_or_zero()
                .extend(tangent.w);
        }
    }
    Ok(())
}

/// The matrix that carries normals: cofactors, which is the inverse transpose up to scale.
fn cofactors(m: Mat3) -> Mat3 {
    Mat3::from_cols(
        m.y_axis.cross(m.z_axis),
        m.z_axis.cross(m.x_axis),
        m.x_axis.cross(m.y_axis),
    )
}

fn joint_matrices(file: &File, skin: &gltf::Skin, tree: &Tree) -> Result<Vec<Mat4>, Error> {
    let inverse: Vec<[f32; 16]> = match skin.inverse_bind_matrices() {
        Some(accessor) => accessor::read_f32::<16>(file, &accessor)?,
        None => Vec::new(),
    };
    Ok(skin
        .joints()
        .enumerate()
        .map(|(i, joint)| {
            let bind = inverse.get(i).map_or(DMat4::IDENTITY, |m| {
                DMat4::from_cols_array(&m.map(f64::from))
            });
            (tree.world(joint.index()) * bind).as_mat4()
        })
        .collect())
}
