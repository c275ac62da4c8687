//! `hovertone batch` on an archive: how many recordings per second and core, how much memory, and whether kills lose anything.
//! Run by people, never in a test.

use crate::cost::{Cost, once};
use crate::options::whole_number;
use crate::workspace::{cargo, target};
use hovertone_sim::HoverSettings;
use hovertone_sim::HoverSound;
use hovertone_vehicle::{RotorSpeed, find_preset};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Recordings, unless `--count` says otherwise.
const COUNT: usize = 10_000;
const LENGTH_S: f64 = 2.0;
const SAMPLE_RATE_HZ: f64 = 22_050.0;
/// Recordings of the runs on one core.
const FEW: usize = 200;
/// Moments at which a run is killed.
const KILLS: usize = 20;
/// Least throughput of `batch` on one core, over that of `speed` on the same files.
const SHARE_OF_SPEED_MIN: f64 = 0.8;
/// Least throughput on two cores, over that on one.
const TWO_CORES_OVER_ONE_MIN: f64 = 1.8;
const PEAK_MIB_MAX: f64 = 300.0;
const FLAGS: [&str; 5] = ["--blades", "2", "--rotors", "1", "--no-progress"];

pub(crate) fn run(root: &Path, options: &[&str]) -> Result<(), String> {
    let count = match options {
        [] => COUNT,
        ["--count", count] => whole_number("--count", count)?,
        _ => return Err("cargo run --release -p hovertone-bench -- batch [--count N]".to_owned()),
    };
    cargo(root, &["build", "--release", "--locked", "-p", "hovertone-cli"])?;
    let exam = Exam {
        program: target(root).join("release").join("hovertone"),
        folder: tempfile::tempdir().map_err(|error| error.to_string())?,
    };
    let (few, all) = (exam.archive("few", FEW.min(count))?, exam.archive("all", count)?);
    let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let busy = load.split(' ').next().unwrap_or("–");
    println!("\n`hovertone batch` on recordings of {LENGTH_S} s; load of the machine before: {busy}\n");
    let bounds = exam.throughput(&few, &all);
    exam.kills(&few)?;
    bounds
}

/// A number that was measured, and what is asked of it.
struct Bound {
    of: &'static str,
    found: f64,
    asked: Asked,
}

enum Asked {
    Min(f64),
    Max(f64),
}

impl Bound {
    fn is_met(&self) -> bool {
        match self.asked {
            Asked::Min(least) => self.found >= least,
            Asked::Max(most) => self.found <= most,
        }
    }

    fn line(&self) -> String {
        let asked = match self.asked {
            Asked::Min(least) => format!("at least {least}"),
            Asked::Max(most) => format!("at most {most}"),
        };
        let verdict = if self.is_met() { "met" } else { "NOT met" };
        format!("{}: {:.2} (asked: {asked}; {verdict})", self.of, self.found)
    }
}

/// Recordings in a folder.
struct Archive {
    place: PathBuf,
    files: Vec<PathBuf>,
}

impl Archive {
    fn count(&self) -> f64 {
        self.files.len() as f64
    }
}

struct Exam {
    program: PathBuf,
    folder: tempfile::TempDir,
}

