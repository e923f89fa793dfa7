//! Weighted rows beside f64 sums of the texels that the address modes find.

use glam::{DVec4, UVec2, Vec4};
use proptest::prelude::*;
use sampler::{AddressMode, Addressing};

use crate::strategies::{float_texture, half_texture, integer_texture};

proptest! {
    /// Any kind of texel, any origin: that of grey texels need not be grey.
    #[test]
    fn rows_are_weighted_sums(
        texture in prop_oneof![float_texture(), half_texture(), integer_texture()],
        i in -20i64..20, j in -20i64..20, weights in prop::collection::vec(0.0..1.0f32, 1..20),
        origin in proptest::array::uniform4(0.0..1.0f32),
        mode in prop::sample::select(vec![AddressMode::Repeat, AddressMode::ClampToBorder]),
    ) {
        let address = Addressing { modes: [mode; 2], border: Vec4::new(0.1, 0.9, 0.4, 0.2) };
        let origin = Vec4::from_array(origin);
        let size = texture.size();
        let texel = |i: i64| {
            let stored = [mode.resolve(i, size.x), mode.resolve(j, size.y)];
            match stored {
                [Some(i), Some(j)] => texture.fetch(UVec2::new(i, j)),
                _ => address.border,
            }
        };
        let (mut wanted, mut greatest) = (DVec4::ZERO, 1.0f64);
        for (k, &weight) in (i..).zip(&weights) {
            let difference = texel(k).as_dvec4() - origin.as_dvec4();
            wanted += difference * f64::from(weight);
            greatest = greatest.max(difference.abs().max_element());
        }
        prop_assume!(greatest < 1e30);
        let got = texture.weighted_row(&address, i, j, &weights, origin);
        let error = (got - wanted).abs().max_element();
        prop_assert!(error <= 20.0 * 20.0 * f64::from(f32::EPSILON) * greatest, "{error:e}: {got} {wanted}");
    }
}
