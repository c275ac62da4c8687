//! Lines of a shaft whose speed is known at nodes and straight between them: chirps.

use super::line::Line;
use super::phasors::BLOCK;
use super::rotor::LINE_HZ_MAX_SHARE;
use super::sampling::Sampling;
use super::truth::RotorTruth;
use std::f64::consts::TAU;

/// A shaft with its speed and its turns at each node.
pub(super) struct NodeShaft {
    speeds_rev_s: Vec<f64>,
    turns: Vec<f64>,
    start_turns: f64,
}

impl NodeShaft {
    /// Extends the speeds by the last one to all nodes of a sampling.
    pub(super) fn new(speeds_rev_s: &[f64], start_turns: f64, sampling: &Sampling) -> Self {
        let mut speeds_rev_s = speeds_rev_s.to_vec();
        speeds_rev_s.resize(sampling.node_count().max(2), speeds_rev_s.last().copied().unwrap_or(0.0));
        let mut turned = start_turns;
        let mut turns = vec![turned];
        for pair in speeds_rev_s.windows(2) {
            turned += sampling.node_step_s() * (pair[0] + pair[1]) / 2.0;
            turns.push(turned);
        }
        Self { speeds_rev_s, turns, start_turns }
    }

    /// Adds a line. Between two nodes its phase is a quadratic function of time, so each sample costs two products of
    /// phasors and no sine; each node begins with an exact phase.
    pub(super) fn add_line(&self, line: &Line, sampling: &Sampling, samples: &mut [f64]) {
        let node_step_s = sampling.node_step_s();
        let step_s = node_step_s / BLOCK as f64;
        for (node, samples) in samples.chunks_mut(BLOCK).enumerate() {
            let (speed, next) = (self.speeds_rev_s[node], self.speeds_rev_s[node + 1]);
            if line.order * speed.max(next) > LINE_HZ_MAX_SHARE * sampling.rate_hz() {
                continue;
            }
            let bend = (next - speed) / node_step_s * step_s * step_s / 2.0;
            let start = line.order * self.turns[node];
            let (mut im, mut re) = (TAU * (start - start.round())).sin_cos();
            let (mut step_im, mut step_re) = (TAU * line.order * (speed * step_s + bend)).sin_cos();
            let (bend_im, bend_re) = (TAU * line.order * 2.0 * bend).sin_cos();
            let (from, to) = (line.amplitude_at(node), line.amplitude_at(node + 1));
            for (index, sample) in samples.iter_mut().enumerate() {
                let share = index as f64 / BLOCK as f64;
                let cosine = from.cosine + share * (to.cosine - from.cosine);
                let sine = from.sine + share * (to.sine - from.sine);
                *sample += cosine * re - sine * im;
                (re, im) = (re * step_re - im * step_im, re * step_im + im * step_re);
                (step_re, step_im) = (step_re * bend_re - step_im * bend_im, step_re * bend_im + step_im * bend_re);
            }
        }
    }

    /// The truth at each row of the sampling, exact for the straight lines.
    pub(super) fn truth(&self, sampling: &Sampling) -> Vec<RotorTruth> {
        let (step_s, mut node, mut square_integral) = (sampling.node_step_s(), 0, 0.0);
        // ∫ω² from a node on, over a part h of the step that ends with the speed b: h (a² + a b + b²) / 3
        let square = |a: f64, b: f64, h: f64| TAU * TAU * h * (a * a + a * b + b * b) / 3.0;
        let row = |row: usize| {
            let time_s = sampling.row_time_s(row);
            let at = ((time_s / step_s + 1e-9) as usize).min(self.speeds_rev_s.len() - 2);
            while node < at {
                square_integral += square(self.speeds_rev_s[node], self.speeds_rev_s[node + 1], step_s);
                node += 1;
            }
            let (before, after) = (self.speeds_rev_s[at], self.speeds_rev_s[at + 1]);
            let since_s = time_s - at as f64 * step_s;
            let speed_rev_s = before + since_s / step_s * (after - before);
            RotorTruth {
                speed_rev_s,
                turns: self.turns[at] - self.start_turns + since_s * (before + speed_rev_s) / 2.0,
                square_integral_rad2_s: square_integral + square(before, speed_rev_s, since_s),
            }
        };
        (0..sampling.row_count()).map(row).collect()
    }
}
