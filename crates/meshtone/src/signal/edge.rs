//! The continuation of a signal beyond its ends.

/// Continuation of a signal beyond its first and last sample, where a filter reaches over them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Edge {
    /// With zeros, as MATLAB's `resample` and SciPy's `resample_poly`: a signal that does not vanish at its ends rings
    /// there.
    Zero,
    /// Mirrored at its end samples, `x₋ᵢ = xᵢ`, without ringing for any signal that is continuous: what a recording needs.
    #[default]
    Reflect,
    /// Repeated, `xᵢ₊ₙ = xᵢ`: exact for a signal that spans whole periods, as a simulated one does.
    Periodic,
}

impl Edge {
    /// The sample that stands at `index` of a signal of `len` samples; none where there is 0.
    pub(super) fn index(self, index: isize, len: usize) -> Option<usize> {
        let n = len as isize;
        if (0..n).contains(&index) {
            return Some(index as usize);
        }
        match self {
            Self::Zero => None,
            Self::Periodic => Some(index.rem_euclid(n) as usize),
            Self::Reflect if n == 1 => Some(0),
            Self::Reflect => {
                let folded = index.rem_euclid(2 * (n - 1));
                Some(folded.min(2 * (n - 1) - folded) as usize)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Edge;

    #[test]
    fn beyond_the_ends() {
        let indices = |edge: Edge| (-4..8).map(|i| edge.index(i, 4)).collect::<Vec<_>>();
        let some = |list: [usize; 12]| list.map(Some).to_vec();
        assert_eq!(indices(Edge::Periodic), some([0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3]));
        assert_eq!(indices(Edge::Reflect), some([2, 3, 2, 1, 0, 1, 2, 3, 2, 1, 0, 1]));
        assert_eq!(indices(Edge::Zero)[3..9], [None, Some(0), Some(1), Some(2), Some(3), None]);
        assert_eq!(Edge::Reflect.index(-3, 1), Some(0));
    }
}
