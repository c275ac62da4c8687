//! One rotor: its speed over time, its level over time, its lines.

use super::chirp::NodeShaft;
use super::line::{Line, Series};
use super::phasors::BLOCK;
use super::sampling::Sampling;
use super::truth::RotorTruth;
use std::f64::consts::TAU;

/// Lines above this share of the sample rate are silent, as behind a recorder's anti-alias filter.
pub(super) const LINE_HZ_MAX_SHARE: f64 = 0.45;

/// A rotor whose speed is prescribed.
///
/// The speed is a function of time ([`new`](Self::new)), or known at the nodes of a [`Sampling`] and straight between them
/// ([`at_nodes`](Self::at_nodes)). Lines are in phase with the shaft at every sample, except for the changes of phase that
/// they have of their own.
pub struct Rotor<'a> {
    speed: Speed<'a>,
    level: Option<Box<dyn Fn(f64) -> f64 + 'a>>,
    start_turns: f64,
    lines: Vec<Line>,
}

enum Speed<'a> {
    Function(Box<dyn Fn(f64) -> f64 + 'a>),
    Nodes(Vec<f64>),
}

impl<'a> Rotor<'a> {
    /// A rotor whose shaft speed, turns per second, is any function of the seconds since the first sample: a formula,
    /// [`Nodes`](super::Nodes), a [`SineWander`](super::SineWander).
    pub fn new(speed_rev_s: impl Fn(f64) -> f64 + 'a, lines: Vec<Line>) -> Self {
        Self { speed: Speed::Function(Box::new(speed_rev_s)), level: None, start_turns: 0.0, lines }
    }

    /// A rotor whose speed does not change.
    pub fn steady(speed_rev_s: f64, lines: Vec<Line>) -> Self {
        Self::new(move |_| speed_rev_s, lines)
    }

    /// A rotor with a shaft speed at each node of the sampling, straight between them. The fastest way to make many lines that
    /// change.
    pub fn at_nodes(speeds_rev_s: Vec<f64>, lines: Vec<Line>) -> Self {
        Self { speed: Speed::Nodes(speeds_rev_s), level: None, start_turns: 0.0, lines }
    }

    /// The same rotor with all its lines times a level, a function of time.
    pub fn with_level(self, level: impl Fn(f64) -> f64 + 'a) -> Self {
        Self { level: Some(Box::new(level)), ..self }
    }

    /// The same rotor with a shaft that has made these turns at the first sample.
    pub fn from_turns(self, start_turns: f64) -> Self {
        Self { start_turns, ..self }
    }

    /// Adds the rotor's sound to the samples, and returns its truth at the rows of the sampling.
    pub(super) fn add_to(&self, samples: &mut [f64], sampling: &Sampling) -> Vec<RotorTruth> {
        let Some(level) = &self.level else { return self.add_lines(samples, sampling) };
        let mut own = vec![0.0; samples.len()];
        let truth = self.add_lines(&mut own, sampling);
        for (index, (sample, own)) in samples.iter_mut().zip(own).enumerate() {
            *sample += level(sampling.time_s(index)) * own;
        }
        truth
    }

    fn add_lines(&self, samples: &mut [f64], sampling: &Sampling) -> Vec<RotorTruth> {
        match &self.speed {
            Speed::Function(speed_rev_s) => self.add_by_function(speed_rev_s, samples, sampling),
            Speed::Nodes(speeds_rev_s) => {
                let shaft = NodeShaft::new(speeds_rev_s, self.start_turns, sampling);
                self.lines.iter().for_each(|line| shaft.add_line(line, sampling, samples));
                shaft.truth(sampling)
            }
        }
    }

    fn add_by_function(
        &self,
        speed_rev_s: &dyn Fn(f64) -> f64,
        samples: &mut [f64],
        sampling: &Sampling,
    ) -> Vec<RotorTruth> {
        let mut shaft = Shaft { turns: self.start_turns, turned: 0.0, square_integral_rad2_s: 0.0 };
        let mut rows = Vec::with_capacity(sampling.row_count());
        let series = Series::of(&self.lines);
        for (block, samples) in samples.chunks_mut(BLOCK).enumerate() {
            let first = block * BLOCK;
            let (mut turns, mut fastest_rev_s) = ([0.0; BLOCK], 0.0_f64);
            for (offset, turns) in turns.iter_mut().enumerate().take(samples.len()) {
                if sampling.is_row(first + offset) {
                    rows.push(shaft.truth(speed_rev_s(sampling.time_s(first + offset))));
                }
                *turns = shaft.turns;
                let halfway_rev_s = speed_rev_s(((first + offset) as f64 + 0.5) / sampling.rate_hz());
                fastest_rev_s = fastest_rev_s.max(halfway_rev_s);
                shaft.advance(halfway_rev_s, sampling.rate_hz());
            }
            let mut sum = [0.0; BLOCK];
            let order_max = LINE_HZ_MAX_SHARE * sampling.rate_hz() / fastest_rev_s;
            series.iter().for_each(|series| series.add(block, &turns, order_max, &mut sum));
            samples.iter_mut().zip(sum).for_each(|(sample, value)| *sample += value);
        }
        rows.push(shaft.truth(speed_rev_s(sampling.time_s(sampling.sample_count()))));
        rows
    }
}

/// A shaft whose speed is a function of time. Between two samples the speed counts as constant, with its value halfway, so
/// the truth is exact for the sound as rendered.
struct Shaft {
    /// Turns of the lines' phase.
    turns: f64,
    /// Turns since the first sample.
    turned: f64,
    square_integral_rad2_s: f64,
}

impl Shaft {
    fn advance(&mut self, speed_rev_s: f64, rate_hz: f64) {
        self.turns += speed_rev_s / rate_hz;
        self.turned += speed_rev_s / rate_hz;
        self.square_integral_rad2_s += (TAU * speed_rev_s).powi(2) / rate_hz;
    }

    fn truth(&self, speed_rev_s: f64) -> RotorTruth {
        RotorTruth { speed_rev_s, turns: self.turned, square_integral_rad2_s: self.square_integral_rad2_s }
    }
}
