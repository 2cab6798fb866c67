//! Damage that grows until its gear fails.

use meshtone::random::{Draws, Purpose};

use super::Distribution;

/// The law by which a damage grows from its first size to failure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// A crack, by Paris: `da/dN = C ΔK^m`, with `ΔK` as the root of its depth.
    Paris {
        /// (-) m.
        exponent: f64,
    },
    /// Wear, by Archard: as the distance that the flanks slide under their load.
    Archard,
    /// Pits, by their count: each pit raises the severity by the same amount. The rate at which pits appear grows as a power of the age.
    Pits {
        /// Number of pits at failure.
        count: u32,
        /// (-) Of the expected count over the age: 1 for pits that come at random, more where they come ever faster.
        exponent: f64,
    },
}

/// What the records of a run are spread over evenly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SpreadOver {
    /// Its age, as where a machine is looked at once a week.
    #[default]
    Age,
    /// The severity, so that as many records have a large damage as a small one, however fast it grows at the end.
    Severity,
}

meshtone_toml::named!(SpreadOver { Age = "age", Severity = "severity" });

/// The growth of the damage of a class's units to failure. All records of a unit in such a class are of one run, in one mounting.
#[derive(Debug, Clone, PartialEq)]
pub struct Growth {
    /// The law of growth.
    pub law: Law,
    /// (-) Severity at the start of a run.
    pub start: f64,
    /// (-) Severity at failure.
    pub failure: f64,
    /// (rev) Turns of the damaged wheel, or of the damaged bearing's shaft, from start to failure.
    pub life_rev: Distribution,
    /// (-) Part of the runs that are stopped before failure, at any part of their life from a fifth on.
    pub censored: f64,
    /// What the records are spread over.
    pub over: SpreadOver,
}

/// The position of a record in the run to failure of its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunPosition {
    /// (rev) Turns since the run began.
    pub age_rev: f64,
    /// (rev) Turns to failure. If the run was stopped before failure: turns to the stop, so that at least so many were left.
    pub remaining_rev: f64,
    /// Whether the run was stopped before failure.
    pub is_censored: bool,
    /// (-) How severe the damage is.
    pub severity: f64,
}

/// (-) Part of the life after which a run may be stopped.
const EARLIEST_END: f64 = 0.2;

impl Law {
    /// The laws' names.
    pub const NAMES: [&'static str; 3] = ["paris", "archard", "pits"];

    /// Its name in a plan.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paris { .. } => Self::NAMES[0],
            Self::Archard => Self::NAMES[1],
            Self::Pits { .. } => Self::NAMES[2],
        }
    }
}

impl Growth {
    /// Computes how severe the damage is at a part of its life.
    ///
    /// # Arguments
    /// * `part` - (-) of the life, 0 to 1
    /// * `seed` - of the run: when pits come
    ///
    /// Sources: P. Paris, F. Erdogan, "A critical analysis of crack propagation laws", J. Basic Eng. 85 (1963) 528–533, integrated for
    /// a crack of which the stress intensity's factor of shape does not change; J. F. Archard, "Contact and rubbing of flat surfaces",
    /// J. Appl. Phys. 24 (1953) 981–988; L. H. Crow, "Reliability analysis for complex, repairable systems", SIAM (1974) 379–410, whose
    /// power-law process has, given its count, the order statistics of `u^(1/β)` for times.
    ///
    /// ```
    /// use meshtone_dataset::plan::{Distribution, Growth, Law};
    ///
    /// let life_rev = Distribution::Fixed(1e6);
    /// let crack = Growth { law: Law::Paris { exponent: 2.0 }, start: 0.01, failure: 1.0, life_rev, censored: 0.0, over: Default::default() };
    /// assert_eq!((crack.severity_at(0.0, 1), crack.severity_at(1.0, 1)), (0.01, 1.0));
    /// assert!((crack.severity_at(0.5, 1) - 0.1).abs() < 1e-12); // exponential growth
    /// ```
    pub fn severity_at(&self, part: f64, seed: u64) -> f64 {
        let (start, failure) = (self.start, self.failure);
        match self.law {
            Law::Paris { exponent: 2.0 } => start * libm::pow(failure / start, part),
            Law::Paris { exponent } => {
                let power = 1.0 - exponent / 2.0;
                let (from, to) = (libm::pow(start, power), libm::pow(failure, power));
                libm::pow(from + part * (to - from), 1.0 / power).clamp(start, failure)
            }
            Law::Archard => start + part * (failure - start),
            Law::Pits { count, exponent } => {
                let mut draws = Draws::new(seed, Purpose::DatasetPits, 0);
                // The last pit is the failure.
                let came =
                    (1..count).filter(|_| libm::pow(draws.uniform(0.5, 0.5), 1.0 / exponent) <= part).count();
                let came = came + usize::from(part >= 1.0);
                start + came as f64 / f64::from(count) * (failure - start)
            }
        }
    }

