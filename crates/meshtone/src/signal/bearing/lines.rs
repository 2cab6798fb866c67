//! The lines of a squared envelope spectrum at the defect orders of a bearing.

use crate::bearing::DefectOrders;
use crate::signal::{SquaredEnvelopeSpectrum, upper_median};

/// (-) How far slip moves a line, on either side, and a stated geometry's orders are off.
pub(super) const SLIP: f64 = 0.03;
/// (-) How far from its place a single line is looked for, on either side.
const REACH: f64 = 0.015;
/// (lines) A line of the spectrum with a Hann window is so wide on either side.
const WIDTH: f64 = 2.0;
/// Lines on either side, and shaft orders if these are more lines, whose median a line is compared with.
const BESIDE: (f64, f64) = (24.0, 0.5);
/// Harmonics of each pass frequency.
const HARMONICS: u32 = 3;
/// Harmonics of the other kinds that are not taken for one.
const MOST_HARMONICS: u32 = 12;

/// Part of a bearing whose defect makes a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DefectKind {
    /// The cage: FTF.
    Cage,
    /// The outer race: BPFO and its harmonics.
    OuterRace,
    /// The inner race: BPFI and its harmonics, with sidebands of the shaft.
    InnerRace,
    /// A ball or roller: 2 BSF and its harmonics, with sidebands of the cage.
    Element,
}

meshtone_toml::named!(DefectKind {
    Cage = "cage",
    OuterRace = "outer race",
    InnerRace = "inner race",
    Element = "rolling element",
});

impl DefectKind {
    /// Name of its first line: `FTF`, `BPFO`, `BPFI` or `2 BSF`.
    pub fn line(self) -> &'static str {
        match self {
            Self::Cage => "FTF",
            Self::OuterRace => "BPFO",
            Self::InnerRace => "BPFI",
            Self::Element => "2 BSF",
        }
    }

    /// (orders) Its first line.
    ///
    /// # Arguments
    /// * `orders` - of the bearing
    pub fn order(self, orders: &DefectOrders) -> f64 {
        match self {
            Self::Cage => orders.cage,
            Self::OuterRace => orders.outer_race,
            Self::InnerRace => orders.inner_race,
            Self::Element => 2.0 * orders.element_spin,
        }
    }

    fn harmonics(self) -> u32 {
        if self == Self::Cage { 1 } else { HARMONICS }
    }
}

/// A line at which a defect would show.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct DefectLine {
    /// Part of the bearing that would be damaged.
    pub kind: DefectKind,
    /// Number of the harmonic, from 1.
    pub harmonic: u32,
    /// (orders of the shaft) Its place without slip.
    pub order: f64,
    /// (orders of the shaft) Place of the largest amplitude within 1.5 % of it.
    pub found_order: f64,
    /// (unit of the signal, squared) That amplitude.
    pub amplitude: f64,
    /// (-) That amplitude over the median of those beside it. Noise alone has 2 to 4.
    pub over_median: f64,
    /// Whether the spectrum is too coarse to separate the line from a whole order of the shaft.
    pub is_beside_shaft_order: bool,
}

impl DefectLine {
    /// Its name: `BPFO`, `2 BPFO` and so on; of a rolling element `2 BSF`, `4 BSF`.
    pub fn name(&self) -> String {
        match (self.kind, self.harmonic) {
            (kind, 1) => kind.line().to_owned(),
            (DefectKind::Element, harmonic) => format!("{} BSF", 2 * harmonic),
            (kind, harmonic) => format!("{harmonic} {}", kind.line()),
        }
    }
}

/// Finds the lines of a bearing's defects in a squared envelope spectrum: FTF, and three harmonics each of BPFO, BPFI and 2 BSF.
///
/// Each is the largest amplitude within 1.5 % of its place, since elements slip, that is not nearer to a line of another kind: a harmonic, or a sideband of an inner race's by the shaft, of an element's by the cage. Amplitudes
/// within two lines of a whole order of the shaft are not taken for it, unless the place itself is so near. The median is of the lines within half a shaft order, and at least 24 lines, of where
/// it is looked for. Lines beyond the spectrum are left out.
///
/// # Arguments
/// * `spectrum` - over orders of a shaft, or over Hz
/// * `orders` - of the bearing
/// * `shaft` - (of the spectrum's axis) place of order 1 of the bearing's shaft: its speed over that of the spectrum's shaft, or its speed in Hz
///
/// ```
/// use meshtone::bearing::BearingGeometry;
/// use meshtone::signal::{ShaftPhase, defect_lines, squared_envelope_order_spectrum};
///
/// // A resonance at 3 kHz that rings whenever a ball passes a place of the outer race.
/// let orders = BearingGeometry::new(9, 7.94, 39.04, 0.0)?.defect_orders();
/// let phase = ShaftPhase::constant(30.0, 20_000.0, 40_000)?;
/// let ringing = |angle: f64| {
///     let since_s = (angle * orders.outer_race).fract() / (30.0 * orders.outer_race);
///     (-800.0 * since_s).exp() * (std::f64::consts::TAU * 3000.0 * since_s).sin()
/// };
/// let signal: Vec<f64> = phase.revolutions.iter().map(|angle| ringing(*angle)).collect();
/// let spectrum = squared_envelope_order_spectrum(&signal, 20_000.0, None, &phase)?;
/// let lines = defect_lines(&spectrum, &orders, 1.0);
/// let over = |name: &str| lines.iter().find(|line| line.name() == name).map(|line| line.over_median);
/// assert!(over("BPFO") > Some(50.0) && over("BPFI") < Some(10.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn defect_lines(
    spectrum: &SquaredEnvelopeSpectrum,
    orders: &DefectOrders,
    shaft: f64,
) -> Vec<DefectLine> {
    let of_kind = |kind: DefectKind, harmonics: u32| {
        (1..=harmonics).map(move |harmonic| (kind, harmonic, f64::from(harmonic) * kind.order(orders)))
    };
    let all = DefectKind::ALL.into_iter().flat_map(|kind| of_kind(kind, kind.harmonics()));
    let others = |kind: DefectKind| {
        let with_harmonics = DefectKind::ALL.into_iter().filter(|of| of.harmonics() > 1 && *of != kind);
        let lines = with_harmonics.flat_map(|of| of_kind(of, MOST_HARMONICS));
        // An inner race turns through the load with the shaft, an element with the cage.
        let modulated = |of: DefectKind| match of {
            DefectKind::InnerRace => Some(1.0),
            DefectKind::Element => Some(orders.cage),
            _ => None,
        };
        lines
            .flat_map(|(of, _, order)| {
                let beside = modulated(of).unwrap_or(0.0);
                let sidebands = if beside > 0.0 { -2..=2 } else { 0..=0 };
                sidebands.map(move |side: i32| order + f64::from(side) * beside)
            })
            .collect::<Vec<_>>()
    };
    all.filter_map(|of| line(spectrum, shaft, of, &others(of.0))).collect()
}

