//! Levels over order → what the lines between the strong ones say: shaft and blades, or an octave.

use super::profile::{ORDERS, OrderProfile, PLACES};
use super::reading::BLADES;
use crate::tone::DiscoveryConfig;
use hovertone_signal::statistics::mean;

/// Lines between the harmonics are looked for up to this order: further up, rotors of unlike speed cross each other. *Decision.*
const BETWEEN_ORDERS: f64 = 4.5;
/// Two of so many lines make a series without its fundamental. *Decision.*
const LOW_LINES: usize = 4;
/// Lines must stand out of the floor's lower quarter by this many standard deviations: the highest of three places does
/// by 1.5 on average. *Decision.*
const LINE_STDS: f64 = 4.5;
/// When fewer of the lines between sound than this, the series is a faster one. *Decision.*
const BETWEEN_SHARE_OF_FASTER: f64 = 0.34;

/// What a series of lines looks like.
#[derive(Clone, Debug)]
pub(crate) struct Pattern {
    /// Fundamental of all lines as a multiple of the fundamental that was looked at: 1/q where q − 1 lines lie between.
    pub(crate) fundamental_ratio: f64,
    /// Level of each line over the places between, the first that of the fundamental; those not heard are absent.
    pub(crate) lines_db: Vec<Option<f64>>,
}

impl Pattern {
    /// The pattern and its fundamental as a multiple of the one that was looked at. What has one line only is a line and not
    /// the harmonic of something unheard; what has few lines and not its lowest is no series.
    pub(crate) fn or_single_line(self) -> Option<(Self, f64)> {
        let heard: Vec<usize> = (1..=self.lines_db.len()).filter(|line| self.lines_db[line - 1].is_some()).collect();
        match heard[..] {
            [] => None,
            [line] => {
                let lines_db = vec![self.lines_db[line - 1]];
                let ratio = line as f64 * self.fundamental_ratio;
                Some((Self { lines_db, fundamental_ratio: 1.0 }, ratio))
            }
            [first, ..] => {
                let ratio = self.fundamental_ratio;
                let low = heard.iter().filter(|&&line| line <= LOW_LINES).count();
                (first <= 2 || low >= 2).then_some((self, ratio))
            }
        }
    }
}

/// The pattern of a profile, or that the series is a faster one by a factor.
pub(crate) enum Look {
    Pattern(Pattern),
    Faster(u32),
}

impl Look {
    pub(crate) fn at(profile: &OrderProfile, config: &DiscoveryConfig) -> Self {
        let heard_db = config.line_over_floor_db.max(LINE_STDS * profile.noise_db);
        let lines = |divisor: usize| -> Vec<Option<f64>> {
            let count = divisor * profile.order_count().min(ORDERS);
            (1..=count).map(|line| profile.line_db(line * PLACES / divisor).filter(|&db| db >= heard_db)).collect()
        };
        let whole = lines(1);
        if let Some(factor) = faster(&whole) {
            return Self::Faster(factor);
        }
        let divisor = divisor(profile, &whole, heard_db, config);
        let lines_db = if divisor == 1 { whole } else { lines(divisor) };
        Self::Pattern(Pattern { fundamental_ratio: 1.0 / divisor as f64, lines_db })
    }
}

/// Where only every second (third, fifth) line sounds, the series is that much faster. The lowest line does not count: one
/// line at half a blade pass is no row of shaft lines.
fn faster(lines_db: &[Option<f64>]) -> Option<u32> {
    let last = last_heard(lines_db);
    [2usize, 3, 5].into_iter().filter(|factor| factor + 2 <= last).find_map(|factor| {
        let share_heard = |of_faster: bool| {
            let chosen = (2..=last).filter(|line| line.is_multiple_of(factor) == of_faster);
            mean(&chosen.map(|line| f64::from(u8::from(lines_db[line - 1].is_some()))).collect::<Vec<_>>())
        };
        (share_heard(true)? > 2.0 * BETWEEN_SHARE_OF_FASTER && share_heard(false)? < BETWEEN_SHARE_OF_FASTER)
            .then_some(factor as u32)
    })
}

/// How many lines there are to an order: 1 where nothing sounds between the harmonics.
fn divisor(profile: &OrderProfile, whole: &[Option<f64>], heard_db: f64, config: &DiscoveryConfig) -> usize {
    let order_max = BETWEEN_ORDERS.min(last_heard(whole) as f64 + 0.5);
    let sounds = |divisor: usize| {
        let places = (1..).map_while(|line| (line as f64 <= order_max * divisor as f64).then_some(line));
        let between = places.filter(|line| gcd(*line, divisor) == 1);
        let heard: Vec<f64> = between
            .filter_map(|line| Some((line * PLACES / divisor, profile.line_db(line * PLACES / divisor)?)))
            .map(|(place, db)| f64::from(u8::from(db >= heard_db && profile.is_peak(place))))
            .collect();
        heard.len() >= 2 && mean(&heard).is_some_and(|share| share >= config.between_share_min)
    };
    let together = BLADES.map(|blades| blades as usize).into_iter().filter(|&divisor| sounds(divisor)).fold(1, lcm);
    // lines at thirds and fourths, say, are those of other sounds
    if together <= 6 { together } else { 1 }
}

fn last_heard(lines_db: &[Option<f64>]) -> usize {
    lines_db.iter().rposition(Option::is_some).map_or(0, |index| index + 1)
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

fn lcm(a: usize, b: usize) -> usize {
    a / gcd(a, b) * b
}
