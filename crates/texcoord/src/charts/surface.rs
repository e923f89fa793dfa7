//! Topology of any triangle mesh: which faces count, which of them meet, and where the surface is cut from the start.

use glam::{DVec3, Vec3};

use super::ChartError;

/// No face, no half-edge, no vertex.
pub(crate) const NONE: u32 = u32::MAX;

/// Height over the longest edge at or below which a face has no area: the noise of f32 positions.
const MIN_RELATIVE_HEIGHT: f64 = 1e-6;

/// Which vertices are one point of the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weld {
    /// Vertices with equal positions (−0 equals 0), as a mesh needs whose normals or colours split its vertices.
    #[default]
    ByPosition,
    /// Only vertices with equal indices: borders between indices stay seams.
    ByIndex,
}

/// Why a face is in no chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceFault {
    /// It names a vertex that does not exist.
    MissingVertex,
    /// A corner is NaN or infinite.
    NotFinite,
    /// Its height is at most 10⁻⁶ of its longest edge, or two corners are one point.
    NoArea,
    /// The face of this index has the same corners in the same winding; it lends this one its coordinates.
    DuplicateOf(u32),
}

/// How many faces and edges were not as a manifold has them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SurfaceReport {
    /// Faces with a [`FaceFault::MissingVertex`].
    pub missing_vertex: usize,
    /// Faces with a [`FaceFault::NotFinite`].
    pub not_finite: usize,
    /// Faces with a [`FaceFault::NoArea`].
    pub no_area: usize,
    /// Faces with a [`FaceFault::DuplicateOf`].
    pub duplicate: usize,
    /// Edges that more than two faces share; the surface is cut there.
    pub non_manifold_edges: usize,
    /// Edges whose two faces run along them the same way (their windings differ); the surface is cut there.
    pub inconsistent_edges: usize,
}

/// A triangle mesh as an oriented surface that may be cut, with its faulty faces set aside.
///
/// Half-edge 3·f + k runs from corner k of face f to corner k + 1. Two faces meet where exactly two half-edges join
/// the same points in opposite ways; everywhere else is border. A vertex where several fans touch is one point here
/// and falls apart in the charts, whose vertices are fans.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Positions in units of `extent`, from the lower corner of the box.
    points: Vec<DVec3>,
    /// Points of the faces; of a faulty face all [`NONE`].
    faces: Vec<[u32; 3]>,
    twins: Vec<u32>,
    faults: Vec<Option<FaceFault>>,
    triangles: Vec<[u32; 3]>,
    extent: f64,
    report: SurfaceReport,
}

impl Surface {
    /// Welds vertices, sets faulty faces aside and finds which faces meet.
    ///
    /// `positions`: any values. `triangles`: corners, counter-clockwise seen from the front. Time n·log n.
    ///
    /// # Errors
    /// [`ChartError::TooManyTriangles`] above 2³⁰ triangles or vertices.
    /// # Examples
    /// ```
    /// use glam::Vec3;
    /// use texcoord::charts::{Surface, Weld};
    /// let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NAN];
    /// let surface = Surface::of(&positions, &[[0, 1, 2], [1, 0, 3], [0, 1, 2]], Weld::ByPosition)?;
    /// assert_eq!((surface.report().not_finite, surface.report().duplicate), (1, 1));
    /// # Ok::<(), texcoord::charts::ChartError>(())
    /// ```
    pub fn of(positions: &[Vec3], triangles: &[[u32; 3]], weld: Weld) -> Result<Self, ChartError> {
        let count = positions.len().max(triangles.len());
        if count > 1 << 30 {
            return Err(ChartError::TooManyTriangles { count });
        }
        let welded = match weld {
            Weld::ByPosition => weld_by_position(positions),
            Weld::ByIndex => (0..id(positions.len())).collect(),
        };
        let (low, extent) = bounds(positions);
        let mut surface = Self {
            points: positions
                .iter()
                .map(|p| (p.as_dvec3() - low) / extent)
                .collect(),
            faces: Vec::with_capacity(triangles.len()),
            twins: Vec::new(),
            faults: Vec::with_capacity(triangles.len()),
            triangles: triangles.to_vec(),
            extent,
            report: SurfaceReport::default(),
        };
        for triangle in triangles {
            let (face, fault) = match surface.judge(triangle, &welded) {
                Ok(face) => (face, None),
                Err(fault) => ([NONE; 3], Some(fault)),
            };
            surface.faces.push(face);
            surface.faults.push(fault);
        }
        surface.set_duplicates_aside();
        surface.pair_half_edges();
        surface.count_faults();
        Ok(surface)
    }

