//! One seed, many independent streams of random numbers. Each part of each rotor has its own stream, so an additional rotor
//! or tone changes no other.

use rand_pcg::Pcg64;

/// The purpose of a stream. The numbers are part of the meaning of a seed: a change of one changes every simulated sound.
#[derive(Clone, Copy)]
pub(crate) enum Part {
    Wander = 1,
    Tones = 2,
    RotorNoise = 3,
    AmbientNoise = 4,
    Trial = 5,
    SelfNoise = 6,
    Babble = 7,
    Reverberation = 8,
    Gust = 20,
    Spread = 21,
    Jitter = 22,
    Scenario = 23,
    MotorGain = 24,
    Levels = 25,
    WindNoise = 26,
}

/// The stream of `part` number `index`.
pub(crate) fn stream(seed: u64, part: Part, index: u64) -> Pcg64 {
    let state = mixed(seed, part, index);
    Pcg64::new(u128::from(state) << 64 | u128::from(mixed(state, part, index)), u128::from(state))
}

/// A seed for a part that has streams of its own.
pub(crate) fn mixed(seed: u64, part: Part, index: u64) -> u64 {
    split_mix(split_mix(split_mix(seed) ^ part as u64) ^ index)
}

/// SplitMix64 (Steele, Lea, Flood 2014): makes unrelated seeds from neighbouring seeds.
fn split_mix(seed: u64) -> u64 {
    let mut mixed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}
