//! Which octave: the beliefs of all reviews of the rotors that are followed, together.
//!
//! A rotor that is followed keeps its octave. Each review hears other seconds, and tells a belief in each possible speed; the beliefs of the reviews
//! multiply. A speed that a review does not name may still be the truth: a decision leaves one chance of a hundred to others. Reviews of the same
//! lines share their doubts, so doubtful reviews together decide nothing: the last review, or more than half of all, must decide alone. Where
//! neither the blades nor the diameter are known, the levels of the lines may deceive, and then they do so in all reviews: the belief is the mean
//! of the reviews.

use hovertone_rotor_speed::EvidenceConfig;
use hovertone_vehicle::Order;

/// Largest difference of the logarithms of two speeds of one rotor: half of that between the nearest families, 4 : 3. *Decision.*
const SAME_LOG_RATIO: f64 = 0.14;
/// Largest distance of such a logarithm from that of a family: rotors wander between reviews. *Decision.*
const FAMILY_LOG_RATIO: f64 = 0.07;
/// Ratios of speeds that the same lines may mean: octaves, and families of three. *Physics.*
const FAMILIES: [f64; 4] = [2.0, 3.0, 4.0, 1.5];

/// A possible speed of the rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PossibleSpeed {
    /// Lines per turn of the tone.
    pub order: Order,
    /// Blades, where they are known.
    pub blades: Option<u32>,
    /// Shaft speed.
    pub speed_rev_s: f64,
    /// Probability.
    pub belief: f64,
}

impl PossibleSpeed {
    /// Whether a speed is this one, up to the wander between two reviews.
    pub fn is_same(&self, speed_rev_s: f64) -> bool {
        (self.speed_rev_s / speed_rev_s).ln().abs() < SAME_LOG_RATIO
    }
}

/// Whether two speeds may be readings of the same lines.
fn is_of_family(a_rev_s: f64, b_rev_s: f64) -> bool {
    let ratio = (a_rev_s / b_rev_s).ln().abs();
    FAMILIES.iter().any(|family| (ratio - family.ln()).abs() < FAMILY_LOG_RATIO)
}

/// A speed for which reviews have decided alone.
#[derive(Clone, Copy, Debug)]
struct DecidedAlone {
    speed_rev_s: f64,
    reviews: u32,
}

/// The possible speeds of the followed rotors, most probable first.
#[derive(Clone, Debug)]
pub(crate) struct Octave {
    speeds: Vec<PossibleSpeed>,
    /// Belief with which an octave is decided.
    belief_min: f64,
    /// Belief in a speed that a review does not name: the most that it leaves to others where it has decided.
    unnamed_belief: f64,
    /// Whether the reviews may all be wrong for the same reason.
    may_be_deceived: bool,
    /// Number of reviews of these speeds.
    reviews: u32,
    /// How many of them decided alone, for each speed.
    decided_alone: Vec<DecidedAlone>,
    /// The speed for which the last one decided alone.
    last_decided_rev_s: Option<f64>,
}

impl Octave {
    /// Decides as a recording does.
    pub(crate) fn new(evidence: &EvidenceConfig, may_be_deceived: bool) -> Self {
        Self {
            speeds: Vec::new(),
            belief_min: evidence.belief_min,
            unnamed_belief: (1.0 - evidence.belief_min).max(f64::EPSILON),
            may_be_deceived,
            reviews: 0,
            decided_alone: Vec::new(),
            last_decided_rev_s: None,
        }
    }

    /// Forgets all reviews.
    pub(crate) fn clear(&mut self) {
        self.speeds.clear();
        self.decided_alone.clear();
        self.reviews = 0;
    }

