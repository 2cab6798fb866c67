//! What is no recording, or not the one that was meant, is refused with what is wrong and where.
#![allow(clippy::unwrap_used)]

use crate::signal::wave;
use meshtone::signal::*;

const RATE_HZ: f64 = 10_000.0;
const TEETH: u32 = 19;

fn recording(samples: usize) -> Vec<f64> {
    (0..samples).map(|i| wave(19.0 * 20.0 * i as f64 / RATE_HZ)).collect()
}

fn steady(samples: usize) -> ShaftPhase {
    ShaftPhase::constant(20.0, RATE_HZ, samples).unwrap()
}

/// The message with which the chain refuses a recording.
fn refused(signal: &[f64], phase: &ShaftPhase, teeth: u32) -> String {
    process_channel(signal, phase, teeth, &ChainSettings::default()).unwrap_err().to_string()
}

#[test]
fn samples_that_are_no_numbers() {
    let mut signal = recording(5_000);
    signal[1_234..1_240].fill(f64::NAN);
    let message = "sample 1234 is NaN; 6 of 5000 samples are not finite numbers";
    assert_eq!(refused(&signal, &steady(5_000), TEETH), message);
    let tone = MeshTone::new(TEETH, 20.0);
    assert_eq!(ShaftPhase::from_mesh_tone(&signal, RATE_HZ, &tone).unwrap_err().to_string(), message);
    let by_waveform = tachometer_pulses(&signal, RATE_HZ, &Tachometer::default());
    assert_eq!(by_waveform.unwrap_err().to_string(), message);
    assert_eq!(envelope(&signal).unwrap_err().to_string(), message);
    assert_eq!(order_spectrum(&signal).unwrap_err().to_string(), message);
    assert_eq!(separate(&signal, &SeparationSettings::new(19)).unwrap_err().to_string(), message);
    assert_eq!(na4(&[signal]).unwrap_err().to_string(), message);

    let mut signal = recording(5_000);
    signal[4_999] = f64::NEG_INFINITY;
    let message = refused(&signal, &steady(5_000), TEETH);
    assert_eq!(message, "sample 4999 is -inf; 1 of 5000 samples are not finite numbers");
}

#[test]
fn a_channel_that_was_not_connected() {
    let message = refused(&[0.31; 5_000], &steady(5_000), TEETH);
    assert_eq!(message, "all 5000 samples are 0.31: a constant channel contains no information");
    assert!(tachometer_pulses(&[0.31; 5_000], RATE_HZ, &Tachometer::default()).is_err());
}

#[test]
fn too_few_revolutions() {
    // 500 samples a revolution; the phase begins at a whole one.
    let message = refused(&recording(999), &steady(999), TEETH);
    assert_eq!(message, "the recording covers 1 whole revolution of the shaft, but at least 2 are needed");
    let message = refused(&recording(400), &steady(400), TEETH);
    assert_eq!(message, "the recording covers 0.798 revolutions of the shaft, but at least 2 are needed");
    assert!(process_channel(&recording(1_001), &steady(1_001), TEETH, &ChainSettings::default()).is_ok());
    // Without the sample that ends them, two revolutions are whole only if they are said to repeat.
    let periodic = AngularSettings { edge: Edge::Periodic, ..Default::default() };
    let periodic = ChainSettings { angular: periodic, ..Default::default() };
    assert!(process_channel(&recording(1_000), &steady(1_000), TEETH, &periodic).is_ok());
    assert!(process_channel(&recording(1_000), &steady(1_000), TEETH, &ChainSettings::default()).is_err());
    let segments = |revolutions| {
        let settings = ChainSettings::default();
        process_segments(&recording(5_000), &steady(5_000), TEETH, &settings, revolutions)
            .unwrap_err()
            .to_string()
    };
    assert_eq!(segments(1), "revolutions of a segment is 1, but must be at least 2");
    assert_eq!(
        segments(11),
        "the recording covers 9 whole revolutions of the shaft, but at least 11 are needed"
    );
    assert!(process_series(&[], TEETH, &ChainSettings::default()).is_err());
}

