//! How deep a hollow of one flank is felt by the round flank that rolls over it.

/// (mm) Gap between a flank with hollows and its mate, `min over t' of h(t') + x²/(2ρ*)`, x the distance along the flank of the
/// point at t' from the one at t that they would touch at: the mate bridges a hollow from edge to edge where it is narrow, and
/// reaches its bottom where it is wide.
///
/// # Arguments
/// * `depth_mm` - (mm) h, how far the flank lies back at each point
/// * `along_mm` - (mm) place of each point along the flank, rising or falling
/// * `relative_radius_mm` - (mm) ρ*, relative radius of curvature at each point
///
/// # Returns
/// At each point, the gap and the number of the point that is touched.
pub(crate) fn bridged(depth_mm: &[f64], along_mm: &[f64], relative_radius_mm: &[f64]) -> Vec<(f64, usize)> {
    let points = depth_mm.len();
    (0..points)
        .map(|here| {
            let mut least = (depth_mm[here], here);
            let bulge = |there: usize| {
                let away = along_mm[there] - along_mm[here];
                away * away / (2.0 * relative_radius_mm[here].max(f64::MIN_POSITIVE))
            };
            for side in [1, -1] {
                let mut there = here;
                while let Some(next) = there.checked_add_signed(side).filter(|&next| next < points) {
                    there = next;
                    let bulge = bulge(there);
                    if bulge + depth_mm[there] < least.0 {
                        least = (bulge + depth_mm[there], there);
                    }
                    // Farther away the mate lies farther back than what is found already.
                    if bulge >= least.0 {
                        break;
                    }
                }
            }
            least
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A groove with upright walls, in steps of 10 µm.
    fn groove(width_mm: f64, depth_mm: f64) -> Vec<(f64, usize)> {
        let along: Vec<f64> = (0..800).map(|point| f64::from(point) * 0.01).collect();
        let depth: Vec<f64> =
            along.iter().map(|x| if (x - 4.0).abs() < width_mm / 2.0 { depth_mm } else { 0.0 }).collect();
        bridged(&depth, &along, &vec![6.0; along.len()])
    }

    #[test]
    fn a_narrow_groove_is_bridged_and_a_wide_one_felt() {
        // The mate sinks in by (w/2)²/(2ρ*); the sound points at its edges are 0.62 mm apart.
        let narrow = groove(0.61, 0.1);
        let deepest = narrow.iter().map(|(gap, _)| *gap).fold(0.0, f64::max);
        assert!((deepest / (0.31 * 0.31 / 12.0) - 1.0).abs() < 1e-9, "{deepest}");
        let wide = groove(4.0, 0.1);
        assert_eq!(wide[400], (0.1, 400));
        // Near an edge the edge is touched.
        let (gap, touched) = wide[210];
        assert!(touched <= 200 && (gap - 0.1 * 0.1 / 12.0).abs() < 2e-4, "{gap} {touched}");
    }

    #[test]
    fn a_sound_flank_is_touched_where_it_is() {
        assert!(groove(0.0, 0.1).iter().enumerate().all(|(point, found)| *found == (0.0, point)));
    }
}