    /// What was found wrong.
    #[must_use]
    pub fn report(&self) -> &SurfaceReport {
        &self.report
    }

    /// Why the face is in no chart; nothing for a sound face.
    ///
    /// # Panics
    /// If there is no such face.
    #[must_use]
    pub fn fault(&self, face: u32) -> Option<FaceFault> {
        self.faults[face as usize]
    }

    /// The number of faces, faulty ones included.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The caller's vertices of a face.
    pub(crate) fn triangle(&self, face: u32) -> [u32; 3] {
        self.triangles[face as usize]
    }

    /// For each corner of a duplicate the corner of the first face at the same point.
    pub(crate) fn matching_corners(&self, duplicate: u32, first: u32) -> [usize; 3] {
        let place = |v: u32| self.points[v as usize];
        let (own, other) = (self.triangle(duplicate), self.triangle(first));
        let turn = (0..3).find(|t| (0..3).all(|k| place(own[k]) == place(other[(k + t) % 3])));
        [0, 1, 2].map(|k| (k + turn.unwrap_or(0)) % 3)
    }

    /// Length of the longest side of the box, the unit of [`corner_points`](Self::corner_points).
    pub(crate) fn extent(&self) -> f64 {
        self.extent
    }

    /// Positions of a sound face's corners in units of the extent.
    pub(crate) fn corner_points(&self, face: u32) -> [DVec3; 3] {
        self.faces[face as usize].map(|v| self.points[v as usize])
    }

    /// The half-edge on the other side, or [`NONE`] at a border.
    pub(crate) fn twin(&self, half_edge: u32) -> u32 {
        self.twins[half_edge as usize]
    }

    /// Sound faces in connected pieces, each in ascending order, the pieces by their first face.
    pub(crate) fn pieces(&self) -> Vec<Vec<u32>> {
        let mut seen: Vec<bool> = self.faults.iter().map(Option::is_some).collect();
        let mut pieces = Vec::new();
        for first in 0..self.faces.len() {
            if seen[first] {
                continue;
            }
            seen[first] = true;
            let mut piece = vec![id(first)];
            let mut next = 0;
            while next < piece.len() {
                let face = piece[next];
                next += 1;
                for twin in (3 * face..3 * face + 3).map(|h| self.twin(h)) {
                    if twin != NONE && !seen[(twin / 3) as usize] {
                        seen[(twin / 3) as usize] = true;
                        piece.push(twin / 3);
                    }
                }
            }
            piece.sort_unstable();
            pieces.push(piece);
        }
        pieces
    }

    /// The points of a face, or what is wrong with it.
    fn judge(&self, triangle: &[u32; 3], welded: &[u32]) -> Result<[u32; 3], FaceFault> {
        if triangle.iter().any(|&v| v as usize >= welded.len()) {
            return Err(FaceFault::MissingVertex);
        }
        let face = triangle.map(|v| welded[v as usize]);
        let [a, b, c] = face.map(|v| self.points[v as usize]);
        if !(a + b + c).is_finite() {
            return Err(FaceFault::NotFinite);
        }
        let longest = [b - a, c - b, a - c]
            .iter()
            .fold(0.0, |most: f64, edge| most.max(edge.length()));
        let height = (b - a).cross(c - a).length() / longest;
        let distinct = face[0] != face[1] && face[1] != face[2] && face[2] != face[0];
        if distinct && height > MIN_RELATIVE_HEIGHT * longest {
            Ok(face)
        } else {
            Err(FaceFault::NoArea)
        }
    }

