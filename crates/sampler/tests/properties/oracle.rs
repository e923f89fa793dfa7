//! Obvious f64 and integer forms of what the crate computes.

use glam::{DVec2, DVec4, UVec2};
use sampler::{AddressMode, Texture};

/// Wraps by walking, one step of the definition at a time.
pub(crate) fn wrapped(mode: AddressMode, index: i64, size: i64) -> Option<i64> {
    let mut i = index;
    match mode {
        AddressMode::Repeat => {
            while i < 0 {
                i += size;
            }
            while i >= size {
                i -= size;
            }
            Some(i)
        }
        AddressMode::MirrorRepeat => loop {
            if i < 0 {
                i = -1 - i;
            } else if i >= size {
                i = 2 * size - 1 - i;
            } else {
                return Some(i);
            }
        },
        AddressMode::ClampToEdge => Some(if i < 0 {
            0
        } else if i >= size {
            size - 1
        } else {
            i
        }),
        AddressMode::MirrorClampToEdge => {
            let reflected = if i < 0 { -1 - i } else { i };
            Some(if reflected < size {
                reflected
            } else {
                size - 1
            })
        }
        AddressMode::ClampToBorder => (0..size).contains(&i).then_some(i),
    }
}

/// ⌊s·size⌋ of the exact product, by splitting the f64 into its integer significand and exponent.
pub(crate) fn exact_texel(s: f64, size: u32) -> i64 {
    let bits = s.abs().to_bits();
    let exponent = (bits >> 52) as i32;
    let fraction = bits & ((1 << 52) - 1);
    let (significand, exponent) = if exponent == 0 {
        (fraction, -1074)
    } else {
        (fraction | 1 << 52, exponent - 1075)
    };
    let product = i128::from(significand) * i128::from(size) * if s < 0.0 { -1 } else { 1 };
    let floor = if exponent >= 0 {
        product << exponent
    } else if exponent > -127 {
        product >> -exponent
    } else {
        product.signum().min(0)
    };
    i64::try_from(floor).expect("a coordinate below 2^31")
}

/// Bilinear in f64 by the textbook formula; `st` of moderate size.
pub(crate) fn bilinear(texture: &Texture, modes: [AddressMode; 2], st: DVec2) -> DVec4 {
    taps(texture, modes, st)
        .iter()
        .map(|&(weight, texel)| texel * weight)
        .sum()
}

/// The four weights and texels.
pub(crate) fn taps(texture: &Texture, modes: [AddressMode; 2], st: DVec2) -> [(f64, DVec4); 4] {
    let size = texture.size();
    // One period is removed first: it is exact, and leaves all of f64's digits to the fraction.
    let reduced = DVec2::new(reduce(modes[0], st.x), reduce(modes[1], st.y));
    let xy = reduced * size.as_dvec2() - 0.5;
    let corner = xy.floor();
    let [a, b] = [xy.x - corner.x, xy.y - corner.y];
    let texel = |di: i64, dj: i64| {
        let i = wrapped(modes[0], corner.x as i64 + di, i64::from(size.x));
        let j = wrapped(modes[1], corner.y as i64 + dj, i64::from(size.y));
        match (i, j) {
            (Some(i), Some(j)) => texture.fetch(UVec2::new(i as u32, j as u32)).as_dvec4(),
            _ => DVec4::ZERO,
        }
    };
    [
        ((1.0 - a) * (1.0 - b), texel(0, 0)),
        (a * (1.0 - b), texel(1, 0)),
        ((1.0 - a) * b, texel(0, 1)),
        (a * b, texel(1, 1)),
    ]
}

fn reduce(mode: AddressMode, s: f64) -> f64 {
    match mode {
        AddressMode::Repeat => s - s.floor(),
        AddressMode::MirrorRepeat => s - 2.0 * (s * 0.5).floor(),
        AddressMode::ClampToEdge | AddressMode::ClampToBorder | AddressMode::MirrorClampToEdge => {
            s.clamp(-2.0, 3.0)
        }
    }
}
