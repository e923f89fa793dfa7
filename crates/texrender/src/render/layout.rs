//! Which attributes the shading of a surface reads, and where they lie in the records of its triangles.

use mipmap::packet::PackedPyramid;

use super::textures::SharedTaps;
use crate::plan::{Curvature, Kernel, Lighting, TangentSource};
use crate::scene::Coordinates;

/// Rows of four that hold the edge functions and 1/w.
pub(super) const EDGE_ROWS: usize = 3;

/// Attributes of a triangle's corners as rows of four numbers, wide (f64) and narrow (f32); what a surface does not
/// read has no row.
///
/// ```text
/// wide    (a, b, c, 1/w) a corner      narrow   (nx, ny, nz, side) a corner, or one row for a flat surface
///         (x, x, x, ·) an axis                  (tx, ty, tz, handedness) a corner
///         (s₀, s₁−s₀, s₂−s₀, ·) s, t a set      (r, g, b, a) a corner
/// ```
#[derive(Debug, Default)]
pub(super) struct Layout {
    /// Sets of texture coordinates that are read.
    pub sets: Vec<usize>,
    /// Mappings that are read; they look at positions and normals.
    pub mappings: Vec<usize>,
    pub normals: Normals,
    pub tangents: Option<TangentSource>,
    pub colors: bool,
    pub positions: bool,
    /// Whether points of the surface are asked for one by one.
    pub surface: bool,
    pub shared: SharedTaps,
}

/// How many normals a triangle has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Normals {
    /// None that anybody reads.
    #[default]
    Unread,
    /// One.
    Flat,
    /// One a corner.
    Smooth,
}

impl Normals {
    fn of(curvature: Curvature) -> Self {
        match curvature {
            Curvature::Flat => Self::Flat,
            Curvature::Smooth => Self::Smooth,
        }
    }
}

/// What a picture asks of its surfaces beside their colour.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wants {
    /// Whether a light's direction depends on the place.
    pub near_lights: bool,
    /// Whether AOVs are kept.
    pub values: bool,
}

impl Layout {
    /// For the colour of a surface; `sheets`: all of the picture.
    pub(super) fn of(kernel: &Kernel, wants: Wants, sheets: &[PackedPyramid]) -> Self {
        let lit = match &kernel.lighting {
            Lighting::Lit(lit) => Some(lit),
            Lighting::Unlit => None,
        };
        let normals = match kernel.curvature {
            _ if lit.is_none() && !wants.values => Normals::Unread,
            curvature => Normals::of(curvature),
        };
        let tangents = lit.and_then(|lit| lit.normal.as_ref().map(|(_, _, source)| *source));
        let mut layout = Self {
            normals,
            tangents: tangents.filter(|source| *source != TangentSource::Mapping),
            colors: kernel.vertex_colors,
            positions: wants.values || (wants.near_lights && lit.is_some()),
            ..Self::default()
        };
        if wants.values {
            layout.sets.push(0);
        }
        for map in kernel.maps() {
            layout.read_coordinates(kernel, map.coordinates);
            layout.shared.add(map, sheets);
        }
        if let Some(shown) = &kernel.shown {
            layout.read_surface(kernel);
            if let Some(coordinates) = shown.coordinates {
                layout.read_coordinates(kernel, coordinates);
            }
        }
        layout
    }

    /// For the alpha of a surface.
    pub(super) fn of_alpha(kernel: &Kernel, sheets: &[PackedPyramid]) -> Self {
        let mut layout = Self {
            colors: kernel.vertex_colors,
            ..Self::default()
        };
        if let Some(map) = &kernel.base_color_map {
            layout.read_coordinates(kernel, map.coordinates);
            layout.shared.add(map, sheets);
        }
        layout
    }

    fn read_coordinates(&mut self, kernel: &Kernel, coordinates: Coordinates) {
        match coordinates {
            Coordinates::Set(set) if !self.sets.contains(&set) => self.sets.push(set),
            Coordinates::Set(_) => {}
            Coordinates::Mapping(mapping) => {
                if !self.mappings.contains(&mapping) {
                    self.mappings.push(mapping);
                }
                self.read_surface(kernel);
            }
        }
    }

    /// Where points lie on the surface: positions and normals.
    fn read_surface(&mut self, kernel: &Kernel) {
        self.surface = true;
        self.positions = true;
        self.normals = Normals::of(kernel.curvature);
    }

    /// Wide rows of a record.
    pub(super) fn wide_rows(&self) -> usize {
        self.set_row(self.sets.len())
    }

    /// Narrow rows of a record.
    pub(super) fn narrow_rows(&self) -> usize {
        self.color_row() + if self.colors { 3 } else { 0 }
    }

    /// First wide row of the positions.
    pub(super) fn position_row(&self) -> usize {
        EDGE_ROWS
    }

    /// First wide row of the set at `place` in [`Self::sets`].
    pub(super) fn set_row(&self, place: usize) -> usize {
        EDGE_ROWS + if self.positions { 3 } else { 0 } + 2 * place
    }

    /// First narrow row of the tangents; normals come first of all.
    pub(super) fn tangent_row(&self) -> usize {
        match self.normals {
            Normals::Unread => 0,
            Normals::Flat => 1,
            Normals::Smooth => 3,
        }
    }

    /// First narrow row of the vertex colours.
    pub(super) fn color_row(&self) -> usize {
        self.tangent_row() + if self.tangents.is_some() { 3 } else { 0 }
    }
}
