//! Flattening that comes as near to an isometry as it can and never folds.
//!
//! With J the Jacobian of the map on a triangle and σ its singular values, minimised is the symmetric Dirichlet energy
//!
//! ```text
//!   E = Σ_T area·(σ₁² + σ₂² + σ₁⁻² + σ₂⁻²) / 2 = Σ_T area·‖J‖²·(1 + 1/det² J) / 2         2·area when isometric
//! ```
//!
//! It grows without bound as a triangle collapses, and no step goes further than where the first one would. Its second
//! half is Sander's squared L² stretch. Steps are those of L-BFGS that starts each time from the inverse of the mesh's
//! Laplacian, which is factorised once.
//!
//! # Source
//! Smith & Schaefer 2015, "Bijective Parameterization with Free Boundaries", 4 and 5.1; Kovalsky, Galun & Lipman 2016,
//! "Accelerated Quadratic Proxy"; Zhu, Bridson & Kaufman 2018, "Blended Cured Quasi-Newton for Distortion Optimization".

use std::collections::VecDeque;

use glam::{DMat2, DVec2};

use super::cholesky::{Cholesky, Matrix};
use super::disk::{Disk, doubled_area};
use super::ordering::nested_dissection;
use super::surface::id;

/// Pairs of step and change of gradient that are remembered.
const MEMORY: usize = 6;

/// Steps after which the map is taken as it is.
const MAX_STEPS: usize = 60;

/// Gain of a step, as part of the energy above an isometry's, below which the map is finished.
const MIN_RELATIVE_GAIN: f64 = 2e-3;

/// Energy above an isometry's, as part of it, that is as good as none.
const ISOMETRIC: f64 = 1e-12;

/// Part of the way to the first collapse that a step may go.
const MAX_STEP_TO_COLLAPSE: f64 = 0.9;

/// Decrease asked of a step, as part of that which the slope promises.
const ARMIJO: f64 = 1e-4;

/// Height over base that a triangle has at least in the Laplacian, so that needles do not dominate it.
const MIN_PROXY_HEIGHT: f64 = 1e-2;

/// Brings a map of the disk nearer to an isometry.
///
/// `st`: one position a vertex, every triangle counter-clockwise; otherwise the map is left as it is. No triangle
/// folds. A developable disk comes out isometric.
///
/// # Accuracy
/// Singular values within 10⁻⁴ of 1 on developable disks.
pub fn make_isometric(disk: &Disk, st: &mut [DVec2]) {
    let Some(laplacian) = factorise_laplacian(disk) else {
        return;
    };
    let energy = Energy::of(disk);
    let mut gradient = vec![DVec2::ZERO; st.len()];
    let mut value = energy.with_gradient(st, &mut gradient);
    let mut memory = Memory::default();
    let least = energy.least();
    let mut small_gains = 0;
    for _ in 0..MAX_STEPS {
        if !value.is_finite() || value - least <= ISOMETRIC * least {
            return;
        }
        let mut direction = memory.direction(&gradient, &laplacian);
        let mut slope = dot(&gradient, &direction);
        if slope.is_nan() || slope >= 0.0 {
            memory = Memory::default();
            direction = memory.direction(&gradient, &laplacian);
            slope = dot(&gradient, &direction);
        }
        let before = st.to_vec();
        if !energy.step_along(st, &direction, value, slope) {
            return;
        }
        let old_gradient = gradient.clone();
        let new_value = energy.with_gradient(st, &mut gradient);
        memory.remember(&before, st, &old_gradient, &gradient);
        let gain = value - new_value;
        value = new_value;
        small_gains = if gain < MIN_RELATIVE_GAIN * (value - least) {
            small_gains + 1
        } else {
            0
        };
        if small_gains == 2 {
            return;
        }
    }
}

/// Gradients of the hat functions of two corners of a triangle (the third's is minus their sum), and its area.
struct Element {
    triangle: [u32; 3],
    hats: [DVec2; 2],
    area: f64,
}

struct Energy {
    elements: Vec<Element>,
}

impl Energy {
    fn of(disk: &Disk) -> Self {
        let elements = (0..disk.triangles.len()).map(|t| {
            let [_, b, c] = disk.laid_flat(t);
            let doubled = b.perp_dot(c);
            Element {
                triangle: disk.triangles[t],
                hats: [-c.perp() / doubled, b.perp() / doubled],
                area: 0.5 * doubled,
            }
        });
        Self {
            elements: elements.collect(),
        }
    }

