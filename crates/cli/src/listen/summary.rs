//! All live speeds in one sentence.

use crate::listen::advice::Advice;
use crate::listen::lines::SPEEDS_PER_SECOND;
use hovertone::live::{LiveSpeed, LiveStatus};
use hovertone::speed::{OtherRotor, Warning};
use hovertone_report::{fixed, with_uncertainty};

/// Speeds of one hover differ by no more than this factor. *Decision.*
const ONE_HOVER_FACTOR: f64 = 1.1;

/// Sums over the live speeds, which come at equal distances in time.
#[derive(Debug, Default)]
pub(crate) struct LiveSummary {
    /// Shortest time for which a rotor must hold its speed where the rest of the sound is longer, s: the same as in a recording.
    held_s_min: f64,
    count: usize,
    settled_count: usize,
    ambiguous_count: usize,
    listening_count: usize,
    /// Single speeds in sequence up to now, and the most of them.
    held_count: usize,
    held_count_max: usize,
    /// Single speeds for which the sound contradicts the given facts, and the rotor that is more probable at the last of them.
    contradicted_count: usize,
    more_probable: Option<OtherRotor>,
    /// Whether the last speed that was told is one of several.
    is_last_ambiguous: bool,
    sum_rev_s: f64,
    sum_std_rev_s: f64,
    /// Slowest and fastest of the single speeds.
    range_rev_s: Option<Range>,
    /// The single speeds since the last second that is complete.
    of_second_rev_s: Vec<f64>,
    /// Slowest and fastest mean of a second: a jump for a moment is no change of the speed.
    range_of_seconds_rev_s: Option<Range>,
    end_s: f64,
}

/// The slowest and the fastest of some speeds.
#[derive(Clone, Copy, Debug)]
struct Range {
    slowest_rev_s: f64,
    fastest_rev_s: f64,
}

impl Range {
    /// The range of all speeds of `before` and one more.
    fn with(before: Option<Self>, speed_rev_s: f64) -> Self {
        let Self { slowest_rev_s, fastest_rev_s } =
            before.unwrap_or(Self { slowest_rev_s: speed_rev_s, fastest_rev_s: speed_rev_s });
        Self { slowest_rev_s: slowest_rev_s.min(speed_rev_s), fastest_rev_s: fastest_rev_s.max(speed_rev_s) }
    }
}

impl LiveSummary {
    pub(crate) fn new(held_s_min: f64) -> Self {
        Self { held_s_min, ..Self::default() }
    }

    /// Adds a live speed, with the rotor that is far more probable than the given one, where there is one.
    pub(crate) fn add(&mut self, speed: &LiveSpeed, more_probable: Option<OtherRotor>) {
        self.count += 1;
        self.end_s = speed.time_s;
        if speed.status != LiveStatus::Ok {
            self.held_count = 0;
        }
        match (speed.status, speed.speed_rev_s, speed.std_uncertainty_rev_s) {
            (LiveStatus::Ok, Some(speed_rev_s), Some(std_rev_s)) => {
                self.settled_count += 1;
                self.held_count += 1;
                self.held_count_max = self.held_count_max.max(self.held_count);
                self.contradicted_count += usize::from(more_probable.is_some());
                self.more_probable = more_probable.or(self.more_probable);
                self.is_last_ambiguous = false;
                self.sum_rev_s += speed_rev_s;
                self.sum_std_rev_s += std_rev_s;
                self.add_to_ranges(speed_rev_s);
            }
            (LiveStatus::Ambiguous, ..) => {
                self.ambiguous_count += 1;
                self.is_last_ambiguous = true;
            }
            (LiveStatus::Listening, ..) => self.listening_count += 1,
            _ => {}
        }
    }

    fn add_to_ranges(&mut self, speed_rev_s: f64) {
        self.range_rev_s = Some(Range::with(self.range_rev_s, speed_rev_s));
        self.of_second_rev_s.push(speed_rev_s);
        if self.of_second_rev_s.len() == SPEEDS_PER_SECOND {
            let mean_rev_s = self.of_second_rev_s.iter().sum::<f64>() / SPEEDS_PER_SECOND as f64;
            self.range_of_seconds_rev_s = Some(Range::with(self.range_of_seconds_rev_s, mean_rev_s));
            self.of_second_rev_s.clear();
        }
    }

