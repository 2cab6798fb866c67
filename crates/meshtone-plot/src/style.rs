//! Colours, strokes and text styles, the same in every figure.

/// Colours that colour-blind readers can tell apart.
///
/// Source: M. Okabe, K. Ito, "Color universal design", 2008.
pub(crate) mod colour {
    /// Text and axes.
    pub(crate) const INK: &str = "#1a1a1a";
    /// Secondary text and lines.
    pub(crate) const MUTED: &str = "#5a5a5a";
    /// Grid lines.
    pub(crate) const GRID: &str = "#e3e3e3";
    /// Material.
    pub(crate) const STEEL: &str = "#e4e9ee";
    /// What is simulated.
    pub(crate) const BLUE: &str = "#0072b2";
    /// Damage, and nothing else.
    pub(crate) const VERMILLION: &str = "#d55e00";
    /// Start of contact; what is simulated, enhanced.
    pub(crate) const GREEN: &str = "#009e73";
    /// Start of the tip relief.
    pub(crate) const PURPLE: &str = "#aa4a8a";
    /// Background.
    pub(crate) const WHITE: &str = "#ffffff";
}

/// (px) Of the dots that stand for many values.
pub(crate) const DOT_RADIUS: f64 = 1.7;

/// How a line is drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stroke {
    pub(crate) colour: &'static str,
    pub(crate) width: f64,
    /// SVG's `stroke-dasharray`; empty for a solid line.
    pub(crate) dash: &'static str,
}

impl Stroke {
    pub(crate) const fn solid(colour: &'static str, width: f64) -> Self {
        Self { colour, width, dash: "" }
    }

    pub(crate) const fn dashed(colour: &'static str, width: f64, dash: &'static str) -> Self {
        Self { colour, width, dash }
    }
}

/// How an area is filled.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fill {
    pub(crate) colour: &'static str,
    pub(crate) opacity: f64,
    /// Diagonal lines of the colour over the fill.
    pub(crate) hatched: bool,
}

impl Fill {
    pub(crate) const fn solid(colour: &'static str) -> Self {
        Self { colour, opacity: 1.0, hatched: false }
    }

    pub(crate) const fn tint(colour: &'static str, opacity: f64) -> Self {
        Self { colour, opacity, hatched: false }
    }

    pub(crate) const fn hatch(colour: &'static str) -> Self {
        Self { colour, opacity: 0.12, hatched: true }
    }
}

/// Which point of a text is placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text is set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TextStyle {
    pub(crate) size: f64,
    pub(crate) bold: bool,
    pub(crate) colour: &'static str,
    pub(crate) anchor: Anchor,
    /// Reads upwards.
    pub(crate) upwards: bool,
    /// White outline, for text over lines.
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

    pub(crate) const fn coloured(self, colour: &'static str) -> Self {
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
