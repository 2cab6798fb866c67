//! Vector instructions that the time loop may use, chosen at run time.

use std::fmt;
use std::sync::OnceLock;

/// A set of vector instructions.
///
/// All sets with fused multiply-add give the same bits; [`Self::Plain`] rounds products apart and differs by rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum InstructionSet {
    /// AVX-512 (x86-64).
    Avx512,
    /// AVX2 and FMA (x86-64).
    Avx2,
    /// NEON (aarch64).
    Neon,
    /// Instructions that every processor of the compiled architecture has.
    Plain,
}

impl InstructionSet {
    /// All sets, the fastest first.
    const ALL: [Self; 4] = [Self::Avx512, Self::Avx2, Self::Neon, Self::Plain];

    /// The sets that this machine can run, the fastest first.
    ///
    /// ```
    /// use meshtone::InstructionSet;
    /// assert!(InstructionSet::available().contains(&InstructionSet::Plain));
    /// ```
    pub fn available() -> Vec<Self> {
        Self::ALL.into_iter().filter(|set| set.is_available()).collect()
    }

    /// The name of the environment variable that chooses a set in place of the fastest one.
    pub const VARIABLE: &'static str = "MESHTONE_INSTRUCTIONS";

    /// The set that [`Self::VARIABLE`] names, or the fastest that this machine can run where the variable is unset or empty.
    ///
    /// # Errors
    /// The variable names no set, or one that this machine cannot run.
    pub fn from_environment() -> Result<Self, NoSuchInstructionSet> {
        let named = std::env::var_os(Self::VARIABLE).filter(|name| !name.is_empty());
        let Some(name) = named else { return Ok(Self::fastest()) };
        (Self::available().into_iter().find(|set| name == set.name()))
            .ok_or_else(|| NoSuchInstructionSet { name: name.to_string_lossy().into_owned() })
    }

    /// That of [`Self::from_environment`], which is read once; the fastest set where it is an error, which programs report at their start.
    pub fn in_use() -> Self {
        static IN_USE: OnceLock<InstructionSet> = OnceLock::new();
        *IN_USE.get_or_init(|| Self::from_environment().unwrap_or_else(|_| Self::fastest()))
    }

    /// The fastest set that this machine can run.
    fn fastest() -> Self {
        Self::ALL.into_iter().find(|set| set.is_available()).unwrap_or(Self::Plain)
    }

    /// What [`Self::VARIABLE`] calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Neon => "neon",
            Self::Plain => "plain",
        }
    }

    fn is_available(self) -> bool {
        self == Self::Plain || self.registers().is_some()
    }

    /// The vector registers of this set; none of the plain one, nor where the machine has not got them.
    pub(crate) fn registers(self) -> Option<Registers> {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => pulp::x86::V4::try_new().map(Registers::Avx512),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => pulp::x86::V3::try_new().map(Registers::Avx2),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => pulp::aarch64::Neon::try_new().map(Registers::Neon),
            _ => None,
        }
    }
}

/// [`InstructionSet::VARIABLE`] names a set that there is not on this machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoSuchInstructionSet {
    /// What it says.
    pub name: String,
}

impl std::error::Error for NoSuchInstructionSet {}

impl fmt::Display for NoSuchInstructionSet {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let allowed: Vec<&str> = InstructionSet::available().into_iter().map(InstructionSet::name).collect();
        let (variable, name) = (InstructionSet::VARIABLE, &self.name);
        write!(formatter, "{variable} = {name:?}: must be one of {} on this machine", allowed.join(", "))
    }
}

/// Vector registers that the machine is known to have.
#[derive(Clone, Copy)]
pub(crate) enum Registers {
    #[cfg(target_arch = "x86_64")]
    Avx512(pulp::x86::V4),
    #[cfg(target_arch = "x86_64")]
    Avx2(pulp::x86::V3),
    #[cfg(target_arch = "aarch64")]
    Neon(pulp::aarch64::Neon),
}

/// Runs tasks with instructions that are chosen at run time. Each implementation says for which sets a task is compiled: that of a large
/// task takes seconds for every set.
pub(crate) trait Dispatch: Copy {
    /// Runs a task.
    fn run<T: Task>(self, task: T) -> T::Output;
}

