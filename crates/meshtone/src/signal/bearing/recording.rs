//! Bearings in a recording of a train: from the channel to the lines of their defects.

use super::{BearingDefects, DefectLine, defect_lines};
use crate::bearing::BearingGeometry;
use crate::signal::{
    FrequencyBand, Kurtogram, KurtogramBand, ShaftPhase, SignalError, SignalWarning, SquaredEnvelopeSpectrum,
    SynchronousResidual, TrainRecording, cepstral_prewhitening, check_channel, discrete_random_separation,
    kurtogram, squared_envelope_order_spectrum, synchronous_residual,
};

/// Fewest revolutions of shafts whose average is removed: it contains one part in so many of the power of all else.
const FEWEST_REVOLUTIONS: f64 = 8.0;
/// Fewest cycles, after which the same teeth meet again. Fewer than of revolutions, since nothing else removes what depends on which teeth meet.
pub(super) const FEWEST_CYCLES: f64 = 4.0;
/// (frequencies of the inner race) Least width of a band that is chosen: two harmonics and sidebands of the envelope have room in it.
pub(super) const LEAST_WIDTH: f64 = 3.0;
/// (rev) Length of a block of the discrete-random separation, of the slowest shaft, and its largest part of the recording.
const BLOCK: (f64, usize) = (4.0, 16);
/// Levels of the kurtogram.
const LEVELS: u32 = 7;

/// What is removed from a recording because it comes from the gears.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BearingSeparation {
    /// The average over the cycle after which the same teeth meet again, which is a cycle of all shafts; where the recording has less than
    /// four cycles those over the revolutions of all shafts with at least eight revolutions: [`synchronous_residual`].
    #[default]
    Averages,
    /// The tones of a constant speed: [`discrete_random_separation`] with blocks of four revolutions of the slowest shaft.
    DiscreteRandom,
    /// All lines of the spectrum get the same amplitude: [`cepstral_prewhitening`].
    Prewhitening,
    /// Nothing.
    None,
}

/// A bearing of a train.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrainBearing {
    /// Its geometry.
    pub geometry: BearingGeometry,
    /// Number of the shaft in its inner ring.
    pub shaft: usize,
}

/// The band whose squared envelope is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum EnvelopeBand {
    /// That in which the verdict sees most; where it tells nothing that of the kurtogram.
    #[default]
    Verdict,
    /// That of the largest kurtosis among those at least three times as wide as the largest BPFI.
    Kurtogram,
    /// A stated one.
    Stated(FrequencyBand),
}

/// How the lines of bearings are looked at; the verdict is the same for all.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BearingSettings {
    /// What is removed first.
    pub separation: BearingSeparation,
    /// The band of the squared envelope.
    pub band: EnvelopeBand,
}

/// What a recording shows about bearings.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BearingRecords {
    /// The verdict about each bearing.
    pub defects: BearingDefects,
    /// Kurtosis in bands of all widths of what was left.
    pub kurtogram: Kurtogram,
    /// The band of the squared envelope.
    pub band: FrequencyBand,
    /// (-) Kurtosis in it, where the kurtogram chose it.
    pub kurtosis: Option<f64>,
    /// For each bearing its spectrum over the orders of its shaft, and its lines.
    pub bearings: Vec<(SquaredEnvelopeSpectrum, Vec<DefectLine>)>,
    /// What is doubtful: shafts whose average was not removed.
    pub warnings: Vec<SignalWarning>,
}

