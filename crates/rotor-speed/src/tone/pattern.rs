//! Levels over order → what the lines between the strong ones say: shaft and blades, or an octave.

use super::profile::{ORDERS, OrderProfile, PLACES};
use crate::tone::DiscoveryConfig;
use hovertone_signal::statistics::{mean, median};

/// Numbers of blades that are considered. *Decision.*
pub(crate) const BLADES: [u32; 5] = [2, 3, 4, 5, 6];
/// Lines between the harmonics are looked for up to this order: further up, rotors of unlike speed cross each other. *Decision.*
const BETWEEN_ORDERS: f64 = 4.5;
/// Two of so many lines make a series without its fundamental. *Decision.*
const LOW_LINES: usize = 4;
/// Thirds, fourths (and halves with them) and fifths of the fundamental are looked at up to this order. *Decision.*
const FRACTION_ORDERS: usize = 4;
/// One faint line there can be anything, but one this far over the floor leaves the pattern in doubt. *Decision.*
const FRACTION_LINE_DB: f64 = 10.0;
/// Smallest number of such lines, each fainter than that, which leave it in doubt. *Decision.*
const FRACTION_LINES_MIN: usize = 2;
/// Lines must stand out of the floor's lower quarter by this many standard deviations: the highest of three places does
/// by 1.5 on average. *Decision.*
const LINE_STDS: f64 = 4.5;
/// When fewer of the lines between sound than this, the series is a faster one. *Decision.*
const BETWEEN_SHARE_OF_FASTER: f64 = 0.34;
/// The contrast is that of the first strong lines: further up all lines sink into the noise and are alike. *Decision.*
const CONTRAST_LINES_MAX: usize = 5;
/// Share of the strong lines that must stand over all lines beside them. *Decision.*
pub(crate) const OVER_NEIGHBOURS_SHARE: f64 = 0.75;

/// What a series of lines looks like.
#[derive(Clone, Debug)]
pub(crate) struct Pattern {
    /// Fundamental of all lines as a multiple of the fundamental that was looked at: 1/q where q − 1 lines lie between.
    pub(crate) fundamental_ratio: f64,
    /// Level of each line over the places between, the first that of the fundamental; those not heard are absent.
    pub(crate) lines_db: Vec<Option<f64>>,
    /// Where every b-th line stands over the others: b, and by how much.
    pub(crate) contrast: Option<Contrast>,
    /// Whether something sounds at halves, thirds, fourths or fifths of the fundamental. A shaft has no such lines; a blade pass whose odd
    /// harmonics an echo swallows has those of its shaft, and alternates no less.
    pub(crate) has_fractions: bool,
}

impl Pattern {
    /// How far the strongest line stands over the floor.
    pub(crate) fn range_db(&self) -> f64 {
        self.lines_db.iter().copied().flatten().fold(0.0, f64::max)
    }

    /// The pattern and its fundamental as a multiple of the one that was looked at. What has one line only is a line and not
    /// the harmonic of something unheard; what has few lines and not its lowest is no series.
    pub(crate) fn or_single_line(self) -> Option<(Self, f64)> {
        let heard: Vec<usize> = (1..=self.lines_db.len()).filter(|line| self.lines_db[line - 1].is_some()).collect();
        match heard[..] {
            [] => None,
            [line] => {
                let lines_db = vec![self.lines_db[line - 1]];
                let ratio = line as f64 * self.fundamental_ratio;
                Some((Self { lines_db, contrast: None, fundamental_ratio: 1.0, ..self }, ratio))
            }
            [first, ..] => {
                let ratio = self.fundamental_ratio;
                let low = heard.iter().filter(|&&line| line <= LOW_LINES).count();
                (first <= 2 || low >= 2).then_some((self, ratio))
            }
        }
    }
}

/// Every b-th line stands out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Contrast {
    pub(crate) blades: u32,
    /// Mean level of those lines over the mean of the lines between.
    pub(crate) over_db: f64,
    /// How many of those lines are heard.
    pub(crate) line_count: usize,
    /// Share of them that stand over all lines up to the next on either side.
    pub(crate) over_all_share: f64,
    /// Share of the lines between that are heard.
    pub(crate) between_share: f64,
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
        let contrast = contrast(&lines_db);
        let sounds_at_parts = |part: usize| {
            let numbers = (1..part * FRACTION_ORDERS).filter(|number| number % part != 0);
            let places = numbers.map(|number| number * PLACES / (part * divisor));
            let level_db = |place: usize| profile.line_db(place).filter(|_| profile.is_peak(place));
            let heard: Vec<f64> = places.filter_map(level_db).filter(|&db| db >= heard_db).collect();
            heard.len() >= FRACTION_LINES_MIN || heard.iter().any(|&db| db >= FRACTION_LINE_DB)
        };
        let has_fractions = [3, 4, 5].into_iter().any(sounds_at_parts);
        Self::Pattern(Pattern { fundamental_ratio: 1.0 / divisor as f64, lines_db, contrast, has_fractions })
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

/// The number of blades whose lines stand out the most, if any do.
fn contrast(lines_db: &[Option<f64>]) -> Option<Contrast> {
    let level_db = |line: usize| lines_db.get(line - 1).copied().flatten().unwrap_or(0.0);
    let last = last_heard(lines_db);
    let of_blades = |blades: u32| {
        let step = blades as usize;
        let strong: Vec<usize> = (1..=last / step).take(CONTRAST_LINES_MAX).map(|k| k * step).collect();
        let beside = |line: usize| -> Vec<f64> {
            let after = (line + 1..line + step).take_while(|&line| line <= lines_db.len());
            (line + 1 - step..line).chain(after).map(level_db).collect()
        };
        let over: Vec<f64> = strong.iter().filter_map(|&line| Some(level_db(line) - mean(&beside(line))?)).collect();
        let stands_out = |line: &&usize| beside(**line).into_iter().all(|other| level_db(**line) > other);
        let over_all_share = strong.iter().filter(stands_out).count() as f64 / strong.len().max(1) as f64;
        let line_count = strong.iter().filter(|&&line| lines_db[line - 1].is_some()).count();
        let reach = strong.last().copied()?;
        let between = (1..reach).filter(|line| !line.is_multiple_of(step));
        let heard_between = between.map(|line| f64::from(u8::from(lines_db[line - 1].is_some())));
        let between_share = mean(&heard_between.collect::<Vec<_>>())?;
        let over_db = mean(&over)?.min(median(&over)?);
        Some(Contrast { blades, over_db, line_count, over_all_share, between_share })
    };
    let clear = |contrast: &Contrast| contrast.over_all_share >= OVER_NEIGHBOURS_SHARE;
    BLADES
        .into_iter()
        .filter_map(of_blades)
        .filter(|contrast| contrast.line_count > 0)
        .max_by(|a, b| clear(a).cmp(&clear(b)).then(a.over_db.total_cmp(&b.over_db)))
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