    /// Takes in the beliefs of a review, the most probable first, while the rotors are followed at a speed.
    pub(crate) fn take(&mut self, reviewed: &[PossibleSpeed], followed_rev_s: Option<f64>) {
        let Some(chosen) = reviewed.first() else { return };
        let is_conflict = self.speeds.iter().any(|known| is_of_family(known.speed_rev_s, chosen.speed_rev_s));
        let Some(followed_rev_s) = followed_rev_s.filter(|&speed| is_conflict || chosen.is_same(speed)) else {
            // other rotors, or the same after a step
            self.speeds = reviewed.to_vec();
            self.reviews = 1;
            self.decided_alone.clear();
            self.count_decision(reviewed);
            return;
        };
        self.move_to(followed_rev_s);
        self.count_decision(reviewed);
        let reviews_before = f64::from(self.reviews);
        self.reviews += 1;
        let unnamed_belief = self.unnamed_belief;
        let unnamed = |speed: &PossibleSpeed| PossibleSpeed { belief: unnamed_belief, ..*speed };
        for named in reviewed {
            if !self.speeds.iter().any(|known| known.is_same(named.speed_rev_s)) {
                self.speeds.push(unnamed(named));
            }
        }
        for known in &mut self.speeds {
            let named = reviewed.iter().find(|named| known.is_same(named.speed_rev_s));
            let belief = named.map_or(unnamed_belief, |named| named.belief.max(unnamed_belief));
            known.belief = match self.may_be_deceived {
                true => (reviews_before * known.belief + belief) / (reviews_before + 1.0),
                false => known.belief * belief,
            };
        }
        let sum: f64 = self.speeds.iter().map(|speed| speed.belief).sum();
        // what was improbable may become the truth again
        self.speeds.iter_mut().for_each(|speed| speed.belief = (speed.belief / sum).max(unnamed_belief.powi(2)));
        self.speeds.sort_by(|a, b| b.belief.total_cmp(&a.belief));
        self.keep_doubt();
    }

    /// Where most reviews doubt, their product must not be sure: the leading speed keeps no more belief than leaves the decision open.
    fn keep_doubt(&mut self) {
        let doubt = 2.0 * (1.0 - self.belief_min);
        let Some((leading, others)) = self.speeds.split_first_mut() else { return };
        let alone = self.decided_alone.iter().find(|decided| leading.is_same(decided.speed_rev_s));
        let is_by_most = 2 * alone.map_or(0, |decided| decided.reviews) > self.reviews;
        let is_by_last = self.last_decided_rev_s.is_some_and(|speed_rev_s| leading.is_same(speed_rev_s));
        let of_others: f64 = others.iter().map(|other| other.belief).sum();
        if self.may_be_deceived || is_by_most || is_by_last || of_others >= doubt || of_others <= 0.0 {
            return;
        }
        leading.belief = 1.0 - doubt;
        others.iter_mut().for_each(|other| other.belief *= doubt / of_others);
        if let Some(second) = others.first_mut() {
            second.belief = second.belief.max(0.5 * doubt);
        }
    }

    /// Counts a review that decides for its most probable speed alone.
    fn count_decision(&mut self, reviewed: &[PossibleSpeed]) {
        self.last_decided_rev_s = None;
        let Some(chosen) = reviewed.first() else { return };
        let possible = reviewed.iter().filter(|speed| speed.belief >= 1.0 - self.belief_min).count();
        if chosen.belief < self.belief_min && possible > 1 {
            return;
        }
        self.last_decided_rev_s = Some(chosen.speed_rev_s);
        match self.decided_alone.iter_mut().find(|decided| chosen.is_same(decided.speed_rev_s)) {
            Some(decided) => decided.reviews += 1,
            None => self.decided_alone.push(DecidedAlone { speed_rev_s: chosen.speed_rev_s, reviews: 1 }),
        }
    }

    /// Scales all speeds as the followed one has changed.
    fn move_to(&mut self, followed_rev_s: f64) {
        let followed = self.speeds.iter().find(|speed| speed.is_same(followed_rev_s));
        let ratio = followed.map_or(1.0, |speed| followed_rev_s / speed.speed_rev_s);
        self.speeds.iter_mut().for_each(|speed| speed.speed_rev_s *= ratio);
        self.decided_alone.iter_mut().for_each(|decided| decided.speed_rev_s *= ratio);
    }

    /// Whether this speed is the most probable one.
    pub(crate) fn is_leading(&self, speed_rev_s: f64) -> bool {
        self.speeds.first().is_none_or(|leading| leading.is_same(speed_rev_s))
    }

