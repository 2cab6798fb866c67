//! Round numbers on axes.

/// Numbers at which an axis is marked.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ticks {
    pub(crate) values: Vec<f64>,
    step: f64,
    scale: Scale,
    /// In place of the numbers.
    names: Vec<String>,
}

/// How the numbers at an axis follow from the values.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Scale {
    Linear,
    /// The values are decadic logarithms.
    Logarithmic,
    /// The values are decadic logarithms of powers of 10.
    Decades,
}

impl Ticks {
    /// Multiples of 1, 2 or 5 × 10ⁿ from `low` to `high`: at least three, from which the scale can be read, and at most
    /// `most` where that leaves three.
    pub(crate) fn nice(low: f64, high: f64, most: usize) -> Self {
        let span = high - low;
        if !(span > 0.0 && span.is_finite()) {
            return Self::linear(Vec::new(), 1.0);
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
            return Self::linear(Vec::new(), 1.0);
        }
        // Not at the very edge, where the number would reach into the next axes.
        let step = [5.0, 4.0, 3.0, 2.0, 1.0].map(|factor| factor * power).into_iter();
        let step = step.into_iter().find(|step| *step <= 0.95 * half).unwrap_or(0.5 * power);
        Self::linear(vec![-step, 0.0, step], step)
    }

    /// Multiples of `step` from `low` to `high`.
    pub(crate) fn every(step: f64, low: f64, high: f64) -> Self {
        let first = (low / step - 1e-9).ceil();
        let last = (high / step + 1e-9).floor();
        let count = if last >= first { (last - first) as usize + 1 } else { 0 };
        Self::linear((0..count.min(1000)).map(|k| (first + k as f64) * step).collect(), step)
    }

    fn linear(values: Vec<f64>, step: f64) -> Self {
        Self { values, step, scale: Scale::Linear, names: Vec::new() }
    }

    /// Names in place of the whole numbers from 1 on.
    pub(crate) fn named(names: &[String]) -> Self {
        Self { names: names.to_vec(), ..Self::every(1.0, 1.0, names.len() as f64) }
    }

    /// Powers of 10, for a logarithmic axis between decadic logarithms.
    pub(crate) fn decades([low, high]: [f64; 2]) -> Self {
        Self { scale: Scale::Decades, ..Self::every(1.0, low, high) }
    }

    /// Decadic logarithms of round numbers, for a logarithmic axis: the fewest of 10ⁿ, of 1, 2 and 5 × 10ⁿ, and
    /// so on to 1 to 9 × 10ⁿ, that are three or more; on a shorter axis those of an even one.
    ///
    /// # Arguments
    /// * `low`, `high` - decadic logarithms of the axis' ends
    pub(crate) fn of_logarithms(low: f64, high: f64) -> Self {
        let decades = low.floor() as i32..=high.ceil() as i32;
        let inside = |factors: &[f64]| -> Vec<f64> {
            let all = decades.clone().flat_map(|n| factors.iter().map(move |f| f.log10() + f64::from(n)));
            all.filter(|value| (low - 1e-9..=high + 1e-9).contains(value)).collect()
        };
        let nine = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
        let sets: [&[f64]; 4] = [&[1.0], &[1.0, 2.0, 5.0], &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0], &nine];
        let values = sets.into_iter().map(inside).find(|values| values.len() >= 3);
        let even = || {
            let ticks = Self::nice(10f64.powf(low), 10f64.powf(high), 5);
            ticks.values.iter().map(|value| value.log10()).collect()
        };
        Self { values: values.unwrap_or_else(even), step: 1.0, scale: Scale::Logarithmic, names: Vec::new() }
    }

    /// Whole numbers only, at most `most` of them.
    pub(crate) fn whole(low: f64, high: f64, most: usize) -> Self {
        let nice = Self::nice(low, high, most);
        if nice.step < 1.0 { Self::every(1.0, low, high) } else { nice }
    }

    /// Every second, third, … of the values, so that there are at most `most`; 0 stays where it is one of them.
    pub(crate) fn thinned(mut self, most: usize) -> Self {
        let every = self.values.len().div_ceil(most.max(1)).max(1);
        let zero = self.values.iter().position(|value| value.abs() < 0.5 * self.step).unwrap_or(0);
        let mut place = 0..;
        self.values.retain(|_| place.next().is_some_and(|k: usize| k % every == zero % every));
        self
    }

    /// The number as it stands at the axis.
    pub(crate) fn text(&self, value: f64) -> String {
        if let Some(name) = self.names.get((value.round() as usize).wrapping_sub(1)) {
            return name.clone();
        }
        match self.scale {
            Scale::Linear => {}
            Scale::Logarithmic => return number(10f64.powf(value)),
            Scale::Decades => return power_of_ten(value.round() as i32),
        }
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
fn power_of_ten(power: i32) -> String {
    let text = match power {
        -4..0 => format!("{:.*}", power.unsigned_abs() as usize, 10f64.powi(power)),
        0..5 => format!("{:.0}", 10f64.powi(power)),
        _ => format!("1e{power}"),
    };
    text.replace('-', "−")
}

/// Writes as many digits as distinguish neighbours.
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
    fn thinned_ticks_keep_zero() {
        let values = |most| Ticks::every(0.2, -0.2, 0.8).thinned(most).values.len();
        assert_eq!((values(9), values(5), values(3), values(2)), (6, 3, 3, 2));
        assert!(Ticks::every(0.2, -0.2, 0.8).thinned(2).values.contains(&0.0));
        assert_eq!(Ticks::every(0.5, 0.5, 1.5).thinned(2).values, [0.5, 1.5]);
    }

    #[test]
    fn logarithmic_ticks_are_round() {
        let texts = |low: f64, high: f64| -> Vec<String> {
            let ticks = Ticks::of_logarithms(low.log10(), high.log10());
            ticks.values.iter().map(|&value| ticks.text(value)).collect()
        };
        assert_eq!(texts(0.01, 30.0), ["0.01", "0.1", "1", "10"]);
        assert_eq!(texts(0.2, 8.0), ["0.2", "0.5", "1", "2", "5"]);
        assert_eq!(texts(0.9, 3.1), ["1", "1.5", "2", "3"]);
        assert_eq!(texts(0.58, 0.82), ["0.6", "0.7", "0.8"]);
        assert_eq!(texts(3.11, 3.42), ["3.2", "3.3", "3.4"]);
        assert_eq!(texts(0.0101, 0.0104), ["0.0101", "0.0102", "0.0103", "0.0104"]);
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
