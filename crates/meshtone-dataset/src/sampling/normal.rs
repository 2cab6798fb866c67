//! The normal distribution.

use std::f64::consts::SQRT_2;

/// Part of a standard normal distribution below `x`.
///
/// # Arguments
/// * `x` - in standard deviations from the mean
///
/// ```
/// assert!((meshtone_dataset::sampling::normal_distribution(1.959963984540054) - 0.975).abs() < 1e-15);
/// ```
pub fn normal_distribution(x: f64) -> f64 {
    0.5 * libm::erfc(-x / SQRT_2)
}

/// The number below which the part `p` of a standard normal distribution is.
///
/// # Arguments
/// * `p` - from 0 to 1; at the ends the result is infinite
///
/// Relative error below 1e-15.
///
/// Source: M. J. Wichura, "Algorithm AS 241: the percentage points of the normal distribution", Appl. Statist. 37 (1988)
/// 477–484, PPND16.
///
/// ```
/// assert!((meshtone_dataset::sampling::normal_quantile(0.975) - 1.959963984540054).abs() < 1e-14);
/// ```
pub fn normal_quantile(p: f64) -> f64 {
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = 0.180_625 - q * q;
        return q * ratio(&CENTRE, r);
    }
    let tail = if q < 0.0 { p } else { 1.0 - p };
    if tail <= 0.0 {
        return q.signum() * f64::INFINITY;
    }
    let r = (-libm::log(tail)).sqrt();
    let x = if r <= 5.0 { ratio(&MIDDLE, r - 1.6) } else { ratio(&TAIL, r - 5.0) };
    q.signum() * x
}

/// Coefficients of a numerator and of a denominator, those of the same power together; the constants come first.
type Rational = [[f64; 2]; 8];

const CENTRE: Rational = [
    [3.387_132_872_796_366_5, 1.0],
    [133.141_667_891_784_38, 42.313_330_701_600_91],
    [1_971.590_950_306_551_3, 687.187_007_492_057_9],
    [13_731.693_765_509_46, 5_394.196_021_424_751],
    [45_921.953_931_549_87, 21_213.794_301_586_597],
    [67_265.770_927_008_7, 39_307.895_800_092_71],
    [33_430.575_583_588_13, 28_729.085_735_721_943],
    [2_509.080_928_730_122_7, 5_226.495_278_852_854_5],
];
const MIDDLE: Rational = [
    [1.423_437_110_749_683_5, 1.0],
    [4.630_337_846_156_546, 2.053_191_626_637_759],
    [5.769_497_221_460_691, 1.676_384_830_183_803_8],
    [3.647_848_324_763_204_5, 0.689_767_334_985_1],
    [1.270_458_252_452_368_4, 0.148_103_976_427_480_08],
    [0.241_780_725_177_450_6, 0.015_198_666_563_616_457],
    [0.022_723_844_989_269_184, 5.475_938_084_995_345e-4],
    [7.745_450_142_783_414e-4, 1.050_750_071_644_416_9e-9],
];
const TAIL: Rational = [
    [6.657_904_643_501_103, 1.0],
    [5.463_784_911_164_114, 0.599_832_206_555_888],
    [1.784_826_539_917_291_3, 0.136_929_880_922_735_8],
    [0.296_560_571_828_504_87, 0.014_875_361_290_850_615],
    [0.026_532_189_526_576_124, 7.868_691_311_456_133e-4],
    [0.001_242_660_947_388_078_4, 1.846_318_317_510_054_8e-5],
    [2.711_555_568_743_487_6e-5, 1.421_511_758_316_446e-7],
    [2.010_334_399_292_288_1e-7, 2.044_263_103_389_939_8e-15],
];

fn ratio(coefficients: &Rational, r: f64) -> f64 {
    let term = |[above, below]: [f64; 2], [a, b]: &[f64; 2]| [above * r + a, below * r + b];
    let [numerator, denominator] = coefficients.iter().rev().fold([0.0; 2], term);
    numerator / denominator
}

#[cfg(test)]
mod tests {
    use super::*;

    // Values of the source.
    #[test]
    fn percentage_points() {
        for (p, x) in [
            (0.25, -0.674_489_750_196_081_7),
            (0.001, -3.090_232_306_167_814),
            (1e-20, -9.262_340_089_798_408),
        ] {
            assert!((normal_quantile(p) - x).abs() < 1e-14 * x.abs(), "{p}");
        }
    }

    #[test]
    fn quantile_and_distribution_are_inverse() {
        for k in -60..=60 {
            let x = f64::from(k) / 10.0;
            // Where the distribution is near 1 its digits end first.
            let tolerance = 1e-13 + 2e-16 / libm::exp(-0.5 * x * x);
            assert!((normal_quantile(normal_distribution(x)) - x).abs() < tolerance.max(1e-13) * 4.0, "{x}");
        }
        assert_eq!(normal_quantile(0.0), f64::NEG_INFINITY);
        assert_eq!(normal_quantile(1.0), f64::INFINITY);
    }
}
