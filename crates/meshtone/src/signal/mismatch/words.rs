//! The text of a [`Mismatch`].

use std::fmt::{Display, Formatter, Result};

use super::{Alternative, Mismatch, StatedTurning};

/// (-) How near to a whole tooth count a speed leads that may as well be one.
const SAME_COUNT: f64 = 0.01;
/// (-) Standard deviation of the speed over its mean up to which the mesh tone can be followed.
const MOST_FOLLOWED: f64 = 0.01;

impl Mismatch {
    /// The source of the angle and its verb.
    fn source(&self) -> &'static str {
        match self.stated.turning {
            StatedTurning::Pulses { .. } => "the pulses are",
            StatedTurning::ConstantSpeed { .. } | StatedTurning::MeshTone { .. } | StatedTurning::Other => {
                "the speed is"
            }
        }
    }
}

impl Display for Mismatch {
    /// Says which facts would fit the recording, and what to check.
    ///
    /// Each alternative ends in what to check or to state. Where another speed means another whole tooth count as well, the count is
    /// mentioned, since the mesh frequency alone does not distinguish the two.
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let teeth = self.stated.teeth;
        match self.alternative {
            Alternative::Teeth { teeth: alternative } => write!(
                f,
                "the mesh lines fit {alternative} teeth on this shaft, or an integer fraction of that, \
                 better than {teeth}: check the tooth count"
            ),
            Alternative::MateTeeth { teeth: alternative, stated } => write!(
                f,
                "the other shaft's orders fit a mating gear of {alternative} teeth better than {stated}: check its tooth count"
            ),
            Alternative::OtherShaft { mate_teeth } => match &self.shafts {
                Some([stated, other]) => write!(
                    f,
                    "{} of shaft {other} rather than of shaft {stated}: state shaft {other}, or check what was recorded",
                    self.source()
                ),
                None => write!(
                    f,
                    "{} of the other shaft, with the wheel of {mate_teeth} teeth: exchange the tooth counts {teeth} and {mate_teeth}",
                    self.source()
                ),
            },
            Alternative::PulsesPerRevolution { pulses, stated } => {
                write!(
                    f,
                    "the recording fits {pulses} pulses per revolution better than {stated}: check \
                           their number"
                )
            }
            Alternative::VaryingSpeed { variation, stated_hz } => write!(
                f,
                "the shaft does not turn at {} {stated_hz} Hz: its speed varies by {:.2} % (rms), and the average loses the mesh; {}",
                if matches!(self.stated.turning, StatedTurning::MeshTone { .. }) {
                    "nearly"
                } else {
                    "a constant"
                },
                100.0 * variation,
                if variation > MOST_FOLLOWED {
                    "take the phase from a tachometer or from a measured speed, or cut out a part at a constant speed"
                } else {
                    "follow the mesh tone, or record a tachometer"
                }
            ),
            Alternative::ShaftSpeed { speed_hz, stated_hz } => {
                let percent = 100.0 * (speed_hz / stated_hz - 1.0);
                write!(
                    f,
                    "the recording fits a speed of {speed_hz:.6} Hz better than {stated_hz} Hz \
                     ({percent:+.4} %)"
                )?;
                if let Some(ratio) = self.energy_ratio {
                    write!(f, ": the average then holds {ratio:.1} times the energy at the mesh orders")?;
                }
                write!(f, "; state that speed, or follow the mesh tone")?;
                // The mesh frequency alone does not distinguish a speed from a tooth count.
                let count = f64::from(teeth) * speed_hz / stated_hz;
                if count.round() != f64::from(teeth) && (count - count.round()).abs() < SAME_COUNT {
                    write!(f, ". Or the wheel has {count:.0} teeth and the speed is right")?;
                }
                Ok(())
            }
        }
    }
}
