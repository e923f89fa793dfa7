//! Random numbers that depend on nothing but what they are asked for.

/// Two numbers in 0..1, spread evenly, for the `index`-th sample of the `stream`-th pixel.
///
/// # Source
/// The finaliser of SplitMix64: Steele, Lea, Flood 2014, "Fast Splittable Pseudorandom Number Generators".
#[inline]
pub(super) fn unit(stream: u64, index: u64) -> [f64; 2] {
    let mut z = (stream << 20 ^ index)
        .wrapping_add(1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    let fraction = |bits: u64| (bits & 0xffff_ffff) as f64 / 4_294_967_296.0;
    [fraction(z >> 32), fraction(z)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_spread_evenly() {
        let count = 1 << 16;
        let mut cells = [0u32; 64];
        let mut product = 0.0;
        for k in 0..count {
            let [a, b] = unit(k >> 8, k & 255);
            let cell = |x: f64| (0..8).filter(|&n| x * 8.0 >= f64::from(n)).count() - 1;
            cells[cell(a) * 8 + cell(b)] += 1;
            product += (a - 0.5) * (b - 0.5);
        }
        // 1024 a cell, standard deviation 32; the covariance of independent ones is 1/12/√65536.
        assert!(cells.iter().all(|n| n.abs_diff(1024) < 160), "{cells:?}");
        assert!((product / count as f64).abs() < 0.0016, "{product}");
    }
}
