//! Round numbers on axes.

/// Numbers at which an axis is marked.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ticks {
    pub(crate) values: Vec<f64>,
    step: f64,
}

impl Ticks {
    /// Multiples of 1, 2 or 5 × 10ⁿ from `low` to `high`: at least three, from which the scale can be read, and at most
    /// `most` where that leaves three.
    pub(crate) fn nice(low: f64, high: f64, most: usize) -> Self {
        let span = high - low;
        if !(span > 0.0 && span.is_finite()) {
            return Self { values: Vec::new(), step: 1.0 };
        }
        let least_step = span / most.max(2) as f64;
        let power = 10f64.powf(least_step.log10().floor());
        let steps = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
        let coarsest = steps.iter().position(|step| *step >= least_step * (1.0 - 1e-9));
        let ticks = steps[..=coarsest.unwrap_or(steps.len() - 1)]
            .iter()
            .rev()
            .map(|&step| Self::every(step, low, high))
            .find(|ticks| ticks.values.len() >= 3);
        ticks.unwrap_or_else(|| Self::every(power, low, high))
    }

    /// Zero and one round number on either side of it, within `half`.
    pub(crate) fn about_zero(half: f64) -> Self {
        let power = 10f64.powf(half.log10().floor());
        if !(half > 0.0 && power.is_finite() && power > 0.0) {
            return Self { values: Vec::new(), step: 1.0 };
        }
        // Not at the very edge, where the number would reach into the next axes.
        let step = [5.0, 4.0, 3.0, 2.0, 1.0].map(|factor| factor * power).into_iter();
        let step = step.into_iter().find(|step| *step <= 0.95 * half).unwrap_or(0.5 * power);
        Self { values: vec![-step, 0.0, step], step }
    }

    /// Multiples of `step` from `low` to `high`.
    pub(crate) fn every(step: f64, low: f64, high: f64) -> Self {
        let first = (low / step - 1e-9).ceil();
        let last = (high / step + 1e-9).floor();
        let count = if last >= first { (last - first) as usize + 1 } else { 0 };
        Self { values: (0..count.min(1000)).map(|k| (first + k as f64) * step).collect(), step }
    }

    /// Whole numbers only, at most `most` of them.
    pub(crate) fn whole(low: f64, high: f64, most: usize) -> Self {
        let nice = Self::nice(low, high, most);
        if nice.step < 1.0 { Self::every(1.0, low, high) } else { nice }
    }

    /// The number as it stands at the axis.
    pub(crate) fn text(&self, value: f64) -> String {
        let largest = self.values.iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
        let text = if self.step < 1e-4 || largest >= 1e5 {
            if value.abs() < self.step / 2.0 { "0".to_owned() } else { scientific(value, self.step) }
        } else {
            let decimals = (-self.step.log10() - 1e-9).ceil().max(0.0) as usize;
            format!("{:.decimals$}", if value.abs() < self.step / 2.0 { 0.0 } else { value })
        };
        text.replace('-', "−")
    }
}

/// 10 to a whole power, as it stands at a logarithmic axis.
pub(crate) fn log_text(decade: f64) -> String {
    let power = decade.round() as i32;
    let text = match power {
        -4..0 => format!("{:.*}", power.unsigned_abs() as usize, 10f64.powi(power)),
        0..5 => format!("{:.0}", 10f64.powi(power)),
        _ => format!("1e{power}"),
    };
    text.replace('-', "−")
}

/// As many digits as tell neighbours apart.
fn scientific(value: f64, step: f64) -> String {
    let digits = (value.abs().log10().floor() - step.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.digits$e}")
}

/// (-) A number in a sentence: up to four significant digits, no trailing zeros.
pub(crate) fn number(value: f64) -> String {
    if !value.is_finite() {
        return "?".to_owned();
    }
    if value != 0.0 && !(1e-4..1e7).contains(&value.abs()) {
        return format!("{value:.2e}").replace('-', "−");
    }
    let size = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    let decimals = (3 - size).max(0) as usize;
    let text = format!("{value:.decimals$}");
    let text = if decimals > 0 { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(low: f64, high: f64, most: usize) -> Vec<String> {
        let ticks = Ticks::nice(low, high, most);
        ticks.values.iter().map(|&value| ticks.text(value)).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(texts(-1.2, 1.1, 5), ["−1.0", "−0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(texts(20.0, 41.0, 5), ["20", "25", "30", "35", "40"]);
        assert_eq!(texts(0.0, 3e-6, 4), ["0", "1e−6", "2e−6", "3e−6"]);
        assert_eq!(texts(1e6, 1.2e6, 3), ["1.0e6", "1.1e6", "1.2e6"]);
        assert!(texts(1.0, 1.0, 5).is_empty());
        assert!(texts(f64::NAN, 1.0, 5).is_empty());
    }

    #[test]
    fn at_least_three_ticks() {
        for k in 1..1000 {
            let half = 1.37e-3 * 1.02f64.powi(k);
            for most in [2, 4, 5, 8] {
                assert!(Ticks::nice(-half, half, most).values.len() >= 3, "{half} {most}");
                assert!(Ticks::nice(0.7 * half, 1.3 * half, most).values.len() >= 3, "{half} {most}");
            }
            let [low, zero, high] = Ticks::about_zero(half).values[..] else { panic!("{half}") };
            assert!(zero == 0.0 && low == -high && high > 0.4 * half && high < half, "{half} {high}");
        }
        assert!(Ticks::about_zero(0.0).values.is_empty() && Ticks::about_zero(f64::NAN).values.is_empty());
    }

    #[test]
    fn numbers_in_sentences_are_short() {
        assert_eq!(number(3.0), "3");
        assert_eq!(number(2.1534), "2.153");
        assert_eq!(number(-0.05), "−0.05");
        assert_eq!(number(1234.56), "1235");
        assert_eq!(number(0.0), "0");
        assert_eq!(number(100.0), "100");
    }
}
