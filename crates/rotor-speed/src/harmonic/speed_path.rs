//! A shaft speed over time, and its integral: the angle of the shaft.

/// A speed at a time from the start of a chunk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpeedPoint {
    pub(crate) time_s: f64,
    pub(crate) speed_rev_s: f64,
}

/// One tick of a path: the angle at its start, and the speeds at its start and end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathTick {
    pub(crate) turns: f64,
    pub(crate) speed_from_rev_s: f64,
    pub(crate) speed_to_rev_s: f64,
}

/// A speed that is linear in each tick, from the start of a chunk. Times count from that start; angles are in turns.
#[derive(Clone, Debug)]
pub(crate) struct SpeedPath {
    /// Length of a tick.
    pub(crate) tick_s: f64,
    /// Speed at each border between ticks: one value more than ticks.
    speeds_rev_s: Vec<f64>,
    /// Angle at each border.
    turns: Vec<f64>,
}

impl SpeedPath {
    /// A path from the speed at each border between ticks.
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

    /// A path through points in order of time, linear between them and constant before the first and after the last. `None` without
    /// points.
    pub(crate) fn through(points: &[SpeedPoint], tick_s: f64, ticks: usize) -> Option<Self> {
        let (first, last) = (points.first()?, points.last()?);
        let mut next = 0;
        let speeds = (0..=ticks)
            .map(|tick| {
                let time_s = tick as f64 * tick_s;
                while next < points.len() && points[next].time_s <= time_s {
                    next += 1;
                }
                match (points.get(next.wrapping_sub(1)), points.get(next)) {
                    (Some(a), Some(b)) => {
                        a.speed_rev_s + (b.speed_rev_s - a.speed_rev_s) * (time_s - a.time_s) / (b.time_s - a.time_s)
                    }
                    (None, _) => first.speed_rev_s,
                    (_, None) => last.speed_rev_s,
                }
            })
            .collect();
        Some(Self::from_borders(tick_s, speeds))
    }

    /// Number of ticks.
    pub(crate) fn ticks(&self) -> usize {
        self.speeds_rev_s.len().saturating_sub(1)
    }

    /// The angle at the start of a tick, and the speeds at its start and end.
    pub(crate) fn tick(&self, tick: usize) -> PathTick {
        PathTick {
            turns: self.turns[tick],
            speed_from_rev_s: self.speeds_rev_s[tick],
            speed_to_rev_s: self.speeds_rev_s[tick + 1],
        }
    }

    /// Speed at a border between ticks.
    pub(crate) fn speed_rev_s(&self, border: usize) -> f64 {
        self.speeds_rev_s[border]
    }

    /// Mean speed of the whole path.
    pub(crate) fn mean_rev_s(&self) -> f64 {
        self.turns.last().map_or(0.0, |turns| turns / (self.ticks().max(1) as f64 * self.tick_s))
    }

    /// Whether the other path differs nowhere by more than `distance_rev_s`.
    pub(crate) fn is_within(&self, distance_rev_s: f64, other: &Self) -> bool {
        let speeds = self.speeds_rev_s.iter().zip(&other.speeds_rev_s);
        self.ticks() == other.ticks() && speeds.into_iter().all(|(a, b)| (a - b).abs() <= distance_rev_s)
    }

    /// Angle from one border between ticks to another.
    pub(crate) fn turns_between(&self, from: usize, to: usize) -> f64 {
        self.turns[to] - self.turns[from]
    }

    /// Angle at the middle of a tick.
    pub(crate) fn turns_at_middle(&self, tick: usize) -> f64 {
        let PathTick { turns, speed_from_rev_s, speed_to_rev_s } = self.tick(tick);
        turns + self.tick_s * (3.0 * speed_from_rev_s + speed_to_rev_s) / 8.0
    }

    /// Angle at any time.
    pub(crate) fn turns_at(&self, time_s: f64) -> f64 {
        let tick = ((time_s / self.tick_s) as usize).min(self.ticks().saturating_sub(1));
        let PathTick { turns, speed_from_rev_s: from, speed_to_rev_s: to } = self.tick(tick);
        let into_s = time_s - tick as f64 * self.tick_s;
        turns + into_s * (from + (to - from) * into_s / (2.0 * self.tick_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_the_integral_of_speed() {
        let point = |time_s, speed_rev_s| SpeedPoint { time_s, speed_rev_s };
        let path = SpeedPath::through(&[point(0.1, 50.0), point(0.3, 60.0)], 0.01, 50).unwrap();
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
