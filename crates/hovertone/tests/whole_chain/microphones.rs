//! Which rotor is which by several microphones, on sound made here: lines of rotors at known places, 1/r and r/c, in white noise.
//! `hovertone-bench labels` does it with simulated flights and rooms.

use hovertone::rotors::{
    ArrayError, LabelSource, MicrophoneArray, MicrophoneLines, MicrophonesConfig, NotTold, PlacedRotor, RotorLabels,
    labels_from_microphones, microphone_lines_from_source,
};
use hovertone::sound::Signal;
use hovertone::speed::{ToneConfig, TrackPoint};
use hovertone_sim::prescribed::{Line, Noise, Recording, Rotor, Sampling};
use hovertone_vehicle::{Layout, Order};
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;

const SAMPLE_RATE_HZ: f64 = 16_000.0;
const LENGTH_S: f64 = 5.0;
const ARM_M: f64 = 0.2;
/// Dry air at 20 °C.
const SOUND_M_S: f64 = 343.2;
/// Fastest first, 1 % apart.
const SPEEDS_REV_S: [f64; 4] = [61.2, 60.6, 60.0, 59.4];
/// Which rotor has which of these speeds.
const ROTORS: [usize; 4] = [2, 0, 3, 1];
const AROUND_M: [[f64; 3]; 3] = [[0.9, 0.3, -0.1], [-0.6, 0.8, 0.1], [-0.2, -1.0, -0.2]];

fn places(layout: Layout) -> Vec<PlacedRotor> {
    let placed = |place: hovertone_vehicle::RotorPlace| PlacedRotor {
        name: place.name.to_owned(),
        position_m: [place.x_m, place.y_m, 0.0],
    };
    layout.places(ARM_M).map(placed).to_vec()
}

fn tone() -> ToneConfig {
    ToneConfig::of_order(Order::from_blades(2).unwrap())
}

fn tracks(gap_s: (f64, f64)) -> Vec<Vec<TrackPoint>> {
    let point = |speed_rev_s: f64, step: usize| TrackPoint {
        time_s: 0.04 * step as f64,
        tone_hz: 2.0 * speed_rev_s,
        speed_rev_s,
        std_uncertainty_rev_s: 0.01,
        level_db: -40.0,
    };
    let is_kept = |point: &TrackPoint| !(gap_s.0..gap_s.1).contains(&point.time_s);
    let steps = (LENGTH_S / 0.04) as usize;
    SPEEDS_REV_S.map(|speed| (0..steps).map(|step| point(speed, step)).filter(is_kept).collect()).to_vec()
}

/// The sound at microphones around a vehicle that drifts by up to 0.3 m, alike for all rotors: levels go with 1/distance,
/// phases with the delay.
fn heard(rotors: &[PlacedRotor], microphones_m: &[[f64; 3]]) -> Vec<Vec<f32>> {
    let mut random = Pcg64::seed_from_u64(1);
    let mut line = |order: f64| {
        let level: f64 = random.sample(StandardNormal);
        Line::new(order, 0.02 * (0.3 * level).exp() / order.sqrt()).with_random_phase(&mut random)
    };
    let lines: [Vec<Line>; 4] = std::array::from_fn(|_| (1..=12).map(|number| line(f64::from(2 * number))).collect());
    let channel = |at_m: &[f64; 3]| -> Vec<f32> {
        let drift_m = random.random_range(-0.3..0.3);
        let heard_rotor = |track: usize| {
            let place_m = rotors[ROTORS[track]].position_m;
            let distance_m: f64 = at_m.iter().zip(place_m).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            // turns at the emission, `speed · (t - path/c)` with `path = distance + drift t/T`
            let speed_rev_s = SPEEDS_REV_S[track] * (1.0 - drift_m / LENGTH_S / SOUND_M_S);
            let lines = lines[track].iter().map(|line| line.clone().times(1.0 / distance_m)).collect();
            Rotor::steady(speed_rev_s, lines).from_turns(-SPEEDS_REV_S[track] * distance_m / SOUND_M_S)
        };
        let rotors: Vec<Rotor<'_>> = (0..4).map(heard_rotor).collect();
        let mut recording = Recording::of_rotors(&rotors, Sampling::new(SAMPLE_RATE_HZ, LENGTH_S));
        recording.add_noise(&Noise::white(0.003), &mut random);
        recording.samples_f32()
    };
    microphones_m.iter().map(channel).collect()
}

fn lines_of(channels: &[Vec<f32>], tracks: &[Vec<TrackPoint>]) -> Vec<MicrophoneLines> {
    let tracks: Vec<&[TrackPoint]> = tracks.iter().map(Vec::as_slice).collect();
    let of = |samples: &Vec<f32>| {
        let mut signal = Signal::new(samples.clone(), SAMPLE_RATE_HZ);
        let config = MicrophonesConfig::default();
        microphone_lines_from_source(&mut signal, &tracks, &tone(), &config, &mut |_| {}).unwrap()
    };
    channels.iter().map(of).collect()
}

fn labelled(lines: &[MicrophoneLines], microphones_m: &[[f64; 3]], rotors: Vec<PlacedRotor>) -> RotorLabels {
    let array = MicrophoneArray::new(microphones_m.to_vec(), rotors).unwrap();
    labels_from_microphones(lines, &array, &MicrophonesConfig::default())
}

