//! Rules of wheels on shafts of beams.

use super::super::layout::{entry_key, find, section};
use super::super::{
    Fault, Layout, Member, MemoryLimit, OfSet, Scenario, ScenarioError, ScenarioWarning, Sensor, Shafts,
    WarningKind, long,
};
use super::{DrivenSpeed, duration, pitch_line_mm};
use crate::bearing::RollingParts;
use crate::damage::check_faults;
use crate::keys::{Keys, below, check_keys, check_rows, require};
use crate::machine::Bearing;
use crate::wheel::quality::{check_errors, one_source};

impl Scenario {
    /// Every value, alone and against the others. Returns warnings about what can be simulated.
    pub(in crate::scenario) fn check_shafts(
        &self,
        Shafts { shafts, bearings, housing, planetary }: &Shafts,
        limit: MemoryLimit,
    ) -> Result<Vec<ScenarioWarning>, ScenarioError> {
        if !self.model.teeth_part() {
            let problem = "must be \"contact\" for a gearbox; the other models accept one pair only";
            return Err(ScenarioError::new("model", format!("\"{}\"", self.model.name()), problem));
        }
        if self.solver.initial_displacement.is_some() || self.solver.initial_velocity.is_some() {
            let problem = "is of the coordinates of a pair in a rig; gearboxes start in equilibrium";
            return Err(ScenarioError::new("solver.initial_velocity", "", problem));
        }
        check_rows(&long::top().rows, self, "")?;
        check_list("shaft", shafts)?;
        check_list("wheel", &self.wheels[..self.own_wheels()])?;
        check_list("mesh", &self.meshes[..self.own_meshes()])?;
        check_list("planetary", planetary)?;
        self.check_sets()?;
        check_list("bearing", bearings)?;
        for (index, sensor) in self.sensors.iter().enumerate() {
            check_rows(&Sensor::rows_of_shafts(), sensor, "sensor")
                .and_then(|()| sensor.check_signal())
                .map_err(|error| error.in_entry("sensor", index, self.sensors.len()))?;
        }
        if let Some(housing) = housing {
            check_keys(housing, "housing")?;
        }
        check_rows(&long::operation().rows, self, "operation")?;
        check_rows(&long::solver().rows, self, "solver")?;
        self.check_counts()?;
        let names: Vec<&str> = self.shafts().iter().map(|shaft| shaft.name.as_str()).collect();
        self.check_ripple(&names)?;
        self.check_pieces()?;
        self.rolling_bearings()?;
        self.operation.check()?;
        self.check_length(limit)?;
        let layout = self.layout()?;
        self.driven_speed(&layout).check()?;
        self.check_faults(&layout)?;
        self.check_quality(&layout)?;
        self.places(&layout)?;
        Ok(self.warnings(&layout))
    }

    fn check_counts(&self) -> Result<(), ScenarioError> {
        let counts = [
            ("shaft", self.shafts().len(), 2),
            ("wheel", self.wheels.len(), 2),
            ("mesh", self.meshes.len(), 1),
        ];
        if let Some((name, count, least)) = counts.into_iter().find(|(_, count, least)| count < least) {
            let problem = format!("there are {count} [[{name}]]; a gearbox has at least {least}");
            return Err(ScenarioError::new(name, "", problem).with_help("see `meshtone init gearbox`"));
        }
        let most = crate::solver::MOST_MESHES;
        if self.meshes.len() > most {
            let problem = format!("there are {} meshes; must be at most {most}", self.meshes.len());
            let error = ScenarioError::new("mesh", "", problem);
            return Err(error.with_help("leave out meshes that carry no load"));
        }
        Ok(())
    }

    /// The shafts of the torque's harmonics must be there.
    pub(super) fn check_ripple(&self, names: &[&str]) -> Result<(), ScenarioError> {
        let ripple = &self.operation.torque_ripple;
        let named = ripple.iter().enumerate().filter_map(|(index, of)| Some((index, of.shaft.as_ref()?)));
        for (index, shaft) in named {
            find(names, shaft, "shaft").map_err(|error| {
                let key = entry_key("torque_ripple", index, ripple.len(), "shaft");
                error.with_key(format!("operation.{key}"))
            })?;
        }
        Ok(())
    }