impl Dispatch for Registers {
    fn run<T: Task>(self, task: T) -> T::Output {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(simd) => pulp::Simd::vectorize(simd, Vectorized(task)),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(simd) => pulp::Simd::vectorize(simd, Vectorized(task)),
            #[cfg(target_arch = "aarch64")]
            Self::Neon(simd) => pulp::Simd::vectorize(simd, Vectorized(task)),
        }
    }
}

impl Dispatch for InstructionSet {
    fn run<T: Task>(self, task: T) -> T::Output {
        match self.registers() {
            Some(registers) => registers.run(task),
            None => task.run(Plain),
        }
    }
}

/// For tasks of one number at a time, of which no register is full: they are compiled for one set with fused multiply-add, which gives the
/// bits of every other, and plainly.
#[derive(Clone, Copy)]
pub(crate) struct OneByOne(pub(crate) InstructionSet);

impl Dispatch for OneByOne {
    fn run<T: Task>(self, task: T) -> T::Output {
        match self.0.registers() {
            #[cfg(target_arch = "x86_64")]
            Some(Registers::Avx512(simd)) => pulp::Simd::vectorize(*simd, Vectorized(task)),
            #[cfg(target_arch = "x86_64")]
            Some(Registers::Avx2(simd)) => pulp::Simd::vectorize(simd, Vectorized(task)),
            #[cfg(target_arch = "aarch64")]
            Some(Registers::Neon(simd)) => pulp::Simd::vectorize(simd, Vectorized(task)),
            None => task.run(Plain),
        }
    }
}

/// Work that is compiled once per instruction set.
pub(crate) trait Task {
    /// The work's result.
    type Output;

    /// Does the work; must be inlined always, down to its loops.
    fn run<I: Instructions>(self, simd: I) -> Self::Output;
}

struct Vectorized<T>(T);

impl<T: Task> pulp::WithSimd for Vectorized<T> {
    type Output = T::Output;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> T::Output {
        self.0.run(Fused(simd))
    }
}

/// Arithmetic on numbers side by side.
pub(crate) trait Instructions: Copy {
    /// `a + b`.
    fn add<const L: usize>(self, a: [f64; L], b: [f64; L]) -> [f64; L];
    /// `a − b`.
    fn sub<const L: usize>(self, a: [f64; L], b: [f64; L]) -> [f64; L];
    /// `a b`.
    fn mul<const L: usize>(self, a: [f64; L], b: [f64; L]) -> [f64; L];
    /// `a b + c`.
    fn mul_add<const L: usize>(self, a: [f64; L], b: [f64; L], c: [f64; L]) -> [f64; L];
    /// `c − a b`.
    fn negative_mul_add<const L: usize>(self, a: [f64; L], b: [f64; L], c: [f64; L]) -> [f64; L];
    /// `a / b`.
    fn div<const L: usize>(self, a: [f64; L], b: [f64; L]) -> [f64; L];
    /// `√a`.
    fn sqrt<const L: usize>(self, a: [f64; L]) -> [f64; L];
    /// `yes` where `a < b`, else `no`.
    fn where_less<const L: usize>(self, a: [f64; L], b: [f64; L], yes: [f64; L], no: [f64; L]) -> [f64; L];
}

/// Instructions that the compiled architecture has; products are rounded before they are added.
#[derive(Clone, Copy)]
pub(crate) struct Plain;

impl Instructions for Plain {
    #[inline(always)]
    fn add<const L: usize>(self, a: [f64; L], b: [f64; L]) -> [f64; L] {
        std::array::from_fn(|l| a[l] + b[l])
    }

    #[inline(always)]
    fn sub<const L: usize>(self, a: [f64; L], b: [f64; L]) -> [f64; L] {
        std::array::from_fn(|l| a[l] - b[l])
    }

    #[inline(always)]
    fn mul<const L: usize>(self, a: [f64; L], b: [f64; L]) -> [f64; L] {
        std::array::from_fn(|l| a[l] * b[l])
    }

    #[inline(always)]
    fn mul_add<const L: usize>(self, a: [f64; L], b: [f64; L], c: [f64; L]) -> [f64; L] {
        std::array::from_fn(|l| a[l] * b[l] + c[l])
    }

