//! Condition indicators of a gear.

mod gear;
mod mesh;
mod na4;
mod shape;

pub use gear::{energy_ratio, fm0, fm4, m6a, m8a, sideband_level_factor};
pub use mesh::{MESH_HARMONICS, MESH_SIDEBANDS, MeshHarmonic, mesh_harmonics};
pub use na4::na4;
pub use shape::ShapeIndicators;

use super::check::check_length;
use super::{OCTAVES, OctaveBand, Separation, SignalError, envelope, octave_bands, order_spectrum, peak};

/// Part of the average's peak below which a part of it is the transforms' rounding.
const ROUNDING: f64 = 1e-12;

/// All indicators of one record. None where one is not defined, as the kurtosis of a part that is 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Indicators {
    /// Of the synchronous average.
    pub average: ShapeIndicators,
    /// Of the regular part.
    pub regular: ShapeIndicators,
    /// Of the residual.
    pub residual: ShapeIndicators,
    /// Of the difference.
    pub difference: ShapeIndicators,
    /// Of the difference's envelope.
    pub envelope: ShapeIndicators,
    /// (-) [`fm0`].
    pub fm0: Option<f64>,
    /// (-) [`fm4`].
    pub fm4: Option<f64>,
    /// (-) [`m6a`].
    pub m6a: Option<f64>,
    /// (-) [`m8a`].
    pub m8a: Option<f64>,
    /// (-) [`na4`], of the records so far; of the first record the kurtosis of its residual.
    pub na4: Option<f64>,
    /// (-) [`energy_ratio`].
    pub energy_ratio: Option<f64>,
    /// (-) [`sideband_level_factor`].
    pub sideband_level_factor: Option<f64>,
    /// [`octave_bands`] of the difference.
    pub octaves: [Option<OctaveBand>; OCTAVES.len()],
    /// [`mesh_harmonics`] of the average.
    pub mesh_harmonics: [MeshHarmonic; MESH_HARMONICS],
}

/// One line of a table of indicators.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct IndicatorValue {
    /// Name, as the path of fields: `difference_kurtosis`, `fm4`.
    pub name: String,
    /// Unit: the signal's, or `-`.
    pub unit: String,
    /// The value, where it is defined.
    pub value: Option<f64>,
}

impl IndicatorValue {
    fn new(name: impl Into<String>, unit: &str, value: Option<f64>) -> Self {
        Self { name: name.into(), unit: unit.to_owned(), value }
    }
}

impl Indicators {
    /// The indicators of a record that stands alone.
    ///
    /// # Arguments
    /// * `average` - one revolution at equal angles
    /// * `parts` - from [`super::separate`]
    /// * `teeth` - of the wheel on the shaft
    ///
    /// A part that is below 1e-12 of the average's peak is rounding, and counts as 0.
    ///
    /// # Errors
    /// NaN; parts that are not as long as the average; a mesh order beyond the Nyquist order.
    ///
    /// ```
    /// use meshtone::signal::{Indicators, SeparationSettings, separate};
    ///
    /// let wave = |order: f64, i: usize| (std::f64::consts::TAU * order * i as f64 / 256.0).cos();
    /// let average: Vec<f64> = (0..256).map(|i| 2.0 * wave(20.0, i) + wave(28.0, i)).collect();
    /// let parts = separate(&average, &SeparationSettings::new(20))?;
    /// let indicators = Indicators::new(&average, &parts, 20)?;
    /// assert!((indicators.fm0.unwrap() - 6.0 / 2.0).abs() < 1e-12);
    /// assert!((indicators.fm4.unwrap() - 1.5).abs() < 1e-12);
    /// assert!((indicators.energy_ratio.unwrap() - 0.5).abs() < 1e-12);
    /// assert_eq!(indicators.envelope.kurtosis, None); // a constant
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn new(average: &[f64], parts: &Separation, teeth: usize) -> Result<Self, SignalError> {
        let (spectrum, envelope) = (order_spectrum(average)?, envelope(&parts.difference)?);
        Self::of_record(average, parts, &spectrum, &envelope, teeth, average.len() as f64 / 2.0)
    }

