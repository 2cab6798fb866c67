//! The answer of a diagnosis, as JSON.

use std::path::Path;

use meshtone::signal::AngleZero;
use serde_json::{Map, Value, json};

use meshtone_learn::Interval;

use crate::answer::{Answer, AnyDamage, Explanation, KindAnswer};
use crate::bearings::BearingAnswer;
use crate::warnings::DiagnosisWarning;

/// Version of the layout; it is raised where a key changes its meaning.
const FORMAT_VERSION: u32 = 2;

impl Answer {
    /// Writes the answer as JSON: probabilities, severities and places, the likeliest kinds first. The signals are not in it.
    pub fn to_json(&self) -> Value {
        let wheels = &self.wheels;
        let kinds: Map<String, Value> =
            self.kinds.iter().map(|kind| (kind.label.to_owned(), kind_json(kind, wheels))).collect();
        let counted_from = self.counted_from.iter().map(|zero| json!(zero.map(AngleZero::name)));
        json!({
            "format_version": FORMAT_VERSION,
            "meshtone_version": env!("CARGO_PKG_VERSION"),
            "signal": self.signal.name(),
            "has_healthy": self.has_healthy,
            "damaged": self.damaged(),
            "teeth_counted_from": by_wheel(wheels, counted_from),
            "summary": self.summary,
            "rule": self.rule.to_json(wheels),
            "bearings": self.bearings.iter().map(bearing).collect::<Vec<_>>(),
            "any_damage": self.any_damage.as_ref().map(|any| any_damage(any, wheels)),
            "kinds": kinds,
            "outside_model": self.outside_model,
            "is_outside": self.is_outside(),
            "healthy_outside_model": self.healthy_outside_model,
            "common_change": self.common_change.map(|of| json!({ "p": of.p, "within_db": of.within_db })),
            "wheel_probabilities": by_wheel(wheels, self.wheel_probabilities.iter().map(|of| json!(of))),
            "shown_wheel": wheels[self.shown_wheel],
            "explanations": self.explanations.iter().map(|one| explanation(one, wheels)).collect::<Vec<_>>(),
            "warnings": self.warnings.iter().map(warning).collect::<Vec<_>>(),
        })
    }

    /// Writes from how many simulations the answer was learnt, as JSON.
    ///
    /// # Arguments
    /// * `asked` - simulations that were asked for
    /// * `folder` - where they are kept
    pub fn reference_json(&self, asked: u64, folder: &Path) -> Value {
        json!({
            "asked": asked,
            "simulated": self.simulated_records,
            "records": self.reference_records,
            "refined_records": self.refined_records,
            "folder": folder.display().to_string(),
        })
    }
}

fn by_wheel(wheels: &[String], values: impl Iterator<Item = Value>) -> Map<String, Value> {
    wheels.iter().cloned().zip(values).collect()
}

fn warning(warning: &DiagnosisWarning) -> Value {
    json!({ "code": warning.code, "message": warning.message })
}

fn bearing(of: &BearingAnswer) -> Value {
    json!({
        "bearings": of.bearings,
        "race": of.test.race.name().replace(' ', "-"),
        "is_defect": of.is_defect(),
        "is_detected": of.test.is_detected(),
        "false_alarm_probability": of.test.stated_probability(),
        "order": of.test.order,
        "found_order": of.test.found_order,
        "slip": of.test.slip(),
        "band_hz": [of.test.band.from_hz, of.test.band.to_hz],
        "depth": of.test.depth,
        "healthy_depth": of.healthy_depth,
    })
}

fn any_damage(any: &AnyDamage, wheels: &[String]) -> Value {
    json!({
        "severity": interval(&any.severity),
        "wheel": wheels[any.wheel],
        "wheel_probability": any.wheel_probability,
        "one_tooth_probability": any.one_tooth_probability,
        "tooth": any.tooth.map(|tooth| tooth.number),
        "tooth_probability": any.tooth.map(|tooth| tooth.probability),
        "angle_deg": any.tooth.map(|tooth| tooth.angle_deg),
    })
}

fn kind_json(kind: &KindAnswer, wheels: &[String]) -> Value {
    let sizes: Map<String, Value> =
        kind.sizes.iter().map(|size| (size.key.to_owned(), interval(&size.interval))).collect();
    let place = kind.place;
    let tooth = place.and_then(|place| place.tooth);
    json!({
        "probability": kind.probability,
        "severity": kind.severity.as_ref().map(interval),
        "sizes": sizes,
        "wheel": place.map(|place| &wheels[place.wheel]),
        "wheel_probability": place.map(|place| place.wheel_probability),
        "is_on_one_tooth": place.map(|place| place.is_on_one_tooth),
        "tooth": tooth.map(|tooth| tooth.number),
        "tooth_probability": tooth.map(|tooth| tooth.probability),
        "angle_deg": tooth.map(|tooth| tooth.angle_deg),
    })
}

fn interval(interval: &Interval) -> Value {
    json!({ "median": interval.median, "within_50": interval.within_50, "within_90": interval.within_90 })
}

fn explanation(explanation: &Explanation, wheels: &[String]) -> Value {
    json!({
        "kind": explanation.label,
        "wheel": explanation.wheel.map(|wheel| &wheels[wheel]),
        "severity": explanation.severity,
    })
}