fn line(
    spectrum: &SquaredEnvelopeSpectrum,
    shaft: f64,
    (kind, harmonic, order): (DefectKind, u32, f64),
    others: &[f64],
) -> Option<DefectLine> {
    let lines_per_order = shaft / spectrum.step;
    let reach = (REACH * order * lines_per_order).max(1.0);
    let place = order * lines_per_order;
    let within = |reach: f64| {
        let from = (place - reach).ceil().max(1.0) as usize;
        from..((place + reach).floor() as usize + 1)
    };
    let from_shaft_order = |line: f64| (line - (line / lines_per_order).round() * lines_per_order).abs();
    let is_nearer = |to: f64, other: f64| (to - other).abs() < (to - order).abs();
    // The nearest line of the spectrum is half a line from the place at most.
    let is_beside_shaft_order = from_shaft_order(place) <= WIDTH + 0.5;
    let amplitudes = spectrum.amplitudes.get(within(reach)).filter(|amplitudes| !amplitudes.is_empty())?;
    let (found, amplitude) = within(reach)
        .zip(amplitudes.iter().copied())
        .filter(|(line, _)| is_beside_shaft_order || from_shaft_order(*line as f64) > WIDTH)
        .filter(|(line, _)| others.iter().all(|other| !is_nearer(*line as f64 / lines_per_order, *other)))
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    let beside = within(reach + BESIDE.0.max(BESIDE.1 * lines_per_order));
    let median = upper_median(&spectrum.amplitudes[beside.start..beside.end.min(spectrum.amplitudes.len())]);
    // A spectrum of zeros has no lines.
    (median > 0.0).then(|| DefectLine {
        kind,
        harmonic,
        order,
        found_order: found as f64 / lines_per_order,
        amplitude,
        over_median: amplitude / median,
        is_beside_shaft_order,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bearing::NamedBearing;

    /// A spectrum of 1 everywhere, 50 lines an order, but for some lines.
    fn spectrum(lines: &[(f64, f64)]) -> SquaredEnvelopeSpectrum {
        let mut amplitudes = vec![1.0; 1000];
        lines.iter().for_each(|(order, amplitude)| amplitudes[(order * 50.0).round() as usize] = *amplitude);
        SquaredEnvelopeSpectrum { step: 0.02, amplitudes }
    }

    #[test]
    fn a_line_is_found_where_slip_moved_it_and_a_shaft_order_is_not_taken_for_it() {
        let orders = NamedBearing::find("ER-10K").unwrap_or_else(|| panic!()).geometry.defect_orders();
        // BPFI of 4.948 slipped to 4.90 beside order 5 of the shaft, which is far stronger.
        let found = defect_lines(&spectrum(&[(4.90, 7.0), (5.0, 90.0), (3.98, 3.0)]), &orders, 1.0);
        let line = |name: &str| *found.iter().find(|line| line.name() == name).unwrap_or_else(|| panic!());
        assert_eq!(found.len(), 10);
        let inner = line("BPFI");
        assert!((inner.found_order - 4.90).abs() < 1e-9 && !inner.is_beside_shaft_order);
        assert_eq!((inner.amplitude, inner.over_median), (7.0, 7.0));
        // 2 BSF of 3.984 cannot be separated from order 4 with lines of 0.02.
        let element = line("2 BSF");
        assert!(element.is_beside_shaft_order && element.over_median == 3.0);
        assert_eq!(line("BPFO").over_median, 1.0);
    }

    #[test]
    fn orders_of_another_shaft_and_lines_beyond_the_spectrum() {
        let orders = NamedBearing::find("6205").unwrap_or_else(|| panic!()).geometry.defect_orders();
        // The spectrum is over a shaft that the bearing's turns three times as fast as.
        let found = defect_lines(&spectrum(&[(10.74, 5.0)]), &orders, 3.0);
        let names: Vec<String> = found.iter().map(DefectLine::name).collect();
        assert_eq!(names, ["FTF", "BPFO", "BPFI", "2 BSF"]);
        assert!(found[1].over_median == 5.0 && (found[1].found_order - 3.58).abs() < 1e-9);
        assert!(
            defect_lines(&SquaredEnvelopeSpectrum { step: 1.0, amplitudes: vec![1.0] }, &orders, 1.0)
                .is_empty()
        );
    }
}
