//! The node hierarchy: where everything stands.

use std::collections::HashMap;

use glam::{DMat4, DQuat, DVec3, Vec3};
use gltf::camera::Projection as GltfProjection;
use gltf::khr_lights_punctual::Kind;
use gltf::scene::Transform;
use shading::{LightKind, PunctualLight};

use super::animation::{self, Pose};
use super::{File, pose, primitive};
use crate::error::Error;
use crate::scene::{Camera, Instance, Projection, Scene};

/// World transforms of all nodes at the moment that is read.
pub(crate) struct Tree {
    world: Vec<DMat4>,
    /// Nodes of the scene, parents before children, in the order of the file.
    visible: Vec<usize>,
    pose: Pose,
}

impl Tree {
    /// Walks the hierarchy.
    pub(crate) fn new(file: &File) -> Result<Self, Error> {
        let nodes: Vec<gltf::Node> = file.document.nodes().collect();
        let children: Vec<Vec<usize>> = nodes
            .iter()
            .map(|n| n.children().map(|c| c.index()).collect())
            .collect();
        let roots = roots(file, &children)?;
        let pose = animation::pose(file)?;

        let mut world = vec![DMat4::IDENTITY; nodes.len()];
        for index in depth_first(&roots, &children) {
            let local = pose.local(&nodes[index]);
            // The walk meets a parent before its children, so world[index] holds the parent's by now.
            world[index] *= local;
            for &child in &children[index] {
                world[child] = world[index];
            }
        }
        let shown: Vec<usize> = match file
            .document
            .default_scene()
            .or_else(|| file.document.scenes().next())
        {
            Some(scene) => scene.nodes().map(|n| n.index()).collect(),
            None => roots,
        };
        let visible = depth_first(&shown, &children);
        Ok(Self {
            world,
            visible,
            pose,
        })
    }

    /// The nodes to draw, by index.
    pub(super) fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.visible.iter().copied()
    }

    /// From a node's space to the world.
    pub(crate) fn world(&self, node: usize) -> DMat4 {
        self.world[node]
    }
}

/// Nodes without a parent; an error unless the nodes form trees.
fn roots(file: &File, children: &[Vec<usize>]) -> Result<Vec<usize>, Error> {
    let mut parent = vec![None; children.len()];
    for (index, list) in children.iter().enumerate() {
        for &child in list {
            if let Some(first) = parent[child].replace(index) {
                return Err(file.error(
                    format!("nodes[{index}].children"),
                    format!("node {child} is also a child of node {first}; nodes must form a tree"),
                ));
            }
        }
    }
    let roots: Vec<usize> = (0..children.len())
        .filter(|&i| parent[i].is_none())
        .collect();
    let mut reached = vec![false; children.len()];
    for index in depth_first(&roots, children) {
        reached[index] = true;
    }
    match reached.iter().position(|r| !r) {
        None => Ok(roots),
        Some(index) => Err(file.error(
            format!("nodes[{index}]"),
            "is its own ancestor; nodes must form a tree",
        )),
    }
}

/// Nodes under `roots`, parents first. `children` must be acyclic below them.
fn depth_first(roots: &[usize], children: &[Vec<usize>]) -> Vec<usize> {
    let mut order = Vec::new();
    let mut stack: Vec<usize> = roots.iter().rev().copied().collect();
    while let Some(index) = stack.pop() {
        order.push(index);
        stack.extend(children[index].iter().rev());
    }
    order
}

impl Pose {
    /// A node's own transform, with what the animation says of it.
    fn local(&self, node: &gltf::Node) -> DMat4 {
        let moved = self.nodes.get(&node.index());
        if let (Transform::Matrix { matrix }, None) = (node.transform(), moved) {
            return DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)));
        }
        let (t, r, s) = node.transform().decomposed();
        let rest = (
            DVec3::from(t.map(f64::from)),
            DQuat::from_array(r.map(f64::from)),
            DVec3::from(s.map(f64::from)),
        );
        let moved = moved.copied().unwrap_or_default();
        DMat4::from_scale_rotation_translation(
            moved.scale.unwrap_or(rest.2),
            moved.rotation.unwrap_or(rest.1).normalize(),
            moved.translation.unwrap_or(rest.0),
        )
    }
}

/// Primitives of a mesh that several nodes may share, by mesh and primitive index.
pub(super) type ReadPrimitives = HashMap<(usize, usize), Option<usize>>;

