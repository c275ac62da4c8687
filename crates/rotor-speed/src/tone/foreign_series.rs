//! Fine spectrum of the hover → a series of lines that the rotor found in it cannot make: a helicopter's main rotor, an engine,
//! an instrument.

use crate::survey::Survey;
use crate::tone::ToneConfig;
use hovertone_analysis::{Hover, NoTone};
use hovertone_signal::spectrogram::{power_db, whitened_db};
use hovertone_signal::statistics::mean;
use hovertone_vehicle::BLADES_MAX;

/// Fundamentals that are tried: below, lines 1 Hz wide melt; above, a run of them leaves the fine spectrum. *Decision.*
const FUNDAMENTAL_HZ: (f64, f64) = (8.0, 500.0);
/// Step between fundamentals, as a share: a third of a line's width at the tenth multiple. *Numeric.*
const STEP_SHARE: f64 = 0.003;
/// Half width of a line, in bins. *Numeric.*
const LINE_HALF_BINS: f64 = 0.6;
/// Multiples that are looked at. *Decision.*
const MULTIPLES: u32 = 16;
/// So many neighbouring multiples, none missing, make a series. Lines of real multirotors, of rotors that differ, chance to
/// lie in a row for four at most. *Decision.*
const RUN_LENGTH: usize = 5;
/// They stand this far over their surroundings on average, dB. *Decision.*
const MEAN_OVER_DB_MIN: f64 = 8.0;
/// Each stands at least so far over its surroundings, dB. *Decision.*
const EACH_OVER_DB_MIN: f64 = 4.5;
/// The mean of many frames of noise, dB over the floor. *Numeric.*
const NOISE_OVER_DB: f64 = 1.5;
/// Standard deviations of noise by which each line stands above. *Decision.*
const NOISE_STDS: f64 = 2.0;
/// Standard deviation of the power of one frame of noise, dB. *Numeric.*
const FRAME_STD_DB: f64 = 5.6;
/// Independent frames that a row is worth. *Numeric.*
const FRAMES_PER_ROW: f64 = 1.8;
/// A series this much weaker than the rotor's lines is another sound beside it. *Decision.*
const WEAKER_DB: f64 = 12.0;
/// So many lines of the rotor are compared with it. *Decision.*
const FIRST_LINES: u32 = 4;
/// Lines between those of a tone that are weaker by less than this on average, dB, belong to one series with it. *Decision.*
const ONE_SERIES_DB: f64 = 3.0;
/// Smallest share of them that is heard. *Decision.*
const BETWEEN_HEARD_SHARE: f64 = 0.8;
/// Rotors of one vehicle turn at speeds that differ by up to this share; a series so near is another of its rotors. *Decision.*
const ROTORS_APART_SHARE: f64 = 0.22;
/// The shaft's own lines, between those of the blade pass, are told from others within this share. *Decision.*
const SHAFT_LINE_SHARE: f64 = 0.02;
/// The same in bins. *Numeric.*
const SHAFT_LINE_BINS: f64 = 2.0;
/// Shaft lines of the other rotors lie within this share. *Decision.*
const OTHER_SHAFTS_SHARE: f64 = 0.12;

/// Why the rotor that was found is none: a stronger order of things explains its lines.
pub(crate) fn foreign_series(
    survey: &Survey,
    hover: &Hover,
    tone: &ToneConfig,
    has_several_rotors: bool,
    speed_rev_s: f64,
) -> Option<NoTone> {
    let is_hover = |time_s: f64| hover.segments.iter().any(|span| span.contains(time_s));
    let middle_s = |span: &hovertone_analysis::Span| (span.from_s + span.to_s) / 2.0;
    let power = survey.fine.mean_power(|row| is_hover(middle_s(&row.span)))?;
    let rows = survey.fine.rows.iter().filter(|row| is_hover(middle_s(&row.span))).count();
    let each_db = NOISE_OVER_DB + NOISE_STDS * FRAME_STD_DB / (FRAMES_PER_ROW * rows as f64).sqrt();
    let search = Search {
        over_db: whitened_db(&power),
        bin_hz: survey.fine.bin_hz,
        hz_max: survey.fine_hz_max,
        claim: Claim::new(tone, has_several_rotors, speed_rev_s),
        each_db: each_db.max(EACH_OVER_DB_MIN),
    };
    if search.claim.tone_hz > search.hz_max {
        return None; // a tone beyond what can be searched for other series is beyond most of them too
    }
    if let Some(fundamental_hz) = search.slower_shaft_hz() {
        return Some(NoTone::ForeignSeries { fundamental_hz, tone_hz: search.claim.tone_hz });
    }
    let steps = ((FUNDAMENTAL_HZ.1 / FUNDAMENTAL_HZ.0).ln() / STEP_SHARE) as u32;
    let (fundamental_hz, run) = (0..steps)
        .map(|step| FUNDAMENTAL_HZ.0 * (STEP_SHARE * f64::from(step)).exp())
        .filter(|&hz| !search.claim.may_be_its_rotor(hz) && !search.is_of_own_blade_pass(hz))
        .filter(|&hz| !survey.hum.as_ref().is_some_and(|hum| hum.explains(hz)))
        .filter_map(|hz| Some((hz, search.best_run(hz)?)))
        .max_by(|a, b| a.1.mean_db.total_cmp(&b.1.mean_db))?;
    let level_db =
        |hz: f64| search.bins(hz).filter_map(|bin| power.get(bin)).map(|&p| power_db(p)).fold(f64::MIN, f64::max);
    let strongest = |lines_hz: &[f64]| lines_hz.iter().map(|&hz| level_db(hz)).fold(f64::MIN, f64::max);
    let is_strong = strongest(&run.lines_hz) >= strongest(&search.claim.first_lines_hz(search.hz_max)) - WEAKER_DB;
    is_strong.then_some(NoTone::ForeignSeries { fundamental_hz, tone_hz: search.claim.tone_hz })
}

