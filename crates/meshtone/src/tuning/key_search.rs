//! The search for numbers of the scenario.

use std::sync::Arc;

use super::candidates::{Region, place, place_of, rounds, value};
use super::search::Grid;
use super::simulations::{Differences, Simulations};
use super::tune::{LeftOutCase, TuningInputs, tune_among};
use super::{Experiment, Fit, HybridError, SimulatedCases, TunedKey, TunedKeys};
use crate::scenario::Scenario;
use crate::threads;

/// The best combinations of a ranking, which predict what it leaves out, or whose parameters the intervals hold where their error allows
/// it; no others are kept.
const KEPT: usize = 12;
/// Simulations that are made, and whose signals are held, at the same time.
const SIMULATED_TOGETHER: usize = 448;

/// A combination of values that was simulated, and its fit to the cases that count.
struct Candidate {
    places: Vec<f64>,
    fit: Fit,
    differences: Arc<Differences>,
}

/// The combinations that fit best all cases, or all but one.
///
/// Whatever is drawn near them knows the cases that count, and therefore enters no other ranking.
struct Ranking {
    left_out: Option<usize>,
    /// The best first.
    best: Vec<Candidate>,
}

impl Ranking {
    fn enter(&mut self, candidate: Candidate) {
        // Of equals the one that was drawn first.
        let rank = self.best.partition_point(|other| other.fit.error <= candidate.fit.error);
        self.best.insert(rank, candidate);
        self.best.truncate(KEPT);
    }

    fn simulated(&self) -> Result<Vec<SimulatedCases>, HybridError> {
        self.best.iter().map(|candidate| SimulatedCases::new(candidate.differences.to_vec())).collect()
    }

    fn with_fits<'a>(&self, simulated: &'a [SimulatedCases]) -> Vec<(&'a SimulatedCases, Fit)> {
        simulated.iter().zip(self.best.iter().map(|candidate| candidate.fit)).collect()
    }
}

/// A combination that is to be simulated.
struct Wish {
    places: Vec<f64>,
    /// Number of the ranking that it enters; all where it was drawn without a look at the measurements.
    ranking: Option<usize>,
}

pub(super) struct KeySearch<'a> {
    experiment: &'a Experiment,
    simulations: &'a Simulations<'a>,
    common: TuningInputs<'a>,
    /// That of all cases first, then with each case left out.
    rankings: Vec<Ranking>,
    candidates: usize,
    failed: usize,
    first_failure: Option<String>,
}

impl<'a> KeySearch<'a> {
    /// # Arguments
    /// * `original` - the scenario as it is, the first that is ranked
    pub(super) fn new(
        experiment: &'a Experiment,
        simulations: &'a Simulations<'a>,
        common: TuningInputs<'a>,
        original: &SimulatedCases,
    ) -> Result<Self, HybridError> {
        let left_out = std::iter::once(None).chain((0..experiment.cases.len()).map(Some));
        let rankings = left_out.map(|left_out| Ranking { left_out, best: Vec::new() }).collect();
        let mut search =
            Self { experiment, simulations, common, rankings, candidates: 0, failed: 0, first_failure: None };
        let wish = Wish { places: own_places(experiment), ranking: None };
        let fits = search.fits(&wish, original.differences().to_vec())?;
        search.keep(wish, fits);
        Ok(search)
    }

    /// Simulates the rounds, the first one anywhere and near the scenario's own values, the others near the best so far: half of each for
    /// the ranking of all cases, the other half shared by those that leave one out.
    pub(super) fn run(mut self) -> Result<TunedKeys, HybridError> {
        let together = (SIMULATED_TOGETHER / self.experiment.cases.len()).max(1);
        let mut first = 0;
        for (round, count) in rounds(self.experiment.candidates).into_iter().enumerate() {
            let wishes = self.wishes(round, first..first + count);
            first += count;
            let mut wishes = wishes.into_iter().peekable();
            while wishes.peek().is_some() {
                self.try_combinations(wishes.by_ref().take(together).collect())?;
            }
        }
        if self.candidates == 0 {
            return Err(HybridError::NoCandidate { first_failure: self.first_failure.unwrap_or_default() });
        }
        let predicted = threads::try_map(self.rankings[1..].iter().enumerate(), |(case, ranking)| {
            let simulated = ranking.simulated()?;
            self.common.prediction(&ranking.with_fits(&simulated), case)
        })?;
        let of_all = &self.rankings[0];
        let mut simulated = of_all.simulated()?;
        let mut tuning = tune_among(&of_all.with_fits(&simulated), &self.common)?;
        tuning.left_out = LeftOutCase::all(self.common.target.measured, predicted);
        Ok(TunedKeys {
            values: self.values(&of_all.best[0].places),
            simulated: simulated.swap_remove(0),
            tuning,
            candidates: self.candidates,
            failed: self.failed,
            first_failure: self.first_failure,
        })
    }

