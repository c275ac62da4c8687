//! How fast and how small: `hovertone log` on long logs of each format, made by repeating short ones. Run by people, never in a test.

#[path = "../../logs/tests/formats/writers/mod.rs"]
mod writers;

use crate::cost::{REPEATS, fastest};
use crate::options::whole_number;
use crate::workspace::{cargo, target};
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use writers::{blackbox, dataflash, ulog};

/// Size of a log, unless `--mb` says otherwise.
const MEGABYTES: u64 = 1000;
const BYTES_PER_MEGABYTE: u64 = 1_000_000;
/// Part of it in which memory is measured for comparison.
const SHORT_SHARE: u64 = 20;

/// A log that is made longer by repeating what stands behind its head.
struct Short {
    name: &'static str,
    bytes: Vec<u8>,
    head: usize,
}

pub(crate) fn run(root: &Path, options: &[&str]) -> Result<(), String> {
    let megabytes = match options {
        [] => MEGABYTES,
        ["--mb", megabytes] => whole_number("--mb", megabytes)?,
        _ => return Err("cargo run --release -p hovertone-bench -- logs [--mb N]".to_owned()),
    };
    cargo(root, &["build", "--release", "--locked", "-p", "hovertone-cli"])?;
    let program = target(root).join("release").join("hovertone");
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    println!("\n`hovertone log --json` on logs of {megabytes} MB, made by repeating; fastest of {REPEATS} runs\n");
    println!("| log | MB/s of processor time | MB/s | MiB | MiB at a twentieth of the length |");
    println!("|---|---|---|---|---|");
    for short in shorts(root) {
        let place = folder.path().join(short.name);
        let small = written(&place, &short, megabytes * BYTES_PER_MEGABYTE / SHORT_SHARE)?;
        let small = listed(&program, &small)?;
        let long = written(&place, &short, megabytes * BYTES_PER_MEGABYTE)?;
        let size = fs::metadata(&long).map_err(|error| error.to_string())?.len();
        // once, so that the file is in memory: the disk is not measured
        let _ = listed(&program, &long)?;
        let cost = listed(&program, &long)?;
        let megabytes = (size / BYTES_PER_MEGABYTE) as f64;
        let busy = cost.cpu_s.map_or("–".to_owned(), |cpu_s| format!("{:.0}", megabytes / cpu_s));
        let rate = megabytes / cost.wall_s;
        println!("| {} | {busy} | {rate:.0} | {:.1} | {:.1} |", short.name, cost.peak_mib, small.peak_mib);
        fs::remove_file(&long).map_err(|error| error.to_string())?;
    }
    Ok(())
}

fn listed(program: &Path, log: &Path) -> Result<crate::cost::Cost, String> {
    let command = || Command::new(program).args(["log", "--json"]).arg(log).stdout(Stdio::null()).spawn();
    fastest(command)
}

/// The short logs; the real one of PX4 where the test data are installed.
fn shorts(root: &Path) -> Vec<Short> {
    let real = fs::read(root.join("../shared/data/logs/px4_sample_small.ulg"));
    let (name, bytes) = match real {
        Ok(bytes) => ("real.ulg", bytes),
        Err(_) => ("written.ulg", ulog::flight()),
    };
    let head = ulog::data_begin(&bytes);
    let csv = csv();
    let csv_head = csv.iter().position(|byte| *byte == b'\n').map_or(0, |at| at + 1);
    vec![
        Short { name, bytes, head },
        Short { name: "written.bin", bytes: dataflash::flight(60), head: 0 },
        Short { name: "written.bbl", bytes: blackbox::flight(2_000_000), head: 0 },
        Short { name: "written.csv", bytes: csv, head: csv_head },
    ]
}

/// A table of nine columns, all rows at one time, so that it can be repeated.
fn csv() -> Vec<u8> {
    let mut text =
        "time_s,motor1_pwm,motor2_pwm,rotor1_rpm,rotor2_rpm,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,battery_v\n"
            .to_owned();
    for row in 0..10_000 {
        let wave = (f64::from(row) / 50.0).sin();
        let command = 1500.0 + 100.0 * wave;
        text += &format!(
            "0.000,{command:.0},{command:.0},{:.1},{:.1},{wave:.5},{:.5},{:.5},16.{row}\n",
            3000.0 + 200.0 * wave,
            3100.0 - 200.0 * wave,
            -wave,
            0.5 * wave
        );
    }
    text.into_bytes()
}

/// Writes a log of about this size.
fn written(place: &Path, short: &Short, size: u64) -> Result<PathBuf, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", place.display());
    let mut file = BufWriter::new(File::create(place).map_err(failed)?);
    file.write_all(&short.bytes).map_err(failed)?;
    let mut length = short.bytes.len() as u64;
    while length < size {
        file.write_all(&short.bytes[short.head..]).map_err(failed)?;
        length += (short.bytes.len() - short.head) as u64;
    }
    file.flush().map_err(failed)?;
    Ok(place.to_owned())
}
