use super::SurfaceError;

/// The largest degree; the cost of a point grows with its square.
const MAX_DEGREE: usize = 255;

/// A knot vector t₀ ≤ t₁ ≤ … and the degree p of the splines over it.
///
/// It carries n = (number of knots) − p − 1 basis functions, one for each control point; together they sum to 1 on the
/// domain t_p..=t_n.
///
/// # Source
/// Piegl & Tiller 1997, "The NURBS Book", chapter 2 (Cox 1972, de Boor 1972).
/// # Examples
/// ```
/// use texcoord::surface::KnotVector;
/// let knots = KnotVector::new(2, vec![0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0])?;
/// assert_eq!(knots.control_points(), 4);
/// let (first, basis) = knots.basis(0.5);
/// assert_eq!((first, basis), (0, vec![0.25, 0.625, 0.125]));
/// # Ok::<(), texcoord::surface::SurfaceError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct KnotVector {
    degree: usize,
    knots: Vec<f64>,
}

impl KnotVector {
    /// A knot vector, checked.
    ///
    /// # Errors
    /// [`SurfaceError::Degree`] for degree 0 or above 255; [`SurfaceError::KnotCount`] for less than 2·(degree + 1)
    /// knots; [`SurfaceError::KnotOrder`] where one falls or is not finite; [`SurfaceError::KnotMultiplicity`] where
    /// one inside stands more often than the degree, or at an end more often than the degree + 1;
    /// [`SurfaceError::EmptyDomain`] where t_p = t_n.
    pub fn new(degree: usize, knots: Vec<f64>) -> Result<Self, SurfaceError> {
        if !(1..=MAX_DEGREE).contains(&degree) {
            return Err(SurfaceError::Degree { degree });
        }
        let (count, least) = (knots.len(), 2 * (degree + 1));
        if count < least {
            return Err(SurfaceError::KnotCount {
                count,
                degree,
                least,
            });
        }
        check_order(degree, &knots)?;
        let (first, last) = (degree, count - degree - 1);
        if knots[first] == knots[last] {
            let value = knots[first];
            return Err(SurfaceError::EmptyDomain { first, last, value });
        }
        Ok(Self { degree, knots })
    }

    /// The knots 0 and 1, each degree + 1 times: those of one Bézier curve.
    ///
    /// # Errors
    /// [`SurfaceError::Degree`] for degree 0 or above 255.
    pub fn bezier(degree: usize) -> Result<Self, SurfaceError> {
        let side = degree.min(MAX_DEGREE) + 1;
        Self::new(degree, [vec![0.0; side], vec![1.0; side]].concat())
    }

    /// The degree, at least 1.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The knots.
    #[must_use]
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The number of control points that the vector carries.
    #[must_use]
    pub fn control_points(&self) -> usize {
        self.knots.len() - self.degree - 1
    }

    /// The first and the last parameter.
    #[must_use]
    pub fn domain(&self) -> [f64; 2] {
        [self.knots[self.degree], self.knots[self.control_points()]]
    }

    /// The basis functions that are not 0 at `t`, degree + 1 of them, and the index of the first.
    ///
    /// `t` beyond the domain, and NaN, is clamped to it. Each is in 0..=1; they sum to 1 within degree·2⁻⁵².
    #[must_use]
    pub fn basis(&self, t: f64) -> (usize, Vec<f64>) {
        let t = self.clamped(t);
        let span = self.span(t);
        (
            span - self.degree,
            self.basis_of_degree(span, t, self.degree),
        )
    }

    /// The derivatives of what [`basis`](Self::basis) gives; at a knot those of the side above it, at the end below.
    ///
    /// N′ᵢ,ₚ = p·(Nᵢ,ₚ₋₁/(tᵢ₊ₚ − tᵢ) − Nᵢ₊₁,ₚ₋₁/(tᵢ₊ₚ₊₁ − tᵢ₊₁)).
    #[must_use]
    pub fn basis_derivatives(&self, t: f64) -> (usize, Vec<f64>) {
        let t = self.clamped(t);
        let (span, p) = (self.span(t), self.degree);
        let lower = self.basis_of_degree(span, t, p - 1);
        let first = span - p;
        let factor = p as f64;
        let part = |k: usize| {
            // The lower function that starts at knot first + k; those beyond the span are 0.
            let before = k.checked_sub(1).and_then(|k| lower.get(k)).copied();
            let width = self.knots[first + k + p] - self.knots[first + k];
            before.map_or(0.0, |n| factor * n / width)
        };
        (first, (0..=p).map(|k| part(k) - part(k + 1)).collect())
    }

    /// The functions of `degree` that are not 0 on the span, by the triangle of Cox and de Boor; all terms are sums of
    /// what is not negative.
    fn basis_of_degree(&self, span: usize, t: f64, degree: usize) -> Vec<f64> {
        let mut basis = vec![1.0];
        for d in 1..=degree {
            let mut saved = 0.0;
            for (r, function) in basis.iter_mut().enumerate() {
                let (low, high) = (self.knots[span + 1 + r - d], self.knots[span + 1 + r]);
                let share = *function / (high - low);
                *function = saved + (high - t) * share;
                saved = (t - low) * share;
            }
            basis.push(saved);
        }
        basis
    }

    /// The index k of the span t_k ≤ t < t_{k+1} that is not empty; at the end of the domain the last such.
    fn span(&self, t: f64) -> usize {
        let last = self.control_points();
        let above = self.knots[self.degree..last].partition_point(|&knot| knot <= t);
        let mut span = self.degree + above - 1;
        while self.knots[span] == self.knots[span + 1] {
            span -= 1;
        }
        span
    }

    /// The spans of the domain that are not empty.
    pub(super) fn spans(&self) -> Vec<usize> {
        (self.degree..self.control_points())
            .filter(|&k| self.knots[k] < self.knots[k + 1])
            .collect()
    }

    fn clamped(&self, t: f64) -> f64 {
        let [low, high] = self.domain();
        // `max` of NaN and a number is the number.
        t.max(low).min(high)
    }
}

/// That knots are finite, do not fall and do not tear the curve apart.
fn check_order(degree: usize, knots: &[f64]) -> Result<(), SurfaceError> {
    let mut run = 0;
    let mut before = f64::NEG_INFINITY;
    for (index, &value) in knots.iter().enumerate() {
        if !(value.is_finite() && value >= before) {
            return Err(SurfaceError::KnotOrder {
                index,
                value,
                before,
            });
        }
        run = if value == before { run + 1 } else { 1 };
        before = value;
        let at_end = value == knots[0] || value == knots[knots.len() - 1];
        let most = degree + usize::from(at_end);
        if run > most {
            return Err(SurfaceError::KnotMultiplicity {
                index,
                value,
                count: run,
                most,
            });
        }
    }
    Ok(())
}
