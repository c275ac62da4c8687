//! The evidence that a recording holds for each shaft speed, in nats: one number that decides whether a rotor sounds, and at which octave.
//!
//! A rotor is a shaft speed that moves no faster than a motor can, with lines at whole orders. In frames of 0.1 s, the power R of each bin
//! over the local floor has the density e^(−R) in noise.
//!
//! 1. *Votes* (`votes`): each line of a candidate (`rotor_lines`) votes for it in each frame, with `ln(1 − p + p Λ(R))`, where Λ is the likelihood
//!    ratio of a line of unknown level, and p the probability that a line of this class is audible. No vote exceeds 8 nats, so that one loud hum
//!    cannot outweigh the absence of all other lines.
//! 2. *Paths* (`path`): in each window of speeds, the path with the most votes, by dynamic programming. With one path over all speeds, wide
//!    lines of several rotors pass for those of a slow comb.
//! 3. *Levels* (`levels`): the level of each order along a path over the local floor (`floor`), the floor there, and the noise from orders where
//!    no rotor has a line.
//! 4. *Level model* (`level_model`, and `ratio_table` for one line): the log-likelihood ratio of these levels, as lines of a rotor, against levels
//!    of nothing, integrated over loudness, slope, and the level of the shaft lines against the blade pass.
//! 5. *Hypotheses* (`hypotheses`): each path at its octaves and families, compared on the same frames, with the prior of mass, diameter and
//!    number of rotors.
//! 6. *Second look* (`second_look`): the levels along the same paths in frames of 0.4 s. The nats of a hypothesis are the mean of both looks:
//!    they are at the same lines, so that their sum would count each level twice.
//! 7. *Companions* (`companions`): whether other rotors of the vehicle have lines of their own, beside one or beside all that were separated.
//! 8. *Elsewhere* (`elsewhere`): whether a rotor that something known leaves out has lines that are far more probable.
//! 9. *Near a speed* (`near_speed`): the same at a speed that is known, for an exam.
//!
//! 10. *Heard* (`heard`): these steps one after the other.
//!
//! A rotor is heard where the median of the votes is at least 1.4 nats, and that of the quieter third (`pauses`) is not negative, because a voice
//! pauses and a rotor does not; where each look has 4.6 nats of levels over a flat floor (0 in a band narrower than an octave); and where its lines
//! stand apart in a frame (from 30 rev/s on, unless it is known to be slow). A faint one is heard in long frames alone, without votes, where its
//! lines keep their phase.
//!
//! Where a path that jumps, as a voice or an instrument does (`voice`), has 7.8 nats a frame more, its lines are left out, and the frames in which it
//! sounds must hold a rotor without them.
//!
//! Sources: Bayesian comparison of pitches as in Nielsen, Christensen, Cemgil and Jensen, IEEE/ACM Trans. ASLP 22, 2014; the path as in
//! Tabrikian, Dubnov and Dickalov, IEEE Trans. SAP 12, 2004. The level model is measured on real rotors (`docs/measurements.md`).

mod beliefs;
mod companions;
mod elsewhere;
mod excess;
mod floor;
mod heard;
mod hypotheses;
mod level_model;
mod level_table;
mod levels;
mod near_floor;
mod near_speed;
mod own_lines;
mod path;
mod pauses;
mod presence;
mod prior;
mod ratio_table;
mod rotor_lines;
mod rounding;
mod search;
mod second_look;
mod settings;
mod voice;
mod votes;

pub(crate) use beliefs::Beliefs;
pub(crate) use companions::{COMPANION_DISTANCE_MIN, Companions};
pub(crate) use excess::{Excess, ExcessBuilder, Looks};
pub(crate) use heard::{beliefs_from_looks, clear_beliefs_from_looks};
pub(crate) use hypotheses::{Hypothesis, WantedPropeller, WantedRotor};
pub use level_model::OrderLevel;
pub use levels::NoiseLevel;
pub use near_speed::LinesNear;
pub(crate) use near_speed::lines_near;
pub(crate) use own_lines::{OwnPropeller, loudness_db, own_lines_nats};
pub(crate) use rotor_lines::RotorLines;
pub use settings::EvidenceConfig;