    /// Computes where a record is in the run of its unit: runs are looked at as often as they have records, once in each of as many equal
    /// parts of the time that they are observed, or of the severity that they reach in it.
    ///
    /// # Arguments
    /// * `seed` - of the run
    /// * `place` - of the record, from 0
    /// * `records` - of the run
    pub fn age(&self, seed: u64, place: u64, records: u64) -> RunPosition {
        let mut draws = Draws::new(seed, Purpose::DatasetRun, 0);
        let [life, stopped, end] = [(); 3].map(|()| draws.uniform(0.5, 0.5));
        let life_rev = self.life_rev.at(life, 0)[0];
        let is_censored = stopped < self.censored;
        let observed = if is_censored { EARLIEST_END + (1.0 - EARLIEST_END) * end } else { 1.0 };
        let within = Draws::new(seed, Purpose::DatasetInspection, place).uniform(0.5, 0.5);
        let spread = (place as f64 + within) / records.max(1) as f64;
        let part = match self.over {
            SpreadOver::Age => observed * spread,
            SpreadOver::Severity => {
                let reached = self.severity_at(observed, seed) - self.start;
                self.part_at(self.start + spread * reached, observed, seed)
            }
        };
        RunPosition {
            age_rev: part * life_rev,
            remaining_rev: (observed - part) * life_rev,
            is_censored,
            severity: self.severity_at(part, seed),
        }
    }

    /// (-) Part of the life, at most `latest`, at which a severity is reached: by bisection, because pits grow in steps.
    fn part_at(&self, severity: f64, latest: f64, seed: u64) -> f64 {
        let [mut before, mut after] = [0.0, latest];
        for _ in 0..53 {
            let middle = 0.5 * (before + after);
            let side = if self.severity_at(middle, seed) < severity { &mut before } else { &mut after };
            *side = middle;
        }
        after
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn growth(law: Law) -> Growth {
        Growth {
            law,
            start: 0.02,
            failure: 0.9,
            life_rev: Distribution::LogUniform([1e5, 1e7]),
            censored: 0.3,
            over: SpreadOver::Age,
        }
    }

    // The law's own derivative: da/dN over a^(m/2) is the same everywhere.
    #[test]
    fn a_crack_grows_by_paris() {
        let crack = growth(Law::Paris { exponent: 3.0 });
        let rate = |part: f64| {
            let step = 1e-6;
            let [before, after] = [part - step, part + step].map(|part| crack.severity_at(part, 1));
            (after - before) / (2.0 * step) / crack.severity_at(part, 1).powf(1.5)
        };
        let first = rate(0.01);
        assert!([0.2, 0.5, 0.9, 0.99].into_iter().all(|part| (rate(part) / first - 1.0).abs() < 1e-6));
        assert!((crack.severity_at(1.0, 1) - 0.9).abs() < 1e-12);
    }

    #[test]
    fn pits_come_one_by_one_as_a_power_of_the_age() {
        let pits = growth(Law::Pits { count: 40, exponent: 2.0 });
        let mut mean = 0.0;
        for seed in 0..500 {
            let severities: Vec<f64> =
                (0..=100).map(|i| pits.severity_at(f64::from(i) / 100.0, seed)).collect();
            assert!(severities.windows(2).all(|pair| pair[1] >= pair[0]));
            assert_eq!((severities[0], severities[100]), (0.02, 0.9));
            mean += (severities[50] - 0.02) / 0.88 / 500.0;
        }
        // A quarter of the 39 before the last have come by half the life.
        assert!((mean - 0.25 * 39.0 / 40.0).abs() < 0.01, "{mean}");
    }

    #[test]
    fn a_run_goes_on_from_record_to_record_and_ends_in_failure_or_is_censored() {
        let wear = growth(Law::Archard);
        let mut censored = 0;
        for seed in 0..1000 {
            let ages: Vec<RunPosition> = (0..10).map(|place| wear.age(seed, place, 10)).collect();
            assert!(ages.windows(2).all(|pair| pair[1].age_rev > pair[0].age_rev));
            let end = |age: &RunPosition| age.age_rev + age.remaining_rev;
            assert!(ages.iter().all(|age| (end(age) / end(&ages[0]) - 1.0).abs() < 1e-12));
            assert!(ages.iter().all(|age| age.is_censored == ages[0].is_censored));
            assert!((1e5 * EARLIEST_END..1e7).contains(&end(&ages[0])));
            censored += u32::from(ages[0].is_censored);
        }
        assert!((250..350).contains(&censored), "{censored}");
    }

    #[test]
    fn records_over_the_severity_are_in_equal_parts_of_it() {
        for law in [Law::Paris { exponent: 3.0 }, Law::Pits { count: 1000, exponent: 2.0 }] {
            let run = Growth { over: SpreadOver::Severity, censored: 0.0, ..growth(law) };
            for place in 0..10 {
                let severity = run.age(7, place, 10).severity;
                let part = 10.0 * (severity - 0.02) / 0.88 - place as f64;
                assert!((-1e-9..1.02).contains(&part), "{law:?}: {severity} of record {place}");
            }
        }
    }
}
