//! Faces as Vulkan and OpenGL define them, seen from inside the cube, s to the right and t down:
//!
//! ```text
//!             +----+
//!             | +Y |             on each face, s and t grow along:
//!        +----+----+----+----+     +X: −z −y    −X: +z −y
//!        | −X | +Z | +X | −Z |     +Y: +x +z    −Y: +x −z
//!        +----+----+----+----+     +Z: +x −y    −Z: −x −y
//!             | −Y |
//!             +----+             (a left-handed picture: the cube is seen from within as if from outside)
//! ```

use glam::{IVec2, UVec2, Vec2, Vec3};

/// A face of a cube map, named by the axis it is centred on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum CubeFace {
    /// Centred on +X.
    PosX,
    /// Centred on −X.
    NegX,
    /// Centred on +Y, the top.
    PosY,
    /// Centred on −Y, the bottom.
    NegY,
    /// Centred on +Z.
    PosZ,
    /// Centred on −Z.
    NegZ,
}

impl CubeFace {
    /// All faces in storage order, which is also that of the enum's values.
    pub const ALL: [Self; 6] = [
        Self::PosX,
        Self::NegX,
        Self::PosY,
        Self::NegY,
        Self::PosZ,
        Self::NegZ,
    ];

    /// Centre of the face, and the directions in which s and t grow.
    const fn axes(self) -> [Vec3; 3] {
        match self {
            Self::PosX => [Vec3::X, Vec3::NEG_Z, Vec3::NEG_Y],
            Self::NegX => [Vec3::NEG_X, Vec3::Z, Vec3::NEG_Y],
            Self::PosY => [Vec3::Y, Vec3::X, Vec3::Z],
            Self::NegY => [Vec3::NEG_Y, Vec3::X, Vec3::NEG_Z],
            Self::PosZ => [Vec3::Z, Vec3::X, Vec3::NEG_Y],
            Self::NegZ => [Vec3::NEG_Z, Vec3::NEG_X, Vec3::NEG_Y],
        }
    }

    /// The texel that touches texel `ij` of a face of `size`² texels from outside, where `ij` is one step beyond one
    /// edge: its face and its index there. Texels of this face give themselves; beyond two edges at once, where
    /// three faces meet, there is none.
    ///
    /// # Source
    /// Direct3D 11.3 functional specification, 7.18.12 (edges and corners).
    /// # Examples
    /// ```
    /// use glam::{IVec2, UVec2};
    /// use sampler::cube::CubeFace;
    /// // To the right of +Z lies +X.
    /// let neighbour = CubeFace::PosZ.touching(4, IVec2::new(4, 2));
    /// assert_eq!(neighbour, Some((CubeFace::PosX, UVec2::new(0, 2))));
    /// ```
    pub fn touching(self, size: u32, ij: IVec2) -> Option<(Self, UVec2)> {
        let n = i32::try_from(size).ok()?;
        let inside = |k: i32| (0..n).contains(&k);
        match (inside(ij.x), inside(ij.y)) {
            (true, true) => Some((self, ij.as_uvec2())),
            (false, false) => None,
            _ => {
                // Texel centres on the cube [−n, n]³ have odd or even coordinates of one kind; all integers.
                let [centre, s, t] = self.axes().map(|axis| axis.as_ivec3());
                let along = 2 * ij + 1 - n;
                let beyond = if inside(ij.x) {
                    t * along.y.signum()
                } else {
                    s * along.x.signum()
                };
                let kept = if inside(ij.x) {
                    s * along.x
                } else {
                    t * along.y
                };
                // Over the edge: the neighbour's plane, one half texel below this face's.
                let point = beyond * n + kept + centre * (n - 1);
                let neighbour = Self::ALL
                    .into_iter()
                    .find(|face| face.axes()[0].as_ivec3() == beyond)?;
                let [_, s, t] = neighbour.axes().map(|axis| axis.as_ivec3());
                let ij = (IVec2::new(point.dot(s), point.dot(t)) + n - 1) / 2;
                Some((neighbour, ij.as_uvec2()))
            }
        }
    }

    /// The point of the cube [−1, 1]³ at `st` of this face; st beyond 0..1 continues in the face's plane.
    #[inline]
    pub fn point(self, st: Vec2) -> Vec3 {
        let [centre, s, t] = self.axes();
        centre + s * (2.0 * st.x - 1.0) + t * (2.0 * st.y - 1.0)
    }
}

/// The cube face that a direction meets, and where on it.
///
/// The face is that of the component of largest magnitude; among equals z wins, then y, then x. On it, with (sc, tc)
/// the components along the face's axes and m the largest: s = (sc/|m| + 1)/2, t = (tc/|m| + 1)/2, in \[0, 1\].
///
/// `direction`: any length. A zero or non-finite direction gives the centre of +Z.
///
/// # Accuracy
/// Within 1.2e-7 in s and t; checked by `tests/properties/cube.rs`.
/// # Source
/// Vulkan 1.3, "Cube Map Face Selection" and "Cube Map Coordinate Transformation".
/// # Examples
/// ```
/// use sampler::cube::CubeFace;
/// use glam::{Vec2, Vec3};
/// let (face, st) = sampler::cube::direction_to_cube(Vec3::new(2.0, 0.0, -1.0));
/// assert_eq!((face, st), (CubeFace::PosX, Vec2::new(0.75, 0.5)));
/// ```
#[inline]
pub fn direction_to_cube(direction: Vec3) -> (CubeFace, Vec2) {
    let magnitude = direction.abs();
    let d = direction;
    let (face, st, m) = if magnitude.z >= magnitude.x && magnitude.z >= magnitude.y {
        if d.z >= 0.0 {
            (CubeFace::PosZ, Vec2::new(d.x, -d.y), magnitude.z)
        } else {
            (CubeFace::NegZ, Vec2::new(-d.x, -d.y), magnitude.z)
        }
    } else if magnitude.y >= magnitude.x {
        if d.y >= 0.0 {
            (CubeFace::PosY, Vec2::new(d.x, d.z), magnitude.y)
        } else {
            (CubeFace::NegY, Vec2::new(d.x, -d.z), magnitude.y)
        }
    } else if d.x >= 0.0 {
        (CubeFace::PosX, Vec2::new(-d.z, -d.y), magnitude.x)
    } else {
        (CubeFace::NegX, Vec2::new(d.z, -d.y), magnitude.x)
    };
    let st = st / m * 0.5 + 0.5;
    if st.is_finite() {
        (face, st)
    } else {
        (CubeFace::PosZ, Vec2::splat(0.5))
    }
}

/// The unit direction at `st` of a cube face; the inverse of [`direction_to_cube`].
///
/// `st`: 0..=1 on the face; beyond, the face's plane continues. Non-finite input gives non-finite output.
///
/// # Accuracy
/// Within 2e-7; checked by `tests/properties/cube.rs`.
/// # Examples
/// ```
/// use sampler::cube::CubeFace;
/// use glam::{Vec2, Vec3};
/// assert_eq!(sampler::cube::cube_to_direction(CubeFace::NegY, Vec2::splat(0.5)), Vec3::NEG_Y);
/// ```
pub fn cube_to_direction(face: CubeFace, st: Vec2) -> Vec3 {
    face.point(st).normalize()
}
