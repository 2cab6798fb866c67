//! From a recording to its indicators.

use super::check::check_mesh_order;
use super::*;

/// Settings by which a channel is processed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChainSettings {
    /// Settings of the resampling over the angle.
    pub angular: AngularSettings,
    /// Sidebands, shaft orders and mean; by default [`SeparationSettings::new`] with the wheel's teeth.
    pub separation: Option<SeparationSettings>,
}

/// Results of one recording, or one segment of it, for one wheel.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Record {
    /// The synchronous average.
    pub average: SynchronousAverage,
    /// Its regular part, residual and difference.
    pub parts: Separation,
    /// Envelope of the difference.
    pub envelope: Vec<f64>,
    /// [`order_spectrum`] of the average; its index is the shaft order.
    pub order_spectrum: Vec<f64>,
    /// [`order_spectrum`] of the envelope.
    pub envelope_spectrum: Vec<f64>,
    /// The indicators.
    pub indicators: Indicators,
    /// (-) Part of the mean square of the revolutions that the average holds; none of an average alone.
    pub held: Option<f64>,
    /// Warnings besides those of the phase: [`ShaftPhase::warnings`].
    pub warnings: Vec<SignalWarning>,
}

impl Record {
    /// Adds what the average holds of the revolutions, and a warning where that is hardly more than noise would leave.
    ///
    /// # Arguments
    /// * `values` - the revolutions that were averaged
    /// * `teeth` - of the wheel
    fn with_doubt(mut self, values: &[f64], teeth: u32) -> Self {
        let part = synchronous_part(values, &self.average.values);
        self.held = part.map(|part| part.of_mean_square);
        let part = part.filter(SynchronousPart::is_noise);
        self.warnings.extend(part.map(|part| SignalWarning::NothingSynchronous { part, teeth, other: None }));
        self
    }
}

/// One recording of a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recording<'a> {
    /// The channel.
    pub signal: &'a [f64],
    /// Phase of the wheel's shaft at its samples.
    pub phase: &'a ShaftPhase,
}

/// Processes one channel: average, parts, envelope, spectra, indicators.
///
/// # Arguments
/// * `signal` - the channel
/// * `phase` - phase of the wheel's shaft; for the other wheel [`ShaftPhase::of_mate`]
/// * `teeth` - of the wheel
/// * `settings` - how
///
/// # Errors
/// Those of [`angular_resample`], [`synchronous_average`] and [`separate`]: NaN, a constant channel, fewer than two whole
/// revolutions, a mesh order beyond what the sampling rate shows.
///
/// ```
/// use meshtone::signal::{ChainSettings, ShaftPhase, process_channel};
///
/// let tooth = |t: f64| (std::f64::consts::TAU * t).cos();
/// let signal: Vec<f64> = (0..20_000).map(|i| tooth(380.0 * i as f64 / 1e4) + 0.1 * tooth(250.0 * i as f64 / 1e4)).collect();
/// let phase = ShaftPhase::constant(20.0, 1e4, signal.len())?;
/// let record = process_channel(&signal, &phase, 19, &ChainSettings::default())?;
/// assert_eq!(record.average.revolutions, 39);
/// assert!((record.order_spectrum[19] - 1.0).abs() < 1e-3);
/// assert!(record.indicators.difference.rms < 0.01); // 250 Hz is no order of the shaft
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn process_channel(
    signal: &[f64],
    phase: &ShaftPhase,
    teeth: u32,
    settings: &ChainSettings,
) -> Result<Record, SignalError> {
    process_angular(&angular_resample(signal, phase, &settings.angular)?, teeth, settings)
}

/// Processes a channel over the angle of the wheel's shaft: average, parts, envelope, spectra, indicators.
///
/// # Arguments
/// * `angular` - the channel, from [`angular_resample`]
/// * `teeth`, `settings` - as for [`process_channel`]
///
/// # Errors
/// Those of [`synchronous_average`] and [`separate`].
pub fn process_angular(
    angular: &AngularSignal,
    teeth: u32,
    settings: &ChainSettings,
) -> Result<Record, SignalError> {
    let record = process_average(synchronous_average(angular)?, teeth, settings)?;
    Ok(record.with_doubt(&angular.values, teeth))
}

/// Processes one channel in segments of equally many revolutions: a series of records.
///
/// # Arguments
/// * `signal`, `phase`, `teeth`, `settings` - as for [`process_channel`]
/// * `revolutions` - (at least 2) of each segment
///
/// Returns the records in the order of time; NA4 is that of the series.
///
/// # Errors
/// Those of [`process_channel`]; not even one segment.
///
/// ```
/// use meshtone::signal::{ChainSettings, ShaftPhase, process_segments};
///
/// let signal: Vec<f64> = (0..20_000).map(|i| (std::f64::consts::TAU * 380.0 * i as f64 / 1e4).cos()).collect();
/// let phase = ShaftPhase::constant(20.0, 1e4, signal.len())?;
/// let records = process_segments(&signal, &phase, 19, &ChainSettings::default(), 10)?;
/// assert_eq!(records.len(), 3);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn process_segments(
    signal: &[f64],
    phase: &ShaftPhase,
    teeth: u32,
    settings: &ChainSettings,
    revolutions: usize,
) -> Result<Vec<Record>, SignalError> {
    let angular = angular_resample(signal, phase, &settings.angular)?;
    process_angular_segments(&angular, teeth, settings, revolutions)
}

