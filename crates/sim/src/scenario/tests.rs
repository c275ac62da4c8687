use super::*;
use crate::flight::FlightState;
use std::collections::BTreeMap;

fn scenario(text: &str) -> Result<Scenario, ScenarioError> {
    toml::from_str::<ScenarioFile>(text).unwrap().resolve(&BTreeMap::new())
}

fn refused(text: &str) -> String {
    match scenario(text).and_then(ScenarioRun::new) {
        Ok(_) => panic!("not refused: {text}"),
        Err(error) => error.to_string(),
    }
}

fn run(text: &str) -> (Vec<Vec<f32>>, Vec<FlightState>, ScenarioTruth) {
    let mut run = ScenarioRun::new(scenario(text).unwrap()).unwrap();
    let (mut channels, mut rows) = (Vec::new(), Vec::new());
    while run.advance(&mut channels, &mut rows).unwrap() {}
    assert_eq!(run.share_done(), 1.0);
    let truth = run.finish(&mut channels);
    (channels, rows, truth)
}

fn mean_square(samples: &[f32]) -> f64 {
    samples.iter().map(|sample| f64::from(*sample).powi(2)).sum::<f64>() / samples.len() as f64
}

#[test]
fn an_empty_file_is_the_papers_hover() {
    let scenario = scenario("").unwrap();
    assert_eq!((scenario.duration_s(), scenario.steps_per_row), (10.0, 10));
    assert_eq!(scenario.flight.vehicle.id, "ardrone");
    let written = toml::to_string(&ScenarioFile::default()).unwrap();
    assert_eq!(toml::from_str::<ScenarioFile>(&written).unwrap(), ScenarioFile::default());
}

/// Still air, alike rotors: mean Σω² is m g/C_f to the rounding, and every channel is as long as the flight.
#[test]
fn the_truth_of_a_still_hover_is_the_balance_itself() {
    let (channels, rows, truth) = run("duration_s = 1.0\n[flight]\ngravity_m_s2 = 9.8\n[[payload]]\nmass_kg = 0.031\n\
         [sound]\nsample_rate_hz = 44100\n[[microphone]]\nposition_m = [1, 0, 1]\n[[microphone]]\n\
         position_m = [0, 2, 1]");
    assert_eq!(channels.iter().map(Vec::len).collect::<Vec<_>>(), [44_100, 44_100]);
    assert_eq!(rows.len(), 101);
    let hover = truth.hover.unwrap();
    assert!((hover.thrust_constant_total_n_s2 / (4.0 * 7.0775e-6) - 1.0).abs() < 1e-9, "{hover:?}");
    let expected = (0.444 * 9.8 / (4.0 * 7.0775e-6_f64)).sqrt();
    assert!(hover.mean_speed_rad_s.iter().all(|speed| (speed / expected - 1.0).abs() < 1e-9));
    assert!((truth.mass_kg - 0.444).abs() < 1e-15 && (hover.duration_s - 1.0).abs() < 1e-12);
    assert_eq!(truth.hovers.len(), 1);
    // 16 bits: whole multiples of 2^-15; the nearer microphone is the louder one
    assert!(channels[0].iter().all(|sample| (sample * 32_768.0).fract() == 0.0));
    assert!(mean_square(&channels[0]) > 2.0 * mean_square(&channels[1]));
}

