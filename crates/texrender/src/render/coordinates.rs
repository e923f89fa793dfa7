//! Texture coordinates of sixteen pixels.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};
use texcoord::AffineTransform;
use texcoord::packet::F64x16;

/// Texture coordinates with their screen derivatives.
#[derive(Clone, Copy)]
pub(super) struct Coordinates<S: Simd> {
    pub s: F64x16<S>,
    pub t: F64x16<S>,
    pub ds_dx: f32x16<S>,
    pub dt_dx: f32x16<S>,
    pub ds_dy: f32x16<S>,
    pub dt_dy: f32x16<S>,
}

impl<S: Simd> Coordinates<S> {
    /// With the transform of a map applied.
    #[inline(always)]
    pub(super) fn placed(self, simd: S, transform: Option<&AffineTransform>) -> Self {
        match transform {
            Some(transform) => self.transformed(simd, transform),
            None => self,
        }
    }

    #[inline(always)]
    pub(super) fn zero(simd: S) -> Self {
        let (wide, narrow) = (F64x16::splat(simd, 0.0), f32x16::splat(simd, 0.0));
        Self {
            s: wide,
            t: wide,
            ds_dx: narrow,
            dt_dx: narrow,
            ds_dy: narrow,
            dt_dy: narrow,
        }
    }

    #[inline(always)]
    pub(super) fn scale(&mut self, footprint: f32) {
        self.ds_dx *= footprint;
        self.dt_dx *= footprint;
        self.ds_dy *= footprint;
        self.dt_dy *= footprint;
    }

    /// [`AffineTransform::apply`].
    #[inline(always)]
    fn transformed(&self, simd: S, transform: &AffineTransform) -> Self {
        let matrix = &transform.matrix;
        let linear = matrix.matrix2.as_mat2();
        let (along_s, along_t) = (linear.x_axis, linear.y_axis);
        Self {
            s: self.moved(
                simd,
                [
                    matrix.matrix2.x_axis.x,
                    matrix.matrix2.y_axis.x,
                    matrix.translation.x,
                ],
            ),
            t: self.moved(
                simd,
                [
                    matrix.matrix2.x_axis.y,
                    matrix.matrix2.y_axis.y,
                    matrix.translation.y,
                ],
            ),
            ds_dx: self.ds_dx * along_s.x + self.dt_dx * along_t.x,
            dt_dx: self.ds_dx * along_s.y + self.dt_dx * along_t.y,
            ds_dy: self.ds_dy * along_s.x + self.dt_dy * along_t.x,
            dt_dy: self.ds_dy * along_s.y + self.dt_dy * along_t.y,
        }
    }

    /// a·s + b·t + c.
    #[inline(always)]
    fn moved(&self, simd: S, [a, b, c]: [f64; 3]) -> F64x16<S> {
        let [a, b] = [F64x16::splat(simd, a), F64x16::splat(simd, b)];
        self.s * a + self.t * b + F64x16::splat(simd, c)
    }
}
