//! Colours, strokes and text styles, the same in every figure.

use std::fmt;

/// An opaque colour of sRGB, 0xrr_gg_bb.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Colour(pub(crate) u32);

impl Colour {
    /// Red, green and blue.
    pub(crate) fn rgb(self) -> [u8; 3] {
        let [_, red, green, blue] = self.0.to_be_bytes();
        [red, green, blue]
    }

    /// Itself with a part of another colour in its place.
    pub(crate) fn mixed(self, other: Self, part: f32) -> Self {
        // In 256ths, finer steps nobody sees; red and blue at once, with room for the products between them.
        let part = (part * 256.0 + 0.5) as u32;
        let mixed =
            |of: u32, half: u32| (((self.0 & of) * (256 - part) + (other.0 & of) * part + half) >> 8) & of;
        Self(mixed(0xff_00_ff, 0x80_00_80) | mixed(0x00_ff_00, 0x00_80_00))
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "#{:06x}", self.0)
    }
}

/// Colours that colour-blind readers can distinguish.
///
/// Source: M. Okabe, K. Ito, "Color universal design", 2008.
pub(crate) mod colour {
    use super::Colour;

    /// Text and axes.
    pub(crate) const INK: Colour = Colour(0x1a_1a_1a);
    /// Secondary text and lines.
    pub(crate) const MUTED: Colour = Colour(0x5a_5a_5a);
    /// Frames and ticks.
    pub(crate) const FRAME: Colour = Colour(0x8a_8a_8a);
    /// Grid lines.
    pub(crate) const GRID: Colour = Colour(0xe3_e3_e3);
    /// Material.
    pub(crate) const STEEL: Colour = Colour(0xe4_e9_ee);
    /// Colour of simulations.
    pub(crate) const BLUE: Colour = Colour(0x00_72_b2);
    /// Damage, and nothing else.
    pub(crate) const VERMILLION: Colour = Colour(0xd5_5e_00);
    /// Start of contact; what is simulated, enhanced.
    pub(crate) const GREEN: Colour = Colour(0x00_9e_73);
    /// Start of the tip relief.
    pub(crate) const PURPLE: Colour = Colour(0xaa_4a_8a);
    /// One more where there are many.
    pub(crate) const ORANGE: Colour = Colour(0xe6_9f_00);
    /// Background.
    pub(crate) const WHITE: Colour = Colour(0xff_ff_ff);
}

/// (px) Of the dots that stand for many values.
pub(crate) const DOT_RADIUS: f64 = 1.7;

/// (px) Of the white outline of a text, half of it outside the letters.
pub(crate) const HALO_WIDTH: f64 = 3.0;

/// (px, °) Of a hatching: from stripe to stripe, a stripe's width, and the angle of the stripes to the vertical.
pub(crate) const HATCH_PITCH: f32 = 7.0;
pub(crate) const HATCH_WIDTH: f32 = 1.5;
pub(crate) const HATCH_ANGLE_DEG: f32 = 45.0;

/// Style of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) colour: Colour,
    pub(crate) width: f64,
    /// (px) Lengths of dashes and gaps in turn, an even number; empty for a solid line.
    pub(crate) dash: &'static [f64],
}

impl Stroke {
    pub(crate) const fn solid(colour: Colour, width: f64) -> Self {
        Self { colour, width, dash: &[] }
    }

    pub(crate) const fn dashed(colour: Colour, width: f64, dash: &'static [f64]) -> Self {
        Self { colour, width, dash }
    }
}

/// Style of an area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fill {
    pub(crate) colour: Colour,
    pub(crate) opacity: f64,
    /// Diagonal lines of the colour over the fill.
    pub(crate) hatched: bool,
}

impl Fill {
    pub(crate) const fn solid(colour: Colour) -> Self {
        Self { colour, opacity: 1.0, hatched: false }
    }

    pub(crate) const fn tint(colour: Colour, opacity: f64) -> Self {
        Self { colour, opacity, hatched: false }
    }

    pub(crate) const fn hatch(colour: Colour) -> Self {
        Self { colour, opacity: 0.12, hatched: true }
    }
}

/// Point of a text that is placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    /// Part of a text's width that lies before the point.
    pub(crate) fn before(self, width: f64) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::Middle => width / 2.0,
            Self::End => width,
        }
    }
}

/// Style of a text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TextStyle {
    pub(crate) size: f64,
    pub(crate) bold: bool,
    pub(crate) colour: Colour,
    pub(crate) anchor: Anchor,
    /// Reads upwards.
    pub(crate) upwards: bool,
    /// White outline of [`HALO_WIDTH`], for text over lines.
    pub(crate) halo: bool,
}

impl TextStyle {
    const fn plain(size: f64) -> Self {
        Self { size, bold: false, colour: colour::INK, anchor: Anchor::Start, upwards: false, halo: false }
    }

    /// The figure's title.
    pub(crate) const TITLE: Self = Self::plain(22.0).bold();
    /// The line below it.
    pub(crate) const FACTS: Self = Self::plain(14.5).coloured(colour::MUTED);
    /// A heading over several axes.
    pub(crate) const HEADING: Self = Self::plain(16.0).bold();
    /// The title of one pair of axes.
    pub(crate) const AXES_TITLE: Self = Self::plain(14.0).bold();
    /// An axis' name.
    pub(crate) const AXIS: Self = Self::plain(13.5).anchored(Anchor::Middle);
    /// Numbers at ticks.
    pub(crate) const TICK: Self = Self::plain(12.5).coloured(colour::MUTED).anchored(Anchor::Middle);
    /// Words inside axes and legends.
    pub(crate) const NOTE: Self = Self::plain(12.5);

    pub(crate) const fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    pub(crate) const fn coloured(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }

    pub(crate) const fn anchored(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }

    pub(crate) const fn upwards(self) -> Self {
        Self { upwards: true, ..self }
    }

    pub(crate) const fn with_halo(self) -> Self {
        Self { halo: true, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_mixed_in_proportion() {
        let [ink, white] = [Colour(0x10_20_f0), colour::WHITE];
        assert_eq!((white.mixed(ink, 0.0), white.mixed(ink, 1.0)), (white, ink));
        assert_eq!(white.mixed(ink, 0.5), Colour(0x88_90_f8));
        assert_eq!(ink.mixed(white, 0.25), Colour(0x4c_58_f4));
        assert_eq!(ink.to_string(), "#1020f0");
    }
}
