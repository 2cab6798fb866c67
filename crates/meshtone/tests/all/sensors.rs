//! Sensors of a scenario: their keys, their channels, and that they change nothing else.
#![allow(clippy::unwrap_used)]

use meshtone::batch::{Control, KeepChannels, KeepSimulation, simulate_many};
use meshtone::scenario::*;
use meshtone::sensor::{Channel, ChannelKind, Channels};
use meshtone::tuning::{DifferenceChain, difference_signals};
use meshtone::{simulate, trace};

use crate::support::{appended, assert_refused};

fn sensor(keys: &str) -> String {
    appended(&format!("[[sensor]]\n{keys}"))
}

/// A small pair under a model.
fn pair(model: Model, keys: &str) -> Scenario {
    let mut scenario = Scenario::from_toml(&appended(&format!("[rig]\n{keys}"))).unwrap();
    scenario.model = model;
    scenario.meshes[0].points_per_tooth = 1000;
    scenario.solver.sampling_rate_hz = 1e4;
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 6);
    scenario
}

fn at(at: SensorPlace, direction: SensorDirection) -> Sensor {
    let mut sensor = Sensor::default();
    (sensor.at, sensor.direction) = (at, direction);
    sensor.path = SensorPath::RIGID;
    sensor
}

/// One of everything.
fn full(name: &str) -> Sensor {
    let mut sensor = at(SensorPlace::GearSupport, SensorDirection::Horizontal);
    sensor.name = Some(name.to_owned());
    sensor.resonance_hz = Some(3e3);
    sensor.resonance_damping_ratio = 0.1;
    sensor.noise_density_g_per_rthz = 1e-3;
    sensor.noise_seed = Some(7);
    sensor.path.strength = 0.3;
    sensor.range_g = Some(2.0);
    sensor.bits = Some(12);
    sensor.frequency_response = Some(FrequencyResponse {
        frequency_hz: vec![0.0, 1e3, 4e3],
        magnitude: vec![1.0, 1.5, 0.25],
        phase_deg: vec![0.0, -90.0, 170.0],
    });
    sensor
}

fn measured(scenario: &Scenario) -> Channels {
    simulate(scenario).unwrap().channels
}

#[test]
fn scenario_is_read_back_with_its_sensors() {
    let base = pair(Model::Contact, "");
    for sensors in [vec![Sensor::default()], vec![full("a"), Sensor::default()]] {
        let scenario = base.clone().with_sensors(sensors);
        let text = scenario.to_toml();
        assert_eq!(Scenario::from_toml(&text), Ok(scenario.clone()), "{text}");
        let json = serde_json::to_value(&scenario).unwrap();
        assert_eq!(serde_json::from_value::<Scenario>(json).unwrap(), scenario);
    }
    let scenario = base.with_sensors(vec![full("a"), Sensor::default()]);
    assert_eq!(scenario.number("sensor[0].resonance_hz"), Some(3e3));
    let other = scenario.with_number("sensor[0].resonance_hz", 4e3).unwrap();
    assert_eq!(other.sensors[0].resonance_hz, Some(4e3));
}

