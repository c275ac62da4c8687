//! Cut, flipped and shuffled bytes: an answer or one error, and only what is in the log.

use crate::signals_of;
use crate::writers::{blackbox, dataflash, ulog};
use hovertone_logs::{ColumnNames, LogSignals, flight_from_log, log_summary, signals_from_log};
use proptest::prelude::*;

const CSV: &str =
    "time_s,motor1_pwm,rotor1_rpm,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s\n0,1,2,3,4,5\n0.1,1,2,,4,5\n0.2,2,1,3,4,6\n";

fn logs() -> [Vec<u8>; 4] {
    [dataflash::flight(1), blackbox::flight(1500), ulog::flight(), CSV.as_bytes().to_vec()]
}

/// Reads a log in all ways; none of them may panic, and all series fit each other.
fn read_in_all_ways(bytes: &[u8]) {
    let names = ColumnNames::default();
    if let Ok(summary) = log_summary(bytes, &names) {
        assert!(summary.loss.lost_bytes <= bytes.len() as u64);
    }
    if let Ok(log) = signals_from_log(bytes, &names, |_, _| true) {
        for table in &log.tables {
            assert!(table.values.iter().all(|values| values.len() == table.time_s.len()));
        }
    }
    if let Ok(flight) = flight_from_log(bytes, &names) {
        for motors in [flight.speeds_rev_s, flight.commands].into_iter().flatten() {
            assert!(motors.values.iter().all(|series| series.len() == motors.time_s.len()));
            assert!(motors.time_s.windows(2).all(|pair| pair[0] < pair[1]));
            assert!(motors.values.iter().flatten().all(|value| value.is_finite()));
        }
    }
}

/// Whether all rows of a table of `part` are rows of `whole`.
fn is_part_of(part: &LogSignals, whole: &LogSignals) -> bool {
    part.tables.iter().all(|table| {
        let of_whole = whole.tables.iter().find(|other| other.name == table.name).unwrap();
        let row_of = |table: &hovertone_logs::SignalTable, row: usize| -> Vec<u64> {
            table.values.iter().map(|values| values[row].to_bits()).collect()
        };
        (0..table.time_s.len()).all(|row| {
            let of_time = of_whole.time_s.iter().position(|time_s| *time_s == table.time_s[row]);
            of_time.is_some_and(|other| row_of(table, row) == row_of(of_whole, other))
        })
    })
}

#[test]
fn a_log_that_breaks_off_anywhere_gives_what_it_holds_and_says_how_much_is_lost() {
    for whole in [dataflash::flight(1), blackbox::flight(1500)] {
        let all = signals_of(&whole);
        let rows = |log: &LogSignals| log.tables.iter().map(|table| table.time_s.len()).sum::<usize>();
        let mut compared = 0;
        for length in (whole.len() / 5..whole.len()).step_by(97) {
            let cut = signals_of(&whole[..length]);
            assert!(is_part_of(&cut, &all));
            // at most the last message is lost
            assert!(cut.loss.lost_bytes < 120, "{}", cut.loss);
            assert!(cut.loss.places.iter().all(|place| place.from_byte + place.bytes == length as u64));
            compared += rows(&cut);
        }
        assert!(compared > 20 * rows(&all), "{compared}");
    }
}

#[test]
fn reading_goes_on_behind_a_hole_and_its_place_is_told() {
    for (whole, lost_most) in [(dataflash::flight(2), 1200), (blackbox::flight(4000), 2200)] {
        let all = signals_of(&whole);
        let mut damaged = whole.clone();
        let middle = whole.len() / 2;
        damaged[middle..middle + 1000].fill(0xff);
        let log = signals_of(&damaged);
        assert!(is_part_of(&log, &all));
        let last_s =
            |log: &LogSignals| log.tables.iter().filter_map(|table| table.time_s.last().copied()).fold(0.0, f64::max);
        assert_eq!(last_s(&log), last_s(&all));
        assert!((1000..lost_most).contains(&log.loss.lost_bytes), "{}", log.loss);
        let place = log.loss.places[0];
        assert!(place.from_byte <= middle as u64 && place.from_byte + place.bytes >= middle as u64 + 1000);
        assert!(place.after_s.is_some_and(|after_s| after_s > 0.0), "{}", log.loss);
        assert!(log.loss.in_words().unwrap().contains("the log is damaged"), "{}", log.loss);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn flipped_bytes_are_answered(
        kind in 0_usize..4,
        flips in prop::collection::vec((0_usize..1 << 20, any::<u8>()), 1..60),
        kept in 0.0..1.0_f64,
    ) {
        let mut bytes = logs()[kind].clone();
        let length = bytes.len();
        flips.iter().for_each(|&(at, with)| bytes[at % length] ^= with);
        bytes.truncate((kept * length as f64) as usize);
        read_in_all_ways(&bytes);
    }

    #[test]
    fn shuffled_bytes_are_answered(kind in 0_usize..4, swaps in prop::collection::vec((0_usize..1 << 20, 0_usize..1 << 20, 1_usize..400), 1..30)) {
        let mut bytes = logs()[kind].clone();
        let length = bytes.len();
        for (from, to, count) in swaps {
            let (from, to) = (from % length, to % length);
            let count = count.min(length - from).min(length - to);
            let moved = bytes[from..from + count].to_vec();
            bytes[to..to + count].copy_from_slice(&moved);
        }
        read_in_all_ways(&bytes);
    }

    #[test]
    fn any_bytes_behind_a_head_are_answered(kind in 0_usize..4, bytes in prop::collection::vec(any::<u8>(), 0..3000), kept in 0_usize..3000) {
        let log = &logs()[kind];
        read_in_all_ways(&[&log[..kept.min(log.len())], &bytes].concat());
    }
}
