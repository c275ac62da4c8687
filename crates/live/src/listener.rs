//! Sound as it arrives → what is heard now.

use crate::follower::Follower;
use crate::live_speed::{LiveSpeed, LiveStatus};
use crate::meter::Meter;
use crate::octave::{Octave, PossibleSpeed};
use crate::recent::Recent;
use crate::review::{HeardRotors, Reviewed, review};
use crate::settings::LiveConfig;
use hovertone_analysis::{NoTone, OtherRotor, Warning};
use hovertone_rotor_speed::{Discovery, Error, blades_known};
use hovertone_signal::{Signal, SignalSource};
use hovertone_vehicle::{KnownRotor, RotorSpeed};

/// Largest ratio of a chosen speed and the speeds that are still searched for. *Decision.*
const CHOSEN_RANGE: f64 = 1.25;
/// Reviews in sequence that must hear the same rotors before the next ones come more seldom. *Decision.*
const SETTLED_REVIEWS: u32 = 3;

/// Listens to sound that arrives block by block.
///
/// [`Listener::push`] follows the rotors that the last review heard; it allocates nothing. [`Listener::review`] analyses the last seconds as a
/// recording is analysed, and finds the rotors, their octave and their mean speed. It is due when [`Listener::wants_review`] says so.
pub struct Listener {
    config: LiveConfig,
    sample_rate_hz: f64,
    recent: Recent,
    meter: Meter,
    /// Audio samples from one live speed to the next, and up to the next one.
    every_samples: usize,
    samples_left: usize,
    /// When the last review was made.
    reviewed_at_s: f64,
    /// Whether a review is due.
    is_review_due: bool,
    /// Number of the last reviews that heard the rotors that are followed; none where the last one did not.
    agreeing_reviews: u32,
    follower: Option<Follower>,
    heard: Option<Box<HeardRotors>>,
    octave: Octave,
    reason: Option<NoTone>,
    /// When the rotors that were followed were lost: the sound before is of other speeds.
    lost_at_s: Option<f64>,
}

impl Listener {
    /// Sound at this rate.
    ///
    /// # Errors
    /// Settings without a meaning.
    pub fn new(sample_rate_hz: f64, config: LiveConfig) -> Result<Self, Error> {
        config.check()?;
        let every_samples = ((config.every_s * sample_rate_hz).round() as usize).max(1);
        Ok(Self {
            sample_rate_hz,
            recent: Recent::new(config.window_s, sample_rate_hz),
            meter: Meter::default(),
            every_samples,
            samples_left: every_samples,
            reviewed_at_s: 0.0,
            is_review_due: false,
            agreeing_reviews: 0,
            follower: None,
            heard: None,
            octave: Octave::new(
                &config.analysis.evidence,
                config.discovery.as_ref().is_some_and(Discovery::may_be_deceived),
            ),
            reason: None,
            lost_at_s: None,
            config,
        })
    }