impl TrainRecording<'_> {
    /// Looks at bearings: [`Self::bearing_defects`] judges them, and for people who look there are the kurtogram of what is left without the gears, and in one band
    /// the spectrum of its squared envelope over the orders of each bearing's shaft with its defect lines.
    ///
    /// # Arguments
    /// * `bearings` - the bearings, any number
    /// * `settings` - how
    ///
    /// # Errors
    /// A bearing on a shaft that the train does not have; those of the functions that [`BearingSeparation`] names, of [`kurtogram`] and of [`squared_envelope_order_spectrum`]; those of [`Self::bearing_defects`].
    ///
    /// ```
    /// use meshtone::bearing::NamedBearing;
    /// use meshtone::signal::{BearingSettings, GearTrain, ShaftPhase, StatedTurning, TrainBearing, TrainRecording, TrainTurning};
    ///
    /// // A resonance at 4 kHz that rings whenever a ball passes a place of the outer race, and a mesh of 19 teeth.
    /// let geometry = NamedBearing::find("6205").ok_or("no such bearing")?.geometry;
    /// let phase = ShaftPhase::constant(30.0, 20_000.0, 60_000)?;
    /// let tau = std::f64::consts::TAU;
    /// let ringing = |angle: f64| {
    ///     let since_s = (angle * 3.585).fract() / (30.0 * 3.585);
    ///     (-800.0 * since_s).exp() * (tau * 4000.0 * since_s).sin() + (tau * 19.0 * angle).cos()
    /// };
    /// let signal: Vec<f64> = phase.revolutions.iter().map(|angle| ringing(*angle)).collect();
    /// let train = GearTrain::of_wheels([("wheel", 19)]);
    /// let turning = TrainTurning::Shaft { shaft: 0, phase, stated: StatedTurning::Other };
    /// let recording = TrainRecording { signal: &signal, sampling_rate_hz: 20_000.0, train: &train, turning: &turning };
    /// let found = recording.bearings(&[TrainBearing { geometry, shaft: 0 }], &BearingSettings::default())?;
    /// let (_, lines) = &found.bearings[0];
    /// assert!(lines.iter().any(|line| line.name() == "BPFO" && line.over_median > 50.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn bearings(
        &self,
        bearings: &[TrainBearing],
        settings: &BearingSettings,
    ) -> Result<BearingRecords, SignalError> {
        let phases = self.phases_of(bearings)?;
        let without_cycle = self.without_cycle(&phases)?;
        let defects = self.defects_without(without_cycle.as_ref(), &phases, bearings)?;
        let (SynchronousResidual { first_sample, values: signal }, warning) =
            self.separated(&phases, settings.separation, without_cycle)?;
        let speed_hz = |shaft: usize| phases[shaft].mean_speed_hz(self.sampling_rate_hz);
        let pass_hz = bearings.iter().map(|of| of.geometry.defect_orders().inner_race * speed_hz(of.shaft));
        let kurtogram = kurtogram(&signal, self.sampling_rate_hz, LEVELS)?;
        let chosen = kurtogram.best(LEAST_WIDTH * pass_hz.fold(0.0, f64::max));
        let stated = match settings.band {
            EnvelopeBand::Verdict => {
                let unexplained = defects.unexplained.as_ref().map(|comb| comb.band);
                unexplained.or(defects.races.first().map(|strongest| strongest.band))
            }
            EnvelopeBand::Kurtogram => None,
            EnvelopeBand::Stated(band) => Some(band),
        };
        let chosen = chosen.filter(|_| stated.is_none());
        let whole = FrequencyBand { from_hz: 0.0, to_hz: 0.5 * self.sampling_rate_hz };
        let band = stated.or(chosen.map(|KurtogramBand { band, .. }| band)).unwrap_or(whole);
        let record = |of: &TrainBearing| {
            let phase = phases[of.shaft].part(first_sample..first_sample + signal.len())?;
            let spectrum =
                squared_envelope_order_spectrum(&signal, self.sampling_rate_hz, Some(band), &phase)?;
            let mut lines = defect_lines(&spectrum, &of.geometry.defect_orders(), 1.0);
            // The envelope of a band has nothing beyond its width.
            lines.retain(|line| line.order * speed_hz(of.shaft) <= band.to_hz - band.from_hz);
            Ok((spectrum, lines))
        };
        let bearings = bearings.iter().map(record).collect::<Result<_, SignalError>>()?;
        let kurtosis = chosen.map(|of| of.kurtosis);
        let warnings = warning.into_iter().collect();
        Ok(BearingRecords { defects, kurtogram, band, kurtosis, bearings, warnings })
    }

    /// The phases of all shafts, which have those of the bearings.
    pub(super) fn phases_of(&self, bearings: &[TrainBearing]) -> Result<Vec<ShaftPhase>, SignalError> {
        check_channel(self.signal)?;
        let shafts = self.train.shafts.len();
        if let Some(of) = bearings.iter().find(|of| of.shaft >= shafts) {
            return Err(SignalError::parameter(
                "shaft of a bearing",
                of.shaft as f64,
                "the number of a shaft of the train, counted from 0",
            ));
        }
        (0..shafts).map(|shaft| self.phase(shaft)).collect()
    }

    /// The recording without the average over the cycle after which the same teeth meet again, which is a cycle of all shafts; or how many cycles it has, where
    /// they are too few.
    pub(super) fn without_cycle(
        &self,
        phases: &[ShaftPhase],
    ) -> Result<Result<SynchronousResidual, f64>, SignalError> {
        let (_, cycles_per_revolution) = self.train.spacings(0);
        let mut cycle = phases[0].clone();
        cycle.revolutions.iter_mut().for_each(|angle| *angle *= cycles_per_revolution);
        if cycle.span_rev() < FEWEST_CYCLES {
            return Ok(Err(cycle.span_rev()));
        }
        Ok(Ok(synchronous_residual(self.signal, &[cycle])?))
    }

    /// The recording after the separation, which may be that of its cycles, and what is doubtful about it.
    fn separated(
        &self,
        phases: &[ShaftPhase],
        separation: BearingSeparation,
        without_cycle: Result<SynchronousResidual, f64>,
    ) -> Result<(SynchronousResidual, Option<SignalWarning>), SignalError> {
        let whole = |values| SynchronousResidual { first_sample: 0, values };
        let left = match (separation, without_cycle) {
            (BearingSeparation::None, _) => whole(self.signal.to_vec()),
            (BearingSeparation::Prewhitening, _) => whole(cepstral_prewhitening(self.signal)?),
            (BearingSeparation::DiscreteRandom, _) => {
                let slowest_hz = phases.iter().map(|phase| phase.mean_speed_hz(self.sampling_rate_hz));
                let samples = BLOCK.0 * self.sampling_rate_hz / slowest_hz.fold(f64::INFINITY, f64::min);
                let block = (samples.ceil() as usize).min(self.signal.len() / BLOCK.1);
                let random = discrete_random_separation(self.signal, block, block)?.random;
                // At the ends some of the tones is left.
                let values = random[block / 2..random.len() - block / 2].to_vec();
                SynchronousResidual { first_sample: block / 2, values }
            }
            (BearingSeparation::Averages, Ok(residual)) => residual,
            (BearingSeparation::Averages, Err(_)) => {
                let enough = phases.iter().filter(|phase| phase.span_rev() >= FEWEST_REVOLUTIONS);
                let averaged: Vec<ShaftPhase> = enough.cloned().collect();
                let left = match averaged[..] {
                    [] => whole(self.signal.to_vec()),
                    _ => synchronous_residual(self.signal, &averaged)?,
                };
                return Ok((left, self.not_averaged(phases)));
            }
        };
        Ok((left, None))
    }

    /// The warning of shafts that turn too few times for an average.
    fn not_averaged(&self, phases: &[ShaftPhase]) -> Option<SignalWarning> {
        let named = self.train.shafts.iter().zip(phases);
        let few = named.filter(|(_, phase)| phase.span_rev() < FEWEST_REVOLUTIONS);
        let shafts: Vec<(String, f64)> =
            few.map(|(shaft, phase)| (shaft.name.clone(), phase.span_rev())).collect();
        let of_all = shafts.len() == phases.len();
        (!shafts.is_empty()).then_some(SignalWarning::NotAveraged {
            shafts,
            of_all,
            needed: FEWEST_REVOLUTIONS,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::{GearTrain, StatedTurning, TrainTurning};

    fn look_for(samples: usize, shaft: usize) -> Result<BearingRecords, SignalError> {
        let phase = ShaftPhase::constant(30.0, 20_000.0, samples)?;
        let signal: Vec<f64> = phase.revolutions.iter().map(|angle| (100.0 * angle * angle).sin()).collect();
        let geometry = BearingGeometry::new(9, 7.94, 39.04, 0.0)?;
        let turning = TrainTurning::Shaft { shaft: 0, phase, stated: StatedTurning::Other };
        let train = GearTrain::of_wheels([("pinion", 20), ("gear", 61)]);
        let recording =
            TrainRecording { signal: &signal, sampling_rate_hz: 20_000.0, train: &train, turning: &turning };
        recording.bearings(&[TrainBearing { geometry, shaft }], &BearingSettings::default())
    }

    #[test]
    fn a_shaft_that_there_is_not_is_refused() {
        let refused = look_for(20_000, 2).unwrap_err().to_string();
        assert!(refused.starts_with("shaft of a bearing is 2"), "{refused}");
    }

    #[test]
    fn shafts_that_are_not_averaged_are_named() {
        let named = |seconds: f64| {
            let warnings = look_for((seconds * 20_000.0) as usize, 0).unwrap().warnings;
            warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
        };
        // The pinion turns 30 times a second, the gear 9.8 times.
        assert_eq!(named(2.0), "");
        assert!(named(0.5).contains("has 4.9 revolutions of shaft gear, and an average needs at least 8: its average is not removed"), "{}", named(0.5));
        assert!(
            named(0.2).contains("6.0 revolutions of shaft pinion and 2.0 revolutions of shaft gear"),
            "{}",
            named(0.2)
        );
    }
}