    /// The slowest and the fastest second; of less than a second, the slowest and the fastest single speed.
    fn range(&self) -> Option<Range> {
        self.range_of_seconds_rev_s.or(self.range_rev_s)
    }

    /// Whether the mean is that of a rotor as given: one speed was clear, and the sound does not contradict the given facts.
    pub(crate) fn is_settled(&self) -> bool {
        self.is_clear() && self.contradiction().is_none()
    }

    /// Whether one speed was told, held, and stayed the only one.
    fn is_clear(&self) -> bool {
        self.settled_count > 0 && self.is_held() && !self.is_open()
    }

    /// Whether a speed was held, as a recording asks: where the rest of the sound is longer than all single speeds, one of them must be held.
    fn is_held(&self) -> bool {
        let rest_count = self.count - self.listening_count - self.settled_count;
        rest_count <= self.settled_count || self.part_s(self.held_count_max) >= self.held_s_min
    }

    /// Whether several speeds remain possible: they were so for longer than one was clear; or for as long, and the sound ends so or its single speeds
    /// change.
    fn is_open(&self) -> bool {
        let is_doubtful = self.is_last_ambiguous || self.has_changed();
        let is_longer = self.ambiguous_count > self.settled_count;
        is_longer || is_doubtful && self.ambiguous_count == self.settled_count
    }

    /// Whether the single speeds are not those of one hover.
    fn has_changed(&self) -> bool {
        self.range().is_some_and(|range| range.fastest_rev_s > ONE_HOVER_FACTOR * range.slowest_rev_s)
    }

    /// That the sound contradicts the given facts, where it does so for half of the single speeds or more.
    fn contradiction(&self) -> Option<Warning> {
        self.more_probable.filter(|_| 2 * self.contradicted_count >= self.settled_count).map(Warning::FitsElsewhere)
    }

    fn part_s(&self, count: usize) -> f64 {
        count as f64 / self.count as f64 * self.end_s
    }

    /// The mean speed, and how long it was heard; `None` if there was no sound.
    ///
    /// The errors of live speeds are those of the same reviews, so they do not average out: the standard uncertainty of the mean is the mean of the
    /// standard uncertainties, which is its value for errors that are all equal and an upper bound for all others.
    pub(crate) fn in_words(&self, advice: &Advice) -> Option<String> {
        if self.count == 0 {
            return None;
        }
        let end_s = fixed(self.end_s, 1);
        let mut words = match self.range() {
            Some(range) if self.is_clear() => self.mean_in_words(range),
            Some(_) => {
                format!(
                    "no mean: one speed was clear in only {} s of {end_s} s",
                    fixed(self.part_s(self.settled_count), 1)
                )
            }
            None if self.listening_count == self.count => {
                format!("no speed: {end_s} s of sound are too short: 3 s or more are needed")
            }
            None if self.ambiguous_count > 0 => format!("no speed was clear in {end_s} s"),
            None => format!("no speed was heard in {end_s} s"),
        };
        if self.ambiguous_count > 0 {
            let open_s = fixed(self.part_s(self.ambiguous_count), 1);
            words += &format!("; for {open_s} s several speeds were possible");
        }
        if self.is_open() {
            words += &format!("; if this is a rotor, {}", advice.which_is_right());
        } else if self.settled_count > 0 && !self.is_held() {
            let (held_s, held_s_min) = (fixed(self.part_s(self.held_count_max), 1), fixed(self.held_s_min, 0));
            words += &format!(
                ", at most {held_s} s without a gap; a mean needs one clear speed for {held_s_min} s without a gap, or for half of the time. A \
                 shorter speed may come from another sound; if it is a rotor, hold one speed for longer, or place the microphone nearer"
            );
        }
        if let Some(contradiction) = self.contradiction().filter(|_| self.is_clear()) {
            let because = if self.has_changed() { "" } else { "do not use this mean, because " };
            words += &format!("; {because}{}; check {}", advice.naming(&contradiction.to_string()), advice.given());
        }
        Some(words + "\n")
    }

