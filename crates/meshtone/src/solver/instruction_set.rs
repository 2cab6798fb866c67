//! Vector instructions that the time loop may use, chosen at run time.

/// A set of vector instructions.
///
/// All sets with fused multiply-add give the same bits; [`Self::Plain`] rounds products apart and differs by rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InstructionSet {
    /// AVX2 and FMA (x86-64).
    Avx2,
    /// NEON (aarch64).
    Neon,
    /// What every processor of the compiled architecture has.
    Plain,
}

impl InstructionSet {
    /// The sets that this machine can run, the fastest first.
    ///
    /// ```
    /// use meshtone::solver::InstructionSet;
    /// assert!(InstructionSet::available().contains(&InstructionSet::Plain));
    /// ```
    pub fn available() -> Vec<Self> {
        [Self::Avx2, Self::Neon, Self::Plain].into_iter().filter(|set| set.is_available()).collect()
    }

    /// The fastest set that this machine can run.
    pub fn fastest() -> Self {
        [Self::Avx2, Self::Neon].into_iter().find(|set| set.is_available()).unwrap_or(Self::Plain)
    }

    fn is_available(self) -> bool {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => pulp::x86::V3::try_new().is_some(),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => pulp::aarch64::Neon::try_new().is_some(),
            Self::Plain => true,
            #[allow(unreachable_patterns)]
            _ => false,
        }
    }

    /// Runs a task with this set's instructions, or plainly where the machine has not got them.
    pub(super) fn run<T: Task>(self, task: T) -> T::Output {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => {
                if let Some(simd) = pulp::x86::V3::try_new() {
                    return pulp::Simd::vectorize(simd, Fused(task));
                }
            }
            #[cfg(target_arch = "aarch64")]
            Self::Neon => {
                if let Some(simd) = pulp::aarch64::Neon::try_new() {
                    return pulp::Simd::vectorize(simd, Fused(task));
                }
            }
            _ => {}
        }
        task.run::<false>()
    }
}

/// Work that is compiled once per instruction set.
pub(super) trait Task {
    /// The work's result.
    type Output;

    /// Does the work; must be inlined always, down to its loops.
    ///
    /// `FUSED`: whether the processor has fused multiply-add.
    fn run<const FUSED: bool>(self) -> Self::Output;
}

struct Fused<T>(T);

impl<T: Task> pulp::WithSimd for Fused<T> {
    type Output = T::Output;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> T::Output {
        self.0.run::<true>()
    }
}