    /// The energy of an isometry.
    fn least(&self) -> f64 {
        2.0 * self.elements.iter().map(|e| e.area).sum::<f64>()
    }

    /// The energy, infinite when a triangle is folded.
    fn value(&self, st: &[DVec2]) -> f64 {
        let mut sum = 0.0;
        for element in &self.elements {
            let jacobian = element.jacobian(st);
            let det = jacobian.determinant();
            if det.is_nan() || det <= 0.0 {
                return f64::INFINITY;
            }
            let squares = jacobian.x_axis.length_squared() + jacobian.y_axis.length_squared();
            sum += 0.5 * element.area * squares * (1.0 + 1.0 / (det * det));
        }
        sum
    }

    /// The energy, and its gradient by the positions of the vertices.
    fn with_gradient(&self, st: &[DVec2], gradient: &mut [DVec2]) -> f64 {
        gradient.fill(DVec2::ZERO);
        let mut sum = 0.0;
        for element in &self.elements {
            let jacobian = element.jacobian(st);
            let (x, y) = (jacobian.x_axis, jacobian.y_axis);
            let det = jacobian.determinant();
            if det.is_nan() || det <= 0.0 {
                return f64::INFINITY;
            }
            let squares = x.length_squared() + y.length_squared();
            let inverse = 1.0 / (det * det);
            sum += 0.5 * element.area * squares * (1.0 + inverse);
            // ∂det/∂x = −y⊥ and ∂det/∂y = x⊥, with ⊥ a quarter turn counter-clockwise.
            let by_det = squares * inverse / det;
            let by_x = (x * (1.0 + inverse) + y.perp() * by_det) * element.area;
            let by_y = (y * (1.0 + inverse) - x.perp() * by_det) * element.area;
            let [b, c] = element.hats.map(|hat| by_x * hat.x + by_y * hat.y);
            gradient[element.triangle[0] as usize] -= b + c;
            gradient[element.triangle[1] as usize] += b;
            gradient[element.triangle[2] as usize] += c;
        }
        sum
    }

    /// Step along `direction` at which the first triangle collapses, or `most` when none has until there.
    fn step_to_collapse(&self, st: &[DVec2], direction: &[DVec2], most: f64) -> f64 {
        let mut least = most;
        for element in &self.elements {
            let [a, b, c] = element.triangle.map(|v| st[v as usize]);
            let [da, db, dc] = element.triangle.map(|v| direction[v as usize]);
            let (p, q, dp, dq) = (b - a, c - a, db - da, dc - da);
            let constant = p.perp_dot(q);
            let linear = p.perp_dot(dq) + dp.perp_dot(q);
            let quadratic = dp.perp_dot(dq);
            // The area is at least its linear part where the quadratic one is not negative.
            if constant + least * linear.min(0.0) > 0.0 && quadratic >= 0.0 {
                continue;
            }
            least = least.min(first_positive_root(quadratic, linear, constant));
        }
        least
    }

    /// Moves along `direction` as far as it pays, and says whether it did.
    fn step_along(&self, st: &mut [DVec2], direction: &[DVec2], value: f64, slope: f64) -> bool {
        let full = 1.0 / MAX_STEP_TO_COLLAPSE;
        let mut step = MAX_STEP_TO_COLLAPSE * self.step_to_collapse(st, direction, full);
        let mut moved = vec![DVec2::ZERO; st.len()];
        for _ in 0..40 {
            for ((to, &from), &along) in moved.iter_mut().zip(&*st).zip(direction) {
                *to = from + along * step;
            }
            if self.value(&moved) <= value + ARMIJO * step * slope {
                st.copy_from_slice(&moved);
                return true;
            }
            step *= 0.5;
        }
        false
    }
}

impl Element {
    /// Columns ∂st/∂x and ∂st/∂y on the triangle laid flat.
    fn jacobian(&self, st: &[DVec2]) -> DMat2 {
        let [a, b, c] = self.triangle.map(|v| st[v as usize]);
        let ([hb, hc], p, q) = (self.hats, b - a, c - a);
        DMat2::from_cols(p * hb.x + q * hc.x, p * hb.y + q * hc.y)
    }
}

