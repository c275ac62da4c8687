//! The shaft of one rotor of a hover: its speed, its phase, and the integrals of the truth.

use super::profile::ProfileParts;
use crate::ornstein_uhlenbeck::OrnsteinUhlenbeck;
use crate::prescribed::phasors::BLOCK;
use crate::prescribed::truth::RotorTruth;
use std::f64::consts::TAU;

/// A shaft whose speed is `mean (1 + wander) share`, with the profile's share.
///
/// Between two samples the speed counts as constant, with its value halfway. Phase and integrals are sums over the
/// samples, so the truth is exact for the sound as rendered.
#[derive(Clone)]
pub(super) struct Shaft {
    mean_rev_s: f64,
    wander: OrnsteinUhlenbeck,
    /// Wander at the start and at the end of the current block.
    wander_from: f64,
    wander_to: f64,
    /// Whole turns and the rest of a turn are separate, so that the phase of a high order loses no digits over hours.
    whole_turns: u64,
    turn: f64,
    square_integral_rad2_s: f64,
}

impl Shaft {
    pub(super) fn new(mean_rev_s: f64, wander: OrnsteinUhlenbeck) -> Self {
        let wander_to = wander.value();
        Self {
            mean_rev_s,
            wander,
            wander_from: wander_to,
            wander_to,
            whole_turns: 0,
            turn: 0.0,
            square_integral_rad2_s: 0.0,
        }
    }

    pub(super) fn scale_mean_speed(&mut self, factor: f64) {
        self.mean_rev_s *= factor;
    }

    pub(super) fn mean_rev_s(&self) -> f64 {
        self.mean_rev_s
    }

    /// Must be called before the first sample of each block.
    pub(super) fn begin_block(&mut self) {
        self.wander_from = self.wander_to;
        self.wander_to = self.wander.step();
    }

    /// Share of a turn since the last whole one: the phase of the sample about to be made.
    pub(super) fn turn(&self) -> f64 {
        self.turn
    }

    /// Goes to the next sample and returns the speed on the way; `share` is the profile's, halfway there.
    pub(super) fn advance(&mut self, sample_in_block: usize, share: f64, sample_s: f64) -> f64 {
        let rev_s = self.speed_rev_s(sample_in_block as f64 + 0.5, share);
        self.turn += rev_s * sample_s;
        if self.turn >= 1.0 {
            let whole = self.turn.floor();
            self.whole_turns += whole as u64;
            self.turn -= whole;
        }
        self.square_integral_rad2_s += (TAU * rev_s).powi(2) * sample_s;
        rev_s
    }

    /// The truth at a sample of the current block.
    pub(super) fn truth(&self, sample_in_block: usize, share: f64) -> RotorTruth {
        RotorTruth {
            speed_rev_s: self.speed_rev_s(sample_in_block as f64, share),
            turns: self.whole_turns as f64 + self.turn,
            square_integral_rad2_s: self.square_integral_rad2_s,
        }
    }

    fn speed_rev_s(&self, sample_in_block: f64, share: f64) -> f64 {
        let wander = self.wander_from + (self.wander_to - self.wander_from) * (sample_in_block / BLOCK as f64);
        self.mean_rev_s * (1.0 + wander) * share
    }
}

/// Mean of the sum of squared speeds over the samples that lie wholly in hover, rad²/s². Runs the speeds alone, without
/// sound.
pub(super) fn hover_mean_sum_of_squares(shafts: &[Shaft], parts: &ProfileParts, samples: u64, rate_hz: f64) -> f64 {
    let sample_s = 1.0 / rate_hz;
    let (mut sum, mut count) = (0.0, 0_u64);
    let mut shafts = shafts.to_vec();
    for sample in 0..samples {
        let in_block = (sample % BLOCK as u64) as usize;
        let share = parts.speed_share((sample as f64 + 0.5) * sample_s);
        let mut squares = 0.0;
        for shaft in &mut shafts {
            if in_block == 0 {
                shaft.begin_block();
            }
            squares += (TAU * shaft.advance(in_block, share, sample_s)).powi(2);
        }
        if share >= 1.0 {
            sum += squares;
            count += 1;
        }
    }
    sum / count.max(1) as f64
}