#[test]
fn what_is_refused_names_key_and_line() {
    let cases: [(&str, &str, usize, &[&str]); 18] = [
        ("name = \"a b\"", "sensor.name", 10, &["\"a b\"", "letters"]),
        ("name = \"1a\"", "sensor.name", 10, &["must be a letter"]),
        ("name = \"vertical\"", "sensor.name", 10, &["vertical_g", "the name of another channel"]),
        ("name = 3", "sensor.name", 10, &["text"]),
        ("at = \"wheel\"", "sensor.at", 10, &["\"gear-support\"", "\"wheels\""]),
        ("direction = \"up\"", "sensor.direction", 10, &["\"vertical\""]),
        ("resonance_hz = 0.0", "sensor.resonance_hz", 10, &["more than 0 Hz"]),
        ("resonance_damping_ratio = -0.1", "sensor.resonance_damping_ratio", 10, &["more than 0"]),
        ("noise_density_g_per_rthz = -1.0", "sensor.noise_density_g_per_rthz", 10, &["0 g/√Hz or more"]),
        ("range_g = -50.0", "sensor.range_g", 10, &["more than 0 g"]),
        ("bits = 16", "sensor.bits", 10, &["needs sensor.range_g"]),
        ("range_g = 2.0\nbits = 33", "sensor.bits", 11, &["from 8 to 32"]),
        ("response_input = \"force\"", "sensor.response_input", 10, &["needs sensor.frequency_response"]),
        ("resonance = 12000.0", "sensor.resonance", 10, &["unknown key", "resonance_hz"]),
        (
            "frequency_response = { frequency_hz = [0.0, 1.0], magnitude = [1.0, 1.0] }",
            "sensor.frequency_response.phase_deg",
            10,
            &["missing"],
        ),
        (
            "frequency_response = { frequency_hz = [1.0, 1.0], magnitude = [1.0, 1.0], phase_deg = [0.0, 0.0] }",
            "sensor.frequency_response.frequency_hz[1]",
            10,
            &["more than the frequency before it, 1.0 Hz"],
        ),
        (
            "frequency_response = { frequency_hz = [0.0, 1.0], magnitude = [1.0, -1.0], phase_deg = [0.0, 0.0] }",
            "sensor.frequency_response.magnitude[1]",
            10,
            &["0 or more"],
        ),
        (
            "frequency_response = { file = \"a.csv\" }",
            "sensor.frequency_response.file",
            10,
            &["text alone", "phase_deg"],
        ),
    ];
    for (keys, key, line, words) in cases {
        assert_refused(&sensor(keys), key, line, words);
    }
    let short = "frequency_response = { frequency_hz = [1.0], magnitude = [1.0], phase_deg = [0.0] }";
    assert_refused(&sensor(short), "sensor.frequency_response", 10, &["at least 2"]);
    let uneven =
        "frequency_response = { frequency_hz = [1.0, 2.0], magnitude = [1.0], phase_deg = [0.0, 0.0] }";
    assert_refused(
        &sensor(uneven),
        "sensor.frequency_response.magnitude",
        10,
        &["as many as frequency_hz, 2"],
    );
}

#[test]
fn two_sensors_cannot_share_a_channel() {
    let text = sensor("at = \"gear-support\"\n[[sensor]]\nname = \"gear_support_vertical\"");
    assert_refused(&text, "sensor[1].name", 12, &["sensor[0]", "name of its own"]);
    let text = sensor("[[sensor]]\nrange_g = 1.0\n[[sensor]]\nname = \"other\"\nbits = 8");
    assert_refused(&text, "sensor[1].name", 10, &["\"pinion_support_vertical\""]);
    let text = sensor("name = \"one\"\n[[sensor]]\nbits = 8");
    assert_refused(&text, "sensor[1].bits", 12, &["needs sensor[1].range_g"]);
}

/// Supports move across the shafts: under `contact` nothing axial is felt there; under the other models the wheels are read.
#[test]
fn axial_is_felt_at_the_wheels() {
    let text = sensor("direction = \"axial\"");
    assert!(Scenario::from_toml(&format!("model = \"linear\"\n{text}")).is_ok());
    assert_refused(&text, "sensor.direction", 10, &["across the shafts", "\"wheels\""]);
    assert!(Scenario::from_toml(&format!("{text}at = \"wheels\"\n")).is_ok());
}

