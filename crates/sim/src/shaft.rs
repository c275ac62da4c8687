//! One rotor's shaft: its speed, its phase, and the integrals that are the truth about both.

use crate::profile::ProfileParts;
use crate::truth::RotorTruth;
use crate::wander::OrnsteinUhlenbeck;
use std::f64::consts::TAU;

/// Samples for which the wander goes along one straight line, and which are made at once: 1 ms at 48 kHz, 1/300 of the
/// wander's usual time constant. Part of what a seed means.
pub(crate) const BLOCK: usize = 48;

/// The speed between two samples is the speed halfway, `mean (1 + wander) share`, and is constant there as far as the
/// sound is concerned: phase and integrals are sums over the samples, with nothing between them to disagree about.
#[derive(Clone)]
pub(crate) struct Shaft {
    mean_rev_s: f64,
    wander: OrnsteinUhlenbeck,
    /// Wander at the start and at the end of the current block.
    wander_from: f64,
    wander_to: f64,
    /// Whole turns, and the rest of a turn: apart, so that the phase of a high order loses no digits over hours.
    whole_turns: u64,
    turn: f64,
    square_integral_rad2_s: f64,
}

impl Shaft {
    pub(crate) fn new(mean_rev_s: f64, wander: OrnsteinUhlenbeck) -> Self {
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

    pub(crate) fn scale_mean_speed(&mut self, factor: f64) {
        self.mean_rev_s *= factor;
    }

    pub(crate) fn mean_rev_s(&self) -> f64 {
        self.mean_rev_s
    }

    /// Must be called before the first sample of each block.
    pub(crate) fn begin_block(&mut self) {
        self.wander_from = self.wander_to;
        self.wander_to = self.wander.step();
    }

    /// Share of a turn since the last whole one: the phase of the sample about to be made.
    pub(crate) fn turn(&self) -> f64 {
        self.turn
    }

    /// On to the next sample; `share` is the profile's, halfway there.
    pub(crate) fn advance(&mut self, sample_in_block: usize, share: f64, sample_s: f64) -> f64 {
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

    /// What is true at a sample of the current block.
    pub(crate) fn truth(&self, sample_in_block: usize, share: f64) -> RotorTruth {
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

/// Mean of the sum of squared speeds over the samples that lie wholly in hover, rad²/s²: a run of the speeds alone.
pub(crate) fn hover_mean_sum_of_squares(shafts: &[Shaft], parts: &ProfileParts, samples: u64, rate_hz: f64) -> f64 {
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
