//! One path of the sound: from a rotor, directly or by a wall, to a microphone.

use super::interpolator::TERMS;
use super::room::Mirror;
use super::source::{Emission, Stretch};
use super::state::{RotorState, difference, dot, norm};

/// At smaller distances a rotor gets no louder: its size is no longer small against the distance.
const DISTANCE_M_MIN: f64 = 0.1;
/// Largest number of taken samples that stay in the buffer: to remove them costs time.
const TAKEN_MAX: usize = 4096;

/// Sound received by a microphone and not yet taken.
pub(crate) struct Received {
    /// First sample that has not yet been taken.
    base: i64,
    /// Number of taken samples in the buffer.
    taken: usize,
    pressure_pa: Vec<f32>,
}

impl Received {
    /// Silence from this sample on.
    pub(crate) fn from(base: i64) -> Self {
        Self { base, taken: 0, pressure_pa: Vec::new() }
    }

    /// Takes the next samples; silence if nothing has arrived.
    pub(crate) fn take(&mut self, samples: &mut [f32]) {
        self.base += samples.len() as i64;
        let count = samples.len().min(self.pressure_pa.len() - self.taken);
        let (there, rest) = samples.split_at_mut(count);
        there.copy_from_slice(&self.pressure_pa[self.taken..self.taken + count]);
        rest.fill(0.0);
        self.taken += count;
        if !rest.is_empty() || self.taken > TAKEN_MAX {
            self.pressure_pa.drain(..self.taken);
            self.taken = 0;
        }
    }

    pub(crate) fn buffered(&self) -> usize {
        self.pressure_pa.len()
    }

    /// The samples `first..end`; missing ones are filled with silence.
    fn samples(&mut self, first: i64, end: i64) -> &mut [f32] {
        let start = self.base - self.taken as i64;
        let (first, end) = ((first - start) as usize, (end - start) as usize);
        if self.pressure_pa.len() < end {
            self.pressure_pa.resize(end, 0.0);
        }
        &mut self.pressure_pa[first..end]
    }
}

/// Arrival of the sound from one control instant: at this (fractional) sample, with these factors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    pub(crate) at: f64,
    in_plane: f64,
    on_axis: f64,
}

pub(crate) struct Path {
    pub(crate) rotor: usize,
    pub(crate) microphone: usize,
    microphone_m: [f64; 3],
    mirror: Option<Mirror>,
    samples_per_m: f64,
    pub(crate) last: Arrival,
}

impl Path {
    pub(crate) fn new(
        rotor: usize,
        microphone: usize,
        microphone_m: [f64; 3],
        mirror: Option<Mirror>,
        samples_per_m: f64,
    ) -> Self {
        let last = Arrival { at: 0.0, in_plane: 0.0, on_axis: 0.0 };
        Self { rotor, microphone, microphone_m, mirror, samples_per_m, last }
    }

    /// `delay = d/c`, factor `√(1-α) / d`, and the two terms `sin²θ`, `cos²θ` of the directivity, where d and θ belong to
    /// the rotor's image in the wall, with its mirrored axis.
    pub(crate) fn arrival(&self, state: &RotorState, sent_at: f64) -> Arrival {
        let (place, axis, reflection) = match self.mirror {
            None => (state.position_m, state.axis, 1.0),
            Some(wall) => (wall.image(state.position_m), wall.image_of_direction(state.axis), wall.reflection),
        };
        let way = difference(self.microphone_m, place);
        let distance_m = norm(way);
        let cosine = if distance_m > 0.0 { dot(way, axis) / distance_m } else { 1.0 };
        let cosine_square = (cosine * cosine).min(1.0);
        let factor = reflection / distance_m.max(DISTANCE_M_MIN);
        Arrival {
            at: sent_at + distance_m * self.samples_per_m,
            in_plane: factor * (1.0 - cosine_square),
            on_axis: factor * cosine_square,
        }
    }

    /// Adds the sound that the rotor sent during the stretch. Between its ends the time of arrival is a straight line over
    /// the time of sending; the error is the second difference of the distance over 8, some 1e-6 m for 1 ms and 10 m/s².
    pub(crate) fn receive(&mut self, stretch: Stretch, next: Arrival, emission: &Emission, to: &mut Received) {
        let before = std::mem::replace(&mut self.last, next);
        let first = (before.at.ceil() as i64).max(to.base);
        let end = next.at.ceil() as i64;
        if end <= first {
            return;
        }
        let received_samples = next.at - before.at;
        // Samples of the source per sample received: the Doppler factor c/(c - v).
        let rate = (stretch.to - stretch.from) / received_samples;
        let in_plane_step = (next.in_plane - before.in_plane) / received_samples;
        let on_axis_step = (next.on_axis - before.on_axis) / received_samples;
        let received = to.samples(first, end);
        let mut done = 0;
        while done < received.len() {
            let since = (first + done as i64) as f64 - before.at;
            let sent = stretch.from + since * rate;
            let nearest = sent.round();
            let fraction = sent - nearest;
            let count = run_length(fraction, rate - 1.0).min(received.len() - done);
            let index = (nearest as i64 - emission.base) as usize;
            let line = |start: f64, step: f64| Line { start: start as f32, step: step as f32 };
            add_run(
                &mut received[done..done + count],
                emission.in_plane.each_ref().map(|term| &term[index..index + count]),
                emission.on_axis.each_ref().map(|term| &term[index..index + count]),
                line(fraction, rate - 1.0),
                line(before.in_plane + since * in_plane_step, in_plane_step),
                line(before.on_axis + since * on_axis_step, on_axis_step),
            );
            done += count;
        }
    }
}

/// Number of received samples for which the nearest source sample moves on by one per sample. Bounded, so that counting in
/// single precision stays exact.
fn run_length(fraction: f64, drift: f64) -> usize {
    const RUN_MAX: f64 = 4096.0;
    let left = if drift > 0.0 {
        (0.5 - fraction) / drift
    } else if drift < 0.0 {
        (-0.5 - fraction) / drift
    } else {
        RUN_MAX
    };
    left.clamp(0.0, RUN_MAX - 1.0) as usize + 1
}

#[derive(Clone, Copy)]
struct Line {
    start: f32,
    step: f32,
}

impl Line {
    #[inline(always)]
    fn at(self, number: f32) -> f32 {
        self.start + number * self.step
    }
}

/// `received += g(n) Σ_k u_k[n] d(n)^k` for both terms of the directivity.
fn add_run(
    received: &mut [f32],
    in_plane: [&[f32]; TERMS],
    on_axis: [&[f32]; TERMS],
    fraction: Line,
    in_plane_gain: Line,
    on_axis_gain: Line,
) {
    let count = received.len();
    let [p0, p1, p2, p3, p4] = in_plane.map(|term| &term[..count]);
    let [a0, a1, a2, a3, a4] = on_axis.map(|term| &term[..count]);
    for n in 0..count {
        // By way of 32 bits: the oldest 64-bit processors have no other vector conversion.
        let number = n as i32 as f32;
        let d = fraction.at(number);
        let plane = (((p4[n] * d + p3[n]) * d + p2[n]) * d + p1[n]) * d + p0[n];
        let axis = (((a4[n] * d + a3[n]) * d + a2[n]) * d + a1[n]) * d + a0[n];
        received[n] += in_plane_gain.at(number) * plane + on_axis_gain.at(number) * axis;
    }
}