impl Exam {
    fn place(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Draws one rotor for each recording.
    fn archive(&self, name: &str, count: usize) -> Result<Archive, String> {
        let place = self.place(name);
        let preset = find_preset("crazyflie").ok_or("there is no preset of the Crazyflie")?;
        let mut random = Pcg64::seed_from_u64(1);
        let mut files = Vec::new();
        for number in 0..count {
            let folder = place.join(format!("{:03}", number / 100));
            fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
            let speed = RotorSpeed::from_rev_s(random.random_range(250.0..400.0));
            let settings = HoverSettings::for_vehicle(preset, speed);
            let rotors = settings.rotors.iter().take(1).cloned().collect();
            let settings = HoverSettings {
                seed: number as u64,
                duration_s: LENGTH_S,
                sample_rate_hz: SAMPLE_RATE_HZ as u32,
                rotors,
                ..settings
            };
            let file = folder.join(format!("{number:05}.wav"));
            write_wav(&file, settings)?;
            files.push(file);
        }
        Ok(Archive { place, files })
    }

    fn throughput(&self, few: &Archive, all: &Archive) -> Result<(), String> {
        let mut speed = Command::new(&self.program);
        speed.arg("speed").arg("--json").args(FLAGS).args(&few.files).env("RAYON_NUM_THREADS", "1");
        let single = self.cost(&mut speed)?;
        let one = self.cost(&mut self.batch(few, &self.place("one"), 1))?;
        let two = self.cost(&mut self.batch(few, &self.place("two"), 2))?;
        let large = self.cost(&mut self.batch(all, &self.place("large"), 2))?;
        println!("| run | recordings | wall s | processor s | recordings/s | MiB |");
        println!("|---|---|---|---|---|---|");
        for (name, archive, cost) in [
            ("speed --json, one core", few, &single),
            ("batch, one core", few, &one),
            ("batch, two cores", few, &two),
            ("batch, two cores", all, &large),
        ] {
            let (count, cpu) = (archive.count(), cost.cpu_s.map_or("–".to_owned(), |cpu_s| format!("{cpu_s:.1}")));
            println!(
                "| {name} | {count} | {:.1} | {cpu} | {:.2} | {:.0} |",
                cost.wall_s,
                count / cost.wall_s,
                cost.peak_mib
            );
        }
        let share = match (single.cpu_s, one.cpu_s) {
            (Some(single_s), Some(one_s)) => single_s / one_s,
            _ => single.wall_s / one.wall_s,
        };
        let bounds = [
            Bound {
                of: "throughput of batch over that of speed, on one core",
                found: share,
                asked: Asked::Min(SHARE_OF_SPEED_MIN),
            },
            Bound {
                of: "throughput on two cores over that on one",
                found: one.wall_s / two.wall_s,
                asked: Asked::Min(TWO_CORES_OVER_ONE_MIN),
            },
            Bound { of: "peak memory, MiB", found: large.peak_mib, asked: Asked::Max(PEAK_MIB_MAX) },
        ];
        println!();
        bounds.iter().for_each(|bound| println!("{}", bound.line()));
        let missed = bounds.iter().filter(|bound| !bound.is_met()).count();
        if missed > 0 {
            return Err(format!(
                "{missed} of {} bounds were not met; beside other work, two cores are not twice as fast",
                bounds.len()
            ));
        }
        Ok(())
    }

    /// Kills a batch at random moments and compares its results with those of a run that was not stopped.
    fn kills(&self, archive: &Archive) -> Result<(), String> {
        let (whole, killed) = (self.place("two"), self.place("killed"));
        let length_s = self.cost(&mut self.batch(archive, &self.place("timed"), 2))?.wall_s;
        let mut random = Pcg64::seed_from_u64(2);
        let (mut stopped, mut begun) = (0, 0);
        while stopped < KILLS {
            let mut child = quiet(&mut self.batch(archive, &killed, 2)).map_err(|error| error.to_string())?;
            begun += 1;
            // together twenty runs last as long as one that is not stopped; where one reaches its end, another archive is begun
            std::thread::sleep(Duration::from_secs_f64(length_s * random.random_range(0.0..2.0) / KILLS as f64));
            let has_ended = child.try_wait().map_err(|error| error.to_string())?.is_some();
            stopped += usize::from(!has_ended);
            child.kill().and_then(|()| child.wait().map(drop)).map_err(|error| error.to_string())?;
            if has_ended {
                fs::remove_dir_all(&killed).map_err(|error| error.to_string())?;
            }
        }
        self.cost(&mut self.batch(archive, &killed, 2))?;
        let mut names = vec!["recordings.parquet".to_owned(), "overview.html".to_owned()];
        let tracks = fs::read_dir(whole.join("tracks")).map_err(|error| error.to_string())?;
        names.extend(tracks.filter_map(|entry| Some(format!("tracks/{}", entry.ok()?.file_name().to_str()?))));
        for name in names {
            let read = |folder: &Path| fs::read(folder.join(&name)).map_err(|error| format!("{name}: {error}"));
            if read(&whole)? != read(&killed)? {
                return Err(format!("{name} differs after {stopped} kills"));
            }
        }
        println!(
            "\n{} recordings, killed in {stopped} of {begun} runs at random moments: the same bytes",
            archive.count()
        );
        Ok(())
    }

    fn batch(&self, archive: &Archive, out: &Path, threads: usize) -> Command {
        let mut command = Command::new(&self.program);
        command
            .arg("batch")
            .arg(&archive.place)
            .arg("-o")
            .arg(out)
            .args(["--threads", &threads.to_string()])
            .args(FLAGS);
        command
    }

    /// The cost of a run that hears all there is to hear.
    fn cost(&self, command: &mut Command) -> Result<Cost, String> {
        let (status, cost) = once(quiet(command))?;
        // 3: a drawn recording without a speed is an answer, too
        if status.success() || status.code() == Some(3) { Ok(cost) } else { Err(format!("a run failed: {status}")) }
    }
}

fn quiet(command: &mut Command) -> std::io::Result<Child> {
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn()
}

fn write_wav(path: &Path, settings: HoverSettings) -> Result<(), String> {
    let sample_rate = settings.sample_rate_hz;
    let (samples, _) = HoverSound::new(settings).map_err(|error| error.to_string())?.render_all();
    let spec =
        hound::WavSpec { channels: 1, sample_rate, bits_per_sample: 16, sample_format: hound::SampleFormat::Int };
    let mut writer = hound::WavWriter::create(path, spec).map_err(|error| error.to_string())?;
    for sample in samples {
        let level = (f64::from(sample) * 32_767.0).round() as i16;
        writer.write_sample(level).map_err(|error| error.to_string())?;
    }
    writer.finalize().map_err(|error| error.to_string())
}