#[test]
fn pulses_that_are_no_train() {
    let from = |times: &[f64], stated| {
        ShaftPhase::from_pulses(times, 1, stated, RATE_HZ, 5_000).map_err(|error| error.to_string())
    };
    let refused = |times: &[f64]| from(times, None).unwrap_err();
    assert_eq!(
        refused(&[0.0, 0.05, 0.04, 0.15]),
        "pulse 2 at 0.04 s comes before pulse 1 at 0.05 s: pulses must be in order of time"
    );
    assert_eq!(
        refused(&[0.0, 0.05, 0.05, 0.15]),
        "pulses 1 and 2 are both at 0.05 s: a pulse must come after the one before it"
    );
    assert_eq!(refused(&[0.0, 0.05]), "tachometer pulses: there are 2, but at least 3 are needed");
    assert_eq!(refused(&[0.0, f64::NAN, 0.1]), "sample 1 is NaN; 1 of 3 samples are not finite numbers");
    // Beyond the recording of half a second.
    assert_eq!(refused(&[1.0, 1.05, 1.1]), "samples with a phase: there are 0, but at least 2 are needed");
    let mut gap: Vec<f64> = (0..10).map(|n| 0.05 * f64::from(n)).collect();
    gap.extend((0..10).map(|n| 1e9 + 0.05 * f64::from(n)));
    assert!(refused(&gap).starts_with("some 19999999990 pulses are missing between 0.450000 s (pulse 9)"));

    let times: Vec<f64> = (0..10).map(|n| 0.05 * f64::from(n)).collect();
    assert!(from(&times, Some(20.5)).is_ok());
    assert_eq!(
        from(&times, Some(40.0)).unwrap_err(),
        "the pulses give 20.0000 Hz, but 40.0000 Hz is stated (+100.0 %): check the speed and the number of pulses per \
         revolution"
    );
    assert!(ShaftPhase::from_pulses(&times, 0, None, RATE_HZ, 5_000).is_err());
}

#[test]
fn speeds_that_are_none() {
    let profile = |time_s: &[f64], speed_hz: &[f64]| {
        ShaftPhase::from_speed_profile(time_s, speed_hz, RATE_HZ, 5_000).map_err(|error| error.to_string())
    };
    assert_eq!(
        profile(&[0.0, 1.0, 2.0], &[20.0, 20.0, f64::NAN]).unwrap_err(),
        "sample 2 is NaN; 1 of 3 samples are not finite numbers"
    );
    assert_eq!(
        profile(&[0.0, 1.0], &[20.0, -1.0]).unwrap_err(),
        "speed of the profile is -1, but must be a number more than 0"
    );
    assert_eq!(
        profile(&[0.0, 0.0], &[20.0, 21.0]).unwrap_err(),
        "time of the speed profile is 0, but must be later than the one before it"
    );
    assert!(profile(&[0.0, 1.0], &[20.0]).is_err());
    assert_eq!(
        profile(&[0.0, 0.1], &[20.0, 21.0]).unwrap().warnings[0].to_string(),
        "the speed profile ends at 0.100000 s, the recording at 0.499900 s: the last speed is held"
    );
    assert!(ShaftPhase::constant(0.0, RATE_HZ, 100).is_err());
    assert!(ShaftPhase::constant(20.0, f64::NAN, 100).is_err());
    let stops = ShaftPhase::from_speed_samples(&[20.0, 0.0, 0.0, 20.0], RATE_HZ).unwrap_err();
    assert!(stops.to_string().starts_with("the shaft stands still or turns backwards at sample 2"));
    assert!(ShaftPhase::from_speed_samples(&[], RATE_HZ).is_err());
}

#[test]
fn a_mesh_beyond_the_sampling_rate() {
    // 500 samples a revolution show orders up to 250.
    let beyond = refused(&recording(5_000), &steady(5_000), 251);
    assert_eq!(
        beyond,
        "mesh order 251 is beyond the Nyquist order 250.0: the sampling rate is too low for this speed and tooth count"
    );
    // Near it the interpolation weakens the mesh.
    let near = |teeth| {
        let signal: Vec<f64> =
            (0..5_000).map(|i| wave(f64::from(teeth) * 20.0 * f64::from(i) / RATE_HZ)).collect();
        process_channel(&signal, &steady(5_000), teeth, &ChainSettings::default()).unwrap()
    };
    assert_eq!(
        near(230).warnings[0].to_string(),
        "mesh order 230 is more than 80 % of the Nyquist order 250.0: the interpolation between samples weakens the mesh \
         tone; record at a higher rate"
    );
    assert!(near(230).order_spectrum[230] < 0.99);
    assert!(near(199).warnings.is_empty() && (near(199).order_spectrum[199] - 1.0).abs() < 1e-4);
    assert!(separate(&recording(500), &SeparationSettings::new(251)).is_err());
    assert_eq!(refused(&recording(5_000), &steady(5_000), 0), "teeth is 0, but must be at least 1");
    let many = SeparationSettings { sidebands: 9, ..SeparationSettings::new(19) };
    let many = separate(&recording(500), &many).unwrap_err().to_string();
    assert_eq!(many, "sidebands is 9, but must be less than half the teeth minus one");
}