    /// The mean of the single speeds, or that they are not those of one hover.
    fn mean_in_words(&self, range: Range) -> String {
        let (heard_s, end_s) = (fixed(self.part_s(self.settled_count), 1), fixed(self.end_s, 1));
        if self.has_changed() {
            let (slowest, fastest) = (fixed(range.slowest_rev_s, 1), fixed(range.fastest_rev_s, 1));
            return format!(
                "no mean: the speed changed between {slowest} and {fastest} rev/s; a speed was heard in {heard_s} s of {end_s} s"
            );
        }
        let count = self.settled_count as f64;
        let mean = with_uncertainty(self.sum_rev_s / count, Some(self.sum_std_rev_s / count));
        format!("mean: {mean} rev/s (± covers about 95 % of cases, k = 2), from {heard_s} s of {end_s} s")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{KnownArguments, ToneArguments};
    use LiveStatus::{Ambiguous, Listening, NoRotorTone, Ok};

    const STEP_S: f64 = 0.1;
    const HELD_S_MIN: f64 = 3.0;

    fn advice() -> Advice {
        let tone = ToneArguments { vehicle: Some("crazyflie".to_owned()), ..ToneArguments::default() };
        Advice::new(&tone, &KnownArguments::default(), "give --rotors".to_owned())
    }

    /// Live speeds of a status, 60 rev/s where it is one speed.
    fn speeds_of(parts: &[(LiveStatus, usize)]) -> Vec<LiveSpeed> {
        let statuses = parts.iter().flat_map(|&(status, count)| std::iter::repeat_n(status, count));
        let speed = |(number, status): (usize, LiveStatus)| LiveSpeed {
            time_s: STEP_S * number as f64,
            status,
            speed_rev_s: matches!(status, Ok | Ambiguous).then_some(if status == Ok { 60.0 } else { 120.0 }),
            std_uncertainty_rev_s: matches!(status, Ok | Ambiguous).then_some(0.1),
            level_db: -20.0,
            clipped_share: 0.0,
        };
        (1..).zip(statuses).map(speed).collect()
    }

    fn summary_of(speeds: &[LiveSpeed]) -> LiveSummary {
        let mut summary = LiveSummary::new(HELD_S_MIN);
        speeds.iter().for_each(|speed| summary.add(speed, None));
        summary
    }

    fn told(parts: &[(LiveStatus, usize)]) -> String {
        let summary = summary_of(&speeds_of(parts));
        let words = summary.in_words(&advice()).unwrap();
        assert_eq!(summary.is_settled(), words.starts_with("mean: "), "{words}");
        words
    }

    #[test]
    fn the_mean_is_over_the_time_that_had_one_speed() {
        let mut speeds = speeds_of(&[(NoRotorTone, 1), (Ok, 2), (NoRotorTone, 1)]);
        speeds[2].speed_rev_s = Some(61.0);
        let sentence = summary_of(&speeds).in_words(&advice()).unwrap();
        assert_eq!(sentence, "mean: 60.50 ± 0.20 rev/s (± covers about 95 % of cases, k = 2), from 0.2 s of 0.4 s\n");
        let mut speeds = speeds_of(&[(Ok, 3)]);
        (speeds[0].speed_rev_s, speeds[1].speed_rev_s) = (Some(52.8), Some(91.8));
        let changed = "no mean: the speed changed between 52.8 and 91.8 rev/s; a speed was heard in 0.3 s of 0.3 s\n";
        assert_eq!(summary_of(&speeds).in_words(&advice()).unwrap(), changed);
        // a jump for two moments is no change, a second at another speed is one
        let mut speeds = speeds_of(&[(Ok, 40)]);
        (speeds[6].speed_rev_s, speeds[31].speed_rev_s) = (Some(53.0), Some(66.0));
        assert!(summary_of(&speeds).in_words(&advice()).unwrap().starts_with("mean: 59.9"));
        speeds[10..20].iter_mut().for_each(|speed| speed.speed_rev_s = Some(66.0));
        assert!(
            summary_of(&speeds)
                .in_words(&advice())
                .unwrap()
                .starts_with("no mean: the speed changed between 59.3 and 66.0")
        );
        assert_eq!(told(&[(NoRotorTone, 20)]), "no speed was heard in 2.0 s\n");
        assert_eq!(summary_of(&[]).in_words(&advice()), None);
    }

    #[test]
    fn what_is_not_settled_is_no_part_of_the_mean() {
        assert_eq!(told(&[(Listening, 20)]), "no speed: 2.0 s of sound are too short: 3 s or more are needed\n");
        let none =
            "no speed was clear in 3.0 s; for 2.0 s several speeds were possible; if this is a rotor, give --rotors\n";
        assert_eq!(told(&[(Listening, 10), (Ambiguous, 20)]), none);
        let some = "mean: 60.00 ± 0.20 rev/s (± covers about 95 % of cases, k = 2), from 1.0 s of 3.0 s; for 1.0 s \
                    several speeds were possible\n";
        assert_eq!(told(&[(Listening, 10), (Ambiguous, 10), (Ok, 10)]), some);
        // what the later sound leaves open is open
        let open = "no mean: one speed was clear in only 1.0 s of 3.0 s; for 1.0 s several speeds were possible; if this \
                    is a rotor, give --rotors\n";
        assert_eq!(told(&[(Listening, 10), (Ok, 10), (Ambiguous, 10)]), open);
        assert!(told(&[(Ok, 20), (Ambiguous, 10)]).starts_with("mean: 60.00"));
    }

    /// Sound without a rotor may resemble one for some seconds.
    #[test]
    fn a_mean_is_of_a_speed_that_was_held_and_that_was_clear_for_longer_than_several_were_possible() {
        let brief = "no mean: one speed was clear in only 2.4 s of 10.0 s, at most 2.4 s without a gap; a mean needs one clear speed for 3 s \
                     without a gap, or for half of the time. A shorter speed may come from another sound; if it is a rotor, hold one speed for longer, or place the microphone nearer\n";
        assert_eq!(told(&[(Listening, 20), (NoRotorTone, 20), (Ok, 24), (NoRotorTone, 36)]), brief);
        assert!(told(&[(Listening, 20), (NoRotorTone, 20), (Ok, 31), (NoRotorTone, 129)]).starts_with("mean: "));
        let pieces = [(Ok, 20), (NoRotorTone, 50), (Ok, 20)];
        assert!(told(&pieces).starts_with("no mean: one speed was clear in only 4.0 s of 9.0 s"));
        let open = "no mean: one speed was clear in only 4.0 s of 10.0 s; for 5.6 s several speeds were possible; if this \
                    is a rotor, give --rotors\n";
        assert_eq!(told(&[(Ambiguous, 56), (NoRotorTone, 4), (Ok, 40)]), open);
    }

    #[test]
    fn a_mean_that_the_sound_contradicts_is_not_to_be_used() {
        let speeds = speeds_of(&[(Ok, 40)]);
        let with_contradicted = |count: usize| {
            let mut summary = LiveSummary::new(HELD_S_MIN);
            let other = OtherRotor { blades: 2, speed_rev_s: 30.0 };
            (0..).zip(&speeds).for_each(|(at, speed)| summary.add(speed, (at < count).then_some(other)));
            (summary.is_settled(), summary.in_words(&advice()).unwrap())
        };
        let (is_settled, words) = with_contradicted(40);
        assert!(!is_settled && words.starts_with("mean: 60.00"), "{words}");
        let because = "from 4.0 s of 4.0 s; do not use this mean, because the sound contradicts --vehicle crazyflie: by the sound alone, a rotor with 2 blades at \
                       30.0 rev/s is more than 99 times as probable as any rotor that fits these facts; check --vehicle crazyflie\n";
        assert!(words.ends_with(because), "{words}");
        let (is_settled, words) = with_contradicted(10);
        assert!(is_settled && !words.contains("contradicts"), "{words}");
    }
}
