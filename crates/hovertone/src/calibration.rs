//! The recorder's clock and the order of the tone, checked against one known speed.
//!
//! ```
//! use hovertone::calibration::{KnownSpeed, Relation, check_against};
//! use hovertone::vehicle::{Order, RotorSpeed};
//!
//! let known = KnownSpeed { speed: RotorSpeed::from_rpm(7200.0), std_share: 20e-6 };
//! // heard 100 millionths too slow because the clock is fast, and with twice the blades
//! let heard = |rpm: f64| check_against(RotorSpeed::from_rpm(rpm), 10e-6, Order::new(2.0)?, known);
//! let check = heard(7199.28)?;
//! assert_eq!(check.relation, Relation::Agrees);
//! assert!((check.correction_ppm - 100.0).abs() < 0.1);
//! assert_eq!(heard(14_398.56)?.relation, Relation::OtherOrder(Order::new(4.0)?));
//! # Ok::<(), hovertone::vehicle::QuantityError>(())
//! ```

use hovertone_vehicle::{BLADES_MAX, CLOCK_CORRECTION_PPM_MAX, COVERAGE_FACTOR, Order, QuantityError, RotorSpeed};

/// *Numeric.*
const MILLION: f64 = 1e6;
/// Smallest standard uncertainty of a correction, in millionths: audio samples in single precision. *Numeric.*
const STD_PPM_MIN: f64 = 0.05;
/// Largest order that is offered in place of a wrong one: the teeth of a large gear wheel. *Decision.*
const ORDER_MAX: f64 = 200.0;

/// Teeth by which somebody may miscount a wheel. *Decision.*
const TEETH_MORE_OR_LESS: f64 = 2.0;
/// Largest part of a simple ratio of orders: a tachometer may be set for 3 blades where there are 2. *Decision.*
const MULTIPLE_MAX: u32 = 4;

/// A speed that another instrument measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownSpeed {
    /// The speed.
    pub speed: RotorSpeed,
    /// Its relative standard uncertainty.
    pub std_share: f64,
}

/// How a heard speed relates to the known one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relation {
    /// They agree, but for an error that a clock may have: the order is right.
    Agrees,
    /// They would agree if the tone had this order.
    OtherOrder(Order),
    /// No order and no clock explains the difference.
    None,
}

/// A heard speed against a known one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedCheck {
    /// How the two relate.
    pub relation: Relation,
    /// Heard over known speed, with the given order.
    pub heard_over_known: f64,
    /// Correction of the recorder's clock, in millionths, with the order that fits: positive where the clock runs fast. A fast clock counts
    /// more audio samples per second than the file says, so that all tones are heard too low.
    pub correction_ppm: f64,
    /// Its standard uncertainty, from the sound and from the known speed.
    pub correction_std_ppm: f64,
}

/// Whether a recorder is as good as it should be (ISO 14253-1: the uncertainty counts against whoever claims).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judgement {
    /// It is, with all of the ±.
    Passes,
    /// It is not, with all of the ±.
    Fails,
    /// The limit lies within the ±.
    Undecided,
}

impl SpeedCheck {
    /// Whether the clock is within its limit.
    pub fn clock(&self, clock_ppm: f64) -> Judgement {
        let off_ppm = self.correction_ppm.abs();
        if off_ppm + self.expanded_ppm() <= clock_ppm {
            Judgement::Passes
        } else if off_ppm - self.expanded_ppm() > clock_ppm {
            Judgement::Fails
        } else {
            Judgement::Undecided
        }
    }

    /// Whether the order is right and the clock within its limit.
    pub fn judgement(&self, clock_ppm: f64) -> Judgement {
        if self.relation == Relation::Agrees { self.clock(clock_ppm) } else { Judgement::Fails }
    }

    /// Whether the correction is more than its uncertainty (k = 2).
    pub fn is_significant(&self) -> bool {
        self.correction_ppm.abs() > self.expanded_ppm()
    }

    /// Expanded uncertainty (k = 2) of the correction.
    pub fn expanded_ppm(&self) -> f64 {
        2.0 * self.correction_std_ppm
    }
}