#[test]
fn means_are_those_of_the_steps_and_hovers_are_told_apart() {
    let (_, rows, truth) = run("seed = 7\ntruth_rate_hz = 1000\n[sound]\nsample_rate_hz = 8000\n\
         [pilot]\njitter = { climb_std = 0.03 }\n[gusts]\nwind_at_6_m_m_s = 1.0\n\
         [[maneuver]]\nkind = \"hover\"\nduration_s = 0.6\n[[maneuver]]\nkind = \"doublet\"\naxis = \"roll\"\namount = 0.5\n\
         half_s = 0.2\n[[maneuver]]\nkind = \"hover\"\nduration_s = 0.5");
    assert_eq!((rows.len(), truth.hovers.len()), (1501, 2));
    for (hover, (from, to)) in truth.hovers.iter().zip([(0, 600), (1000, 1500)]) {
        let states = &rows[from..=to];
        assert!(
            (hover.from_s - states[0].time_s).abs() < 1e-9
                && (hover.duration_s - 0.001 * (to - from) as f64).abs() < 1e-9
        );
        for k in 0..4 {
            // the trapezoid's Σω² is above ∫ω² of straight lines by h² mean(ω'²)/6
            let trapezoid: f64 = states
                .windows(2)
                .map(|pair| 0.5 * (pair[0].speed_rad_s[k].powi(2) + pair[1].speed_rad_s[k].powi(2)))
                .sum::<f64>()
                / (to - from) as f64;
            let over: f64 = states.windows(2).map(|p| (p[1].speed_rad_s[k] - p[0].speed_rad_s[k]).powi(2) / 6.0).sum();
            let expected = trapezoid - over / (to - from) as f64;
            assert!((hover.mean_square_rad2_s2[k] / expected - 1.0).abs() < 1e-12);
            assert!(hover.std_speed_rad_s[k] > 0.3, "{hover:?}");
        }
    }
    let both = truth.hover.unwrap();
    assert!((both.duration_s - 1.1).abs() < 1e-9 && both.from_s == 0.0 && (both.to_s - 1.5).abs() < 1e-9);
    let driven = rows.iter().filter(|row| row.command.roll == 0.5).count();
    assert_eq!(driven, 200);
}

#[test]
fn a_hover_with_an_unsteady_hand_begins_in_full_swing() {
    let spread = |rows: &[FlightState]| {
        let speeds: Vec<f64> = rows.iter().map(|row| row.speed_rad_s.iter().sum::<f64>() / 4.0).collect();
        speeds.iter().copied().fold(0.0, f64::max) - speeds.iter().copied().fold(f64::INFINITY, f64::min)
    };
    let of_seed = |seed: u32| {
        let (_, rows, _) = run(&format!(
            "duration_s = 2.0\nseed = {seed}\n[sound]\nsample_rate_hz = 8000\n[pilot]\njitter = {{ climb_std = 0.079, time_constant_s = 0.3 }}"
        ));
        (spread(&rows[..20]), spread(&rows[20..]))
    };
    // a sudden change of the commanded climb kicks all rotors: 40 rad/s with the first seed
    for (first, rest) in (1..6).map(of_seed) {
        assert!(first < 0.8 * rest, "{first} {rest}");
    }
    // on the ground nothing moves yet
    let (_, rows, _) = run("[flight]\nstarts_on_ground = true\n[sound]\nsample_rate_hz = 8000\n[ground]\n\
         [[microphone]]\nposition_m = [1, 0, 0.5]\n[pilot]\njitter = { climb_std = 0.079 }\n\
         [[maneuver]]\nkind = \"take_off\"\nheight_m = 0.5\nduration_s = 1");
    assert_eq!(rows[0].velocity_m_s, [0.0; 3]);
}

#[test]
fn a_flight_from_the_ground_is_silent_first_and_after_landing() {
    let (channels, rows, truth) = run("[flight]\nstarts_on_ground = true\n[sound]\nsample_rate_hz = 8000\n[ground]\n\
         [[microphone]]\nposition_m = [1, 0, 0.5]\nideal = true\n\
         [[maneuver]]\nkind = \"hover\"\nduration_s = 0.5\n[[maneuver]]\nkind = \"take_off\"\nheight_m = 0.5\nduration_s = 5\n\
         [[maneuver]]\nkind = \"hover\"\nduration_s = 2\n[[maneuver]]\nkind = \"land\"\nduration_s = 4\n\
         [[maneuver]]\nkind = \"hover\"\nduration_s = 1");
    let loud = mean_square(&channels[0][44_000..60_000]);
    assert!(mean_square(&channels[0][..4_000]) < 1e-6 * loud, "silence before");
    assert!(mean_square(&channels[0][96_000..100_000]) < 1e-6 * loud, "silence after");
    assert!(rows[600].position_m[2] > 0.4 && rows.last().unwrap().speed_rad_s.iter().all(|speed| *speed < 1.0));
    assert!((truth.hover.unwrap().duration_s - 2.0).abs() < 1e-9);
    let settled = truth.hover.unwrap().thrust_constant_total_n_s2 / (4.0 * 7.0775e-6) - 1.0;
    assert!(settled.abs() < 0.01, "{settled}");
}

