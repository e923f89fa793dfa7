use glam::{DMat3, DVec3};

use super::mapped_point::{Lookups, SlopedCoordinate};
use super::surface_point::SlopedPoint;
use super::{BackFacets, CubeFace, Facets, MappedPoint, MappingError, SurfacePoint};
use crate::dual::{Dual, DualVec3};

/// The projections of [`Facets`] along all three axes, blended by how much the normal looks along each.
///
/// ```text
///   wᵢ = |nᵢ|ᵏ / Σⱼ |nⱼ|ᵏ
/// ```
///
/// k is the sharpness: 1 blends everywhere, large values come near [`Facets`]. A normal that is zero or not finite
/// gives each plane 1/3.
///
/// A normal map is read once per plane, in the plane's own frame [T, B, outward] of [`Facets::frame`] for the face that
/// the point reports. Carried into mapping space and blended there, the result is Σ wᵢ·(T·x + B·y + outward·z), then
/// normalised. Where the surface's own normal n should stay visible it is n + Σ wᵢ·(T·x + B·y), its tangential part.
///
/// # Accuracy
/// Weights within 2⁻⁵⁰ relative for k ≤ 8; they sum to 1 within 2⁻⁵¹.
/// # Source
/// Geiss 2007, "Generating Complex Procedural Terrains Using the GPU" (GPU Gems 3, chapter 1), section 1.5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triplanar {
    sharpness: f64,
    facets: Facets,
}

/// The three coordinates of a point and their weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriplanarPoint {
    /// The coordinate on the plane across x, y and z, with its face.
    pub planes: [MappedPoint; 3],
    /// Weights in 0..=1.
    pub weights: DVec3,
    /// ∂(weights)/∂N; column k belongs to axis k.
    pub weights_by_normal: DMat3,
}

impl Triplanar {
    /// A blend of `sharpness` in 1..=1024.
    ///
    /// # Errors
    /// [`MappingError::Sharpness`] beyond that.
    pub fn new(sharpness: f64, backs: BackFacets) -> Result<Self, MappingError> {
        if (1.0..=1024.0).contains(&sharpness) {
            Ok(Self {
                sharpness,
                facets: Facets { backs },
            })
        } else {
            Err(MappingError::Sharpness { value: sharpness })
        }
    }

    /// The projections that are blended, with their frames.
    #[must_use]
    pub fn facets(&self) -> Facets {
        self.facets
    }

    /// The coordinates and weights of a point. `None` for a position that is not finite.
    ///
    /// # Examples
    /// ```
    /// use glam::DVec3;
    /// use texcoord::mapping::{BackFacets, Triplanar};
    /// let blend = Triplanar::new(2.0, BackFacets::Readable)?;
    /// let mapped = blend.at(DVec3::ONE, DVec3::new(3.0, 0.0, 4.0)).unwrap();
    /// assert!((mapped.weights - DVec3::new(0.36, 0.0, 0.64)).length() < 1e-15);
    /// # Ok::<(), texcoord::mapping::MappingError>(())
    /// ```
    #[must_use]
    pub fn at(&self, position: DVec3, normal: DVec3) -> Option<TriplanarPoint> {
        let at = SurfacePoint::new(position, normal).along_axes();
        let planes = self.planes(&at);
        let [x, y, z] = planes.map(|plane| plane.map(MappedPoint::from));
        let weights = self.weights(at.normal);
        Some(TriplanarPoint {
            planes: [x?, y?, z?],
            weights: weights.value(),
            weights_by_normal: DMat3::from_cols(
                weights.slope(3),
                weights.slope(4),
                weights.slope(5),
            ),
        })
    }

    /// The coordinate on each plane.
    fn planes<const N: usize>(&self, at: &SlopedPoint<N>) -> [Option<SlopedCoordinate<N>>; 3] {
        let normal = at.normal.value();
        DVec3::AXES.map(|axis| {
            let along = normal.dot(axis);
            let face = CubeFace::toward(if along < 0.0 { -axis } else { axis });
            self.facets.evaluate(at.position, face)
        })
    }

    /// A lookup for each plane with a weight above 0.
    pub(super) fn lookups(&self, at: &SlopedPoint<2>) -> Lookups {
        let weights = self.weights(at.normal).value();
        let planes = self.planes(at);
        Lookups::three(core::array::from_fn(|k| {
            planes[k]
                .filter(|_| weights[k] > 0.0)
                .map(|plane| plane.weighted(weights[k]))
        }))
    }

    fn weights<const N: usize>(&self, normal: DualVec3<N>) -> DualVec3<N> {
        let largest = normal.value().abs().max_element();
        if !(largest > 0.0 && normal.value().is_finite()) {
            return DualVec3::constant(DVec3::splat(1.0 / 3.0));
        }
        let powers = normal.map(|n| self.power(n.abs() / largest));
        let sum = powers.x + powers.y + powers.z;
        powers.map(|power| power / sum)
    }

    /// x to the power of the sharpness, 0 ≤ x ≤ 1.
    fn power<const N: usize>(&self, x: Dual<N>) -> Dual<N> {
        let below = libm::pow(x.value, self.sharpness - 1.0);
        x.through(libm::pow(x.value, self.sharpness), self.sharpness * below)
    }
}
