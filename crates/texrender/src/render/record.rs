//! What shading reads of a triangle, laid out once for all of its pixels in a tile.

use glam::{DVec2, DVec3, Vec2, Vec3, Vec4};
use raster::{Facing, Triangle};

use super::frame::Frame;
use super::layout::{Layout, Normals};
use crate::plan::{Draw, TangentSource, Winding};
use crate::scene::{Primitive, Topology};

/// Records of a few triangles, each as its [`Layout`] says.
#[derive(Debug, Default)]
pub(super) struct Records {
    pub wide: Vec<[f64; 4]>,
    pub narrow: Vec<[f32; 4]>,
    /// Draw of each.
    pub draws: Vec<usize>,
}

impl Records {
    pub(super) fn clear(&mut self) {
        self.wide.clear();
        self.narrow.clear();
        self.draws.clear();
    }

    /// Keeps record `last` alone, as the first.
    pub(super) fn keep(&mut self, last: usize, layout: &Layout) {
        let (wide, narrow) = (layout.wide_rows(), layout.narrow_rows());
        self.wide.copy_within(last * wide..(last + 1) * wide, 0);
        self.wide.truncate(wide);
        self.narrow
            .copy_within(last * narrow..(last + 1) * narrow, 0);
        self.narrow.truncate(narrow);
        self.draws.swap(0, last);
        self.draws.truncate(1);
    }

    /// Adds the record of a triangle of a draw.
    pub(super) fn push(
        &mut self,
        frame: &Frame,
        layout: &Layout,
        draw: usize,
        triangle: &Triangle,
    ) {
        self.draws.push(draw);
        let planes = triangle.planes();
        let corners = Corners::new(frame, draw, triangle, planes.piece);
        for (edge, inv_w) in planes.edges.iter().zip(planes.inv_w) {
            self.wide.push([edge[0], edge[1], edge[2], inv_w]);
        }
        if layout.positions {
            let [a, b, c] = corners.positions();
            (0..3).for_each(|axis| self.wide.push([a[axis], b[axis], c[axis], 0.0]));
        }
        for &set in &layout.sets {
            let [a, b, c] = corners.texture_coordinates(set);
            let (toward_1, toward_2) = (b - a, c - a);
            (0..2).for_each(|k| self.wide.push([a[k], toward_1[k], toward_2[k], 0.0]));
        }
        self.push_directions(layout, &corners, triangle.facing());
        if layout.colors {
            let colors = corners.colors();
            self.narrow.extend(colors.map(|color| color.to_array()));
        }
    }

    fn push_directions(&mut self, layout: &Layout, corners: &Corners, facing: Facing) {
        let side = match facing {
            Facing::Front => 1.0,
            Facing::Back => -1.0,
        };
        match layout.normals {
            Normals::Unread => {}
            Normals::Flat => self
                .narrow
                .push(corners.flat_normal().extend(side).to_array()),
            Normals::Smooth => {
                let normals = corners.normals();
                self.narrow
                    .extend(normals.map(|n| n.extend(side).to_array()));
            }
        }
        if let Some(source) = layout.tangents {
            let (tangents, handedness) = corners.tangents(source);
            self.narrow
                .extend(tangents.map(|t| t.extend(handedness).to_array()));
        }
    }
}

/// The corners of a triangle on the screen, with their vertices at hand.
struct Corners<'a> {
    frame: &'a Frame<'a>,
    draw_index: usize,
    draw: &'a Draw,
    primitive: &'a Primitive,
    element: usize,
    vertices: [usize; 3],
    /// Where the corners lie in the element, if clipping moved them.
    piece: Option<[DVec3; 3]>,
}