    /// The speeds that remain possible, most probable first; empty where one is decided.
    pub(crate) fn possible(&self) -> &[PossibleSpeed] {
        let count = self.speeds.iter().take_while(|speed| speed.belief >= 1.0 - self.belief_min).count();
        let is_decided = self.speeds.first().is_none_or(|leading| leading.belief >= self.belief_min);
        &self.speeds[..if is_decided || count < 2 { 0 } else { count }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn beliefs(speeds: &[(f64, f64)]) -> Vec<PossibleSpeed> {
        let order = Order::from_blades(2).unwrap();
        let speed = |&(speed_rev_s, belief): &(f64, f64)| PossibleSpeed { order, blades: Some(2), speed_rev_s, belief };
        speeds.iter().map(speed).collect()
    }

    #[test]
    fn one_review_of_another_octave_does_not_outvote_two() {
        let mut octave = Octave::new(&EvidenceConfig::default(), false);
        octave.take(&beliefs(&[(90.0, 0.996), (180.0, 0.004)]), None);
        assert!(octave.is_leading(91.0) && octave.possible().is_empty());
        octave.take(&beliefs(&[(92.0, 0.996)]), Some(92.0));
        octave.take(&beliefs(&[(183.0, 0.996), (91.5, 0.004)]), Some(91.5));
        assert!(octave.is_leading(91.5) && octave.possible().is_empty(), "{octave:?}");
        // as many on both sides decide nothing, and more on the other side decide for it
        octave.take(&beliefs(&[(184.0, 0.996)]), Some(92.0));
        assert_eq!(octave.possible().len(), 2, "{octave:?}");
        octave.take(&beliefs(&[(184.0, 0.996)]), Some(92.0));
        octave.take(&beliefs(&[(184.0, 0.996)]), Some(184.0));
        assert!(octave.is_leading(184.0) && octave.possible().is_empty(), "{octave:?}");
    }

    #[test]
    fn reviews_that_may_be_deceived_together_settle_nothing() {
        let review = beliefs(&[(90.0, 0.93), (45.0, 0.04), (180.0, 0.03)]);
        for may_be_deceived in [true, false] {
            let mut octave = Octave::new(&EvidenceConfig::default(), may_be_deceived);
            octave.take(&review, None);
            (0..9).for_each(|_| octave.take(&review, Some(90.0)));
            assert_eq!(octave.possible().len(), if may_be_deceived { 3 } else { 2 }, "{octave:?}");
            assert!(octave.is_leading(90.0), "{octave:?}");
            if may_be_deceived {
                assert!((octave.possible()[0].belief - 0.93).abs() < 1e-9, "{octave:?}");
            }
        }
    }

    /// A helicopter of the recordings: `speed` on the whole of it says 97 % and leaves the octave open.
    #[test]
    fn doubtful_reviews_after_one_that_decides_leave_the_octave_open() {
        let mut octave = Octave::new(&EvidenceConfig::default(), false);
        octave.take(&beliefs(&[(75.0, 0.995), (37.5, 0.005)]), None);
        assert!(octave.possible().is_empty());
        octave.take(&beliefs(&[(75.0, 0.91), (37.5, 0.09)]), Some(75.0));
        assert_eq!(octave.possible().len(), 2, "{octave:?}");
        // two of three that decide alone decide
        octave.take(&beliefs(&[(75.0, 0.996), (37.5, 0.004)]), Some(75.0));
        assert!(octave.possible().is_empty() && octave.is_leading(75.0), "{octave:?}");
    }

    #[test]
    fn a_step_or_another_rotor_begins_anew() {
        let mut octave = Octave::new(&EvidenceConfig::default(), false);
        octave.take(&beliefs(&[(90.0, 0.6), (180.0, 0.4)]), None);
        assert_eq!(octave.possible().len(), 2);
        octave.take(&beliefs(&[(110.0, 0.999)]), Some(90.0));
        assert!(octave.is_leading(110.0) && octave.possible().is_empty());
        octave.take(&beliefs(&[(60.0, 0.999)]), None);
        assert!(octave.is_leading(60.0));
    }
}
