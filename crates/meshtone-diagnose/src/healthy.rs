//! The change of a wheel since it was healthy.

use meshtone_fourier::Complex64;

use crate::observation::{WheelLines, revolution};

/// The lines of a wheel without those that it had when it was healthy: turned to where they fit best, since two recordings need not
/// begin at the same tooth, and scaled, since their loads may differ.
///
/// # Arguments
/// * `now` - the average now
/// * `healthy` - the average when the wheel was healthy
/// * `last` - the last order that is whole in both
pub(crate) fn beyond_healthy(now: &WheelLines, healthy: &WheelLines, last: usize) -> WheelLines {
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
    let energy: f64 = old.iter().take(count).map(Complex64::norm_sqr).sum();
    let shared: f64 = (0..count).map(|order| (new[order] * (old[order] * turn(order)).conj()).re).sum();
    let scale = (shared / energy.max(f64::MIN_POSITIVE)).clamp(0.0, 3.0);
    let lines = (0..count).map(|order| new[order] - old[order] * turn(order) * scale).collect();
    WheelLines { lines, ..now.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshtone::random::{Draws, Purpose};

    // The same wheel from another tooth on, twice as loud, and a line that was not there.
    #[test]
    fn what_was_there_before_is_taken_away() {
        let mut draws = Draws::new(3, Purpose::DiagnosisNoise, 0);
        let mut line = |_| {
            let [re, im] = draws.normals();
            Complex64::new(re, im)
        };
        let healthy =
            WheelLines { teeth: 38, beside_teeth: Vec::new(), lines: (0..400).map(&mut line).collect() };
        let turned =
            |order: usize| Complex64::from_polar(2.0, std::f64::consts::TAU * order as f64 * 5.0 / 38.0);
        let mut now = healthy.clone();
        now.lines.iter_mut().enumerate().for_each(|(order, line)| *line *= turned(order));
        now.lines[100] += 30.0;
        let beyond = beyond_healthy(&now, &healthy, 399);
        let strongest = (0..400).max_by(|&a, &b| beyond.lines[a].norm().total_cmp(&beyond.lines[b].norm()));
        assert_eq!(strongest, Some(100));
        let rest: f64 = beyond
            .lines
            .iter()
            .enumerate()
            .filter(|(order, _)| *order != 100)
            .map(|(_, line)| line.norm_sqr())
            .sum();
        let before: f64 = now.difference().iter().map(Complex64::norm_sqr).sum();
        assert!(rest < 0.01 * before, "{rest} of {before}");
    }
}