    /// What the rolling bearings are made of: each with its number.
    ///
    /// # Errors
    /// Those of [`Bearing::rolling`]; too many of them.
    pub(crate) fn rolling_bearings(&self) -> Result<Vec<(usize, RollingParts)>, ScenarioError> {
        let entries = self.bearings().len();
        let rolling = |(number, bearing): (usize, &Bearing)| match bearing.rolling() {
            Ok(parts) => parts.map(|parts| Ok((number, parts))),
            Err(error) => {
                let key = entry_key("bearing", number, entries, &error.key);
                Some(Err(error.with_key(key)))
            }
        };
        let rolling: Vec<_> =
            self.bearings().iter().enumerate().filter_map(rolling).collect::<Result<_, _>>()?;
        let most = crate::solver::MOST_ROLLING_BEARINGS;
        if rolling.len() > most {
            let problem = format!("there are {} rolling bearings; must be at most {most}", rolling.len());
            return Err(ScenarioError::new("bearing", "", problem).with_help("let the others be linear"));
        }
        Ok(rolling)
    }

    fn check_pieces(&self) -> Result<(), ScenarioError> {
        let entries = self.shafts().len();
        for (index, shaft) in self.shafts().iter().enumerate() {
            let key = |name: &str| entry_key("shaft", index, entries, name);
            match (shaft.radius_mm, shaft.segments.is_empty()) {
                (None, true) => {
                    let problem = "missing, and it has no default; it is (mm) the shaft's radius, unless segments is given";
                    return Err(ScenarioError::new(key("radius_mm"), "", problem));
                }
                (Some(radius_mm), false) => {
                    let problem = "given beside segments, which have radii of their own";
                    return Err(ScenarioError::new(key("radius_mm"), radius_mm, problem)
                        .with_help("remove one of the two"));
                }
                _ => {}
            }
            let whole_mm: f64 = shaft.pieces_mm().iter().map(|[length_mm, _]| length_mm).sum();
            if (whole_mm / shaft.length_mm - 1.0).abs() > 1e-6 {
                let problem =
                    format!("add up to {whole_mm:?} mm; must be length_mm, {:?} mm", shaft.length_mm);
                return Err(ScenarioError::new(key("segments"), "", problem));
            }
            let thinnest_mm =
                shaft.pieces_mm().iter().map(|[_, radius_mm]| *radius_mm).fold(f64::INFINITY, f64::min);
            if shaft.bore_radius_mm >= thinnest_mm {
                let problem = format!("must be less than {thinnest_mm:?} mm, the shaft's least radius");
                return Err(ScenarioError::new(key("bore_radius_mm"), shaft.bore_radius_mm, problem));
            }
        }
        Ok(())
    }

    /// The kept signal has one length and at least two samples, and there is memory for it.
    fn check_length(&self, limit: MemoryLimit) -> Result<(), ScenarioError> {
        let settings = &self.solver;
        if let (Some(duration_s), Some(_)) = (settings.duration_s, settings.pinion_revolutions) {
            let problem = "given beside solver.input_revolutions; the length has only one source";
            return Err(ScenarioError::new("solver.duration_s", duration_s, problem)
                .with_help("remove one of the two"));
        }
        duration::check_profiles(self, "solver.input_revolutions")?;
        let time = self.time_grid();
        // Time, force of each mesh, speed of each shaft and a sensor's signal, with what is made of them.
        let signals = 4 * self.meshes.len()
            + 2 * self.shafts().len()
            + 2 * self.sensors.len().max(self.bearings().len());
        let bytes = (time.samples as u64).saturating_mul(8 * signals as u64);
        if let Some(objection) = limit.objection(bytes) {
            let key =
                if settings.duration_s.is_some() { "solver.duration_s" } else { "solver.sampling_rate_hz" };
            return Err(ScenarioError::new(key, "", objection)
                .with_help("simulate a shorter time, or at a lower rate; or raise the memory limit"));
        }
        if time.kept_samples() < 2 {
            let problem = "keeps less than two samples";
            let error = ScenarioError::new("solver.duration_s", "", problem);
            return Err(error.with_help("keep a longer signal"));
        }
        Ok(())
    }

    fn check_faults(&self, layout: &Layout) -> Result<(), ScenarioError> {
        let names: Vec<&str> = self.wheels.iter().map(|wheel| wheel.name.as_str()).collect();
        for (index, Fault { wheel, flank, .. }) in self.faults.iter().enumerate() {
            let key = entry_key("fault", index, self.faults.len(), "wheel");
            let number = find(&names, wheel, "wheel").map_err(|error| error.with_key(key))?;
            let is_planet =
                matches!(self.wheels[number].of_set, Some(OfSet { member: Member::Planet(_), .. }));
            if let (Some(flank), false) = (flank, is_planet) {
                let key = entry_key("fault", index, self.faults.len(), "flank");
                let problem =
                    format!("given for {wheel:?}, which is no planet; only its teeth work on both flanks");
                return Err(
                    ScenarioError::new(key, format!("{:?}", flank.name()), problem).with_help("remove it")
                );
            }
        }
        for mesh in 0..self.meshes.len() {
            let (numbers, faults): (Vec<usize>, Vec<Fault>) =
                layout.faults_of_mesh(&self.placed_faults(), mesh).into_iter().unzip();
            check_faults(&faults, &numbers, self.faults.len(), &self.named_gears(layout, mesh))?;
        }
        Ok(())
    }