/// Compares a speed, heard by a tone of the given order, with a known one. `heard_std_share` is its relative standard uncertainty without
/// the clock's part.
///
/// # Errors
/// None is known, since the orders that are tried are allowed.
pub fn check_against(
    heard: RotorSpeed,
    heard_std_share: f64,
    order: Order,
    known: KnownSpeed,
) -> Result<SpeedCheck, QuantityError> {
    let ratio = heard.rev_s() / known.speed.rev_s();
    let correction_std_ppm = (MILLION * heard_std_share.hypot(known.std_share)).max(STD_PPM_MIN);
    let limit_ppm = CLOCK_CORRECTION_PPM_MAX + COVERAGE_FACTOR * correction_std_ppm;
    let correction_ppm = |ratio: f64| MILLION * (1.0 / ratio - 1.0);
    let fits = |ratio: f64| correction_ppm(ratio).abs() <= limit_ppm;
    // the order of the tone, if the known speed is right
    let lines = ratio * order.lines_per_turn();
    let nearest = lines.round();
    let (relation, ratio_of_clock) = if fits(ratio) {
        (Relation::Agrees, ratio)
    } else if (1.0..=ORDER_MAX).contains(&nearest) && fits(lines / nearest) && may_be_meant(nearest, order) {
        (Relation::OtherOrder(Order::new(nearest)?), lines / nearest)
    } else {
        (Relation::None, ratio)
    };
    Ok(SpeedCheck {
        relation,
        heard_over_known: ratio,
        correction_ppm: correction_ppm(ratio_of_clock),
        correction_std_ppm,
    })
}

/// Whether somebody may have taken one order for the other: for blades, a few teeth more or less, or a simple multiple. Among large orders, some
/// one fits any ratio by chance.
fn may_be_meant(lines: f64, given: Order) -> bool {
    let given = given.lines_per_turn();
    let is_multiple = |[part, of]: [f64; 2]| (lines * of - given * part).abs() < 0.5;
    let parts = (1..=MULTIPLE_MAX).flat_map(|part| (1..=MULTIPLE_MAX).map(move |of| [f64::from(part), f64::from(of)]));
    lines <= BLADES_MAX || (lines - given).abs() <= TEETH_MORE_OR_LESS || parts.into_iter().any(is_multiple)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(heard_rpm: f64, order: f64, std_share: f64) -> SpeedCheck {
        let known = KnownSpeed { speed: RotorSpeed::from_rpm(6000.0), std_share };
        check_against(RotorSpeed::from_rpm(heard_rpm), 0.0, Order::new(order).unwrap(), known).unwrap()
    }

    #[test]
    fn a_clock_is_corrected_and_an_order_named() {
        let fast = check(6000.0 / (1.0 + 83e-6), 2.0, 10e-6);
        assert!(fast.relation == Relation::Agrees && (fast.correction_ppm - 83.0).abs() < 1e-6);
        assert!(fast.is_significant());
        // 83 ± 20 against three limits
        assert_eq!(
            [50.0, 70.0, 104.0].map(|limit| fast.judgement(limit)),
            [Judgement::Fails, Judgement::Undecided, Judgement::Passes]
        );
        let of = |order: f64| Relation::OtherOrder(Order::new(order).unwrap());
        assert_eq!(check(9000.0, 2.0, 1e-5).relation, of(3.0));
        assert_eq!(check(3000.0, 2.0, 1e-5).relation, of(1.0));
        assert_eq!(check(6000.0 * 68.0 / 69.0, 69.0, 1e-5).relation, of(68.0));
        assert!((check(9000.9, 2.0, 1e-5).correction_ppm + 100.0).abs() < 0.1);
    }

    /// A recorder whose clock is fast by ε takes (1 + ε) as many samples of a second as its file says. The tone has fewer turns in each.
    #[test]
    fn the_sign_follows_from_counting_samples() {
        for off in [400e-6, -400e-6, 0.03e-6] {
            let (true_hz, said_rate_hz) = (440.0, 44_100.0);
            let turns_per_sample = true_hz / (said_rate_hz * (1.0 + off));
            let heard_hz = turns_per_sample * said_rate_hz;
            let order = Order::new(1.0).unwrap();
            let known = KnownSpeed { speed: RotorSpeed::from_tone_hz(true_hz, order), std_share: 0.0 };
            let check = check_against(RotorSpeed::from_tone_hz(heard_hz, order), 0.0, order, known).unwrap();
            assert!((check.correction_ppm - 1e6 * off).abs() < 1e-6, "{check:?}");
            assert_eq!(check.is_significant(), off.abs() > 1e-7, "{check:?}");
        }
    }

    #[test]
    fn a_speed_of_another_rotor_has_no_relation_and_never_passes() {
        // 48 kHz played as 44.1 kHz, and twice the speed where one line per turn is heard
        for (heard, order) in [(6000.0 * 44.1 / 48.0, 2.0), (6500.0, 2.0), (3000.0, 1.0)] {
            let check = check(heard, order, 1e-5);
            assert_eq!(check.relation, Relation::None, "{heard}");
            assert_eq!(check.judgement(1e6), Judgement::Fails);
        }
        // a coarse tachometer shows no more than it can
        let coarse = check(6003.0, 2.0, 1e-3);
        assert!(coarse.judgement(50.0) == Judgement::Undecided && !coarse.is_significant());
    }
}
