//! A speed over time, straight between its points.

/// Speeds at increasing times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpeedPath {
    /// Times of the points.
    pub time_s: Vec<f64>,
    /// A speed for each.
    pub speed_rev_s: Vec<f64>,
}

impl SpeedPath {
    /// The speed at a time; the speed of the nearest end outside. 0 without points.
    pub fn at(&self, time_s: f64) -> f64 {
        let behind = self.time_s.partition_point(|&of_point| of_point < time_s);
        match (behind.checked_sub(1), self.time_s.get(behind)) {
            (Some(before), Some(&behind_s)) => {
                let share = (time_s - self.time_s[before]) / (behind_s - self.time_s[before]);
                self.speed_rev_s[before] + share * (self.speed_rev_s[behind] - self.speed_rev_s[before])
            }
            (None, Some(_)) => self.speed_rev_s[0],
            (Some(last), None) => self.speed_rev_s[last],
            (None, None) => 0.0,
        }
    }
}
