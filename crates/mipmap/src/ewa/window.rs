use crate::lod::round_to_f32;

/// exp(−q/2) − exp(−R²/2) for q in 0..R², tabulated.
pub(crate) struct Window {
    /// R².
    pub(crate) reach: f64,
    /// What the covariance is multiplied by, so that the cut Gaussian has the wanted one.
    pub(crate) widening: f64,
    /// exp(−R²/2).
    pub(crate) edge: f64,
    /// Entries a unit of q.
    density: f32,
    /// The weight at an entry, and what is added until the next.
    table: Vec<[f32; 2]>,
}

impl Window {
    const ENTRIES: u16 = 1024;

    pub(super) fn new(cut: f64) -> Self {
        let reach = cut * cut;
        let half = 0.5 * reach;
        let edge = libm::exp(-half);
        // ∫ (e⁻ᵘ − e⁻ᵁ) du and ∫ (e⁻ᵘ − e⁻ᵁ) u du over 0..U, with u = r²/2.
        let mass = 1.0 - edge - half * edge;
        let second = 1.0 - (1.0 + half) * edge - 0.5 * half * half * edge;
        let step = reach / f64::from(Self::ENTRIES);
        let entry = |k: u16| round_to_f32((libm::exp(-0.5 * step * f64::from(k)) - edge).max(0.0));
        Self {
            reach,
            widening: mass / second,
            edge,
            density: round_to_f32(1.0 / step),
            table: (0..=Self::ENTRIES)
                .map(|k| [entry(k), entry(k + 1) - entry(k)])
                .collect(),
        }
    }

    /// The weight at q ≥ 0, interpolated: within 8e-6 (the square of a step of 16/1024, times ⅛ of f″ = ¼).
    #[inline(always)]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "q ≥ 0, and truncation is the floor of it"
    )]
    pub(super) fn weight(&self, q: f32) -> f32 {
        let position = q * self.density;
        let index = (position as u32).min(u32::from(Self::ENTRIES));
        let fraction = position - index as f32;
        let [weight, change] = self.table[index as usize];
        weight + change * fraction
    }
}