#[test]
fn a_run_keeps_nothing_and_repeats_itself() {
    let text = "duration_s = 2.0\nseed = 3\n[sound]\nsample_rate_hz = 8000\n[room]\n[people]\n[ambient]\n[spread]\n\
                thrust_std_share = 0.01\n[gusts]\nwind_at_6_m_m_s = 2.0\n[flight]\nbattery_sag = true\nground_effect = true";
    let mut pieces = ScenarioRun::new(scenario(text).unwrap()).unwrap();
    let (mut channels, mut rows, mut count, mut most) = (Vec::new(), Vec::new(), 0, 0);
    let mut all = Vec::new();
    while pieces.advance(&mut channels, &mut rows).unwrap() {
        count += 1;
        most = most.max(channels[0].len());
        all.append(&mut channels[0]);
        rows.clear();
    }
    pieces.finish(&mut channels);
    all.append(&mut channels[0]);
    assert!(count == 2001 && most < 300, "{most}");
    let (whole, _, truth) = run(text);
    assert_eq!(whole[0], all);
    let (_, _, other) = run(&text.replace("seed = 3", "seed = 4"));
    assert_ne!(other.rotor_thrust_constants_n_s2, truth.rotor_thrust_constants_n_s2);
}

#[test]
fn numbers_and_names_without_meaning_are_refused() {
    assert!(refused("[vehicle]\npreset = \"ardrome\"").contains("ardrome"));
    assert!(refused("[vehicle]\nmass_kg = -1.0").contains("mass_kg"));
    assert!(refused("[vehicle]\nmass_kg = 5.0").contains("hover voltage"));
    for gravity in ["-9.8", "0.0", "nan"] {
        let said = refused(&format!("[flight]\ngravity_m_s2 = {gravity}"));
        assert!(said.starts_with("gravity_m_s2 = ") && said.contains("above 0"), "{said}");
    }
    assert!(refused("duration_s = 0.0").contains("duration_s"));
    assert!(refused("duration_s = 80000.0").contains("4 GiB"));
    assert!(refused("truth_rate_hz = 300.0").contains("truth_rate_hz"));
    assert!(refused("[room]\n[ground]").contains("[ground]"));
    assert!(refused("[gusts]\nstd_m_s = [1, 1, 1]").contains("airspeed_m_s"));
    assert!(refused("[spread]\nthrust_std_share = 0.5").contains("thrust_std_share"));
    assert!(refused("[pilot]\njitter = { climb_std = 2.0 }").contains("jitter"));
    assert!(refused("[room]\n[[microphone]]\nposition_m = [9, 0, 1]").contains("microphone"));
    let square = "[pilot]\nholds_place = false\n[[maneuver]]\nkind = \"square\"\nside_m = 1\nside_s = 2";
    assert!(refused(square).contains("holds_place"));
    for (text, word) in [
        ("[vehicle]\nmas_kg = 1.0", "unknown field `mas_kg`"),
        ("[[maneuver]]\nkind = \"hoover\"\nduration_s = 1", "unknown variant `hoover`"),
        ("[[maneuver]]\nkind = \"hover\"\nlength_s = 1", "length_s"),
    ] {
        let error = toml::from_str::<ScenarioFile>(text).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    }
}