fn numbers(labels: &RotorLabels) -> Vec<Option<usize>> {
    labels.rotors.iter().map(|label| label.as_ref().map(|label| label.number - 1)).collect()
}

const NO_GAP: (f64, f64) = (-1.0, -1.0);

#[test]
fn rotors_are_told_while_the_vehicle_drifts() {
    let rotors = places(Layout::X);
    let channels = heard(&rotors, &AROUND_M);
    let lines = lines_of(&channels, &tracks(NO_GAP));
    let labels = labelled(&lines, &AROUND_M, rotors.clone());
    assert_eq!(numbers(&labels), ROTORS.map(Some), "{labels:?}");
    assert_eq!((labels.source, &labels.not_told, labels.offset_s), (LabelSource::Microphones, &None, None));
    let names: Vec<&str> = labels.rotors.iter().flatten().map(|label| label.name.as_str()).collect();
    assert_eq!(names, ["rear right", "front left", "front right", "rear left"]);
    // a gap costs the blocks that it falls into
    let labels = labelled(&lines_of(&channels, &tracks((2.3, 2.6))), &AROUND_M, rotors.clone());
    assert_eq!(numbers(&labels), ROTORS.map(Some), "{labels:?}");
    // three of four rotors told apart: the fourth sounds among them
    let labels = labelled(&lines_of(&channels, &tracks(NO_GAP)[..3]), &AROUND_M, rotors.clone());
    assert_eq!(numbers(&labels), [Some(2), Some(0), Some(3)], "{labels:?}");
    // channels in another order are microphones at other places
    let elsewhere = [AROUND_M[1], AROUND_M[0], [0.5, 0.9, 0.0]];
    let labels = labelled(&lines, &elsewhere, rotors);
    assert_eq!(numbers(&labels), [None; 4]);
    assert!(matches!(labels.not_told, Some(NotTold::OtherArray { .. })), "{labels:?}");
}

/// Microphones in a plane of symmetry do not tell left from right; on a frame with a rotor in front, they tell front and rear.
#[test]
fn what_symmetry_hides_is_not_told() {
    let in_plane_m = [[0.8, 0.0, -0.2], [-0.5, 0.0, 0.4], [0.1, 0.0, -0.9]];
    for (layout, told) in [(Layout::X, [None; 4]), (Layout::Plus, [Some(2), Some(0), None, None])] {
        let rotors = places(layout);
        let lines = lines_of(&heard(&rotors, &in_plane_m), &tracks(NO_GAP));
        let labels = labelled(&lines, &in_plane_m, rotors);
        assert_eq!(numbers(&labels), told, "{labels:?}");
        let tracks = told.iter().filter(|label| label.is_none()).count();
        assert_eq!(labels.not_told, Some(NotTold::SeveralPlacesFit { tracks }));
    }
}

#[test]
fn what_cannot_be_compared_says_why() {
    let rotors = places(Layout::X);
    let mut channels = heard(&rotors, &AROUND_M);
    let all = tracks(NO_GAP);
    let lines = lines_of(&channels, &all);
    let reason = |lines: &[MicrophoneLines]| labelled(lines, &AROUND_M, rotors.clone()).not_told;
    assert_eq!(reason(&lines[..2]), Some(NotTold::OtherChannels { channels: 2, microphones: 3 }));
    assert_eq!(reason(&lines_of(&channels, &all[..1])), Some(NotTold::TooFewTracks { tracks: 1, needed: 2 }));
    let two = labelled(&lines, &AROUND_M, rotors[..2].to_vec()).not_told;
    assert_eq!(two, Some(NotTold::OtherPlaces { tracks: 4, places: 2 }));
    // shorter than the shortest block
    let short: Vec<Vec<TrackPoint>> = all.iter().map(|track| track[..8].to_vec()).collect();
    assert_eq!(reason(&lines_of(&channels, &short)), Some(NotTold::NothingHeard { microphone: 1 }));
    let mut random = Pcg64::seed_from_u64(2);
    channels[1].iter_mut().for_each(|sample| *sample = random.random_range(-0.01..0.01));
    assert_eq!(reason(&lines_of(&channels, &all)), Some(NotTold::NothingHeard { microphone: 2 }));
    channels[1].fill(0.0);
    assert_eq!(reason(&lines_of(&channels, &all)), Some(NotTold::NothingHeard { microphone: 2 }));
}

#[test]
fn arrays_that_mean_nothing_are_refused() {
    let rotors = places(Layout::X);
    let array = |microphones_m: &[[f64; 3]], rotors: &[PlacedRotor]| {
        MicrophoneArray::new(microphones_m.to_vec(), rotors.to_vec()).unwrap_err()
    };
    assert_eq!(array(&AROUND_M[..1], &rotors), ArrayError::TooFewMicrophones { count: 1 });
    assert_eq!(array(&AROUND_M, &rotors[..1]), ArrayError::WrongRotorCount { count: 1 });
    let bad = [AROUND_M[0], [0.0, f64::NAN, 0.0]];
    assert_eq!(array(&bad, &rotors), ArrayError::BadPosition { what: "microphone", number: 2 });
    assert!(MicrophonesConfig { position_std_m: 0.0, ..MicrophonesConfig::default() }.check().is_err());
    assert!(MicrophonesConfig { array_prior: f64::NAN, ..MicrophonesConfig::default() }.check().is_err());
}