#[test]
fn plain_sensors_read_their_places() {
    use SensorDirection::*;
    use SensorPlace::*;
    let places = [Support, PinionSupport, GearSupport, Wheels];
    let sensors: Vec<Sensor> = places.map(|place| at(place, Vertical)).into();
    for model in [Model::Linear, Model::Contact] {
        let scenario = pair(model, "").with_sensors(sensors.clone());
        let channels = measured(&scenario);
        let [support, pinion, gear, wheels] = [0, 1, 2, 3].map(|n| &channels.signals[n].values);
        assert_eq!(pinion, &channels["vertical_g"]);
        let without = measured(&scenario.clone().with_sensors(Vec::new()));
        let mut others = channels.clone();
        others.signals.drain(..sensors.len());
        assert_eq!(without, others, "{model:?}");
        if model == Model::Linear {
            assert!([pinion, gear, wheels].into_iter().all(|signal| signal == support));
            let ignored: Vec<String> =
                scenario.ignored_by_model().into_iter().map(|warning| warning.key).collect();
            assert_eq!(ignored, ["sensor[0].at", "sensor[2].at", "sensor[3].at"]);
        } else {
            let scale = support.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            let mean = pinion.iter().zip(gear).map(|(a, b)| (a + b) / 2.0);
            assert!(mean.zip(support).all(|(mean, both)| (mean - both).abs() < 1e-12 * scale));
            assert!(wheels != support && pinion != gear);
            assert_eq!(scenario.ignored_by_model(), []);
        }
        let names: Vec<_> = channels.signals[..4].iter().map(|signal| signal.name.clone()).collect();
        let expected = ["support", "pinion_support", "gear_support", "wheels"];
        assert_eq!(names, expected.map(|place| format!("{place}_vertical_g")));
    }
}

/// With an axial direction at the wheels, the sensor is the axial channel.
#[test]
fn axial_sensor_is_the_axial_channel() {
    let mut scenario = pair(Model::Contact, "");
    let chip = ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 12.0, tip_loss_mm: 0.0 };
    scenario.faults = vec![Fault::on_first_gear_tooth(chip)];
    scenario.sensors = vec![at(SensorPlace::Wheels, SensorDirection::Axial)];
    let channels = measured(&scenario);
    let largest = channels["axial_g"].iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let mut pairs = channels.signals[0].values.iter().zip(&channels["axial_g"]);
    assert!(pairs.all(|(sensor, axial)| (sensor - axial).abs() <= 1e-12 * largest));
}

#[test]
fn flat_path_from_the_force_is_the_force_over_g() {
    let mut sensor = at(SensorPlace::Support, SensorDirection::Axial);
    sensor.response_input = ResponseInput::Force;
    sensor.frequency_response = Some(FrequencyResponse {
        frequency_hz: vec![0.0, 1e5],
        magnitude: vec![1.0, 1.0],
        phase_deg: vec![0.0, 0.0],
    });
    for model in [Model::Linear, Model::Contact] {
        let channels = measured(&pair(model, "").with_sensors(vec![sensor.clone()]));
        let mut pairs = channels.signals[0].values.iter().zip(&channels["mesh_force_n"]);
        assert!(pairs.all(|(shown, force)| (shown - force / 9.81).abs() < 1e-10), "{model:?}");
    }
}

/// Alone, in lanes beside others with more sensors or fewer, in one thread or two, and in a trace: the same bits.
#[test]
fn sensors_show_the_same_bits_in_any_company() {
    let scenarios: Vec<Scenario> = (0..11)
        .map(|n| {
            let model = if n % 3 == 0 { Model::Linear } else { Model::Contact };
            let mut scenario = pair(model, "");
            scenario.seed = n;
            scenario.operation.brake_torque_nm = 5.0 + n as f64;
            scenario.sensors = match n % 4 {
                0 => Vec::new(),
                1 => vec![full("b"), full("a")],
                2 => vec![full("a")],
                _ => vec![Sensor::default(), full("a"), at(SensorPlace::Wheels, SensorDirection::Axial)],
            };
            if n == 5 {
                scenario.operation.torque_fluctuation_nm = 0.5;
            }
            scenario
        })
        .collect();
    let alone: Vec<Channels> = scenarios.iter().map(measured).collect();
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let many = scenarios.clone();
            simulate_many(many, &KeepSimulation, &Control::default(), |n, result| {
                assert_eq!(result.unwrap().channels, alone[n], "{n}");
            });
            let keep = KeepChannels::new([Channel::Sensor("a".into()), ChannelKind::Vertical.into()]);
            simulate_many(scenarios.clone(), &keep, &Control::default(), |n, result| {
                let single = |values: &[f64]| values.iter().map(|&value| value as f32).collect::<Vec<_>>();
                match alone[n].signal("a_g") {
                    Some(signal) => {
                        let expected = [single(signal), single(&alone[n]["vertical_g"])];
                        assert_eq!(result.unwrap().channels, expected, "{n}");
                    }
                    None => {
                        let message = result.unwrap_err().to_string();
                        for word in ["`a_g`", "vertical_g", "mesh_force_n"] {
                            assert!(message.contains(word), "{message}");
                        }
                    }
                }
            });
        });
    }
    assert_eq!(trace(&scenarios[3]).unwrap().0.channels, alone[3]);
}