#[test]
fn every_cell_has_its_column() {
    let (_, rows, _) = run("duration_s = 0.1\n[flight]\nstart_yaw_deg = 90.0\n[sound]\nsample_rate_hz = 8000");
    let cells = truth_cells(&rows[10]);
    let of = |name: &str| cells[TRUTH_COLUMNS.iter().position(|column| *column == name).unwrap()];
    assert!((of("time_s") - 0.1).abs() < 1e-12 && (of("z_m") - 1.0).abs() < 1e-9);
    assert!((of("yaw_deg") - 90.0).abs() < 1e-6 && (of("attitude_w") - 0.5_f64.sqrt()).abs() < 1e-9);
    assert!((of("total_thrust_n") - 0.413 * 9.806_65).abs() < 1e-9 && of("battery_v") == 11.1);
    assert_eq!(of("speed_4_rad_s"), rows[10].speed_rad_s[3]);
}

/// With C_f of the front 14 % below and of the back 14 % above the mean, equal thrusts need speeds √(1.14/0.86) = 1.15 apart.
#[test]
fn rotors_are_as_far_apart_as_their_thrust_constants_demand() {
    let (_, _, truth) =
        run("duration_s = 2.0\n[spread]\nthrust_shares = [0.86, 1.14, 1.14, 0.86]\n[sound]\nsample_rate_hz = 8000");
    let speeds = truth.hover.unwrap().mean_speed_rad_s;
    let fastest = speeds.iter().fold(0.0_f64, |fastest, speed| fastest.max(*speed));
    let slowest = speeds.iter().fold(f64::INFINITY, |slowest, speed| slowest.min(*speed));
    assert!((fastest / slowest - (1.14_f64 / 0.86).sqrt()).abs() < 1e-3, "{speeds:?}");
}

#[test]
fn drawn_levels_differ_with_the_seed_and_assumed_ones_are_the_default() {
    let text = |seed: u32, levels: &str| {
        format!("seed = {seed}\n[vehicle]\npreset = \"f450\"\n[sound]\nline_levels = \"{levels}\"")
    };
    let tones = |seed, levels| scenario(&text(seed, levels)).unwrap().sound.source;
    let plain = scenario("[vehicle]\npreset = \"f450\"").unwrap().sound.source;
    assert_eq!(tones(5, "assumed"), plain);
    let drawn = tones(5, "drawn");
    assert_eq!(drawn, tones(5, "drawn"));
    assert!(drawn.tones != plain.tones && drawn.motor.is_some() && drawn != tones(6, "drawn"));
}

/// A silent flight: the wind alone, at an ideal microphone whose full scale is √2 Pa. Its noise has 44 independent values a second (the square of
/// the integral of the density over the integral of its square), so the mean square of 10 s has a relative standard error of 4.8 %.
#[test]
fn wind_makes_noise_of_the_set_level_and_an_automatic_gain_brings_it_to_its_target() {
    let silent = "duration_s = 10.0\n[sound]\nsample_rate_hz = 8000\nsample_format = \"float32\"\ntone_level_db_spl = -100\n\
         broadband_level_db_spl = -100\n[[microphone]]\nposition_m = [1, 0, 1]\nideal = true\nwind_noise_db_spl = 74\n";
    let (channels, ..) = run(silent);
    assert!((mean_square(&channels[0]) / 0.005 - 1.0).abs() < 5.0 * 0.048, "{}", mean_square(&channels[0]));
    let (channels, ..) =
        run(&format!("{silent}automatic_gain = {{ target_dbfs = -30, attack_s = 0.5, release_s = 0.5 }}\n"));
    // the level of a full-scale sine is a mean square of 1/2; a fluctuating noise comes out within 3 dB of the target
    let level_db = 10.0 * (2.0 * mean_square(&channels[0])).log10();
    assert!((level_db + 30.0).abs() < 3.0, "{level_db}");
    assert!(refused(&format!("{silent}automatic_gain = {{ attack_s = 0 }}\n")).contains("attack_s"));
}
