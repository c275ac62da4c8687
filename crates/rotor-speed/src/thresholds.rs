//! Numbers that several decisions share. Each has one meaning, and stands here once.

/// Share of something that is most of it. *Decision.*
pub(crate) const MOST: f64 = 0.5;
/// Share of something that is nearly all of it. *Decision.*
pub(crate) const NEARLY_ALL: f64 = 0.8;
/// Share of the frames, or of the time, that is a good part of it. *Decision.*
pub(crate) const MANY: f64 = 0.3;
/// Share of the frames, of the time or of the points that are few of them. *Decision.*
pub(crate) const FEW: f64 = 0.2;

/// Standard deviations of the noise beyond which a single value is more than noise: chance alone goes there once in 370 times. *Decision.*
pub(crate) const NOISE_STDS_MAX: f64 = 3.0;
/// The same for the greatest of many values. *Decision.*
pub(crate) const SEARCHED_NOISE_STDS_MAX: f64 = 5.0;
/// Most nats that one line of one frame counts: it may be of another sound. *Decision.*
pub(crate) const LINE_NATS_MAX: f64 = 8.0;
/// Nats that speak clearly, with odds of 20 to 1. *Decision.*
pub(crate) const CLEAR_NATS: f64 = 3.0;
/// Height over the noise at which a line, or the mean of a comb, is clear, dB. *Decision.*
pub(crate) const CLEAR_DB: f64 = 10.0;
/// Likelihood of a clear block, in units of the likelihood that stands out of the noise. *Decision.*
pub(crate) const CLEAR_TIMES: f64 = 2.0;

/// Shortest time for which a speed is held, so that it is a state of its own, s. *Decision.*
pub(crate) const HELD_S: f64 = 2.0;
/// Shortest sound that is told as that of a rotor, s: beeps of an ESC are shorter. *Decision.*
pub(crate) const HEARD_S_MIN: f64 = 1.0;
/// Frame length at which steady rotors are clearest, s: in longer frames sound in a room loses its phase. *Decision.*
pub(crate) const STEADY_FRAME_S: f64 = 0.4;

/// Width of the speeds of a hover, with those of all rotors of a vehicle, as a share: a hover wanders. *Decision.*
pub(crate) const HOVER_WIDTH_SHARE: f64 = 0.024;
/// How far the speed of a rotor lies from a first estimate at most, as a share: by its wander, and by the grid of a search. *Decision.*
pub(crate) const BESIDE_SHARE: f64 = 0.03;
/// By how much a flight may change its speed to either side, as a share. *Decision.*
pub(crate) const FLIGHT_WIDTH_SHARE: f64 = 0.08;
/// Largest difference of two speeds that are one, where the flight may have changed between them, as a share. *Decision.*
pub(crate) const SAME_SPEED_SHARE: f64 = 0.1;
/// Other speeds of one rotor lie within this factor: below an octave, so that an octave stays as it is. *Decision.*
pub(crate) const BELOW_OCTAVE: f64 = 1.9;
/// How fast the speed of a hovering rotor changes, as a share per second. *Decision.*
pub(crate) const SLOPE_SHARE_PER_S: f64 = 0.1;

/// Harmonics of a blade pass by which it is recognised: as many as stand out of the noise of small multirotors. *Decision.*
pub(crate) const SERIES_LINES: u32 = 8;
/// Harmonics of a gear mesh by which it is recognised: the third of the AR.Drone's is at 12 kHz, and more are above what recorders keep. *Decision.*
pub(crate) const MESH_LINES: u32 = 3;
/// A line of a series counts up to this level, dB over the noise, so that one strong line does not outweigh the series. *Decision.*
pub(crate) const SERIES_LEVEL_DB_MAX: f64 = 40.0;
