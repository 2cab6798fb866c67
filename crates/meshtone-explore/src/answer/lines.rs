//! What the lines of a gearbox's spectrum are: harmonics of which mesh, sidebands of which shaft.

use meshtone::signal::{GearTrain, TrainSet};
use meshtone_fourier::{hann_window, real_spectrum};
use serde_json::{Value, json};

use crate::packet::Packet;

/// Mesh harmonics of the fastest mesh up to which a spectrum is sent.
const SENT_HARMONICS: f64 = 8.0;
/// Lines of a spectrum that are named: the strongest.
const MOST_LINES: usize = 24;
/// Multiples of a shaft's rotation by which a line is named instead of a mesh.
const MOST_TURNS: f64 = 5.0;
/// (lines of the spectrum) How far a line may be from what it is named after.
const TOLERANCE: f64 = 1.0;
/// (-) Tolerance over a shaft's speed, from which on its sidebands cannot be distinguished from what lies between them.
const LEAST_RESOLVED: f64 = 0.25;

/// The spectrum of a signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// (Hz) From one value to the next.
    pub step_hz: f64,
    /// Amplitudes, in the signal's unit.
    pub amplitudes: Vec<f64>,
}

/// A line of a spectrum.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectrumLine {
    /// (Hz) Its frequency.
    pub frequency_hz: f64,
    /// Its amplitude, in the signal's unit.
    pub amplitude: f64,
    /// What it is, such as `2 × mesh z1-z2 − 1 × shaft middle`.
    pub name: String,
}

/// A mesh as far as the lines depend on it.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshTone {
    /// Its name.
    pub name: String,
    /// (Hz) Its frequency.
    pub frequency_hz: f64,
    /// Numbers of the shafts of whose rotation its lines have sidebands: those of its wheels.
    pub shafts: Vec<usize>,
}

/// The tones of a train: of its meshes, and names and (Hz) rotations of its shafts.
#[derive(Debug, Clone, PartialEq)]
pub struct Tones {
    /// The meshes.
    pub meshes: Vec<MeshTone>,
    /// What lines are named after: the meshes, but all those of a planetary set whose carrier turns as one, of which the sensor hears sidebands of the
    /// carrier.
    pub named: Vec<MeshTone>,
    /// The shafts.
    pub shafts: Vec<(String, f64)>,
    /// Numbers of the shafts that lines are named after: of planets alike the first, and of no ring that the carrier turns past.
    pub named_shafts: Vec<usize>,
}

impl Spectrum {
    /// The amplitudes of a signal, through a Hann window.
    ///
    /// # Arguments
    /// * `signal` - its samples
    /// * `sampling_rate_hz` - (S/s) their rate
    pub fn of(signal: &[f64], sampling_rate_hz: f64) -> Self {
        let count = signal.len().max(1) as f64;
        let mean = signal.iter().sum::<f64>() / count;
        let window = hann_window(signal.len());
        let windowed: Vec<f64> =
            signal.iter().zip(window).map(|(value, window)| (value - mean) * window).collect();
        // The mean of the window is 1/2.
        let amplitudes = real_spectrum(&windowed).iter().map(|line| 4.0 * line.norm() / count).collect();
        Self { step_hz: sampling_rate_hz / count, amplitudes }
    }

    /// As JSON, up to some harmonics of the fastest mesh, with its array in a packet.
    ///
    /// # Arguments
    /// * `tones` - of the train
    /// * `packet` - takes the array up
    pub fn json(&self, tones: &Tones, packet: &mut Packet) -> Value {
        let highest_hz = tones.meshes.iter().map(|mesh| mesh.frequency_hz).fold(0.0, f64::max);
        let sent = (SENT_HARMONICS * highest_hz / self.step_hz) as usize;
        json!({ "step_hz": self.step_hz, "values": packet.array(self.amplitudes.iter().copied().take(sent.max(2))) })
    }

