//! The sound of rotors whose speeds are prescribed instead of flown, with the truth about those speeds at every instant:
//! for tests and benches, which examine an estimator one difficulty at a time.
//!
//! There are two ways in. A [`Recording`] is put together from parts, in memory, by the caller:
//!
//! ```text
//! Wander, SineWander, Nodes, any formula ─▶ Rotor (speed, level, Lines) ─▶ Recording ─▶ + Echoes ─▶ + Noise ─▶ gain ─▶ samples
//!                                                                              └─▶ Truth
//! ```
//!
//! - [`Rotor`]: a shaft speed over time, a level over time, and lines.
//! - [`Line`]: order, level and phase. The phase is set or drawn; level and phase may change ([`Wander`], [`PhaseWalk`]).
//! - [`Noise`]: white, falling, pink or low-passed, of a standard deviation or a power density. For a signal-to-noise ratio
//!   take the power of the lines ([`Line::power`]).
//! - [`Echoes`]: a room.
//! - [`Truth`]: speed of each rotor at any instant, mean and mean square over any span.
//!
//! All random numbers come from a generator of the caller ([`seeded`]), so the caller decides the order of the draws.
//!
//! ```
//! use hovertone_sim::prescribed::{Line, Noise, Recording, Rotor, Sampling, SineWander, seeded};
//!
//! let random = &mut seeded(1);
//! let wander = SineWander::drawn(0.004, 4, 0.05..1.2, random);
//! let lines = vec![Line::new(2.0, 1.0).with_random_phase(random), Line::new(4.0, 0.5).with_random_phase(random)];
//! let power: f64 = lines.iter().map(Line::power).sum();
//! let rotor = Rotor::new(|time_s| 60.0 * (1.0 + wander.at(time_s)), lines);
//!
//! let mut recording = Recording::of_rotors(&[rotor], Sampling::new(48_000.0, 2.0));
//! let snr_db = 20.0;
//! recording.add_noise(&Noise::white((power / 10_f64.powf(snr_db / 10.0)).sqrt()), random);
//! let mean = recording.truth().mean_speed(0, 0.5, 1.5).unwrap();
//! assert!((mean.rev_s() / 60.0 - 1.0).abs() < 0.02);
//! ```
//!
//! A [`HoverSound`] is made from [`HoverSettings`]: a hover with take-off and landing, rendered block by block, whatever
//! its length.
//!
//! The model is optimistic: no distance, no microphone, and tones that stay in phase with their shaft unless a line has a
//! phase that changes. The sound of a flight is [`FlightSound`](crate::FlightSound).

mod chirp;
mod echoes;
mod hover;
mod line;
mod nodes;
mod noise;
mod phasors;
mod recording;
mod rotor;
mod sampling;
mod truth;
mod wander;

pub use echoes::Echoes;
pub use hover::{HoverSettings, HoverSound, NoiseSettings, PaperSimulation, ProfileParts, RotorSound, SpeedProfile};
pub use line::Line;
pub use nodes::Nodes;
pub use noise::Noise;
pub use recording::Recording;
pub use rotor::Rotor;
pub use sampling::Sampling;
pub use truth::{RotorTruth, Span, Truth, TruthRow};
pub use wander::{PhaseWalk, SineWander, Wander};

use rand::SeedableRng;
use rand_pcg::Pcg64;

/// The random numbers of a seed.
pub fn seeded(seed: u64) -> Pcg64 {
    Pcg64::seed_from_u64(seed)
}