#[test]
fn a_phase_of_another_recording() {
    let message = refused(&recording(5_000), &steady(6_000), TEETH);
    assert_eq!(message, "samples of the recording, by its phase: 5000 values, but 6000 are expected");
    assert!(ShaftPhase::new(0, vec![0.0, 0.1, 0.1]).is_err());
    assert!(steady(100).of_mate(0, 19).is_err());
    let points = |points| {
        let settings = AngularSettings { points_per_revolution: Some(points), ..Default::default() };
        angular_resample(&recording(5_000), &steady(5_000), &settings)
    };
    assert!(points(1).is_err() && points(usize::MAX).is_err() && points(2).is_ok());
    let slow = ShaftPhase::constant(1e-300, RATE_HZ, 5_000).unwrap();
    assert!(refused(&recording(5_000), &slow, TEETH).starts_with("the recording covers 0.000 revolutions"));
}

#[test]
fn rates_with_no_ratio() {
    assert!(resampling_ratio(std::f64::consts::PI, 1.0).is_err());
    assert!(resampling_ratio(0.0, 1.0).is_err());
    assert!(resample(&[1.0, 2.0], 0, 1, Edge::Zero).is_err());
    assert!(resample(&[], 2, 1, Edge::Zero).is_err());
}

// The structs' fields are open, so they may hold what no function of the library makes.
#[test]
fn structs_that_are_made_by_hand() {
    let signal = recording(5_000);
    for revolutions in [vec![], vec![1.0], vec![1.0, 1.0], vec![0.0, f64::NAN], vec![0.0, 1.0, 0.5]] {
        let phase =
            ShaftPhase { first_sample: usize::MAX, revolutions, zero: AngleZero::Given, warnings: vec![] };
        assert!(process_channel(&signal, &phase, TEETH, &ChainSettings::default()).is_err());
        let _ = (phase.span_rev(), phase.mean_speed_hz(RATE_HZ), points_per_revolution(&phase));
    }
    let far = ShaftPhase { first_sample: usize::MAX, ..ShaftPhase::new(0, vec![0.0, 1.0]).unwrap() };
    assert!(angular_resample(&signal, &far, &AngularSettings::default()).is_err());
    let nothing =
        AngularSignal { points_per_revolution: 0, start_rev: 0.0, nyquist_order: 1.0, values: vec![1.0; 9] };
    assert!(synchronous_average(&nothing).is_err() && segmented_averages(&nothing, 2).is_err());
    let empty = SynchronousAverage { revolutions: 2, nyquist_order: 1e3, values: vec![] };
    assert!(process_average(empty, TEETH, &ChainSettings::default()).is_err());
    let many = SeparationSettings { sidebands: usize::MAX, ..SeparationSettings::new(19) };
    assert!(separate(&signal[..500], &many).is_err());
    let no_order = SeparationSettings { shaft_orders: vec![usize::MAX], ..SeparationSettings::new(19) };
    assert!(separate(&signal[..500], &no_order).is_ok());
}

#[test]
fn places_that_are_none() {
    for place in [f64::NAN, f64::INFINITY, 1e300] {
        assert!(interpolate_band_limited(&[1.0, 2.0], &[0.5, place], Edge::Reflect).is_err());
        assert!(interpolate_pchip(&[1.0, 2.0], &[0.5, place], Edge::Reflect).is_err());
    }
    assert!(interpolate_band_limited(&[], &[0.5], Edge::Zero).is_err());
    assert!(interpolate_pchip(&[1.0], &[0.5], Edge::Zero).is_err());
}
