//! A test whether a speed that is stated to be constant varies.

use super::fine_orders::{FineOrders, affordable};
use super::hypotheses::Hypothesis;
use crate::signal::statistics::StraightLine;
use crate::signal::{AngularSettings, AngularSignal, MeshTone, ShaftPhase, angular_resample};

/// Harmonics whose tone is followed.
const FOLLOWED: [u32; 2] = [1, 2];
/// (shaft orders) Half width of the band in which a tone is followed: it ends before the first sideband.
const HALF_BAND: f64 = 0.95;
/// Least gain of the harmonics that were not followed, over both trackings.
const LEAST_GAIN: f64 = 5.0;
/// (mesh cycles) Least rms deviation from the best constant speed that is a varying one.
const LEAST_DEVIATION: f64 = 0.15;

/// (-) Standard deviation of the speed over its mean, where the mesh harmonics show that it varies.
///
/// Along the phase of one harmonic's tone the others become lines, if it is a mesh; in noise, or at a constant speed, they stand
/// out no more than before. A tone that was followed does not count for itself.
pub(super) fn varying_speed(
    angular: &AngularSignal,
    orders: &FineOrders,
    as_stated: &Hypothesis,
    teeth: u32,
) -> Option<f64> {
    let points = angular.points_per_revolution;
    let part = affordable(angular)?;
    let mut gain = 0.0;
    let mut variation = None;
    for harmonic in FOLLOWED {
        // A revolution is the unit of time.
        let tone = MeshTone { harmonic, half_band_hz: Some(HALF_BAND), ..MeshTone::new(teeth, 1.0) };
        let Ok(phase) = ShaftPhase::from_mesh_tone(part, points as f64, &tone) else { continue };
        let of_harmonic = phase_deviation(&phase, points);
        if of_harmonic.rms_rev * f64::from(teeth) < LEAST_DEVIATION {
            return None;
        }
        let settings = AngularSettings { points_per_revolution: Some(points), ..AngularSettings::default() };
        let Ok(followed) = angular_resample(part, &phase, &settings) else { continue };
        let nyquist_order = followed.nyquist_order.min(angular.nyquist_order);
        let Some(along) = FineOrders::of(&AngularSignal { nyquist_order, ..followed }) else { continue };
        let others = |of: &FineOrders| -> f64 {
            let is_other = |order: f64| (order - tone.per_revolution()).abs() > 0.5;
            let lines = as_stated.mesh_lines(of).filter(|(order, _)| is_other(*order));
            lines.map(|(_, prominence)| prominence.max(0.0)).sum()
        };
        gain += others(&along) - others(orders);
        variation = variation.or(Some(of_harmonic.of_speed));
    }
    variation.filter(|_| gain > LEAST_GAIN)
}

/// Deviation of a phase from that of a constant speed.
struct PhaseDeviation {
    /// (rev) Rms deviation from the straight line through it.
    rms_rev: f64,
    /// (-) Standard deviation of the speeds of its revolutions over their mean.
    of_speed: f64,
}

/// # Arguments
/// * `points` - values of the phase in a revolution
fn phase_deviation(phase: &ShaftPhase, points: usize) -> PhaseDeviation {
    // Once in each revolution.
    let turned: Vec<f64> = phase.revolutions.iter().step_by(points).copied().collect();
    let StraightLine { slope, off, .. } = StraightLine::through(&turned);
    let steps = turned.windows(2).map(|pair| (pair[1] - pair[0] - slope).powi(2));
    PhaseDeviation {
        rms_rev: (off / turned.len() as f64).sqrt(),
        of_speed: (steps.sum::<f64>() / (turned.len() as f64 - 1.0)).sqrt() / slope,
    }
}
