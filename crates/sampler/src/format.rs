//! How texels are stored: component type, channels, transfer function, kind of alpha.

use half::f16;

/// How a stored colour component relates to light.
///
/// It concerns colour only: alpha is always stored linearly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Transfer {
    /// The component is proportional to light (or is not light at all: data, normals).
    #[default]
    Linear,
    /// The component is encoded by the sRGB curve (IEC 61966-2-1); see [`crate::transfer`].
    #[doc(alias = "gamma")]
    Srgb,
}

/// Whether colour is stored as it is, or multiplied by its alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum AlphaMode {
    /// Colour does not know its alpha, as glTF and PNG store it.
    #[default]
    #[doc(alias = "unassociated")]
    Straight,
    /// Colour was multiplied by alpha in linear light; a filter of such colour has no fringe.
    #[doc(alias = "associated")]
    Premultiplied,
}

/// The type of one stored component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Component {
    /// 8-bit unsigned normalised: code k means k/255.
    U8,
    /// 16-bit unsigned normalised: code k means k/65535.
    U16,
    /// 16-bit float (IEEE 754 binary16), any value; finite ones reach ±65504.
    F16,
    /// 32-bit float, any value.
    F32,
}

/// The full description of what a texel's bytes mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Format {
    /// Type of each component.
    pub component: Component,
    /// Components a texel, 1..=4: grey, grey and alpha, RGB, RGBA.
    pub channels: u8,
    /// How colour components are encoded.
    pub transfer: Transfer,
    /// Whether colour is multiplied by alpha. Without an alpha channel it says nothing.
    pub alpha: AlphaMode,
}

impl Component {
    /// Bytes of one component.
    pub const fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 | Self::F16 => 2,
            Self::F32 => 4,
        }
    }
}

impl Format {
    /// Index of the alpha component within a texel: 1 for two channels, 3 for four, else none.
    pub fn alpha_index(&self) -> Option<usize> {
        matches!(self.channels, 2 | 4).then(|| usize::from(self.channels) - 1)
    }
}

/// Stored components: interleaved, row after row, the first row at the top.
#[derive(Debug, Clone, PartialEq)]
pub enum Texels {
    /// 8-bit unsigned normalised components.
    U8(Vec<u8>),
    /// 16-bit unsigned normalised components.
    U16(Vec<u16>),
    /// 16-bit float components.
    F16(Vec<f16>),
    /// 32-bit float components.
    F32(Vec<f32>),
}

impl Texels {
    /// The number of stored components (not texels, not bytes).
    pub fn len(&self) -> usize {
        match self {
            Self::U8(components) => components.len(),
            Self::U16(components) => components.len(),
            Self::F16(components) => components.len(),
            Self::F32(components) => components.len(),
        }
    }

    /// Whether nothing is stored.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The type of the components.
    pub fn component(&self) -> Component {
        match self {
            Self::U8(_) => Component::U8,
            Self::U16(_) => Component::U16,
            Self::F16(_) => Component::F16,
            Self::F32(_) => Component::F32,
        }
    }
}
