//! Many tests at once: Holm's step-down procedure (1979).

use super::{Change, FALSE_ALARM_CHANCE};

/// Fills in what follows from all tests together.
pub(super) fn adjust(mut changes: Vec<&mut Change>) {
    changes.sort_by(|one, other| one.p_value.total_cmp(&other.p_value));
    let count = changes.len();
    let mut least: f64 = 0.0;
    for (rank, change) in changes.iter_mut().enumerate() {
        least = least.max((change.p_value * (count - rank) as f64).min(1.0));
        change.p_value_holm = least;
        change.has_changed = change.is_rotor_known && least < FALSE_ALARM_CHANCE;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holm_multiplies_the_smallest_by_the_number_of_tests_and_never_decreases() {
        let change = |p_value: f64| Change {
            change_share: 0.0,
            std_uncertainty_share: 1.0,
            degrees_of_freedom: None,
            p_value,
            p_value_holm: 1.0,
            is_rotor_known: true,
            has_changed: false,
        };
        let mut changes = [0.04, 0.01, 0.03, 0.9].map(change);
        adjust(changes.iter_mut().collect());
        let adjusted: Vec<f64> = changes.iter().map(|change| (change.p_value_holm * 1e6).round() / 1e6).collect();
        assert_eq!(adjusted, [0.09, 0.04, 0.09, 0.9]);
        assert_eq!(changes.iter().filter(|change| change.has_changed).count(), 1);
    }
}