    /// The combinations of a round.
    ///
    /// # Arguments
    /// * `numbers` - of the combinations, over all rounds
    fn wishes(&self, round: usize, numbers: std::ops::Range<usize>) -> Vec<Wish> {
        let Experiment { keys, seed, .. } = self.experiment;
        let own = own_places(self.experiment);
        // The best of the earlier rounds, not of this one.
        let places = |ranking: &Ranking| ranking.best.iter().map(|best| best.places.clone()).collect();
        let best: Vec<Vec<Vec<f64>>> = self.rankings.iter().map(places).collect();
        let (first, cases) = (numbers.start, best.len() - 1);
        let wish = |number: usize| {
            // A round begins with the best of each ranking, however few its combinations are.
            let half = (number - first) / 2;
            let (ranking, region) = if round == 0 {
                (None, Region::of_first_round(number, &own))
            } else if number.is_multiple_of(2) {
                (Some(0), Region::of_round(round, half, &best[0]))
            } else {
                let ranking = 1 + number / 2 % cases;
                (Some(ranking), Region::of_round(round, half / cases, &best[ranking]))
            };
            Wish { places: place(keys, *seed, number, region), ranking }
        };
        numbers.map(wish).collect()
    }

    fn values(&self, places: &[f64]) -> Vec<f64> {
        self.experiment.keys.iter().zip(places).map(|(key, &at)| value(key, at)).collect()
    }

    /// Simulates some combinations and ranks them.
    fn try_combinations(&mut self, wishes: Vec<Wish>) -> Result<(), HybridError> {
        let (mut possible, mut scenarios) = (Vec::new(), Vec::new());
        for wish in wishes {
            let values = self.values(&wish.places);
            let all = self.experiment.cases.iter().map(|case| self.experiment.scenario_with(case, &values));
            match all.collect::<Result<Vec<Scenario>, _>>() {
                Ok(all) => {
                    possible.push(wish);
                    scenarios.push(all);
                }
                Err(error) => {
                    self.simulations.skip_one();
                    self.fail(&error);
                }
            }
        }
        let simulated = self.simulations.run(scenarios)?;
        let fitted = threads::map(possible.into_iter().zip(simulated), |(wish, simulated)| {
            let fits = simulated.and_then(|simulated| self.fits(&wish, simulated));
            (wish, fits)
        });
        for (wish, fits) in fitted {
            match fits {
                Ok(fits) => {
                    self.candidates += 1;
                    self.keep(wish, fits);
                }
                Err(HybridError::Cancelled) => return Err(HybridError::Cancelled),
                Err(error) => self.fail(&error),
            }
        }
        Ok(())
    }

    fn fail(&mut self, error: &HybridError) {
        self.failed += 1;
        self.first_failure.get_or_insert_with(|| error.to_string());
    }

    /// Fits a combination's simulations to the cases of every ranking that it enters.
    fn fits(&self, wish: &Wish, differences: Differences) -> Result<Fits, HybridError> {
        let simulated = SimulatedCases::new(differences)?;
        let grid = Grid::new(&simulated, self.common.target)?;
        let entered = wish.ranking.map_or(0..self.rankings.len(), |ranking| ranking..ranking + 1);
        let fits = entered.map(|ranking| Ok((ranking, grid.fit(self.rankings[ranking].left_out)?)));
        Ok(Fits {
            of_rankings: fits.collect::<Result<_, HybridError>>()?,
            differences: simulated.into_differences(),
        })
    }

    fn keep(&mut self, wish: Wish, fits: Fits) {
        let differences = Arc::new(fits.differences);
        for (ranking, fit) in fits.of_rankings {
            let (places, differences) = (wish.places.clone(), differences.clone());
            self.rankings[ranking].enter(Candidate { places, fit, differences });
        }
    }
}

/// The fits to a combination's simulations, each with the number of its ranking.
struct Fits {
    of_rankings: Vec<(usize, Fit)>,
    differences: Differences,
}

/// Where the scenario's own values lie, each in \[0, 1) of its range; a fault's are those of the first case that has it.
fn own_places(experiment: &Experiment) -> Vec<f64> {
    let place = |key: &TunedKey| {
        let own = experiment.cases.iter().find_map(|case| experiment.scenario(case).number(&key.key));
        own.map_or(0.5, |value| place_of(key, value))
    };
    experiment.keys.iter().map(place).collect()
}
