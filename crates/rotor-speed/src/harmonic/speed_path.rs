//! A shaft speed over time, and the angle that the shaft has turned.

/// Straight pieces of speed between ticks, from the start of a quantum.
#[derive(Clone, Debug)]
pub(crate) struct SpeedPath {
    pub(crate) tick_s: f64,
    /// Speed at each border between ticks: one more than there are ticks.
    speeds_rev_s: Vec<f64>,
    /// Turns since the start at each border.
    turns: Vec<f64>,
}

impl SpeedPath {
    /// From the speed at each border between ticks.
    pub(crate) fn from_borders(tick_s: f64, speeds_rev_s: Vec<f64>) -> Self {
        let mut turns = Vec::with_capacity(speeds_rev_s.len());
        let mut total = 0.0;
        for (index, speed) in speeds_rev_s.iter().enumerate() {
            if index > 0 {
                total += tick_s * (speeds_rev_s[index - 1] + speed) / 2.0;
            }
            turns.push(total);
        }
        Self { tick_s, speeds_rev_s, turns }
    }

    /// Through points of time and speed, held before the first and after the last. Without points there is no path.
    pub(crate) fn through(points: &[(f64, f64)], tick_s: f64, ticks: usize) -> Option<Self> {
        let (first, last) = (points.first()?, points.last()?);
        let mut next = 0;
        let speeds = (0..=ticks)
            .map(|tick| {
                let time_s = tick as f64 * tick_s;
                while next < points.len() && points[next].0 <= time_s {
                    next += 1;
                }
                match (points.get(next.wrapping_sub(1)), points.get(next)) {
                    (Some(&(a_s, a)), Some(&(b_s, b))) => a + (b - a) * (time_s - a_s) / (b_s - a_s),
                    (None, _) => first.1,
                    (_, None) => last.1,
                }
            })
            .collect();
        Some(Self::from_borders(tick_s, speeds))
    }

    pub(crate) fn ticks(&self) -> usize {
        self.speeds_rev_s.len().saturating_sub(1)
    }

    /// Turns at the start of a tick, and speed at its start and end.
    pub(crate) fn tick(&self, tick: usize) -> (f64, f64, f64) {
        (self.turns[tick], self.speeds_rev_s[tick], self.speeds_rev_s[tick + 1])
    }

    /// Speed at a border between ticks.
    pub(crate) fn speed_rev_s(&self, border: usize) -> f64 {
        self.speeds_rev_s[border]
    }

    /// Mean over all of it.
    pub(crate) fn mean_rev_s(&self) -> f64 {
        self.turns.last().map_or(0.0, |turns| turns / (self.ticks().max(1) as f64 * self.tick_s))
    }

    /// Whether the other path is nowhere further off than that.
    pub(crate) fn is_within(&self, distance_rev_s: f64, other: &Self) -> bool {
        let speeds = self.speeds_rev_s.iter().zip(&other.speeds_rev_s);
        self.ticks() == other.ticks() && speeds.into_iter().all(|(a, b)| (a - b).abs() <= distance_rev_s)
    }

    /// Turns at the middle of a tick.
    pub(crate) fn turns_at_middle(&self, tick: usize) -> f64 {
        let (turns, from, to) = self.tick(tick);
        turns + self.tick_s * (3.0 * from + to) / 8.0
    }

    /// Turns at any time.
    pub(crate) fn turns_at(&self, time_s: f64) -> f64 {
        let tick = ((time_s / self.tick_s) as usize).min(self.ticks().saturating_sub(1));
        let (turns, from, to) = self.tick(tick);
        let into_s = time_s - tick as f64 * self.tick_s;
        turns + into_s * (from + (to - from) * into_s / (2.0 * self.tick_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_the_integral_of_speed() {
        let path = SpeedPath::through(&[(0.1, 50.0), (0.3, 60.0)], 0.01, 50).unwrap();
        assert!((path.turns_at(0.1) - 5.0).abs() < 1e-12);
        assert!((path.turns_at(0.2) - (5.0 + 5.25)).abs() < 1e-12);
        assert!((path.turns_at(0.3) - 16.0).abs() < 1e-12);
        assert!((path.turns_at(0.5) - 28.0).abs() < 1e-12);
        for tick in 0..50 {
            assert!((path.turns_at_middle(tick) - path.turns_at((tick as f64 + 0.5) * 0.01)).abs() < 1e-12);
        }
        assert!(SpeedPath::through(&[], 0.01, 50).is_none());
    }
}
