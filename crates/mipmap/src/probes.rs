//! A line of probes along the major axis of a footprint.
//!
//! The box of length η (in units of the probe distance) is cut into cells of length 1, centred on the middle one; the
//! two end cells hold what is left. Each cell has one probe, at its middle, weighted by its length:
//!
//! ```text
//!   η = 3.6    |··|------|------|------|··|       cells
//!               ↑     ↑      ↑      ↑    ↑        probes
//!              0.3    1      1      1   0.3       weights, sum η
//! ```
//!
//! As η grows, end cells grow from length 0, so no probe appears with a jump.

use glam::{DVec2, DVec4};

/// The probes of one footprint.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Probes {
    /// From one probe to the next, in st.
    step: DVec2,
    /// Whole cells on each side of the middle one.
    whole: u32,
    /// Length of an end cell, in (0, 1].
    end: f64,
    /// Length of the box in cells.
    total: f64,
}

impl Probes {
    /// `axis`: the major axis from end to end. `eta`: its length in cells, finite, ≥ 1.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "η is at most MAX_ANISOTROPY, and truncation is the floor"
    )]
    pub(crate) fn along(axis: DVec2, eta: f32) -> Self {
        let eta = f64::from(eta);
        let half = (eta - 1.0) * 0.5;
        let whole = half as u32;
        Self {
            step: axis / eta,
            whole,
            end: half - f64::from(whole),
            total: eta,
        }
    }

    /// The weighted mean of `colour` over the probes' offsets from the middle.
    ///
    /// Summed in f64 so that a constant comes back to the bit and the largest f32 does not overflow.
    #[inline(always)]
    pub(crate) fn map_sum(self, colour: impl Fn(DVec2) -> DVec4) -> DVec4 {
        let pair = |cells: f64| colour(self.step * cells) + colour(self.step * -cells);
        let mut sum = colour(DVec2::ZERO);
        for cell in 1..=self.whole {
            sum += pair(f64::from(cell));
        }
        if self.end > 0.0 {
            // The end cell's middle: half a cell beyond the last whole one's centre, and half its own length.
            sum += pair(f64::from(self.whole) + 0.5 + 0.5 * self.end) * self.end;
        }
        sum / self.total
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment(eta: f32, power: i32) -> f64 {
        Probes::along(DVec2::X * f64::from(eta), eta)
            .map_sum(|offset| DVec4::splat(offset.x.abs().powi(power)))
            .x
    }

    #[test]
    fn weights_sum_to_one() {
        for eta in [1.0, 1.001, 2.0, 2.999, 3.0, 3.001, 16.0, 64.0] {
            assert!((moment(eta, 0) - 1.0).abs() < 1e-14, "{eta}");
        }
    }

    #[test]
    fn the_mean_distance_is_near_that_of_the_box() {
        // A box of length η has mean |x| = η/4; the midpoint rule is off by the middle cell alone: 1/(4η).
        for eta in [2.0f32, 3.0, 7.5, 16.0] {
            let expected = f64::from(eta) / 4.0 - 0.25 / f64::from(eta);
            assert!((moment(eta, 1) - expected).abs() < 1e-12, "{eta}");
        }
    }
}
