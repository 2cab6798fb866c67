//! The change of a wheel since it was healthy.

use meshtone_fourier::Complex64;

use crate::lines::{WheelLines, revolution};

/// (lines) How far around each line its neighbours count for the gain from then to now: the gain of a path changes over orders where the speed
/// differs, while damage has another phase at each line than the deviations, so that a sixth of it is lost.
const GAIN_LINES: usize = 3;
/// (-) Largest gain: where there was nothing before, nothing is taken away.
const MOST_GAIN: f64 = 3.0;

/// The lines of a wheel without those that it had when it was healthy: turned to where they fit best, since two recordings need not
/// begin at the same tooth, and behind the gain that fits best around each line, since their loads and speeds may differ.
///
/// # Arguments
/// * `now` - the average now
/// * `healthy` - the average when the wheel was healthy
/// * `last` - the last order that is whole in both
pub fn beyond_healthy(now: &WheelLines, healthy: &WheelLines, last: usize) -> WheelLines {
    let last = last.min(now.last()).min(healthy.last());
    let (new, old) = (now.difference(), healthy.difference());
    let count = last + 1;
    let points = (2 * last + 1).next_power_of_two().max(64);
    // The circular cross-correlation is largest at the turn that fits best.
    let cross: Vec<Complex64> = new.iter().zip(&old).take(count).map(|(a, b)| a * b.conj()).collect();
    let correlation = revolution(&cross, points);
    let at = (0..points).max_by(|&a, &b| correlation[a].total_cmp(&correlation[b])).unwrap_or(0);
    // Between the points by a parabola: at high orders a point is a large part of a period.
    let [before, here, after] = [at + points - 1, at, at + 1].map(|place| correlation[place % points]);
    let bend = before - 2.0 * here + after;
    let place = at as f64 + if bend < 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 };
    let turn = |order: usize| {
        Complex64::from_polar(1.0, -std::f64::consts::TAU * order as f64 * place / points as f64)
    };
    let old: Vec<Complex64> = (0..count).map(|order| old[order] * turn(order)).collect();
    let gain = |order: usize| {
        let around = order.saturating_sub(GAIN_LINES)..=(order + GAIN_LINES).min(last);
        let sums = around.fold((Complex64::default(), f64::MIN_POSITIVE), |(shared, energy), other| {
            let weight = 1.0 - order.abs_diff(other) as f64 / (GAIN_LINES + 1) as f64;
            (shared + weight * new[other] * old[other].conj(), energy + weight * old[other].norm_sqr())
        });
        let gain = sums.0 / sums.1;
        // The square, since a root of each line would take a tenth of the whole diagnosis.
        if gain.norm_sqr() > MOST_GAIN * MOST_GAIN { gain * (MOST_GAIN / gain.norm()) } else { gain }
    };
    let lines = (0..count).map(|order| new[order] - gain(order) * old[order]).collect();
    WheelLines { lines, ..now.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lines::separation;
    use meshtone::random::{Draws, Purpose};

    // The same wheel from another tooth on, behind a resonance that was elsewhere, and a burst that was not there.
    #[test]
    fn what_was_there_before_is_taken_away() {
        let mut draws = Draws::new(3, Purpose::DiagnosisNoise, 0);
        let mut line = |_| {
            let [re, im] = draws.normals();
            Complex64::new(re, im)
        };
        let healthy = WheelLines { separation: separation(38), lines: (0..400).map(&mut line).collect() };
        let resonance = |order: usize, at: f64| {
            let ratio = order as f64 / at;
            Complex64::new(1.0 - ratio * ratio, 0.2 * ratio).inv()
        };
        let turned =
            |order: usize, rev: f64| Complex64::from_polar(1.0, std::f64::consts::TAU * order as f64 * rev);
        let mut now = healthy.clone();
        for (order, line) in now.lines.iter_mut().enumerate() {
            *line *= 2.0 * turned(order, 5.0 / 38.0) * resonance(order, 210.0) / resonance(order, 200.0);
        }
        let alike = now.difference();
        now.lines.iter_mut().enumerate().for_each(|(order, line)| *line += 3.0 * turned(order, 0.3));
        let burst: Vec<Complex64> =
            now.difference().iter().zip(&alike).map(|(now, alike)| now - alike).collect();
        let beyond = beyond_healthy(&now, &healthy, 399);
        let energy = |lines: &[Complex64]| lines.iter().map(Complex64::norm_sqr).sum::<f64>();
        let rest: Vec<Complex64> =
            beyond.lines.iter().zip(&burst).map(|(found, burst)| found - burst).collect();
        let part = energy(&rest) / energy(&burst);
        // The gain follows the part of the burst that its lines share by chance: of so many neighbours with their weights, Σw²/(Σw)² of it.
        let weights: Vec<f64> = (-3i32..=3).map(|away| 1.0 - f64::from(away.abs()) / 4.0).collect();
        let [sum, squares] = [1, 2].map(|power| weights.iter().map(|weight| weight.powi(power)).sum::<f64>());
        assert!((part / (squares / (sum * sum)) - 1.0).abs() < 0.1, "{part} of the burst's energy");
        // Of a recording that is the healthy one, turned and twice as loud, nothing is left.
        let mut same = healthy.clone();
        same.lines.iter_mut().enumerate().for_each(|(order, line)| *line *= 2.0 * turned(order, 5.0 / 38.0));
        let whole = energy(&same.difference());
        let left = energy(&beyond_healthy(&same, &healthy, 399).lines);
        assert!(left < 0.01 * whole, "{left} of {whole}");
    }
}