    /// Takes in samples up to the next review, and calls `on_speed` whenever a live speed is due. Returns the samples after the review: the answers
    /// do not depend on the length of the blocks.
    pub fn push<'a>(&mut self, samples: &'a [f32], on_speed: &mut dyn FnMut(LiveSpeed)) -> &'a [f32] {
        let mut rest = samples;
        while !rest.is_empty() {
            let (now, later) = rest.split_at(rest.len().min(self.samples_left));
            rest = later;
            self.recent.push(now);
            self.meter.push(now);
            if let Some(follower) = &mut self.follower {
                follower.push(now);
            }
            self.samples_left -= now.len();
            if self.samples_left == 0 {
                self.samples_left = self.every_samples;
                on_speed(self.live_speed());
                self.meter = Meter::default();
                if self.follower.is_some() && self.lost_at_s.is_none() && !self.is_following() {
                    // the next review comes when there is enough sound since now
                    let lost_at_s = self.recent.heard_s();
                    (self.lost_at_s, self.reviewed_at_s) = (Some(lost_at_s), lost_at_s);
                }
                let after_s = match (self.is_following(), self.agreeing_reviews) {
                    (false, _) => self.config.search_s,
                    (true, SETTLED_REVIEWS..) => self.config.settled_review_s,
                    // a little more sound may decide
                    (true, _) if !self.octave.possible().is_empty() => self.config.search_s,
                    (true, _) => self.config.review_s,
                };
                if self.recent.heard_s() >= self.reviewed_at_s + after_s {
                    self.is_review_due = true;
                    break;
                }
            }
        }
        rest
    }

    fn live_speed(&mut self) -> LiveSpeed {
        let followed = self.follower.as_mut().and_then(Follower::now).zip(self.heard.as_ref());
        let status = match followed {
            None if self.reviewed_at_s > 0.0 => LiveStatus::NoRotorTone,
            None => LiveStatus::Listening,
            Some(_) if self.octave.possible().is_empty() => LiveStatus::Ok,
            Some(_) => LiveStatus::Ambiguous,
        };
        LiveSpeed {
            time_s: self.recent.heard_s(),
            status,
            speed_rev_s: followed.map(|(now, _)| now.speed_rev_s),
            std_uncertainty_rev_s: followed
                .map(|(now, heard)| now.std_uncertainty_rev_s.hypot(heard.std_uncertainty_rev_s)),
            level_db: self.meter.level_db(),
            clipped_share: self.meter.clipped_share(),
        }
    }

    /// Length of the sound so far.
    pub fn heard_s(&self) -> f64 {
        self.recent.heard_s()
    }

    /// Whether a review is due.
    pub fn wants_review(&self) -> bool {
        self.is_review_due
    }

    /// Analyses the last seconds. Where the rotors that were followed are lost, and that does not hear them again, the sound since then alone.
    ///
    /// # Errors
    /// A band above half the sample rate.
    pub fn review(&mut self) -> Result<(), Error> {
        let now_s = self.recent.heard_s();
        (self.reviewed_at_s, self.is_review_due) = (now_s, false);
        let sound = self.recent.sound();
        self.review_sound(sound)?;
        let LiveConfig { search_s, window_s, .. } = self.config;
        let is_recent = |lost_at_s: &f64| now_s >= lost_at_s + search_s && now_s < lost_at_s + window_s;
        match self.lost_at_s.filter(is_recent) {
            Some(lost_at_s) if !self.is_following() => self.review_sound(self.recent.sound_since(lost_at_s)),
            _ => Ok(()),
        }
    }

    fn review_sound(&mut self, mut sound: Signal) -> Result<(), Error> {
        match review(&mut sound, &self.config)? {
            Reviewed::Heard(heard) => {
                let followed = if self.is_following() { self.follower.as_mut().and_then(Follower::now) } else { None };
                self.octave.take(&heard.compared, followed.map(|now| now.speed_rev_s));
                let is_leading = self.octave.is_leading(heard.speed_rev_s);
                self.agreeing_reviews = if is_leading && followed.is_some() { self.agreeing_reviews + 1 } else { 1 };
                // the reviews before may know the octave better; then the rotors are followed as before
                if followed.is_none() || is_leading {
                    self.follow(&sound, heard);
                }
            }
            Reviewed::NotHeard(reason) => {
                // a manoeuvre leaves no hover to review, while the rotors are followed
                if !self.is_following() || self.agreeing_reviews == 0 {
                    (self.follower, self.heard, self.reason) = (None, None, Some(reason));
                }
                self.agreeing_reviews = 0;
            }
        }
        Ok(())
    }

    /// Follows the rotors of a review.
    fn follow(&mut self, sound: &Signal, heard: Box<HeardRotors>) {
        let (order, start_s) = (heard.followed_order(), sound.start_s());
        let follower = Follower::of_review(sound.samples(), start_s, self.sample_rate_hz, order, heard.as_ref());
        // a hover without a frame in its track cannot be followed
        if follower.is_some() {
            (self.follower, self.heard, self.reason) = (follower, Some(heard), None);
        }
        if self.is_following() {
            self.lost_at_s = None;
        }
    }

    fn is_following(&self) -> bool {
        self.follower.as_ref().is_some_and(|follower| !follower.is_lost())
    }

    /// The speeds that remain possible by all reviews of these rotors, most probable first; empty where one is decided.
    pub fn possible(&self) -> &[PossibleSpeed] {
        if self.is_following() { self.octave.possible() } else { &[] }
    }

    /// Decides for one of the possible speeds: from now on, speeds near it are searched for. Without such a speed, nothing changes.
    pub fn choose(&mut self, possible: usize) {
        let Some(&PossibleSpeed { order, blades, speed_rev_s, .. }) = self.possible().get(possible) else { return };
        let Some(heard) = &self.heard else { return };
        let mut analysis = heard.config.clone();
        let at = |factor: f64| RotorSpeed::from_rev_s(factor * speed_rev_s);
        (analysis.tone.order, analysis.tone.blades) = (order, blades.or(analysis.tone.blades));
        (analysis.tone.speed_min, analysis.tone.speed_max) = (at(1.0 / CHOSEN_RANGE), at(CHOSEN_RANGE));
        (self.config.analysis, self.config.discovery) = (analysis, None);
        self.follower = None;
        self.octave.clear();
        self.is_review_due = true;
    }

    /// Speeds of the separated rotors in the last review, fastest first; empty where they were not separated, or are lost.
    pub fn rotors_rev_s(&self) -> &[f64] {
        self.heard.as_ref().filter(|_| self.is_following()).map_or(&[], |heard| &heard.rotors_rev_s)
    }

    /// The rotor that is far more probable than the given one, where the last review of the followed rotors heard one: the sound contradicts the
    /// given facts.
    pub fn more_probable(&self) -> Option<OtherRotor> {
        let heard = self.heard.as_ref().filter(|_| self.is_following())?;
        heard
            .doubts
            .iter()
            .find_map(|doubt| if let Warning::FitsElsewhere(other) = doubt { Some(*other) } else { None })
    }

    /// Why the last review heard no rotor, or why its speed is doubtful; empty where all is well.
    pub fn remark(&self) -> String {
        match self.heard.as_ref().filter(|_| self.is_following()) {
            Some(heard) => heard.doubts.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "),
            None => self.reason.as_ref().map_or_else(String::new, |reason| self.reason_in_words(reason)),
        }
    }

    /// Why no rotor is heard. A tone that the given blades may make asks for no other number of blades: a few seconds of sound seldom tell which of
    /// two numbers is right.
    fn reason_in_words(&self, reason: &NoTone) -> String {
        let NoTone::NoSeries { only_rev_s: None, instead: Some(other) } = reason else { return reason.to_string() };
        let tone_hz = f64::from(other.blades) * other.speed_rev_s;
        self.speed_of_given_blades(tone_hz).map_or_else(
            || reason.to_string(),
            |speed| {
                format!(
                    "a tone near {tone_hz:.0} Hz fits the given facts ({:.1} rev/s), but may come from something else than a rotor; listen for longer; \
                     if this message stays, check the given facts",
                    speed.rev_s()
                )
            },
        )
    }

    /// The speed at which the given blades make a tone; `None` where no blades are given, and where other given facts may exclude that speed.
    fn speed_of_given_blades(&self, tone_hz: f64) -> Option<RotorSpeed> {
        let (tone, known) = (&self.config.analysis.tone, self.config.analysis.known);
        let blades = f64::from(blades_known(tone)?);
        let speed = RotorSpeed::from_rev_s(tone_hz / blades);
        let are_blades_alone = known == KnownRotor { rotor_count: known.rotor_count, ..KnownRotor::default() };
        let is_followed = tone.order.lines_per_turn() == blades && tone.band_hz.is_none();
        let is_searched = (tone.speed_min.rad_s()..=tone.speed_max.rad_s()).contains(&speed.rad_s());
        (are_blades_alone && is_followed && is_searched).then_some(speed)
    }
}
