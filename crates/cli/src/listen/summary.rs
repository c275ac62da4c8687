//! All live speeds in one sentence.

use hovertone::live::LiveSpeed;
use hovertone_report::{fixed, with_uncertainty};

const PERCENT: f64 = 100.0;

/// Sums over the live speeds, which come at equal distances in time.
#[derive(Debug, Default)]
pub(crate) struct LiveSummary {
    count: usize,
    with_speed_count: usize,
    sum_rev_s: f64,
    sum_std_rev_s: f64,
    end_s: f64,
}

impl LiveSummary {
    pub(crate) fn add(&mut self, speed: &LiveSpeed) {
        self.count += 1;
        self.end_s = speed.time_s;
        if let (Some(speed_rev_s), Some(std_rev_s)) = (speed.speed_rev_s, speed.std_uncertainty_rev_s) {
            self.with_speed_count += 1;
            self.sum_rev_s += speed_rev_s;
            self.sum_std_rev_s += std_rev_s;
        }
    }

    /// The mean speed, and how much of the time had a speed; `None` if nothing was heard.
    ///
    /// The errors of live speeds are those of the same reviews, so they do not average out: the standard uncertainty of the mean is the mean of the
    /// standard uncertainties, which is its value for errors that are all equal and an upper bound for all others.
    pub(crate) fn in_words(&self) -> Option<String> {
        let end_s = fixed(self.end_s, 1);
        match (self.count, self.with_speed_count as f64) {
            (0, _) => None,
            (_, 0.0) => Some(format!("no speed was heard in {end_s} s\n")),
            (count, with_speed_count) => {
                let std_rev_s = self.sum_std_rev_s / with_speed_count;
                let mean = with_uncertainty(self.sum_rev_s / with_speed_count, Some(std_rev_s));
                let share = with_speed_count / count as f64;
                let heard_s = fixed(share * self.end_s, 1);
                let percent = fixed(PERCENT * share, 0);
                Some(format!(
                    "mean: {mean} rev/s (k = 2), over {heard_s} of {end_s} s: {percent} % of the time had a speed\n"
                ))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone::live::LiveStatus;

    fn summary_of(speeds_rev_s: &[Option<f64>]) -> LiveSummary {
        let mut summary = LiveSummary::default();
        for (number, &speed_rev_s) in (1..).zip(speeds_rev_s) {
            summary.add(&LiveSpeed {
                time_s: 0.1 * f64::from(number),
                status: if speed_rev_s.is_some() { LiveStatus::Ok } else { LiveStatus::NoRotorTone },
                speed_rev_s,
                std_uncertainty_rev_s: speed_rev_s.map(|_| 0.1),
                level_db: -20.0,
                clipped_share: 0.0,
            });
        }
        summary
    }

    #[test]
    fn the_mean_is_over_the_time_that_had_a_speed() {
        let sentence = summary_of(&[None, Some(60.0), Some(61.0), None]).in_words().unwrap();
        assert_eq!(sentence, "mean: 60.50 ± 0.20 rev/s (k = 2), over 0.2 of 0.4 s: 50 % of the time had a speed\n");
        assert_eq!(summary_of(&[None; 20]).in_words().unwrap(), "no speed was heard in 2.0 s\n");
        assert_eq!(summary_of(&[]).in_words(), None);
    }
}