    /// The strongest lines, the strongest first, each with its name.
    ///
    /// # Arguments
    /// * `tones` - of the train
    pub fn lines(&self, tones: &Tones) -> Vec<SpectrumLine> {
        let values = &self.amplitudes;
        // A window's own line is as wide as four values.
        let is_peak = |&i: &usize| {
            let around = &values[i.saturating_sub(2)..(i + 3).min(values.len())];
            around.iter().all(|value| *value <= values[i]) && values[i] > 0.0
        };
        let mut peaks: Vec<usize> = (2..values.len()).filter(is_peak).collect();
        peaks.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
        peaks.truncate(MOST_LINES);
        let line = |i: usize| {
            let frequency_hz = i as f64 * self.step_hz;
            let name = tones.name(frequency_hz, TOLERANCE * self.step_hz);
            SpectrumLine { frequency_hz, amplitude: values[i], name }
        };
        peaks.into_iter().map(line).collect()
    }
}

impl Tones {
    /// The tones of a machine.
    ///
    /// # Arguments
    /// * `train` - the machine
    /// * `input_hz` - (Hz) speed of its input
    pub fn of(train: &GearTrain, input_hz: f64) -> Self {
        let speed_hz = |shaft: usize| train.shafts[shaft].speed_ratio.value() * input_hz;
        let mesh = |(number, wheels): (usize, &[usize; 2])| {
            let shafts = wheels.map(|wheel| train.wheels[wheel].shaft).to_vec();
            let frequency_hz = f64::from(train.wheels[wheels[0]].teeth) * speed_hz(shafts[0]);
            MeshTone { name: train.mesh_name(number), frequency_hz, shafts }
        };
        let shafts = train.shafts.iter().enumerate();
        let meshes: Vec<MeshTone> = train.meshes.iter().enumerate().map(mesh).collect();
        let of_set = |set: &TrainSet| set.first_wheel..set.first_wheel + set.planets_rev.len() + 2;
        let is_in = |set: &TrainSet, mesh: usize| of_set(set).contains(&train.meshes[mesh][0]);
        let alone = (0..meshes.len()).filter(|&mesh| !train.sets.iter().any(|set| is_in(set, mesh)));
        let of_sets = train.sets.iter().filter_map(|set| {
            let mesh = (0..meshes.len()).find(|&mesh| is_in(set, mesh))?;
            let carrier =
                train.shafts.iter().position(|of| of.speed_ratio.value() == set.carrier.value().abs())?;
            let wheels = [0, 1].map(|member| train.wheels[set.first_wheel + member].shaft);
            let shafts = [carrier].into_iter().chain(wheels).collect();
            Some(MeshTone { name: set.name.clone(), shafts, ..meshes[mesh] })
        });
        let is_again = |shaft: usize| {
            let mut others = train.sets.iter().flat_map(|set| of_set(set).skip(2));
            others.any(|wheel| train.wheels[wheel].shaft == shaft)
        };
        Self {
            named: alone.map(|mesh| meshes[mesh].clone()).chain(of_sets).collect(),
            named_shafts: (0..train.shafts.len()).filter(|shaft| !is_again(*shaft)).collect(),
            meshes,
            shafts: shafts.map(|(number, shaft)| (shaft.name.clone(), speed_hz(number))).collect(),
        }
    }

