//! Several steps as one value.

use hovertone_vehicle::{Ending, Estimate};

/// A value from several steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CombinedEstimate {
    /// The value.
    pub estimate: Estimate,
    /// Steps that it is from.
    pub step_count: usize,
}

/// The weighted mean of values that scatter by more than their uncertainties: the variance between them is added to each (DerSimonian and
/// Laird 1986). Values without uncertainty are left out; `None` without any.
pub(crate) fn combined(estimates: impl Iterator<Item = Estimate>) -> Option<CombinedEstimate> {
    let values: Vec<WeighedValue> = estimates.filter_map(weighed).collect();
    let first = values.first()?;
    let weights = |between: f64| values.iter().map(move |value| 1.0 / (value.variance + between));
    let mean_of = |between: f64| {
        let products: f64 = weights(between).zip(&values).map(|(weight, value)| weight * value.value).sum();
        products / weights(between).sum::<f64>()
    };
    let (sum, squares) = (weights(0.0).sum::<f64>(), weights(0.0).map(|weight| weight * weight).sum::<f64>());
    let centre = mean_of(0.0);
    let chi_square: f64 = values.iter().map(|value| (value.value - centre).powi(2) / value.variance).sum();
    let freedom = (values.len() - 1) as f64;
    let between = if values.len() > 1 { ((chi_square - freedom) / (sum - squares / sum)).max(0.0) } else { 0.0 };
    let std_uncertainty = Some(weights(between).sum::<f64>().recip().sqrt());
    let (value, ending) = match values.len() {
        1 => (first.value, Ending::SingleObservation),
        _ => (mean_of(between), Ending::Solved),
    };
    Some(CombinedEstimate { estimate: Estimate { value, std_uncertainty, ending }, step_count: values.len() })
}

struct WeighedValue {
    value: f64,
    variance: f64,
}

fn weighed(estimate: Estimate) -> Option<WeighedValue> {
    let variance = estimate.std_uncertainty?.powi(2);
    (variance > 0.0 && variance.is_finite()).then_some(WeighedValue { value: estimate.value, variance })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64], std: f64) -> CombinedEstimate {
        let estimate = |&value: &f64| Estimate { value, std_uncertainty: Some(std), ending: Ending::Solved };
        combined(values.iter().map(estimate)).unwrap()
    }

    #[test]
    fn values_that_scatter_more_than_they_claim_are_worth_less() {
        let agreeing = of(&[1.0, 1.01, 0.99, 1.0], 0.02).estimate;
        assert!((agreeing.std_uncertainty.unwrap() - 0.01).abs() < 1e-9 && (agreeing.value - 1.0).abs() < 1e-9);
        // standard deviation 0.2 of four values: 0.1 for their mean
        let scattered = of(&[0.8, 1.2, 0.826_794_919, 1.173_205_081], 0.001).estimate;
        assert!((scattered.std_uncertainty.unwrap() - 0.1).abs() < 0.01, "{scattered:?}");
        assert_eq!(of(&[0.5], 0.1).step_count, 1);
        assert!(combined(std::iter::empty()).is_none());
    }
}