/// Processes a channel over the angle of the wheel's shaft in segments.
///
/// # Arguments
/// * `angular` - the channel, from [`angular_resample`]
/// * `teeth`, `settings`, `revolutions` - as for [`process_segments`]
///
/// # Errors
/// Those of [`process_angular`]; not even one segment.
pub fn process_angular_segments(
    angular: &AngularSignal,
    teeth: u32,
    settings: &ChainSettings,
    revolutions: usize,
) -> Result<Vec<Record>, SignalError> {
    let averages = segmented_averages(angular, revolutions)?;
    let segments = angular.values.chunks_exact(angular.points_per_revolution * revolutions);
    let process =
        |(average, values)| Ok(process_average(average, teeth, settings)?.with_doubt(values, teeth));
    as_series(averages.into_iter().zip(segments).map(process).collect())
}

/// Processes a series of recordings of the same wheel.
///
/// # Arguments
/// * `recordings` - in the order of time
/// * `teeth`, `settings` - as for [`process_channel`]
///
/// Returns a record for each; NA4 is that of the series.
///
/// # Errors
/// Those of [`process_channel`], for the first recording that is refused; no recordings.
///
/// ```
/// use meshtone::signal::{ChainSettings, Recording, ShaftPhase, process_series};
///
/// let signal: Vec<f64> = (0..20_000).map(|i| (std::f64::consts::TAU * 380.0 * i as f64 / 1e4).cos()).collect();
/// let phase = ShaftPhase::constant(20.0, 1e4, signal.len())?;
/// let recording = Recording { signal: &signal, phase: &phase };
/// let records = process_series(&[recording, recording], 19, &ChainSettings::default())?;
/// assert_eq!(records[0].indicators, records[1].indicators);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn process_series(
    recordings: &[Recording],
    teeth: u32,
    settings: &ChainSettings,
) -> Result<Vec<Record>, SignalError> {
    let process = |recording: &Recording| process_channel(recording.signal, recording.phase, teeth, settings);
    as_series(recordings.iter().map(process).collect())
}

/// Processes an average: parts, envelope, spectra, indicators.
///
/// # Arguments
/// * `average` - the synchronous average
/// * `teeth` - of the wheel on the shaft
/// * `settings` - how; its separation, and its interpolation for a warning where that has weakened the mesh tone
///
/// # Errors
/// NaN; a mesh order beyond the Nyquist order of the average or of the recording.
///
/// ```
/// use meshtone::signal::{ChainSettings, SynchronousAverage, process_average};
///
/// let values = (0..256).map(|i| (std::f64::consts::TAU * 19.0 * i as f64 / 256.0).cos()).collect();
/// let average = SynchronousAverage { revolutions: 10, nyquist_order: 128.0, values };
/// let record = process_average(average, 19, &ChainSettings::default())?;
/// assert_eq!(record.indicators.fm4, None); // nothing is left
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn process_average(
    average: SynchronousAverage,
    teeth: u32,
    settings: &ChainSettings,
) -> Result<Record, SignalError> {
    let teeth = teeth as usize;
    let (mesh_order, nyquist_order) = (teeth as f64, average.nyquist_order);
    check_mesh_order(teeth, nyquist_order)?;
    let passed = settings.angular.interpolation.passed();
    let near = SignalWarning::MeshOrderNearNyquist { mesh_order, nyquist_order, passed };
    let doubtful = mesh_order > passed * nyquist_order;
    let separation = settings.separation.clone().unwrap_or_else(|| SeparationSettings::new(teeth));
    let parts = separate(&average.values, &separation)?;
    let envelope = envelope(&parts.difference)?;
    let spectrum = order_spectrum(&average.values)?;
    Ok(Record {
        indicators: Indicators::of_record(
            &average.values,
            &parts,
            &spectrum,
            &envelope,
            teeth,
            passed * nyquist_order,
        )?,
        envelope_spectrum: order_spectrum(&envelope)?,
        order_spectrum: spectrum,
        held: None,
        warnings: doubtful.then_some(near).into_iter().collect(),
        envelope,
        parts,
        average,
    })
}

/// Gives every record the NA4 that it has in the series.
pub(super) fn as_series(records: Result<Vec<Record>, SignalError>) -> Result<Vec<Record>, SignalError> {
    let mut records = records?;
    let residuals: Vec<&[f64]> = records.iter().map(|record| record.parts.residual.as_slice()).collect();
    let values = na4(&residuals)?;
    for (record, value) in records.iter_mut().zip(values) {
        // A residual that is rounding has none, alone as in the series.
        record.indicators.na4 = record.indicators.na4.and(value);
    }
    Ok(records)
}