    /// What a frequency is: the mesh harmonics that it is nearest to, counted in sidebands of their wheels' shafts; else a multiple of a
    /// shaft's rotation; else neither.
    ///
    /// # Arguments
    /// * `frequency_hz` - (Hz) of a line
    /// * `tolerance_hz` - (Hz) how far it may be beside what it is named after
    pub fn name(&self, frequency_hz: f64, tolerance_hz: f64) -> String {
        let mut found: Vec<(i64, String)> = Vec::new();
        for mesh in &self.named {
            let nearest = (frequency_hz / mesh.frequency_hz).round().max(1.0);
            let beside = frequency_hz - nearest * mesh.frequency_hz;
            let harmonic = format!("{nearest} × mesh {}", mesh.name);
            if beside.abs() <= tolerance_hz {
                let name = &mesh.name;
                let is_fundamental = nearest == 1.0;
                found.push((0, if is_fundamental { format!("mesh frequency of {name}") } else { harmonic }));
                continue;
            }
            for shaft in &mesh.shafts {
                let (name, speed_hz) = &self.shafts[*shaft];
                let count = (beside / speed_hz).round();
                // Lines that are hardly farther apart than the spectrum's own would be named whatever they are.
                let is_resolved = tolerance_hz < LEAST_RESOLVED * speed_hz;
                let is_near = is_resolved && (beside - count * speed_hz).abs() <= tolerance_hz;
                if count != 0.0 && is_near {
                    let sign = if count > 0.0 { '+' } else { '−' };
                    found.push((
                        count.abs() as i64,
                        format!("{harmonic} {sign} {} × shaft {name}", count.abs()),
                    ));
                }
            }
        }
        for (name, speed_hz) in self.named_shafts.iter().map(|shaft| &self.shafts[*shaft]) {
            let count = (frequency_hz / speed_hz).round();
            let is_near = (frequency_hz - count * speed_hz).abs() <= tolerance_hz;
            if count >= 1.0 && is_near && count <= MOST_TURNS {
                found.push((count as i64, format!("{count} × shaft {name}")));
            }
        }
        let Some(fewest) = found.iter().map(|(count, _)| *count).min() else {
            if self.shafts.iter().any(|(_, speed_hz)| tolerance_hz >= LEAST_RESOLVED * speed_hz) {
                return "beside a mesh harmonic; of which shaft, a longer signal would show".to_owned();
            }
            return "not identified (natural frequency or hunting-tooth line)".to_owned();
        };
        let mut names: Vec<String> =
            found.into_iter().filter(|(count, _)| *count == fewest).map(|(_, name)| name).collect();
        names.dedup();
        names.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn tones() -> Tones {
        let mesh =
            |name: &str, frequency_hz, shafts| MeshTone { name: name.to_owned(), frequency_hz, shafts };
        let meshes = vec![mesh("z1-z2", 960.0, vec![0, 1]), mesh("z3-z4", 480.0, vec![1, 2])];
        let shafts = [("input", 30.0), ("middle", 10.0), ("output", 6.0)];
        Tones {
            named: meshes.clone(),
            meshes,
            named_shafts: vec![0, 1, 2],
            shafts: shafts.map(|(name, speed_hz)| (name.to_owned(), speed_hz)).to_vec(),
        }
    }

    #[test]
    fn every_kind_of_line_has_its_name() {
        for (frequency_hz, name) in [
            (480.0, "mesh frequency of z3-z4"),
            (960.0, "mesh frequency of z1-z2, 2 × mesh z3-z4"),
            (990.0, "1 × mesh z1-z2 + 1 × shaft input"),
            (950.0, "1 × mesh z1-z2 − 1 × shaft middle, 2 × mesh z3-z4 − 1 × shaft middle"),
            (486.3, "1 × mesh z3-z4 + 1 × shaft output"),
            (1434.0, "3 × mesh z3-z4 − 1 × shaft output"),
            (30.0, "1 × shaft input"),
        ] {
            assert_eq!(tones().name(frequency_hz, 0.5), name, "{frequency_hz}");
        }
        // Sidebands reach as far as half way to the next harmonic.
        assert_eq!(tones().name(700.0, 0.5), "1 × mesh z3-z4 + 22 × shaft middle");
        assert!(tones().name(703.0, 0.5).starts_with("not identified"));
        // Lines 4 Hz apart distinguish no sidebands of 6 and 10 Hz.
        assert!(tones().name(486.0, 4.0).starts_with("beside a mesh harmonic"));
    }

    /// A tone's amplitude is its own, and the lines are those of the tones.
    #[test]
    fn lines_are_found_with_their_amplitudes() {
        let rate_hz = 10_000.0;
        let tone = |i: usize, hz: f64| (TAU * hz * i as f64 / rate_hz).sin();
        let signal: Vec<f64> =
            (0..10_000).map(|i| 2.0 * tone(i, 960.0) + 0.5 * tone(i, 990.0) + 0.25 * tone(i, 6.0)).collect();
        let lines = Spectrum::of(&signal, rate_hz).lines(&tones());
        let strong: Vec<_> = lines.iter().filter(|line| line.amplitude > 0.01).collect();
        assert_eq!(strong.len(), 3);
        for (line, (hz, amplitude)) in strong.iter().zip([(960.0, 2.0), (990.0, 0.5), (6.0, 0.25)]) {
            assert!(
                (line.frequency_hz - hz).abs() < 1e-9 && (line.amplitude - amplitude).abs() < 1e-3,
                "{line:?}"
            );
        }
        assert_eq!(strong[2].name, "1 × shaft output");
    }
}