/// What the rotor that was found can make.
struct Claim {
    tone_hz: f64,
    shaft_hz: f64,
    shaft_hz_min: f64,
    /// Orders of the fundamentals of its series.
    orders: Vec<f64>,
    band_half_width_share: f64,
    is_blade_pass: bool,
    /// Whether other rotors with the same blades turn beside it.
    has_company: bool,
}

impl Claim {
    fn new(tone: &ToneConfig, has_company: bool, speed_rev_s: f64) -> Self {
        let order = tone.order.lines_per_turn();
        let is_blade_pass = order <= BLADES_MAX;
        let orders = match tone.blades.map(f64::from).or(is_blade_pass.then_some(order)) {
            Some(blades) => vec![blades, 2.0 * blades, 3.0 * blades],
            None => (1..=6).map(f64::from).collect(),
        };
        Self {
            tone_hz: order * speed_rev_s,
            shaft_hz: speed_rev_s,
            shaft_hz_min: tone.speed_min.rev_s(),
            orders,
            band_half_width_share: tone.band_half_width_share,
            is_blade_pass,
            has_company: has_company && (is_blade_pass || tone.blades.is_some()),
        }
    }

    /// The first lines of the tone, and of the blade pass where that is known beside a gear.
    fn first_lines_hz(&self, hz_max: f64) -> Vec<f64> {
        let blade_pass_hz = self.shaft_hz * self.orders.first().copied().unwrap_or(1.0);
        let lines = |hz: f64| (1..=FIRST_LINES).map(move |k| f64::from(k) * hz);
        lines(self.tone_hz).chain(lines(blade_pass_hz)).filter(|hz| *hz < hz_max).collect()
    }

    /// Whether a series can be that of another rotor of the same vehicle, or of all their shafts.
    fn may_be_its_rotor(&self, fundamental_hz: f64) -> bool {
        let near = |order: f64, share: f64| (fundamental_hz / (order * self.shaft_hz) - 1.0).abs() < share;
        let blades = self.orders.first().copied().unwrap_or(1.0);
        let shafts_share = if self.has_company { ROTORS_APART_SHARE } else { OTHER_SHAFTS_SHARE };
        self.orders.iter().any(|&order| near(order, ROTORS_APART_SHARE))
            || (1..blades as u32).any(|order| near(f64::from(order), shafts_share))
    }

    /// Whether a line is one of the claimed rotor's own, or the blade pass of one beside it. A few chance lines of several rotors
    /// make a series of almost any fundamental.
    fn explains(&self, hz: f64, bin_hz: f64) -> bool {
        if let Some(blades) = self.orders.first().filter(|_| self.has_company) {
            let blade_pass_hz = blades * self.shaft_hz;
            let multiple = (hz / blade_pass_hz).round().max(1.0);
            if (hz / (multiple * blade_pass_hz) - 1.0).abs() < ROTORS_APART_SHARE / 2.0 {
                return true;
            }
        }
        let order = (hz / self.shaft_hz).round().max(1.0);
        let is_shaft_line = (hz - order * self.shaft_hz).abs() < (SHAFT_LINE_SHARE * hz).max(SHAFT_LINE_BINS * bin_hz);
        if self.is_blade_pass {
            return is_shaft_line;
        }
        let multiple = (hz / self.tone_hz).round().max(1.0);
        let is_mesh_line = (hz / (multiple * self.tone_hz) - 1.0).abs() < self.band_half_width_share;
        // unlike blades sound at every order of the shaft; orders of the mesh lie too close to be told from others
        is_mesh_line || (is_shaft_line && self.orders.last().is_some_and(|&last| order <= last))
    }
}

