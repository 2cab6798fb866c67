//! A shuffled order of which any place can be computed alone.

const ROUNDS: u64 = 4;

/// The place of `index` in a random order of `count` things.
///
/// # Arguments
/// * `index` - below `count`
/// * `count` - at least 1
/// * `key` - which order
///
/// A balanced Feistel network over the next power of four, walked until the result is below `count`.
///
/// Source: J. Black, P. Rogaway, "Ciphers with arbitrary finite domains", CT-RSA 2002, LNCS 2271, 114–130 (cycle walking).
///
/// ```
/// use meshtone_dataset::sampling::permuted;
///
/// let mut order: Vec<u64> = (0..10).map(|index| permuted(index, 10, 7)).collect();
/// order.sort();
/// assert_eq!(order, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]);
/// ```
pub fn permuted(index: u64, count: u64, key: u64) -> u64 {
    if count <= 1 {
        return 0;
    }
    let bits = 64 - (count - 1).leading_zeros();
    let half = bits.div_ceil(2);
    let mask = (1u64 << half) - 1;
    let mut value = index;
    loop {
        let (mut left, mut right) = (value >> half, value & mask);
        for round in 0..ROUNDS {
            (left, right) = (right, left ^ (mixed(right ^ mixed(key ^ (round << 56))) & mask));
        }
        value = (left << half) | right;
        if value < count {
            return value;
        }
    }
}

/// The finaliser of SplitMix64.
///
/// Source: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
fn mixed(mut bits: u64) -> u64 {
    bits = bits.wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::permuted;

    #[test]
    fn every_place_once() {
        for count in [1, 2, 3, 5, 16, 17, 100, 1023, 1025] {
            for key in [0, 1, u64::MAX] {
                let mut order: Vec<u64> = (0..count).map(|index| permuted(index, count, key)).collect();
                order.sort_unstable();
                assert_eq!(order, (0..count).collect::<Vec<_>>(), "{count} {key}");
            }
        }
    }

    #[test]
    fn orders_look_random() {
        let count = 2000;
        // Correlation of index and place, over several keys: about 1/√count.
        for key in 0..20 {
            let sum: f64 = (0..count)
                .map(|index| {
                    let place = permuted(index, count, key) as f64 / count as f64 - 0.5;
                    place * (index as f64 / count as f64 - 0.5)
                })
                .sum();
            assert!((12.0 * sum / count as f64).abs() < 0.1, "{key}");
        }
    }
}