    /// Does what [`Self::new`] does, with quantities that a record holds already.
    ///
    /// # Arguments
    /// * `average`, `parts`, `teeth` - as there
    /// * `spectrum` - order spectrum of the average
    /// * `envelope` - of the difference
    /// * `highest_order` - (shaft orders) up to which the recording shows orders without loss
    pub(super) fn of_record(
        average: &[f64],
        parts: &Separation,
        spectrum: &[f64],
        envelope: &[f64],
        teeth: usize,
        highest_order: f64,
    ) -> Result<Self, SignalError> {
        for (what, part) in [
            ("regular part", &parts.regular),
            ("residual", &parts.residual),
            ("difference", &parts.difference),
        ] {
            check_length(what, part.len(), average.len())?;
        }
        let rounding = ROUNDING * peak(average);
        let zeros = vec![0.0; average.len()];
        let is_significant = |part: &[f64]| peak(part) > rounding;
        let significant = |part| if is_significant(part) { part } else { &zeros[..] };
        let [regular, residual, difference] =
            [&parts.regular, &parts.residual, &parts.difference].map(|part| significant(part));
        let envelope = if is_significant(&parts.difference) { envelope } else { &zeros };
        Ok(Self {
            average: ShapeIndicators::new(average),
            regular: ShapeIndicators::new(regular),
            residual: ShapeIndicators::new(residual),
            difference: ShapeIndicators::new(difference),
            envelope: ShapeIndicators::above(envelope, rounding),
            fm0: fm0(average, spectrum, teeth)?,
            fm4: fm4(difference),
            m6a: m6a(difference),
            m8a: m8a(difference),
            na4: na4(&[residual])?[0],
            energy_ratio: energy_ratio(difference, regular),
            sideband_level_factor: sideband_level_factor(average, spectrum, teeth)?,
            octaves: octave_bands(difference, teeth, highest_order)?,
            mesh_harmonics: mesh_harmonics(spectrum, teeth, highest_order),
        })
    }

    /// The indicators as a table, in a fixed order.
    ///
    /// # Arguments
    /// * `unit` - of the signal, such as `g`
    ///
    /// ```
    /// # use meshtone::signal::{Indicators, SeparationSettings, separate};
    /// # let average: Vec<f64> = (0..64).map(|i| f64::from(i * i % 37)).collect();
    /// # let parts = separate(&average, &SeparationSettings::new(20))?;
    /// let table = Indicators::new(&average, &parts, 20)?.table("g");
    /// assert_eq!((table[0].name.as_str(), table[0].unit.as_str()), ("average_rms", "g"));
    /// assert_eq!((table[25].name.as_str(), table[25].unit.as_str()), ("fm0", "-"));
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn table(&self, unit: &str) -> Vec<IndicatorValue> {
        let shapes = [
            ("average", &self.average),
            ("regular", &self.regular),
            ("residual", &self.residual),
            ("difference", &self.difference),
            ("envelope", &self.envelope),
        ];
        let gear = [
            ("fm0", self.fm0),
            ("fm4", self.fm4),
            ("m6a", self.m6a),
            ("m8a", self.m8a),
            ("na4", self.na4),
            ("energy_ratio", self.energy_ratio),
            ("sideband_level_factor", self.sideband_level_factor),
        ];
        let of_shapes = shapes.into_iter().flat_map(|(part, shape)| shape.table(part, unit));
        let of_gear = gear.into_iter().map(|(name, value)| IndicatorValue::new(name, "-", value));
        let of_octaves = OCTAVES.iter().zip(&self.octaves).flat_map(|((name, _), band)| {
            let value = |last, unit, value| {
                IndicatorValue::new(format!("difference_octave_{name}_{last}"), unit, value)
            };
            let kurtosis = band.and_then(|band| band.kurtosis);
            [value("rms", unit, band.map(|band| band.rms)), value("kurtosis", "-", kurtosis)]
        });
        let of_mesh = (1..).zip(&self.mesh_harmonics).flat_map(|(number, of)| of.table(number, unit));
        of_shapes.chain(of_gear).chain(of_octaves).chain(of_mesh).collect()
    }
}
