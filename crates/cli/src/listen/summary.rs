//! All live speeds in one sentence.

use hovertone::live::{LiveSpeed, LiveStatus};
use hovertone_report::{fixed, with_uncertainty};

/// Speeds of one hover differ by no more than this factor. *Decision.*
const ONE_HOVER_FACTOR: f64 = 1.1;

/// Sums over the live speeds, which come at equal distances in time.
#[derive(Debug, Default)]
pub(crate) struct LiveSummary {
    count: usize,
    settled_count: usize,
    ambiguous_count: usize,
    listening_count: usize,
    /// Whether the last speed that was told is one of several.
    is_last_ambiguous: bool,
    sum_rev_s: f64,
    sum_std_rev_s: f64,
    /// Slowest and fastest.
    range_rev_s: Option<(f64, f64)>,
    end_s: f64,
}

impl LiveSummary {
    pub(crate) fn add(&mut self, speed: &LiveSpeed) {
        self.count += 1;
        self.end_s = speed.time_s;
        match (speed.status, speed.speed_rev_s, speed.std_uncertainty_rev_s) {
            (LiveStatus::Ok, Some(speed_rev_s), Some(std_rev_s)) => {
                self.settled_count += 1;
                self.is_last_ambiguous = false;
                self.sum_rev_s += speed_rev_s;
                self.sum_std_rev_s += std_rev_s;
                let (slowest, fastest) = self.range_rev_s.unwrap_or((speed_rev_s, speed_rev_s));
                self.range_rev_s = Some((slowest.min(speed_rev_s), fastest.max(speed_rev_s)));
            }
            (LiveStatus::Ambiguous, ..) => {
                self.ambiguous_count += 1;
                self.is_last_ambiguous = true;
            }
            (LiveStatus::Listening, ..) => self.listening_count += 1,
            _ => {}
        }
    }

    /// Whether one speed was told, and stayed the only one: where the sound ends open, or its single speeds change, and it is open for as long a
    /// time, it is open, as it is for `hovertone speed`.
    pub(crate) fn is_settled(&self) -> bool {
        let is_doubtful = self.is_last_ambiguous || self.has_changed();
        self.settled_count > 0 && !(is_doubtful && self.ambiguous_count >= self.settled_count)
    }

    /// Whether the single speeds are not those of one hover.
    fn has_changed(&self) -> bool {
        self.range_rev_s.is_some_and(|(slowest_rev_s, fastest_rev_s)| fastest_rev_s > ONE_HOVER_FACTOR * slowest_rev_s)
    }

    /// The mean speed, and how long it was heard; `None` if there was no sound.
    ///
    /// The errors of live speeds are those of the same reviews, so they do not average out: the standard uncertainty of the mean is the mean of the
    /// standard uncertainties, which is its value for errors that are all equal and an upper bound for all others.
    ///
    /// `advice` says what to do where several speeds are possible.
    pub(crate) fn in_words(&self, advice: &str) -> Option<String> {
        if self.count == 0 {
            return None;
        }
        let end_s = fixed(self.end_s, 1);
        let part_s = |count: usize| fixed(count as f64 / self.count as f64 * self.end_s, 1);
        let mean = self.range_rev_s.filter(|_| self.is_settled()).map(|(slowest_rev_s, fastest_rev_s)| {
            let heard_s = part_s(self.settled_count);
            if self.has_changed() {
                let (slowest, fastest) = (fixed(slowest_rev_s, 1), fixed(fastest_rev_s, 1));
                return format!(
                    "no mean: the speed changed between {slowest} and {fastest} rev/s; a speed was heard in {heard_s} s of {end_s} s"
                );
            }
            let count = self.settled_count as f64;
            let mean = with_uncertainty(self.sum_rev_s / count, Some(self.sum_std_rev_s / count));
            format!("mean: {mean} rev/s (± covers about 95 % of cases, k = 2), from {heard_s} s of {end_s} s")
        });
        let mut words = match mean {
            Some(mean) => mean,
            None if self.listening_count == self.count => format!("no speed: {end_s} s of sound are too short"),
            None if self.settled_count > 0 => {
                format!("no mean: one speed was clear in only {} s of {end_s} s", part_s(self.settled_count))
            }
            None if self.ambiguous_count > 0 => format!("no single speed was heard in {end_s} s"),
            None => format!("no speed was heard in {end_s} s"),
        };
        if self.ambiguous_count > 0 {
            words += &format!("; for {} s several speeds were possible", part_s(self.ambiguous_count));
            if !self.is_settled() {
                words += &format!("; to find the right speed, {advice}");
            }
        }
        Some(words + "\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn the_mean_is_over_the_time_that_had_one_speed() {
        let sentence = summary_of(&[None, Some(60.0), Some(61.0), None]).in_words("give --rotors").unwrap();
        assert_eq!(sentence, "mean: 60.50 ± 0.20 rev/s (± covers about 95 % of cases, k = 2), from 0.2 s of 0.4 s\n");
        let changed = "no mean: the speed changed between 52.8 and 91.8 rev/s; a speed was heard in 0.3 s of 0.3 s\n";
        assert_eq!(summary_of(&[Some(52.8), Some(91.8), Some(70.0)]).in_words("give --rotors").unwrap(), changed);
        assert_eq!(summary_of(&[None; 20]).in_words("give --rotors").unwrap(), "no speed was heard in 2.0 s\n");
        assert_eq!(summary_of(&[]).in_words("give --rotors"), None);
    }

    #[test]
    fn what_is_not_settled_is_no_part_of_the_mean() {
        let of_status = |statuses: &[LiveStatus]| {
            let mut summary = LiveSummary::default();
            for (number, &status) in (1..).zip(statuses) {
                let has_speed = matches!(status, LiveStatus::Ok | LiveStatus::Ambiguous);
                summary.add(&LiveSpeed {
                    time_s: f64::from(number),
                    status,
                    speed_rev_s: has_speed.then_some(if status == LiveStatus::Ok { 60.0 } else { 120.0 }),
                    std_uncertainty_rev_s: has_speed.then_some(0.1),
                    level_db: -20.0,
                    clipped_share: 0.0,
                });
            }
            summary.in_words("give --rotors").unwrap()
        };
        use LiveStatus::{Ambiguous, Listening, Ok};
        assert_eq!(of_status(&[Listening; 2]), "no speed: 2.0 s of sound are too short\n");
        let none = "no single speed was heard in 3.0 s; for 2.0 s several speeds were possible; to find the right speed, give --rotors\n";
        assert_eq!(of_status(&[Listening, Ambiguous, Ambiguous]), none);
        let some = "mean: 60.00 ± 0.20 rev/s (± covers about 95 % of cases, k = 2), from 1.0 s of 3.0 s; for 1.0 s \
                    several speeds were possible\n";
        assert_eq!(of_status(&[Listening, Ambiguous, Ok]), some);
        // what the later sound leaves open is open
        let open = "no mean: one speed was clear in only 1.0 s of 3.0 s; for 1.0 s several speeds were possible; to \
                    find the right speed, give --rotors\n";
        assert_eq!(of_status(&[Listening, Ok, Ambiguous]), open);
        assert!(of_status(&[Ok, Ok, Ambiguous]).starts_with("mean: 60.00"));
    }
}