struct Search {
    over_db: Vec<f64>,
    bin_hz: f64,
    hz_max: f64,
    claim: Claim,
    each_db: f64,
}

/// Lines in a row that the claim does not explain.
struct Run {
    lines_hz: Vec<f64>,
    mean_db: f64,
}

impl Search {
    fn bins(&self, hz: f64) -> std::ops::RangeInclusive<usize> {
        let place = hz / self.bin_hz;
        let half = (STEP_SHARE * place).max(LINE_HALF_BINS);
        (place - half).round() as usize..=(place + half).round() as usize
    }

    /// The distance of lines between those of the tone that are as strong as they: then the tone is not the blade pass but a
    /// multiple of a slower one. Only where that is too slow to be looked for: the shaft lines of small rotors can be as strong.
    fn slower_shaft_hz(&self) -> Option<f64> {
        if !self.claim.is_blade_pass {
            return None;
        }
        let over_db = |hz: f64| self.bins(hz).filter_map(|bin| self.over_db.get(bin)).copied().fold(0.0, f64::max);
        [2u32, 3, 4, 5].into_iter().find_map(|parts| {
            let fundamental_hz = self.claim.tone_hz / f64::from(parts);
            if self.claim.shaft_hz / f64::from(parts) >= self.claim.shaft_hz_min {
                return None;
            }
            let lines = (1..=4 * parts).take_while(|k| f64::from(*k) * fundamental_hz < self.hz_max);
            let (own, between): (Vec<u32>, Vec<u32>) = lines.partition(|k| k.is_multiple_of(parts));
            let levels = |ks: &[u32]| ks.iter().map(|&k| over_db(f64::from(k) * fundamental_hz)).collect::<Vec<f64>>();
            let (own_db, between_db) = (mean(&levels(&own))?, mean(&levels(&between))?);
            let heard = levels(&between).iter().filter(|&&level| level >= self.each_db).count();
            let is_one_series = own_db - between_db < ONE_SERIES_DB
                && between_db >= MEAN_OVER_DB_MIN
                && heard as f64 >= BETWEEN_HEARD_SHARE * between.len() as f64;
            (is_one_series && between.len() >= 3).then_some(fundamental_hz)
        })
    }

    /// Whether a series is every third, fourth … line of the claimed rotor's blade pass, all of whose first lines are heard. Where
    /// those between are not, the rotor turns faster than claimed.
    fn is_of_own_blade_pass(&self, fundamental_hz: f64) -> bool {
        let Some(&blades) = self.claim.orders.first().filter(|&&blades| blades > 1.0) else { return false };
        let blade_pass_hz = blades * self.claim.shaft_hz;
        let multiple = (fundamental_hz / blade_pass_hz).round().max(1.0);
        let over_db = |hz: f64| self.bins(hz).filter_map(|bin| self.over_db.get(bin)).copied().fold(0.0, f64::max);
        (fundamental_hz / (multiple * blade_pass_hz) - 1.0).abs() < SHAFT_LINE_SHARE
            && (1..=FIRST_LINES).all(|k| over_db(f64::from(k) * blade_pass_hz) >= self.each_db)
    }

    /// The strongest run of multiples that stand out; those that the claim explains neither count nor interrupt.
    fn best_run(&self, fundamental_hz: f64) -> Option<Run> {
        let lines: Vec<(f64, f64)> = (1..=MULTIPLES)
            .map(|k| f64::from(k) * fundamental_hz)
            .take_while(|hz| *hz < self.hz_max)
            .filter(|hz| !self.claim.explains(*hz, self.bin_hz))
            .map(|hz| (hz, self.bins(hz).filter_map(|bin| self.over_db.get(bin)).copied().fold(0.0, f64::max)))
            .collect();
        lines
            .windows(RUN_LENGTH)
            .filter(|run| run.iter().all(|(_, over_db)| *over_db >= self.each_db))
            .map(|run| Run {
                mean_db: run.iter().map(|(_, over_db)| over_db).sum::<f64>() / RUN_LENGTH as f64,
                lines_hz: run.iter().map(|(hz, _)| *hz).collect(),
            })
            .filter(|run| run.mean_db >= MEAN_OVER_DB_MIN)
            .max_by(|a, b| a.mean_db.total_cmp(&b.mean_db))
    }
}