    fn check_quality(&self, layout: &Layout) -> Result<(), ScenarioError> {
        for (index, wheel) in self.wheels.iter().enumerate() {
            let section = section("wheel", index, self.wheels.len());
            // Every wheel is in a mesh, as the layout has checked.
            let module_mm = layout.mesh_of(index).map_or(f64::NAN, |(mesh, _)| layout.gears[mesh].module_mm);
            let eccentricity = format!("{section}.eccentricity_mm");
            below(&eccentricity, wheel.eccentricity_mm, module_mm, "the module")?;
            // Its direction counts from the line of centres, of which such a wheel has several.
            let is_in_one = layout.meshes_of(index).count() == 1 || wheel.eccentricity_mm == 0.0;
            require(
                &eccentricity,
                wheel.eccentricity_mm,
                is_in_one,
                "must be 0 of a wheel in several meshes",
            )?;
            one_source(&section, wheel.din_grade, wheel.iso_class, wheel.profile_errors_mm.is_some())?;
            let pitches = format!("{section}.cumulative_pitch_um");
            wheel.deviations.check_pitches(&pitches, wheel.teeth, module_mm)?;
            if let Some(errors) = &wheel.profile_errors_mm {
                check_errors(&format!("{section}.profile_errors_mm"), errors, wheel.teeth, module_mm)?;
            }
        }
        Ok(())
    }

    /// What is doubtful about a gearbox that can be simulated.
    fn warnings(&self, layout: &Layout) -> Vec<ScenarioWarning> {
        const LONG_CYCLE: i64 = 1000;
        let cycle = layout.cycle_revolutions();
        let time = self.time_grid();
        // Planets come round again only after a long time in every set.
        let long = (layout.cycle_of_shafts() > LONG_CYCLE).then(|| {
            let kept = time.kept_samples() as f64 / time.samples_per_pinion_revolution as f64;
            let message = format!(
                "the hunting-tooth period is {cycle} revolutions of the input; the kept signal covers {:.1} % of them",
                100.0 * kept / cycle as f64
            );
            ScenarioWarning::new(WarningKind::LongCycle, "solver.duration_s", message)
        });
        let of_teeth = layout.warnings_of_teeth(self);
        let wheels = self.wheels.len();
        let of_wheel = |number: usize| self.wheels[number].ignored_shares(&section("wheel", number, wheels));
        let of_shares = (0..wheels).flat_map(of_wheel);
        let of_speed = self.driven_speed(layout).warnings();
        let of_teeth = of_teeth.into_iter().chain(layout.added_thrusts(self));
        let of_teeth = of_teeth.chain(layout.warnings_of_sets(self, self.fastest_speed(layout).1));
        of_teeth
            .chain(of_shares)
            .chain(of_speed)
            .chain(long)
            .chain(self.operation.reversed_torque())
            .collect()
    }

    /// The key of the input's highest speed, and (rev/s) the speed.
    pub(crate) fn fastest_speed(&self, layout: &Layout) -> (String, f64) {
        self.driven_speed(layout).fastest()
    }

    fn driven_speed(&self, layout: &Layout) -> DrivenSpeed<'_> {
        let pitch_lines_mm = layout.gears.iter().enumerate().map(|(mesh, gears)| {
            pitch_line_mm(gears.transverse_module_mm(), gears.pinion_teeth) * layout.driving_ratio(mesh).abs()
        });
        DrivenSpeed {
            operation: &self.operation,
            key: "operation.input_speed_hz",
            pitch_line_mm: pitch_lines_mm.fold(0.0, f64::max),
        }
    }
}

/// Each key alone, of every entry of a list.
fn check_list<S: Keys>(name: &str, entries: &[S]) -> Result<(), ScenarioError> {
    let check = |(index, entry): (usize, &S)| {
        check_keys(entry, name).map_err(|error| error.in_entry(name, index, entries.len()))
    };
    entries.iter().enumerate().try_for_each(check)
}