/// Each sensor draws for itself: one more behind it changes nothing, and another seed changes it.
#[test]
fn noise_is_keyed_by_seed_and_place_in_the_list() {
    let mut noisy = Sensor::default();
    noisy.noise_density_g_per_rthz = 1e-2;
    let mut second = noisy.clone();
    second.name = Some("second".into());
    let base = pair(Model::Linear, "");
    let shown = |sensors: Vec<Sensor>, seed| {
        let count = sensors.len();
        let channels = measured(&base.clone().with_seed(seed).with_sensors(sensors));
        let vertical = channels["vertical_g"].to_vec();
        let noise = move |values: Vec<f64>| -> Vec<f64> {
            values.iter().zip(&vertical).map(|(shown, vertical)| shown - vertical).collect()
        };
        channels.signals.into_iter().take(count).map(|signal| noise(signal.values)).collect::<Vec<_>>()
    };
    let one = shown(vec![noisy.clone()], 1);
    let two = shown(vec![noisy.clone(), second], 1);
    assert_eq!(one[0], two[0]);
    assert_ne!(two[0], two[1]);
    let rms = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    let expected = 1e-2 * (base.actual_sampling_rate_hz() / 2.0).sqrt();
    assert!((rms(&one[0]) / expected - 1.0).abs() < 0.05);
    noisy.noise_seed = Some(5);
    let own = shown(vec![noisy], 1);
    assert_ne!(own[0], one[0]);
}

#[test]
fn unknown_channel_is_refused_with_those_that_there_are() {
    let sensors = [Sensor::default()];
    assert_eq!(
        Channel::of("pinion_support_vertical_g", &sensors),
        Ok(Channel::Sensor("pinion_support_vertical".into()))
    );
    assert_eq!(Channel::of("vertical_g", &sensors), Ok(ChannelKind::Vertical.into()));
    let message = Channel::of("gear_g", &sensors).unwrap_err().to_string();
    assert!(
        message
            .starts_with("there is no channel `gear_g`; there are pinion_support_vertical_g, horizontal_g"),
        "{message}"
    );
}

/// A difference signal may be a sensor's: that of one without anything is its place's.
#[test]
fn difference_signals_of_a_sensor() {
    let mut scenario = pair(Model::Linear, "").with_sensors(vec![Sensor::default(), full("a")]);
    scenario.faults = vec![Fault::on_first_gear_tooth(MissingTooth)];
    let of = |channel: Channel| {
        let chain = DifferenceChain { channel, ..DifferenceChain::new(8e3) };
        difference_signals(vec![scenario.clone()], &chain)
    };
    let [plain, vertical] =
        [Channel::Sensor("pinion_support_vertical".into()), ChannelKind::Vertical.into()].map(of);
    assert_eq!(plain.unwrap(), vertical.unwrap());
    assert!(of(Channel::Sensor("a".into())).is_ok());
    let message = of(Channel::Sensor("b".into())).unwrap_err().to_string();
    assert!(message.contains("`b_g`") && message.contains("pinion_support_vertical_g"), "{message}");
}