    /// Of faces with the same points in the same winding only the first stays.
    fn set_duplicates_aside(&mut self) {
        let mut keyed: Vec<([u32; 3], u32)> = (0..id(self.faces.len()))
            .zip(&self.faces)
            .filter(|(_, face)| face[0] != NONE)
            .map(|(f, face)| (from_smallest(*face), f))
            .collect();
        keyed.sort_unstable();
        let mut first = ([NONE; 3], NONE);
        for (key, face) in keyed {
            if key == first.0 {
                self.faults[face as usize] = Some(FaceFault::DuplicateOf(first.1));
                self.faces[face as usize] = [NONE; 3];
            } else {
                first = (key, face);
            }
        }
    }

    fn pair_half_edges(&mut self) {
        self.twins = vec![NONE; 3 * self.faces.len()];
        let mut keyed: Vec<(u32, u32, u32)> = Vec::with_capacity(self.twins.len());
        for (h, half_edge) in (0u32..).zip(&self.twins) {
            let face = self.faces[h as usize / 3];
            if face[0] != NONE && *half_edge == NONE {
                let (a, b) = (face[h as usize % 3], face[(h as usize + 1) % 3]);
                keyed.push((a.min(b), a.max(b), h));
            }
        }
        keyed.sort_unstable();
        for group in keyed.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            match *group {
                [_] => {}
                [(.., g), (.., h)] if self.origin(g) != self.origin(h) => {
                    self.twins[g as usize] = h;
                    self.twins[h as usize] = g;
                }
                [_, _] => self.report.inconsistent_edges += 1,
                _ => self.report.non_manifold_edges += 1,
            }
        }
    }

    /// The point where a half-edge starts.
    fn origin(&self, half_edge: u32) -> u32 {
        self.faces[half_edge as usize / 3][half_edge as usize % 3]
    }

    fn count_faults(&mut self) {
        for fault in self.faults.iter().flatten() {
            *match fault {
                FaceFault::MissingVertex => &mut self.report.missing_vertex,
                FaceFault::NotFinite => &mut self.report.not_finite,
                FaceFault::NoArea => &mut self.report.no_area,
                FaceFault::DuplicateOf(_) => &mut self.report.duplicate,
            } += 1;
        }
    }
}

/// An index as u32.
#[allow(
    clippy::cast_possible_truncation,
    reason = "`Surface::of` takes at most 2³⁰ faces, so all counts of corners and edges fit"
)]
pub(crate) fn id(index: usize) -> u32 {
    index as u32
}

/// For each vertex the first, in the order of positions, with the same position.
fn weld_by_position(positions: &[Vec3]) -> Vec<u32> {
    let key = |p: Vec3| (p + Vec3::ZERO).to_array().map(f32::to_bits);
    let mut keyed: Vec<([u32; 3], u32)> =
        (0u32..).zip(positions).map(|(v, &p)| (key(p), v)).collect();
    keyed.sort_unstable();
    let mut welded = vec![0; positions.len()];
    for group in keyed.chunk_by(|a, b| a.0 == b.0) {
        for &(_, v) in group {
            welded[v as usize] = group[0].1;
        }
    }
    welded
}

/// Lower corner and longest side of the box around the finite positions; a side of 1 when there is none.
fn bounds(positions: &[Vec3]) -> (DVec3, f64) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for p in positions.iter().filter(|p| p.is_finite()) {
        low = low.min(p.as_dvec3());
        high = high.max(p.as_dvec3());
    }
    let extent = (high - low).max_element();
    if extent > 0.0 {
        (low, extent)
    } else {
        (DVec3::ZERO, 1.0)
    }
}

/// The same cycle of corners, started at the smallest.
fn from_smallest([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}
