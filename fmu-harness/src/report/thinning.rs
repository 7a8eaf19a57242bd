//! Thinning of curves.

/// Selects about `most` points and keeps peaks: of every bucket the first, the lowest, the highest and the last point.
pub fn thinned(points: &[(f64, f64)], most: usize) -> Vec<(f64, f64)> {
    if points.len() <= most {
        return points.to_vec();
    }
    let by_height = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
    let of_bucket = |bucket: &[(f64, f64)]| -> Vec<(f64, f64)> {
        let kept = [bucket.first(), bucket.iter().min_by(by_height), bucket.iter().max_by(by_height), bucket.last()];
        let mut kept: Vec<(f64, f64)> = kept.into_iter().flatten().copied().collect();
        kept.sort_by(|a, b| a.0.total_cmp(&b.0));
        kept
    };
    points.chunks(points.len().div_ceil(most / 4)).flat_map(of_bucket).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_ends_peaks_and_order() {
        let mut points: Vec<(f64, f64)> = (0..50_000).map(|i| (f64::from(i), f64::from(i % 7))).collect();
        (points[31_234].1, points[44_321].1) = (1e6, -1e6);
        let thin = thinned(&points, 4000);
        assert!(thin.len() <= 4000 + 4 && thin.is_sorted_by(|a, b| a.0 <= b.0));
        assert!(thin.contains(&points[31_234]) && thin.contains(&points[44_321]));
        assert_eq!((thin.first(), thin.last()), (points.first(), points.last()));
    }
}