/// Adds what hangs on a node: mesh, camera, light.
pub(super) fn add_to_scene(
    file: &File,
    tree: &Tree,
    index: usize,
    read: &mut ReadPrimitives,
    scene: &mut Scene,
) -> Result<(), Error> {
    let Some(node) = file.document.nodes().nth(index) else {
        return Ok(());
    };
    let world = tree.world(index);
    if let Some(mesh) = node.mesh() {
        add_mesh(file, tree, &node, &mesh, read, scene)?;
    }
    if let Some(camera) = node.camera() {
        scene.cameras.push(Camera {
            name: camera.name().or(node.name()).unwrap_or_default().to_owned(),
            world,
            projection: projection(file, &camera)?,
        });
    }
    if let Some(light) = node.light() {
        scene.lights.push(punctual(&light, world));
    }
    Ok(())
}

fn add_mesh(
    file: &File,
    tree: &Tree,
    node: &gltf::Node,
    mesh: &gltf::Mesh,
    read: &mut ReadPrimitives,
    scene: &mut Scene,
) -> Result<(), Error> {
    let weights = pose::morph_weights(node, mesh, tree.pose.weights.get(&node.index()));
    let name = node.name().or(mesh.name()).unwrap_or_default();
    for source in mesh.primitives() {
        let posed = node.skin().is_some() || weights.iter().any(|&w| w != 0.0);
        let key = (mesh.index(), source.index());
        let slot = match read.get(&key) {
            Some(&slot) if !posed => slot,
            _ => {
                let place = primitive::Place {
                    mesh: mesh.index(),
                    primitive: source.index(),
                };
                let mut made = primitive::read(file, place, &source)?;
                if let (Some(made), true) = (made.as_mut(), posed) {
                    pose::morph(file, place, &source, &weights, made)?;
                    pose::skin(file, place, node, &source, tree, made)?;
                }
                let slot = made.map(|mut made| {
                    made.name = mesh.name().unwrap_or_default().to_owned();
                    scene.primitives.push(made);
                    scene.primitives.len() - 1
                });
                if !posed {
                    read.insert(key, slot);
                }
                slot
            }
        };
        if let Some(primitive) = slot {
            let skinned = node.skin().is_some();
            scene.instances.push(Instance {
                name: name.to_owned(),
                primitive,
                // A skin has placed its vertices in the world already.
                world: if skinned {
                    DMat4::IDENTITY
                } else {
                    tree.world(node.index())
                },
            });
        }
    }
    Ok(())
}

fn projection(file: &File, camera: &gltf::Camera) -> Result<Projection, Error> {
    let projection = match camera.projection() {
        GltfProjection::Perspective(p) => Projection::Perspective {
            fov_y_radians: p.yfov().into(),
            near: p.znear().into(),
            far: p.zfar().map(f64::from),
        },
        GltfProjection::Orthographic(o) => Projection::Orthographic {
            half_width: o.xmag().abs().into(),
            half_height: o.ymag().abs().into(),
            near: o.znear().into(),
            far: o.zfar().into(),
        },
    };
    let sound = match projection {
        Projection::Perspective {
            fov_y_radians,
            near,
            far,
        } => {
            fov_y_radians > 0.0
                && fov_y_radians < std::f64::consts::PI
                && near > 0.0
                && far.is_none_or(|far| far > near)
        }
        Projection::Orthographic {
            half_width,
            half_height,
            near,
            far,
        } => half_width > 0.0 && half_height > 0.0 && near >= 0.0 && far > near,
    };
    if sound {
        Ok(projection)
    } else {
        Err(file.error(
            format!("cameras[{}]", camera.index()),
            "needs 0 < yfov < π, 0 < znear < zfar, and xmag and ymag other than 0",
        ))
    }
}

fn punctual(light: &gltf::khr_lights_punctual::Light, world: DMat4) -> PunctualLight {
    let kind = match light.kind() {
        Kind::Directional => LightKind::Directional,
        Kind::Point => LightKind::Point,
        Kind::Spot {
            inner_cone_angle,
            outer_cone_angle,
        } => LightKind::Spot {
            inner_cone_radians: inner_cone_angle,
            outer_cone_radians: outer_cone_angle,
        },
    };
    PunctualLight {
        kind,
        intensity: Vec3::from(light.color()) * light.intensity(),
        position: world.w_axis.truncate().as_vec3(),
        direction: (-world.z_axis.truncate())
            .try_normalize()
            .unwrap_or(DVec3::NEG_Z)
            .as_vec3(),
        range: light.range(),
    }
}
