//! Several numbers side by side, one per simulation.

use super::instruction_set::Instructions;

/// `L` numbers, one per simulation (lane).
///
/// The result of a lane does not depend on the number of lanes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lanes<const L: usize>(pub(crate) [f64; L]);

impl<const L: usize> Lanes<L> {
    #[inline(always)]
    pub(crate) fn splat(value: f64) -> Self {
        Self([value; L])
    }

    #[inline(always)]
    pub(crate) fn from_fn(mut f: impl FnMut(usize) -> f64) -> Self {
        // A loop instead of the array's `from_fn`, which is two functions more to compile for every closure.
        let mut lanes = [0.0; L];
        for (l, lane) in lanes.iter_mut().enumerate() {
            *lane = f(l);
        }
        Self(lanes)
    }

    #[inline(always)]
    pub(crate) fn add<I: Instructions>(self, simd: I, other: Self) -> Self {
        Self(simd.add(self.0, other.0))
    }

    #[inline(always)]
    pub(crate) fn sub<I: Instructions>(self, simd: I, other: Self) -> Self {
        Self(simd.sub(self.0, other.0))
    }

    #[inline(always)]
    pub(crate) fn mul<I: Instructions>(self, simd: I, other: Self) -> Self {
        Self(simd.mul(self.0, other.0))
    }

    /// `self · factor + term`.
    #[inline(always)]
    pub(crate) fn mul_add<I: Instructions>(self, simd: I, factor: Self, term: Self) -> Self {
        Self(simd.mul_add(self.0, factor.0, term.0))
    }

    /// `term − self · factor`.
    #[inline(always)]
    pub(crate) fn negative_mul_add<I: Instructions>(self, simd: I, factor: Self, term: Self) -> Self {
        Self(simd.negative_mul_add(self.0, factor.0, term.0))
    }

    #[inline(always)]
    pub(crate) fn neg<I: Instructions>(self, simd: I) -> Self {
        Self(simd.sub([0.0; L], self.0))
    }

    #[inline(always)]
    pub(crate) fn div<I: Instructions>(self, simd: I, other: Self) -> Self {
        Self(simd.div(self.0, other.0))
    }

    #[inline(always)]
    pub(crate) fn sqrt<I: Instructions>(self, simd: I) -> Self {
        Self(simd.sqrt(self.0))
    }

    #[inline(always)]
    pub(crate) fn min<I: Instructions>(self, simd: I, other: Self) -> Self {
        self.where_less(simd, self, other, other)
    }

    #[inline(always)]
    pub(crate) fn max<I: Instructions>(self, simd: I, other: Self) -> Self {
        self.where_less(simd, other, self, other)
    }

    /// `self` where `left < right`, `other` elsewhere.
    #[inline(always)]
    pub(crate) fn where_less<I: Instructions>(self, simd: I, left: Self, right: Self, other: Self) -> Self {
        Self(simd.where_less(left.0, right.0, self.0, other.0))
    }
}

/// `Σ a_n b_n` in four interleaved chains: a quarter of the time until the sum is there.
#[derive(Clone, Copy)]
pub(crate) struct Chains<const L: usize>([Lanes<L>; CHAINS]);

const CHAINS: usize = 4;

impl<const L: usize> Chains<L> {
    /// No products.
    pub(crate) const NONE: Self = Self([Lanes([0.0; L]); CHAINS]);

    /// Adds product number `n`, from 0 on in order.
    #[inline(always)]
    pub(crate) fn add<I: Instructions>(&mut self, simd: I, n: usize, a: Lanes<L>, b: Lanes<L>) {
        let chain = &mut self.0[n % CHAINS];
        *chain = if n < CHAINS { a.mul(simd, b) } else { a.mul_add(simd, b, *chain) };
    }

    /// The sum, on top of a base.
    #[inline(always)]
    pub(crate) fn total<I: Instructions>(&self, simd: I, base: Lanes<L>) -> Lanes<L> {
        let [first, second, third, fourth] = self.0;
        first.add(simd, third).add(simd, second.add(simd, fourth)).add(simd, base)
    }
}
