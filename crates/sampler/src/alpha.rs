use glam::Vec4;

/// Straight colour from premultiplied: (r/a, g/a, b/a, a).
///
/// Where alpha is not greater than 0, or is NaN, there is no colour to recover and the colour is 0.
///
/// # Accuracy
/// Half an ulp per channel.
/// # Source
/// Porter and Duff 1984, "Compositing Digital Images", section 3.
/// # Examples
/// ```
/// use glam::Vec4;
/// assert_eq!(sampler::unpremultiply(Vec4::new(0.25, 0.5, 0.0, 0.5)), Vec4::new(0.5, 1.0, 0.0, 0.5));
/// ```
#[must_use]
pub fn unpremultiply(colour: Vec4) -> Vec4 {
    if colour.w > 0.0 {
        (colour.truncate() / colour.w).extend(colour.w)
    } else {
        Vec4::new(0.0, 0.0, 0.0, colour.w)
    }
}
