//! What does not fit, in words.

use std::fmt::{Display, Formatter, Result};

use super::{Likelier, Misfit, ToldTurning};

/// (-) How near to a whole tooth count a speed leads that may as well be one.
const SAME_COUNT: f64 = 0.01;

impl Display for Misfit {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let teeth = self.told.teeth;
        match self.likelier {
            Likelier::Teeth { teeth: likelier } => write!(
                f,
                "the mesh lines are those of {likelier} teeth on this shaft, or of a whole part of that, rather than {teeth}: check \
                 the tooth count"
            ),
            Likelier::MateTeeth { teeth: likelier, told } => write!(
                f,
                "the other shaft's orders are those of a mate of {likelier} teeth rather than {told}: check its tooth count"
            ),
            Likelier::OtherShaft { mate_teeth } => {
                let what = match self.told.turning {
                    ToldTurning::Pulses { .. } => "the pulses are",
                    ToldTurning::ConstantSpeed { .. } | ToldTurning::Other => "the speed is",
                };
                write!(
                    f,
                    "{what} rather of the other shaft, that of the wheel with {mate_teeth} teeth: exchange the tooth counts \
                     {teeth} and {mate_teeth}"
                )
            }
            Likelier::PulsesPerRevolution { pulses, told } => {
                write!(f, "there are rather {pulses} pulses in a revolution than {told}: check their number")
            }
            Likelier::VaryingSpeed { variation, told_hz } => write!(
                f,
                "the shaft does not turn at a constant {told_hz} Hz: its speed varies by {:.2} % (rms), and the average loses the mesh; \
                 follow the mesh tone, or record a tachometer",
                100.0 * variation
            ),
            Likelier::ShaftSpeed { speed_hz, told_hz } => {
                let percent = 100.0 * (speed_hz / told_hz - 1.0);
                write!(
                    f,
                    "the shaft turns rather at {speed_hz:.6} Hz than at {told_hz} Hz ({percent:+.4} %)"
                )?;
                if let Some(ratio) = self.energy_ratio {
                    write!(f, ": the average then holds {ratio:.1} times the energy at the mesh orders")?;
                }
                write!(f, "; state that speed, or follow the mesh tone")?;
                // The mesh frequency alone does not tell a speed from a tooth count.
                let count = f64::from(teeth) * speed_hz / told_hz;
                if count.round() != f64::from(teeth) && (count - count.round()).abs() < SAME_COUNT {
                    write!(f, ". Or the wheel has {count:.0} teeth and the speed is right")?;
                }
                Ok(())
            }
        }
    }
}
