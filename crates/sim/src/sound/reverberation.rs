//! The exponential tail of a room, by a feedback delay network (Jot 1991).

use super::phasors::CHUNK;
use crate::seed::{Part, stream};
use rand::RngExt;

/// Delay lines; their echoes are mixed by Hadamard's matrix, which keeps the energy.
const LINES: usize = 16;
/// Shortest and longest delay: longer than the first reflections of a room, short against its tail. Their sum is 0.8 s,
/// which gives 0.8 resonances per hertz: three within the width 2.2/T60 of each at T60 = 0.6 s (Schroeder's criterion).
const DELAY_S: (f64, f64) = (0.02, 0.1);

pub(crate) struct Reverberation {
    lines: Vec<DelayLine>,
    gain: f32,
}

struct DelayLine {
    ring: Vec<f32>,
    at: usize,
    feedback: f32,
    input: f32,
    output: f32,
}

impl Reverberation {
    /// A tail that falls by 60 dB in this time, with `power` times the power of a steady noise at the input.
    pub(crate) fn new(reverberation_s: f64, power: f64, sample_rate_hz: f64, seed: u64, microphone: u64) -> Self {
        let mut random = stream(seed, Part::Reverberation, microphone);
        let line = |number: usize| {
            let place = (number as f64 + random.random::<f64>()) / LINES as f64;
            let delay_s = DELAY_S.0 * (DELAY_S.1 / DELAY_S.0).powf(place);
            // Odd lengths have fewer echoes in common.
            let length = ((delay_s * sample_rate_hz) as usize | 1).max(CHUNK);
            let mut sign = || if random.random::<bool>() { 1.0 } else { -1.0 };
            DelayLine {
                ring: vec![0.0; length],
                at: 0,
                feedback: 10_f64.powf(-3.0 * length as f64 / (reverberation_s * sample_rate_hz)) as f32,
                input: sign(),
                output: sign(),
            }
        };
        let mut tail = Self { lines: (0..LINES).map(line).collect(), gain: 1.0 };
        tail.calibrate(reverberation_s, power, sample_rate_hz);
        tail
    }

    /// Energy of the response to a click, down to -90 dB: the gain for the power of white noise.
    fn calibrate(&mut self, reverberation_s: f64, power: f64, sample_rate_hz: f64) {
        let mut energy = 0.0;
        let mut click = [0.0; CHUNK];
        click[0] = 1.0;
        for _ in 0..(1.5 * reverberation_s * sample_rate_hz / CHUNK as f64) as usize + 1 {
            let mut heard = [0.0; CHUNK];
            self.add(&click, &mut heard);
            energy += heard.iter().map(|value| f64::from(value * value)).sum::<f64>();
            click[0] = 0.0;
        }
        self.gain = (power / energy).sqrt() as f32;
        for line in &mut self.lines {
            line.ring.fill(0.0);
        }
    }

    /// Adds the tail of `sent` to `heard`, up to a chunk at a time.
    pub(crate) fn add(&mut self, sent: &[f32], heard: &mut [f32]) {
        for (sent, heard) in sent.chunks(CHUNK).zip(heard.chunks_mut(CHUNK)) {
            let count = sent.len();
            let mut echoes = [[0.0_f32; CHUNK]; LINES];
            for (line, echo) in self.lines.iter().zip(&mut echoes) {
                line.read(&mut echo[..count]);
                for (heard, value) in heard.iter_mut().zip(&echo[..count]) {
                    *heard += self.gain * line.output * value;
                }
            }
            let mut width = 1;
            while width < LINES {
                for low in (0..LINES).filter(|number| number & width == 0) {
                    let (before, after) = echoes.split_at_mut(low + width);
                    for (a, b) in before[low].iter_mut().zip(&mut after[0]) {
                        (*a, *b) = (*a + *b, *a - *b);
                    }
                }
                width *= 2;
            }
            let scale = 1.0 / (LINES as f32).sqrt();
            for (line, echo) in self.lines.iter_mut().zip(&mut echoes) {
                let (feedback, input) = (line.feedback * scale, line.input);
                for (value, sent) in echo.iter_mut().zip(sent) {
                    *value = feedback * *value + input * sent;
                }
                line.write(&echo[..count]);
            }
        }
    }

    pub(crate) fn buffered(&self) -> usize {
        self.lines.iter().map(|line| line.ring.len()).sum()
    }
}

impl DelayLine {
    fn read(&self, to: &mut [f32]) {
        let until_end = (self.ring.len() - self.at).min(to.len());
        let (first, rest) = to.split_at_mut(until_end);
        first.copy_from_slice(&self.ring[self.at..self.at + until_end]);
        rest.copy_from_slice(&self.ring[..rest.len()]);
    }

    fn write(&mut self, from: &[f32]) {
        let until_end = (self.ring.len() - self.at).min(from.len());
        let (first, rest) = from.split_at(until_end);
        self.ring[self.at..self.at + until_end].copy_from_slice(first);
        self.ring[..rest.len()].copy_from_slice(rest);
        self.at = (self.at + from.len()) % self.ring.len();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn click_response(tail: &mut Reverberation, count: usize) -> Vec<f64> {
        let mut sent = vec![0.0; count];
        sent[0] = 1.0;
        let mut heard = vec![0.0; count];
        tail.add(&sent, &mut heard);
        heard.into_iter().map(f64::from).collect()
    }

    #[test]
    fn the_tail_has_the_set_power_and_falls_by_60_db_in_the_set_time() {
        for (t60_s, power) in [(0.3, 0.5), (0.6, 0.8), (1.5, 2.0)] {
            let rate = 48_000.0;
            let response =
                click_response(&mut Reverberation::new(t60_s, power, rate, 1, 0), (2.0 * t60_s * rate) as usize);
            let energy: f64 = response.iter().map(|value| value * value).sum();
            assert!((energy / power - 1.0).abs() < 1e-3, "{energy}");
            // Schroeder's backward integral at 0.2 and 0.7 of the time: 30 dB.
            let left = |share: f64| -> f64 {
                response[(share * t60_s * rate) as usize..].iter().map(|value| value * value).sum()
            };
            let fall_db = 10.0 * (left(0.2) / left(0.7)).log10();
            assert!((fall_db - 30.0).abs() < 1.0, "{t60_s}: {fall_db}");
            // Nothing comes back before the shortest delay.
            assert!(response[..(DELAY_S.0 * rate) as usize].iter().all(|value| *value == 0.0));
        }
    }

    #[test]
    fn blocks_of_any_size_give_the_same() {
        let whole = click_response(&mut Reverberation::new(0.5, 1.0, 44_100.0, 3, 1), 20_000);
        let mut tail = Reverberation::new(0.5, 1.0, 44_100.0, 3, 1);
        let mut parts = Vec::new();
        for size in [1, 63, 64, 65, 200, 1000, 18_607] {
            let mut sent = vec![0.0; size];
            sent[0] = if parts.is_empty() { 1.0 } else { 0.0 };
            let mut heard = vec![0.0; size];
            tail.add(&sent, &mut heard);
            parts.extend(heard.into_iter().map(f64::from));
        }
        assert_eq!(parts, whole);
    }
}
