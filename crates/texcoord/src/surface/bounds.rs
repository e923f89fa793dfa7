//! How far a patch can be from the triangles on it: bounds of its derivatives from its control net.
//!
//! Over a triangle whose parameters fill a box of a by b, linear interpolation is off by at most
//!
//! ```text
//!   ⅛·(a²·M_uu + 2·a·b·M_uv + b²·M_vv)      M the largest second derivatives over the box
//! ```
//!
//! With the Taylor remainder at the corners vᵢ the error at x is ½·|Σ λᵢ·(vᵢ − x)ᵀ·H·(vᵢ − x)|, and Σ λᵢ·(vᵢ − x)² is
//! the variance of a coordinate that spans a, a²/4 at most.
//!
//! # Source
//! Filip, Magedson & Markot 1986, "Surface algorithms using bounds on derivatives" (right triangles; the step above
//! lifts that).

use glam::{DVec3, DVec4, Vec4Swizzles};

/// Bounds of the derivatives of a patch over 0..=1 × 0..=1, in units of the object.
#[derive(Clone, Copy, Debug)]
pub(super) struct DerivativeBounds {
    /// `order[i][j]` bounds |∂ⁱ⁺ʲP/∂uⁱ∂vʲ|, for i, j ≤ 2.
    order: [[f64; 3]; 3],
}

impl DerivativeBounds {
    /// Bounds for the rational patch over a net of `columns` points a row; a single row is a curve along u.
    ///
    /// Derivatives of a Bézier net are Bézier nets of its differences, in the hull of these. From those of (w·P, w)
    /// follow those of P by Leibniz' rule: w·P⁽ᵅ⁾ = (wP)⁽ᵅ⁾ − Σ C(α,β)·w⁽ᵝ⁾·P⁽ᵅ⁻ᵝ⁾ over 0 < β ≤ α. P counts from the
    /// middle of the first and last control point. Read backwards, a curve has the same bounds to the bit.
    pub(super) fn of_net(net: &[DVec4], columns: usize) -> Self {
        let ends = [net[0], net[net.len() - 1]].map(|p| p.xyz() / p.w);
        let origin = (ends[0] + ends[1]) * 0.5;
        let centred = |p: &DVec4| (p.xyz() - origin * p.w).extend(p.w);
        let mut along_u = Net {
            columns,
            points: net.iter().map(centred).collect(),
        };
        let least_weight = net.iter().fold(f64::INFINITY, |least, p| least.min(p.w));
        let mut product = [[0.0; 3]; 3];
        let mut weight = [[0.0; 3]; 3];
        for i in 0..3 {
            let mut along_v = along_u.transposed();
            for j in 0..3 {
                product[i][j] = along_v.largest(|p| p.xyz().length());
                weight[i][j] = along_v.largest(|p| p.w.abs());
                along_v = along_v.differences();
            }
            along_u = along_u.differences();
        }
        let mut order: [[f64; 3]; 3] = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                let mut sum = product[i][j];
                for (k, l) in (0..=i).flat_map(|k| (0..=j).map(move |l| (k, l))) {
                    if (k, l) != (0, 0) {
                        sum += CHOOSE[i][k] * CHOOSE[j][l] * weight[k][l] * order[i - k][j - l];
                    }
                }
                order[i][j] = sum / least_weight;
            }
        }
        Self { order }
    }

    pub(super) fn uu(&self) -> f64 {
        self.order[2][0]
    }

    pub(super) fn vv(&self) -> f64 {
        self.order[0][2]
    }

    pub(super) fn uv(&self) -> f64 {
        self.order[1][1]
    }

    pub(super) fn uuv(&self) -> f64 {
        self.order[2][1]
    }

    pub(super) fn uvv(&self) -> f64 {
        self.order[1][2]
    }

    /// The bound of the error of triangles that span `a` by `b`.
    pub(super) fn error(&self, a: f64, b: f64) -> f64 {
        (a * a * self.uu() + 2.0 * a * b * self.uv() + b * b * self.vv()) / 8.0
    }
}

/// Binomial coefficients.
const CHOOSE: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 2.0, 1.0]];

/// A net of control points, or of their differences; without points where it has been differenced away.
#[derive(Clone, Debug)]
struct Net {
    columns: usize,
    points: Vec<DVec4>,
}

impl Net {
    /// The net of the derivative along u.
    fn differences(&self) -> Self {
        let columns = self.columns.saturating_sub(1);
        if columns == 0 {
            let points = Vec::new();
            return Self { columns, points };
        }
        let degree = columns as f64;
        let rows = self.points.chunks_exact(self.columns);
        let points = rows.flat_map(|row| row.windows(2).map(|pair| (pair[1] - pair[0]) * degree));
        Self {
            columns,
            points: points.collect(),
        }
    }

    fn transposed(&self) -> Self {
        if self.columns == 0 {
            return self.clone();
        }
        let rows = self.points.len() / self.columns;
        let column = |k: usize| self.points.iter().skip(k).step_by(self.columns).copied();
        Self {
            columns: rows,
            points: (0..self.columns).flat_map(column).collect(),
        }
    }

    fn largest(&self, measure: impl Fn(DVec4) -> f64) -> f64 {
        let measures = self.points.iter().map(|&p| measure(p));
        measures.fold(0.0, f64::max)
    }
}

/// The largest scale at the control points of a net.
pub(super) fn largest_scale(
    net: impl Iterator<Item = DVec4>,
    scale: &impl Fn(DVec3) -> f64,
) -> Result<f64, super::SurfaceError> {
    let mut largest: f64 = 0.0;
    for point in net {
        let value = scale(point.xyz() / point.w);
        if !(value.is_finite() && value >= 0.0) {
            return Err(super::SurfaceError::Scale { value });
        }
        largest = largest.max(value);
    }
    Ok(largest)
}
