//! Memory: damaged logs allocate little, and a long log no more than a short one.

// The lints know tests by their attribute, and what tests share has none.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout)]

#[path = "formats/writers/mod.rs"]
mod writers;

use hovertone_logs::{ColumnNames, flight_from_log, log_summary, signals_from_log};
use peak_alloc::PeakAlloc;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::io::Read;
use writers::{blackbox, dataflash, ulog};

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

const ALLOCATED_MIB_MAX: f32 = 64.0;
/// Of a listing: the window over the bytes, and the names of signals.
const LISTING_MIB_MAX: f32 = 4.0;

const LONG_BYTES: usize = 30_000_000;
const CSV_HEADER: &str = "time_s,motor1_pwm,rotor1_rpm\n";

/// Highest allocation during some work, beyond what was allocated before.
fn peak_mib(work: impl FnOnce()) -> f32 {
    let before_mib = ALLOCATOR.current_usage_as_mb();
    ALLOCATOR.reset_peak_usage();
    work();
    ALLOCATOR.peak_usage_as_mb() - before_mib
}

/// Changed bytes, and a run of them that is moved.
fn damage() -> impl Strategy<Value = Damage> {
    let flips = prop::collection::vec((0_usize..1 << 20, any::<u8>()), 0..60);
    let moved = prop::collection::vec((0_usize..1 << 20, 0_usize..1 << 20, 1_usize..400), 0..20);
    (0_usize..4, flips, moved, 0.2..1.0_f64).prop_map(|(kind, flips, moved, kept)| Damage { kind, flips, moved, kept })
}

#[derive(Debug)]
struct Damage {
    kind: usize,
    flips: Vec<(usize, u8)>,
    moved: Vec<(usize, usize, usize)>,
    kept: f64,
}

impl Damage {
    fn done_to(&self, logs: &[Vec<u8>; 4]) -> Vec<u8> {
        let mut bytes = logs[self.kind].clone();
        let length = bytes.len();
        for &(from, to, count) in &self.moved {
            let (from, to) = (from % length, to % length);
            let count = count.min(length - from).min(length - to);
            bytes.copy_within(from..from + count, to);
        }
        self.flips.iter().for_each(|&(at, with)| bytes[at % length] ^= with);
        bytes.truncate((self.kept * length as f64) as usize);
        bytes
    }
}

/// A log that goes on and on: its frames are repeated behind its head.
struct Repeated {
    bytes: Vec<u8>,
    head: usize,
    at: usize,
    left: usize,
}

impl Read for Repeated {
    fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
        if self.at == self.bytes.len() {
            self.at = self.head;
        }
        let count = into.len().min(self.bytes.len() - self.at).min(self.left);
        into[..count].copy_from_slice(&self.bytes[self.at..self.at + count]);
        self.at += count;
        self.left -= count;
        Ok(count)
    }
}

/// One test: allocations are counted for the whole program.
#[test]
fn damage_allocates_little_and_a_long_log_no_more_than_a_short_one() {
    let csv = format!("{CSV_HEADER}{}", "0,1,2\n0,2,3\n".repeat(100));
    let logs = [dataflash::flight(1), blackbox::flight(1500), ulog::flight(), csv.into_bytes()];
    let names = ColumnNames::default();
    let mut highest_mib: f32 = 0.0;
    let mut runner = TestRunner::new(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) });
    runner
        .run(&damage(), |damage| {
            let bytes = damage.done_to(&logs);
            let mib = peak_mib(|| {
                let _ = log_summary(&bytes[..], &names);
                let _ = flight_from_log(&bytes[..], &names);
                let _ = signals_from_log(&bytes[..], &names, |_, _| true);
            });
            prop_assert!(mib < ALLOCATED_MIB_MAX, "{mib} MiB");
            Ok(())
        })
        .unwrap();
    let [dataflash, _, ulog, csv] = logs;
    let (head, rows) = (ulog::data_begin(&ulog), CSV_HEADER.len());
    for long in [
        // a log may describe its messages again, and its clock may start again
        Repeated { bytes: dataflash, head: 0, at: 0, left: LONG_BYTES },
        Repeated { bytes: ulog, head, at: 0, left: LONG_BYTES },
        Repeated { bytes: blackbox::flight(500_000), head: 0, at: 0, left: 4_000_000 },
        Repeated { bytes: csv, head: rows, at: 0, left: LONG_BYTES },
    ] {
        let mut rows = 0;
        let mib = peak_mib(|| {
            let summary = log_summary(long, &names).unwrap();
            rows = summary.tables.iter().map(|table| table.row_count).sum();
        });
        highest_mib = highest_mib.max(mib);
        assert!(rows > 100_000, "{rows} rows");
        assert!(mib < LISTING_MIB_MAX, "{mib} MiB");
    }
    println!("a listing of a long log allocates {highest_mib:.2} MiB");
}
