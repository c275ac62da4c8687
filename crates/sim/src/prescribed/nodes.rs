//! A number that changes over time, known at evenly spaced instants.

/// A function of time: known at nodes that are `step_s` apart, the first at 0 s, and straight between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Nodes {
    mean: f64,
    step_s: f64,
    deviations: Vec<f64>,
}

impl Nodes {
    /// From the values at the nodes. Without nodes the function is 0.
    pub fn new(step_s: f64, values: Vec<f64>) -> Self {
        Self::about(0.0, step_s, values)
    }

    /// From a mean and the deviations from it at the nodes. Without nodes the function is the mean.
    pub fn about(mean: f64, step_s: f64, deviations: Vec<f64>) -> Self {
        Self { mean, step_s, deviations }
    }

    /// The value at an instant. Before the first node it is that of the first node; after the last node it goes on straight.
    pub fn at(&self, time_s: f64) -> f64 {
        let [first, .., _] = self.deviations[..] else { return self.mean + self.deviations.first().unwrap_or(&0.0) };
        if time_s <= 0.0 {
            return self.mean + first;
        }
        let position = time_s / self.step_s;
        let before = (position as usize).min(self.deviations.len() - 2);
        let (from, to) = (self.deviations[before], self.deviations[before + 1]);
        self.mean + from + (position - before as f64) * (to - from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_straight_between_the_nodes() {
        let nodes = Nodes::about(10.0, 0.5, vec![1.0, 3.0, 2.0]);
        for (time_s, value) in [(-1.0, 11.0), (0.0, 11.0), (0.25, 12.0), (0.5, 13.0), (0.75, 12.5), (1.0, 12.0)] {
            assert!((nodes.at(time_s) - value).abs() < 1e-12, "{time_s} s: {}", nodes.at(time_s));
        }
        assert_eq!([Nodes::new(1.0, vec![7.0]).at(3.0), Nodes::about(2.0, 1.0, Vec::new()).at(3.0)], [7.0, 2.0]);
    }
}
