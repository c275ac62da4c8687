//! Minimum of a function of one variable.

/// Share of an interval that golden section search keeps.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// An interval of one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Interval {
    /// Points from end to end in equal steps.
    pub(crate) fn points(self, count: usize) -> impl Iterator<Item = f64> {
        let step = self.step(count);
        (0..count).map(move |at| self.low + at as f64 * step)
    }

    /// Step between those points.
    pub(crate) fn step(self, count: usize) -> f64 {
        (self.high - self.low) / (count.max(2) - 1) as f64
    }

    /// The part within a distance of a point.
    pub(crate) fn around(self, centre: f64, distance: f64) -> Self {
        Self { low: (centre - distance).max(self.low), high: (centre + distance).min(self.high) }
    }
}

/// The place of the minimum by golden section search (Kiefer 1953), to a share of the interval.
pub(crate) fn minimum(interval: Interval, share: f64, mut cost: impl FnMut(f64) -> f64) -> f64 {
    let Interval { mut low, mut high } = interval;
    let width = share * (high - low);
    let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut at_left, mut at_right) = (cost(left), cost(right));
    while high - low > width {
        if at_left <= at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - GOLDEN * (high - low);
            at_left = cost(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + GOLDEN * (high - low);
            at_right = cost(right);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_minimum_of_a_parabola_is_its_vertex() {
        let place = minimum(Interval { low: -1.0, high: 4.0 }, 1e-6, |x| (x - 0.7).powi(2));
        assert!((place - 0.7).abs() < 1e-5);
        assert_eq!(Interval { low: 0.0, high: 1.0 }.points(3).collect::<Vec<_>>(), [0.0, 0.5, 1.0]);
    }
}
