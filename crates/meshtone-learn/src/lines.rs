//! What an average over the revolutions of a wheel shows, by orders of its shaft.

use meshtone::random::Draws;
use meshtone::signal::{GearTrain, MeanPart, SeparationSettings, SynchronousAverage};
use meshtone_fourier::{Complex64, from_real_spectrum, real_spectrum};

/// Mesh orders of which lines are looked at.
pub const MESH_ORDERS: usize = 16;
/// (-) Part of a recording's Nyquist order up to which its lines are whole.
pub const PASSED: f64 = 0.8;

/// The lines of a wheel's average over the orders of its shaft.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelLines {
    /// Teeth of the wheel, and what else is regular in the average.
    pub separation: SeparationSettings,
    /// (g) Complex amplitude at each order from 0 on: half the peak of a tone, as a line of the spectrum over its length.
    pub lines: Vec<Complex64>,
}

impl WheelLines {
    /// The lines of an average, as far as it is whole and they are looked at.
    ///
    /// # Arguments
    /// * `average` - over the revolutions of the wheel
    /// * `separation` - of the wheel
    pub fn of_average(average: &SynchronousAverage, separation: SeparationSettings) -> Self {
        let passed = (PASSED * average.nyquist_order) as usize;
        Self::of_values(&average.values, separation, passed)
    }

    /// The lines of one revolution.
    ///
    /// # Arguments
    /// * `values` - (g) at equal angles
    /// * `separation` - of the wheel
    /// * `last` - the last order that is whole
    pub fn of_values(values: &[f64], separation: SeparationSettings, last: usize) -> Self {
        let count = values.len().max(1) as f64;
        let mut lines = real_spectrum(values);
        lines.truncate(1 + last.min(Self::most(separation.teeth)));
        lines.iter_mut().for_each(|line| *line /= count);
        Self { separation, lines }
    }

    /// The last order that is looked at.
    ///
    /// # Arguments
    /// * `teeth` - of the wheel
    pub fn most(teeth: usize) -> usize {
        MESH_ORDERS * teeth + teeth / 2
    }

    /// Teeth of the wheel.
    pub fn teeth(&self) -> usize {
        self.separation.teeth
    }

    /// The last order there is.
    pub fn last(&self) -> usize {
        self.lines.len().saturating_sub(1)
    }

    /// The lines without the regular part.
    pub fn difference(&self) -> Vec<Complex64> {
        let regular = self.separation.regular_orders(self.last());
        let kept =
            |(line, is_regular): (&Complex64, bool)| if is_regular { Complex64::default() } else { *line };
        self.lines.iter().zip(regular).map(kept).collect()
    }

    /// The lines up to an order, with noise as a recording has it.
    ///
    /// # Arguments
    /// * `last` - the last order that is kept
    /// * `known_g` - (g) standard deviation of the noise in a line by mesh order from 0 on; the last one holds beyond; empty where it is
    ///   not known
    /// * `unknown_part` - (-) where it is not known: noise in a line, as a part of the difference signal's mean line
    /// * `draws` - of the noise
    #[must_use]
    pub fn with_noise(&self, last: usize, known_g: &[f64], unknown_part: f64, draws: &mut Draws) -> Self {
        let mut noisy = self.clone();
        noisy.lines.truncate(last + 1);
        let count = noisy.lines.len().max(1) as f64;
        let energy: f64 = noisy.difference().iter().map(Complex64::norm_sqr).sum();
        let unknown_g = unknown_part * (energy / count).sqrt();
        let teeth = noisy.teeth().max(1);
        for (order, line) in noisy.lines.iter_mut().enumerate() {
            let deviation_g =
                known_g.get((order + teeth / 2) / teeth).or(known_g.last()).unwrap_or(&unknown_g);
            let [re, im] = draws.normals();
            *line += Complex64::new(re, im) * (deviation_g * std::f64::consts::FRAC_1_SQRT_2);
        }
        noisy
    }
}

/// What is regular in the average of a wheel that is alone on its shaft.
///
/// # Arguments
/// * `teeth` - of the wheel
pub fn separation(teeth: u32) -> SeparationSettings {
    SeparationSettings { mean: MeanPart::Removed, ..SeparationSettings::new(teeth as usize) }
}

/// What is regular in the average of each wheel of a train, in its order.
///
/// # Arguments
/// * `train` - the machine by its tooth counts
pub fn separations(train: &GearTrain) -> Vec<SeparationSettings> {
    let of = |wheel: usize| train.separation(wheel, &separation(train.wheels[wheel].teeth));
    (0..train.wheels.len()).map(of).collect()
}

/// (g) Values of one revolution.
///
/// # Arguments
/// * `lines` - complex amplitudes by order
/// * `points` - how many values
pub fn revolution(lines: &[Complex64], points: usize) -> Vec<f64> {
    let count = points as f64;
    let mut spectrum: Vec<Complex64> = lines.iter().take(points / 2 + 1).map(|line| line * count).collect();
    spectrum.resize(points / 2 + 1, Complex64::default());
    from_real_spectrum(spectrum, points)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn lines_are_those_of_a_revolution() {
        let value = |rev: f64| (TAU * 38.0 * rev).cos() + 0.1 * (TAU * 43.0 * rev).cos();
        let values: Vec<f64> = (0..2048).map(|at| value(f64::from(at) / 2048.0)).collect();
        let lines = WheelLines::of_values(&values, separation(38), 800);
        assert_eq!(lines.last(), WheelLines::most(38));
        assert!((lines.lines[38].norm() - 0.5).abs() < 1e-9);
        assert!(lines.difference()[38].norm() == 0.0 && (lines.difference()[43].norm() - 0.05).abs() < 1e-9);
        let error = revolution(&lines.lines, 2048)
            .iter()
            .zip(&values)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(error < 1e-9, "{error}");
    }
}