    #[inline(always)]
    fn negative_mul_add<const L: usize>(self, a: [f64; L], b: [f64; L], c: [f64; L]) -> [f64; L] {
        std::array::from_fn(|l| c[l] - a[l] * b[l])
    }

    #[inline(always)]
    fn div<const L: usize>(self, a: [f64; L], b: [f64; L]) -> [f64; L] {
        std::array::from_fn(|l| a[l] / b[l])
    }

    #[inline(always)]
    fn sqrt<const L: usize>(self, a: [f64; L]) -> [f64; L] {
        std::array::from_fn(|l| a[l].sqrt())
    }

    #[inline(always)]
    fn where_less<const L: usize>(self, a: [f64; L], b: [f64; L], yes: [f64; L], no: [f64; L]) -> [f64; L] {
        std::array::from_fn(|l| if a[l] < b[l] { yes[l] } else { no[l] })
    }
}

/// Vector instructions with fused multiply-add. What does not fill a register is computed number by number, with the
/// same result.
#[derive(Clone, Copy)]
struct Fused<S>(S);

/// Registers full of numbers, and the rest.
macro_rules! by_register {
    ($simd:expr, $vector:expr, $single:expr, $($input:ident),+) => {{
        let mut result = [0.0; L];
        {
            let (whole, rest) = S::as_mut_simd_f64s(&mut result);
            $(let $input = S::as_simd_f64s(&$input);)+
            for (k, result) in whole.iter_mut().enumerate() {
                *result = $vector($($input.0[k]),+);
            }
            for (k, result) in rest.iter_mut().enumerate() {
                *result = $single($($input.1[k]),+);
            }
        }
        result
    }};
}

impl<S: pulp::Simd> Instructions for Fused<S> {
    #[inline(always)]
    fn add<const L: usize>(self, a: [f64; L], b: [f64; L]) -> [f64; L] {
        by_register!(self, |a, b| self.0.add_f64s(a, b), |a: f64, b: f64| a + b, a, b)
    }

    #[inline(always)]
    fn sub<const L: usize>(self, a: [f64; L], b: [f64; L]) -> [f64; L] {
        by_register!(self, |a, b| self.0.sub_f64s(a, b), |a: f64, b: f64| a - b, a, b)
    }

    #[inline(always)]
    fn mul<const L: usize>(self, a: [f64; L], b: [f64; L]) -> [f64; L] {
        by_register!(self, |a, b| self.0.mul_f64s(a, b), |a: f64, b: f64| a * b, a, b)
    }

    #[inline(always)]
    fn mul_add<const L: usize>(self, a: [f64; L], b: [f64; L], c: [f64; L]) -> [f64; L] {
        by_register!(
            self,
            |a, b, c| self.0.mul_add_f64s(a, b, c),
            |a: f64, b: f64, c: f64| a.mul_add(b, c),
            a,
            b,
            c
        )
    }

    #[inline(always)]
    fn negative_mul_add<const L: usize>(self, a: [f64; L], b: [f64; L], c: [f64; L]) -> [f64; L] {
        by_register!(
            self,
            |a, b, c| self.0.negate_mul_add_f64s(a, b, c),
            |a: f64, b: f64, c: f64| (-a).mul_add(b, c),
            a,
            b,
            c
        )
    }

    #[inline(always)]
    fn div<const L: usize>(self, a: [f64; L], b: [f64; L]) -> [f64; L] {
        by_register!(self, |a, b| self.0.div_f64s(a, b), |a: f64, b: f64| a / b, a, b)
    }

    #[inline(always)]
    fn sqrt<const L: usize>(self, a: [f64; L]) -> [f64; L] {
        by_register!(self, |a| self.0.sqrt_f64s(a), f64::sqrt, a)
    }

    #[inline(always)]
    fn where_less<const L: usize>(self, a: [f64; L], b: [f64; L], yes: [f64; L], no: [f64; L]) -> [f64; L] {
        by_register!(
            self,
            |a, b, yes, no| self.0.select_f64s(self.0.less_than_f64s(a, b), yes, no),
            |a: f64, b: f64, yes: f64, no: f64| if a < b { yes } else { no },
            a,
            b,
            yes,
            no
        )
    }
}
