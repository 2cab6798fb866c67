//! Several numbers side by side, one per simulation.

/// `L` numbers, one per simulation (lane). `FUSED`: whether `a·b + c` is rounded once, as every processor with
/// fused multiply-add does, or twice.
///
/// Each operation is a loop over the lanes that the compiler turns into vector instructions where the calling
/// function allows them; what a lane computes does not depend on the number of lanes.
#[derive(Clone, Copy)]
pub(super) struct Lanes<const L: usize, const FUSED: bool>(pub(super) [f64; L]);

impl<const L: usize, const FUSED: bool> Lanes<L, FUSED> {
    #[inline(always)]
    pub(super) fn splat(value: f64) -> Self {
        Self([value; L])
    }

    #[inline(always)]
    pub(super) fn from_fn(f: impl FnMut(usize) -> f64) -> Self {
        Self(std::array::from_fn(f))
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = self.0;
        for l in 0..L {
            result[l] = f(self.0[l], other.0[l]);
        }
        Self(result)
    }

    #[inline(always)]
    pub(super) fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }

    #[inline(always)]
    pub(super) fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }

    #[inline(always)]
    pub(super) fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }

    /// `self · factor + term`.
    #[inline(always)]
    pub(super) fn mul_add(self, factor: Self, term: Self) -> Self {
        let mut result = self.0;
        for l in 0..L {
            result[l] = if FUSED {
                self.0[l].mul_add(factor.0[l], term.0[l])
            } else {
                self.0[l] * factor.0[l] + term.0[l]
            };
        }
        Self(result)
    }

    /// `term − self · factor`.
    #[inline(always)]
    pub(super) fn negative_mul_add(self, factor: Self, term: Self) -> Self {
        let mut result = self.0;
        for l in 0..L {
            result[l] = if FUSED {
                (-self.0[l]).mul_add(factor.0[l], term.0[l])
            } else {
                term.0[l] - self.0[l] * factor.0[l]
            };
        }
        Self(result)
    }

    #[inline(always)]
    pub(super) fn neg(self) -> Self {
        let mut result = self.0;
        for l in 0..L {
            result[l] = -self.0[l];
        }
        Self(result)
    }

    #[inline(always)]
    pub(super) fn floor(self) -> Self {
        let mut result = self.0;
        for l in 0..L {
            result[l] = self.0[l].floor();
        }
        Self(result)
    }

    /// `self` where `left < right`, `other` elsewhere.
    #[inline(always)]
    pub(super) fn where_less(self, left: Self, right: Self, other: Self) -> Self {
        let mut result = self.0;
        for l in 0..L {
            result[l] = if left.0[l] < right.0[l] { self.0[l] } else { other.0[l] };
        }
        Self(result)
    }

    /// Whole numbers from 0 to 2⁵² − 1 as indices.
    #[inline(always)]
    pub(super) fn indices(self) -> [usize; L] {
        // Adding 2⁵² leaves a whole number in the mantissa's low bits: unlike a cast it vectorises.
        const SHIFT: f64 = (1u64 << 52) as f64;
        let mut result = [0; L];
        for l in 0..L {
            result[l] = ((self.0[l] + SHIFT).to_bits() & ((1 << 52) - 1)) as usize;
        }
        result
    }
}

/// `Σ a_n b_n` in two interleaved chains, which halves the time until the sum is there.
#[inline(always)]
pub(super) fn dot<const L: usize, const FUSED: bool, const N: usize>(
    a: &[Lanes<L, FUSED>; N],
    b: &[Lanes<L, FUSED>; N],
) -> Lanes<L, FUSED> {
    let mut even = a[0].mul(b[0]);
    let mut odd = Lanes::splat(0.0);
    for n in 1..N {
        if n % 2 == 0 {
            even = a[n].mul_add(b[n], even);
        } else {
            odd = a[n].mul_add(b[n], odd);
        }
    }
    even.add(odd)
}