/// The last steps and what they did to the gradient.
#[derive(Default)]
struct Memory {
    pairs: VecDeque<(Vec<DVec2>, Vec<DVec2>, f64)>,
}

impl Memory {
    /// Two-loop recursion of L-BFGS: minus the inverse Hessian, as far as it is known, times the gradient.
    fn direction(&self, gradient: &[DVec2], laplacian: &Cholesky<f64>) -> Vec<DVec2> {
        let mut q: Vec<DVec2> = gradient.iter().map(|&g| -g).collect();
        let mut weights = Vec::with_capacity(self.pairs.len());
        for (step, change, curvature) in self.pairs.iter().rev() {
            let weight = dot(step, &q) / curvature;
            add(&mut q, change, -weight);
            weights.push(weight);
        }
        let mut r = laplacian.solve(&q);
        for ((step, change, curvature), weight) in self.pairs.iter().zip(weights.iter().rev()) {
            let other = dot(change, &r) / curvature;
            add(&mut r, step, weight - other);
        }
        r
    }

    fn remember(
        &mut self,
        before: &[DVec2],
        after: &[DVec2],
        old_gradient: &[DVec2],
        new_gradient: &[DVec2],
    ) {
        let difference = |a: &[DVec2], b: &[DVec2]| -> Vec<DVec2> {
            a.iter().zip(b).map(|(a, b)| *a - *b).collect()
        };
        let step = difference(after, before);
        let change = difference(new_gradient, old_gradient);
        let curvature = dot(&step, &change);
        if curvature > 0.0 {
            if self.pairs.len() == MEMORY {
                self.pairs.pop_front();
            }
            self.pairs.push_back((step, change, curvature));
        }
    }
}

fn dot(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

fn add(sum: &mut [DVec2], other: &[DVec2], factor: f64) {
    for (s, o) in sum.iter_mut().zip(other) {
        *s += *o * factor;
    }
}

/// Smallest t > 0 with a·t² + b·t + c = 0, or infinity; c > 0.
fn first_positive_root(a: f64, b: f64, c: f64) -> f64 {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    // The form without cancellation: q has the sign of −b.
    let root = discriminant.sqrt();
    let q = -0.5 * if b < 0.0 { b - root } else { b + root };
    let positive = |t: f64| if t > 0.0 { t } else { f64::INFINITY };
    positive(q / a).min(positive(c / q))
}

/// The mesh's Laplacian times 4, about the energy's curvature at an isometry; needles count as less thin.
fn factorise_laplacian(disk: &Disk) -> Option<Cholesky<f64>> {
    let order = nested_dissection(&disk.points, &disk.triangles);
    let mut matrix = Matrix::<f64>::new(&order);
    for (t, triangle) in disk.triangles.iter().enumerate() {
        let corners = fattened(disk.laid_flat(t));
        let doubled = doubled_area(corners);
        let edges = [0, 1, 2].map(|k| corners[(k + 2) % 3] - corners[(k + 1) % 3]);
        for j in 0..3 {
            for k in j..3 {
                let entry = 2.0 * edges[j].dot(edges[k]) / doubled;
                matrix.add(triangle[j], triangle[k], entry);
            }
        }
    }
    // A map is free to move as a whole: one vertex is held softly, which changes no direction that matters.
    matrix.add(0, 0, 1.0);
    // Keeps places that hardly any area holds from breaking the factorisation.
    for v in 0..id(disk.points.len()) {
        matrix.add(v, v, 1e-9);
    }
    matrix.factorise()
}

/// The triangle with its height over the longest edge raised to the least that is allowed.
fn fattened(corners: [DVec2; 3]) -> [DVec2; 3] {
    let edge = |k: usize| corners[(k + 1) % 3] - corners[k];
    let longest = (1..3).fold(0, |most, k| {
        if edge(k).length_squared() > edge(most).length_squared() {
            k
        } else {
            most
        }
    });
    let base = edge(longest);
    let height = doubled_area(corners) / base.length();
    let missing = (MIN_PROXY_HEIGHT * base.length() - height).max(0.0);
    let mut raised = corners;
    raised[(longest + 2) % 3] += base.perp().normalize_or_zero() * missing;
    raised
}