impl<'a> Corners<'a> {
    fn new(
        frame: &'a Frame<'a>,
        draw_index: usize,
        triangle: &Triangle,
        piece: Option<[DVec3; 3]>,
    ) -> Self {
        let draw = &frame.plan.draws[draw_index];
        let primitive = &frame.scene.primitives[draw.primitive];
        let element = triangle.source() as usize;
        let indices = primitive.indices[element];
        let corners = match draw.topology {
            Topology::Triangles => draw.winding.corners(indices),
            Topology::Lines | Topology::Points => indices,
        };
        Self {
            frame,
            draw_index,
            draw,
            primitive,
            element,
            vertices: corners.map(|v| v as usize),
            piece,
        }
    }

    fn at<T: Copy>(&self, attribute: &[T]) -> [T; 3] {
        self.vertices.map(|v| attribute[v])
    }

    /// Values at the element's corners → values at the triangle's.
    fn cut<T>(&self, values: [T; 3]) -> [T; 3]
    where
        T: Copy + core::ops::Mul<f64, Output = T> + core::ops::Add<Output = T>,
    {
        let [a, b, c] = values;
        match &self.piece {
            None => values,
            Some(piece) => piece.map(|w| a * w.x + b * w.y + c * w.z),
        }
    }

    fn cut_vec3(&self, values: [Vec3; 3]) -> [Vec3; 3] {
        match self.piece {
            None => values,
            Some(_) => self.cut(values.map(Vec3::as_dvec3)).map(|v| v.as_vec3()),
        }
    }

    /// In the world.
    fn positions(&self) -> [DVec3; 3] {
        let world = |p: Vec3| self.draw.world.transform_point3(p.as_dvec3());
        self.cut(self.at(&self.primitive.positions).map(world))
    }

    fn texture_coordinates(&self, set: usize) -> [DVec2; 3] {
        let set = self.primitive.texcoords.get(set);
        let st = set.map_or([Vec2::ZERO; 3], |set| self.at(set));
        self.cut(st.map(Vec2::as_dvec2))
    }

    /// Linear.
    fn colors(&self) -> [Vec4; 3] {
        let colors = self.primitive.colors.as_ref();
        let colors = colors.map_or([Vec4::ONE; 3], |colors| self.at(colors));
        match self.piece {
            None => colors,
            Some(_) => self.cut(colors.map(Vec4::as_dvec4)).map(|v| v.as_vec4()),
        }
    }

    /// In the world, not normalised.
    fn normals(&self) -> [Vec3; 3] {
        let normals = self.primitive.normals.as_ref();
        let normals = normals.map_or([Vec3::Z; 3], |normals| self.at(normals));
        self.cut_vec3(normals.map(|n| self.draw.normal_matrix * n))
    }

    /// Unit, of the element's plane.
    fn flat_normal(&self) -> Vec3 {
        let world = |p: Vec3| self.draw.world.transform_point3(p.as_dvec3());
        let [a, b, c] = self.at(&self.primitive.positions).map(world);
        let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
        normal.try_normalize().unwrap_or(Vec3::Z)
    }

    /// In the world, each as long as in the file; and the handedness of the frame there.
    fn tangents(&self, source: TangentSource) -> ([Vec3; 3], f32) {
        let tangents: [Vec4; 3] = match (source, &self.primitive.tangents) {
            (TangentSource::Generated(index), _) => {
                // Stored for the corners in the file's order.
                let corners = self.frame.resources.tangents[index][self.element];
                self.draw.winding.corners(corners)
            }
            (TangentSource::File, Some(tangents)) => self.at(tangents),
            (TangentSource::File, None) | (TangentSource::Mapping, _) => [Vec4::ZERO; 3],
        };
        // A mirrored node turns the bitangent that a cross product makes of mirrored axes.
        let mirrored = match self.draw.winding {
            Winding::Kept => 1.0,
            Winding::Reversed => -1.0,
        };
        let linear = &self.frame.linear[self.draw_index];
        let world = |tangent: Vec4| {
            let local = tangent.truncate();
            (*linear * local).normalize_or_zero() * local.length()
        };
        (self.cut_vec3(tangents.map(world)), tangents[0].w * mirrored)
    }
}
