//! Kinds of filters, and their colours.

use plotters::style::RGBColor;

/// What kind of thing a point stands for: its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Level 0 only.
    SingleLevel,
    /// One lookup in a pyramid of square levels.
    Isotropic,
    /// Several lookups along the major axis.
    ProbeLine,
    /// Every texel under an ellipse.
    Elliptic,
    /// Rip-maps and summed-area tables.
    AxisAligned,
    /// Random texels.
    Stochastic,
    /// The cheapest filter that a tolerance allows.
    Automatic,
    /// Another renderer, by its number.
    Peer(usize),
}

impl Family {
    /// All but peers, with what they are called.
    pub const NAMED: [(Self, &'static str); 7] = [
        (Self::SingleLevel, "level 0 only"),
        (Self::Isotropic, "one lookup in the pyramid"),
        (Self::ProbeLine, "probes along the major axis"),
        (Self::Elliptic, "all texels under an ellipse"),
        (Self::AxisAligned, "rip-map, summed-area table"),
        (Self::Stochastic, "random texels"),
        (Self::Automatic, "automatic, by tolerance"),
    ];

    /// The family of the filter called `name`.
    pub fn of(name: &str) -> Self {
        match name {
            "bilinear_mip" | "trilinear" => Self::Isotropic,
            "rip_map" | "sat" => Self::AxisAligned,
            _ if name.starts_with("aniso") => Self::ProbeLine,
            _ if name.starts_with("ewa") => Self::Elliptic,
            _ if name.starts_with("stochastic") => Self::Stochastic,
            _ if name.starts_with("automatic") => Self::Automatic,
            _ => Self::SingleLevel,
        }
    }

    /// Its colour: told apart on white and on black, and by most colour-blind eyes.
    pub fn colour(self) -> RGBColor {
        const PEERS: [RGBColor; 5] = [
            RGBColor(60, 120, 130),
            RGBColor(130, 100, 60),
            RGBColor(110, 110, 160),
            RGBColor(140, 80, 110),
            RGBColor(90, 130, 80),
        ];
        match self {
            Self::SingleLevel => RGBColor(125, 131, 140),
            Self::Isotropic => RGBColor(47, 126, 216),
            Self::ProbeLine => RGBColor(224, 84, 20),
            Self::Elliptic => RGBColor(134, 86, 214),
            Self::AxisAligned => RGBColor(18, 150, 104),
            Self::Stochastic => RGBColor(178, 132, 10),
            Self::Automatic => RGBColor(214, 51, 108),
            Self::Peer(number) => PEERS[number % PEERS.len()],
        }
    }
}
