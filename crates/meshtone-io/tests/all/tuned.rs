//! What tuning found, with a sensor's channel.
#![allow(clippy::unwrap_used)]

use meshtone::scenario::{Model, WheelName};
use meshtone::sensor::Channel;
use meshtone::tuning::Enhancement;
use meshtone_io::experiment::{Tuned, read_tuned, write_tuned};

#[test]
fn channel_may_be_a_sensors() {
    let tuned = Tuned {
        model: Model::Linear,
        enhancement: Enhancement { width_ratio: 0.2, fault_to_harmonics_ratio: 2.0, noise_level: 0.5 },
        centre_rev: 0.0,
        channel: Channel::Sensor("casing".into()),
        sampling_rate_hz: 25e3,
        wheel: WheelName::Gear.into(),
        sidebands: 2,
        shaft_orders: 7,
        keys: Vec::new(),
    };
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("tuned.toml");
    let text = write_tuned(&tuned, "rig.toml");
    std::fs::write(&path, &text).unwrap();
    assert_eq!(read_tuned(&path).unwrap(), tuned);
    for name in ["casing", "mesh_force_n", "1_g"] {
        std::fs::write(&path, text.replace("\"casing_g\"", &format!("\"{name}\""))).unwrap();
        let message = read_tuned(&path).unwrap_err().to_string();
        assert!(message.contains("signal.channel") && message.contains("\"vertical_g\""), "{message}");
    }
}
