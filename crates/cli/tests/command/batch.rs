//! `hovertone batch`: one row for each recording, the same bytes however it is run, and nothing lost when it is killed.

mod doubts;
mod inputs;
mod overview;

use crate::report_fixture::write_rotor;
use crate::testkit::{Run, hovertone, refused_with, text, write_noise};
use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, RecordBatch};
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// The first rows of a table.
fn table(path: &Path) -> RecordBatch {
    let mut batches = ParquetRecordBatchReaderBuilder::try_new(File::open(path).unwrap()).unwrap().build().unwrap();
    batches.next().unwrap().unwrap()
}

fn texts(table: &RecordBatch, name: &str) -> Vec<String> {
    let column = table.column_by_name(name).unwrap().as_string::<i32>();
    column.iter().map(|text| text.unwrap_or_default().to_owned()).collect()
}

/// Short recordings of one rotor each.
fn write_archive(folder: &Path, count: u32) {
    for number in 0..count {
        let place = folder.join(format!("flight {}/{number}.wav", number % 3));
        fs::create_dir_all(place.parent().unwrap()).unwrap();
        write_rotor(&place, 80.0 + f64::from(number), 0.0, 1.0, number);
    }
}

fn batch(archive: &Path, out: &Path, more: &[&str]) -> Run {
    let words = ["batch", text(archive), "-o", text(out), "--blades", "2", "--rotors", "1"];
    hovertone(&[&words[..], more].concat())
}

/// The bytes of all results.
fn results(out: &Path) -> Vec<(String, Vec<u8>)> {
    let tracks = fs::read_dir(out.join("tracks")).unwrap().map(|entry| entry.unwrap().path());
    let mut places: Vec<PathBuf> =
        tracks.chain(["recordings.parquet", "overview.html"].map(|name| out.join(name))).collect();
    places.sort();
    places.iter().map(|place| (text(place.strip_prefix(out).unwrap()).to_owned(), fs::read(place).unwrap())).collect()
}

#[test]
fn each_recording_is_a_row_with_the_numbers_of_speed() {
    let folder = tempfile::tempdir().unwrap();
    let (archive, out) = (folder.path().join("archive"), folder.path().join("out"));
    write_archive(&archive, 4);
    write_noise(&archive.join("noise.wav"), 1.0);
    fs::write(archive.join("empty.mp4"), "").unwrap();
    fs::write(archive.join("text.wav"), "this is no sound").unwrap();
    fs::write(archive.join("notes.md"), "no recording").unwrap();
    let run = batch(&archive, &out, &["--json"]).ends_with(3);
    assert_eq!(run.json_lines()[0]["counts"]["error"], 2);
    let unsure = run.stderr.lines().find(|line| line.contains("1 recording has no speed: ")).unwrap_or_default();
    assert!(unsure.contains("noise.wav") && unsure.contains("this recording and the same flags"), "{}", run.stderr);
    let rows = table(&out.join("recordings.parquet"));
    let files = texts(&rows, "file");
    assert_eq!(files.len(), 7, "{files:?}");
    assert!(files.is_sorted());
    let words: Vec<&str> = files.iter().map(String::as_str).collect();
    let speed = hovertone(&[&["speed", "--json", "--blades", "2", "--rotors", "1"], &words[..]].concat());
    let mut known = 0;
    for (row, said) in speed.json_lines().iter().enumerate() {
        assert_eq!(said["file"], files[row].as_str());
        for name in ["status", "method", "reason", "rotors_heard"] {
            assert_eq!(texts(&rows, name)[row], said[name].as_str().unwrap_or_default(), "{name} of {}", files[row]);
        }
        for name in [
            "order",
            "tone_hz",
            "speed_rev_s",
            "speed_rpm",
            "speed_rad_s",
            "std_uncertainty_rev_s",
            "spread_rev_s",
            "combined_std_uncertainty_rev_s",
            "mean_square_rad2_s2",
            "from_s",
            "to_s",
            "window_s",
        ] {
            let column = rows.column_by_name(name).unwrap().as_primitive::<Float64Type>();
            let value = column.is_valid(row).then(|| column.value(row));
            // the shortest text that reads back exactly is the same for the same bits
            assert_eq!(serde_json::to_string(&value).unwrap(), said[name].to_string(), "{name} of {}", files[row]);
            known += usize::from(value.is_some());
        }
        let facts = rows.column_by_name("recording").unwrap().as_struct();
        let sha256 = facts.column_by_name("sha256").unwrap().as_string::<i32>();
        assert_eq!(facts.is_valid(row).then(|| sha256.value(row)), said["recording"]["sha256"].as_str());
    }
    assert!(known >= 40, "{known} numbers were compared");
    let classes = texts(&rows, "error_class");
    let class = |name: &str| classes[files.iter().position(|file| file.ends_with(name)).unwrap()].as_str();
    assert_eq!([class("empty.mp4"), class("text.wav"), class("noise.wav")], ["empty", "unknown_format", ""]);
    has_tracks_of(&out, &files);
    let page = fs::read_to_string(out.join("overview.html")).unwrap();
    assert_eq!(page.matches("<img ").count(), 5, "one picture for each recording that could be read");
    overview::has_a_page_that_sorts(&out, &files);
}

/// The tracks are those of `speed --track`, point by point.
fn has_tracks_of(out: &Path, files: &[String]) {
    let csv = out.join("track.csv");
    let words: Vec<&str> = files.iter().map(String::as_str).collect();
    hovertone(&[&["speed", "--blades", "2", "--rotors", "1", "--track", text(&csv)], &words[..]].concat());
    let tracks = table(&out.join("tracks/part-00000.parquet"));
    let of_file = texts(&tracks, "file");
    let numbers = |name: &str| tracks.column_by_name(name).unwrap().as_primitive::<Float64Type>().clone();
    let columns = ["time_s", "tone_hz", "speed_rev_s", "std_uncertainty_rev_s", "level_db"].map(numbers);
    let rows: Vec<csv::StringRecord> = csv::Reader::from_path(&csv).unwrap().records().map(Result::unwrap).collect();
    assert!(rows.len() >= 20 && rows.len() == tracks.num_rows(), "{} and {}", rows.len(), tracks.num_rows());
    for (index, row) in rows.iter().enumerate() {
        assert_eq!(&row[0], of_file[index].as_str());
        for (column, cell) in columns.iter().zip(row.iter().skip(1)) {
            assert_eq!(column.value(index), cell.parse::<f64>().unwrap());
        }
    }
}

#[test]
fn columns_have_their_unit_in_the_schema() {
    let folder = tempfile::tempdir().unwrap();
    let (archive, out) = (folder.path().join("archive"), folder.path().join("out"));
    write_archive(&archive, 1);
    batch(&archive, &out, &[]).ends_with(0);
    let unit =
        |rows: &RecordBatch, name: &str| rows.schema().field_with_name(name).unwrap().metadata().get("unit").cloned();
    let rows = table(&out.join("recordings.parquet"));
    assert_eq!(unit(&rows, "speed_rev_s").unwrap(), "rev/s");
    assert_eq!(unit(&table(&out.join("tracks/part-00000.parquet")), "level_db").unwrap(), "dB");
    assert!(rows.schema().fields().iter().all(|field| field.metadata().contains_key("meaning")));
    let bytes = fs::read(out.join("recordings.parquet")).unwrap();
    assert!(bytes.windows(18).any(|word| word == b"hovertone.settings"), "the settings stand in the file");
}

#[test]
fn the_bytes_do_not_depend_on_threads_and_jobs() {
    let folder = tempfile::tempdir().unwrap();
    let archive = folder.path().join("archive");
    write_archive(&archive, 7);
    fs::write(archive.join("text.wav"), "this is no sound").unwrap();
    let [one, four, jobs] = ["one", "four", "jobs"].map(|name| folder.path().join(name));
    batch(&archive, &one, &["--threads", "1"]).ends_with(3);
    batch(&archive, &four, &["--threads", "4"]).ends_with(3);
    assert_eq!(results(&one), results(&four));
    for job in ["2/3", "3/3"] {
        batch(&archive, &jobs, &["--shard", job]);
        assert!(!jobs.join("recordings.parquet").exists(), "job 1 has not ended");
    }
    let last = batch(&archive, &jobs, &["--shard", "1/3"]).ends_with(3);
    assert!(last.stdout.contains("8 recordings"), "{}", last.stdout);
    assert_eq!(results(&one), results(&jobs));
}

/// Killed again and again, also while tables are written, a batch gives the bytes of one that was never stopped.
#[cfg(unix)]
#[test]
fn a_killed_batch_goes_on_and_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let archive = folder.path().join("archive");
    write_archive(&archive, 12);
    fs::write(archive.join("text.wav"), "this is no sound").unwrap();
    let (whole, out) = (folder.path().join("whole"), folder.path().join("out"));
    batch(&archive, &whole, &[]).ends_with(3);
    let (mut killed, mut part_done) = (0, 0);
    // a run is killed as soon as so many recordings are finished, whatever the speed of the machine
    for finished in [0, 1, 2, 4, 5, 7, 9, 10] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hovertone"));
        command.args(["batch", text(&archive), "-o", text(&out), "--blades", "2", "--rotors", "1"]);
        let mut run = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let is_far = || out.join("parts").exists() && walk(&out.join("parts")).len() >= finished;
        while run.try_wait().unwrap().is_none() && !is_far() {
            std::thread::sleep(Duration::from_millis(1));
        }
        killed += u32::from(run.try_wait().unwrap().is_none());
        run.kill().unwrap();
        run.wait().unwrap();
        part_done += u32::from(out.join("parts").exists() && !out.join("recordings.parquet").exists());
    }
    assert!(killed >= 3 && part_done >= 1, "killed {killed} times, {part_done} times with a part of the recordings");
    let run = batch(&archive, &out, &[]).ends_with(3);
    assert_eq!(results(&whole), results(&out), "{}", run.stdout);
    let left = walk(&out).into_iter().filter(|path| text(path).ends_with("unfinished")).count();
    assert_eq!(left, 0);
}

fn walk(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { walk(&path) } else { vec![path] }).collect()
}

#[test]
fn new_and_changed_recordings_are_heard_and_no_others() {
    let folder = tempfile::tempdir().unwrap();
    let (archive, out) = (folder.path().join("archive"), folder.path().join("out"));
    write_archive(&archive, 3);
    fs::write(archive.join("broken.wav"), "this is no sound").unwrap();
    let heard = |more: &[&str]| {
        let more = [more, &["--json"]].concat();
        batch(&archive, &out, &more).json_lines()[0]["heard_count"].as_u64().unwrap()
    };
    assert_eq!(heard(&[]), 4);
    assert_eq!(heard(&[]), 0);
    assert_eq!(heard(&["--retry"]), 1, "the one that could not be heard");
    write_rotor(&archive.join("flight 0/0.wav"), 120.0, 0.0, 1.5, 9);
    write_rotor(&archive.join("new.wav"), 90.0, 0.0, 1.0, 10);
    assert_eq!(heard(&[]), 2);
    let rows = table(&out.join("recordings.parquet"));
    assert_eq!(rows.num_rows(), 5);
    let speeds = rows.column_by_name("speed_rev_s").unwrap().as_primitive::<Float64Type>();
    let changed = texts(&rows, "file").iter().position(|file| file.ends_with("0/0.wav")).unwrap();
    assert!((speeds.value(changed) - 120.0).abs() < 0.1);
    fs::remove_file(archive.join("new.wav")).unwrap();
    assert_eq!(heard(&[]), 0);
    assert_eq!(table(&out.join("recordings.parquet")).num_rows(), 4);
}

#[test]
fn a_folder_of_something_else_is_refused_with_what_differs() {
    let folder = tempfile::tempdir().unwrap();
    let (archive, out, full) = (folder.path().join("archive"), folder.path().join("out"), folder.path().join("full"));
    write_archive(&archive, 2);
    fs::create_dir(&full).unwrap();
    fs::write(full.join("notes.txt"), "precious").unwrap();
    refused_with(
        &["batch", text(&archive), "-o", text(&full)],
        &["has files that do not come from an earlier run", "-o DIR"],
    );
    assert_eq!(fs::read_dir(&full).unwrap().count(), 1, "nothing was written");
    batch(&archive, &out, &[]).ends_with(0);
    let words = ["batch", text(&archive), "-o", text(&out), "--rotors", "1", "--blades"];
    refused_with(
        &[&words[..], &["3"]].concat(),
        &["other recordings or settings", "(blades: 2 in the earlier run, 3 in this run)"],
    );
    refused_with(
        &["batch", text(&archive.join("flight 0")), "-o", text(&out), "--blades", "2"],
        &["inputs: ", "in this run"],
    );
    let before = results(&out);
    // what a person wrote beside the results stays
    fs::write(out.join("notes.txt"), "mine").unwrap();
    hovertone(&[&words[..], &["3", "--force"]].concat());
    assert!(results(&out) != before && out.join("notes.txt").exists());
    let parts = walk(&out.join("parts"));
    assert_eq!(parts.len(), 2, "those of the earlier settings are gone: {parts:?}");
    let recordings = out.join("recordings.parquet");
    fs::write(&recordings, "mine").unwrap();
    refused_with(&[&words[..], &["3"]].concat(), &["recordings.parquet", "was changed"]);
    assert_eq!(fs::read_to_string(&recordings).unwrap(), "mine");
}

#[test]
fn parts_of_recordings_that_are_gone_or_changed_are_removed_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let (archive, out) = (folder.path().join("archive"), folder.path().join("out"));
    write_archive(&archive, 4);
    batch(&archive, &out, &[]).ends_with(0);
    let parts = || walk(&out.join("parts"));
    let before = parts();
    let not_ours = ["mine.part", "mine.txt"].map(|name| before[0].with_file_name(name));
    not_ours.iter().for_each(|place| fs::write(place, "mine").unwrap());
    write_rotor(&archive.join("flight 0/0.wav"), 95.0, 0.0, 1.5, 7);
    fs::remove_file(archive.join("flight 1/1.wav")).unwrap();
    // one of several jobs does not know what the others need
    batch(&archive, &out, &["--shard", "1/1000"]);
    batch(&archive, &out, &["--shard", "2/1000"]);
    assert!(before.iter().all(|part| part.exists()));
    batch(&archive, &out, &[]).ends_with(0);
    let after = parts();
    assert_eq!(after.len(), 3 + not_ours.len(), "{after:?}");
    assert_eq!(before.iter().filter(|part| after.contains(part)).count(), 2);
    assert!(not_ours.iter().all(|place| place.exists()));
}

#[cfg(not(feature = "stores"))]
#[test]
fn a_build_without_stores_says_how_to_read_addresses() {
    let folder = tempfile::tempdir().unwrap();
    let list = folder.path().join("list.txt");
    fs::write(&list, "https://host/hover.wav\n").unwrap();
    for input in ["s3://bucket/flights", "https://host/list.txt", text(&list)] {
        refused_with(&["batch", input, "-o", "none"], &["built without stores", "--features stores"]);
    }
}

#[test]
fn a_second_run_in_the_same_folder_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (archive, out) = (folder.path().join("archive"), folder.path().join("out"));
    write_archive(&archive, 6);
    batch(&archive, &out, &["--shard", "1/100"]);
    let lock = File::options().append(true).open(out.join(".run.hovertone-lock")).unwrap();
    lock.lock_shared().unwrap();
    let run = batch(&archive, &out, &[]).ends_with(1);
    assert!(run.stderr.contains("another run of hovertone"), "{}", run.stderr);
    // one job cannot begin again for all: --force is refused beside --shard
    let other = batch(&archive, &out, &["--shard", "1/100", "--channel", "1"]).ends_with(2);
    assert!(other.stderr.contains("for all jobs, or remove this folder"), "{}", other.stderr);
    assert!(!other.stderr.contains("--force"), "{}", other.stderr);
    // a job beside other jobs is none
    batch(&archive, &out, &["--shard", "2/100"]).ends_with(0);
    drop(lock);
    batch(&archive, &out, &[]).ends_with(0);
}

#[test]
fn a_damaged_part_is_heard_again() {
    let folder = tempfile::tempdir().unwrap();
    let (archive, out) = (folder.path().join("archive"), folder.path().join("out"));
    write_archive(&archive, 3);
    batch(&archive, &out, &[]).ends_with(0);
    let before = results(&out);
    let part = walk(&out.join("parts")).remove(0);
    let bytes = fs::read(&part).unwrap();
    fs::write(&part, &bytes[..bytes.len() / 2]).unwrap();
    let run = batch(&archive, &out, &[]).ends_with(1);
    assert!(run.stderr.contains("is damaged and is removed now") && run.stderr.contains("run the same command again"));
    batch(&archive, &out, &[]).ends_with(0);
    assert_eq!(before, results(&out));
}

#[test]
fn a_comparison_names_what_has_changed() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for (archive, factor) in [("old", 1.0), ("new", 1.002)] {
        fs::create_dir(at(archive)).unwrap();
        for number in 0..5 {
            let speed_rev_s = (80.0 + 5.0 * f64::from(number)) * if number == 4 { 1.0 } else { factor };
            write_rotor(&at(archive).join(format!("{number}.wav")), speed_rev_s, 0.0, 2.0, number);
        }
        batch(&at(archive), &at(&format!("out_{archive}")), &[]).ends_with(0);
    }
    let words = ["batch-compare", text(&at("out_old")), text(&at("out_new"))].map(str::to_owned);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let drift = &hovertone(&[&words[..], &["--json"]].concat()).ends_with(0).json_lines()[0];
    assert_eq!(drift["is_paired"], true);
    let changed: Vec<bool> =
        drift["recordings"].as_array().unwrap().iter().map(|row| row["has_changed"] == true).collect();
    assert_eq!(changed, [true, true, true, true, false], "{drift}");
    let told = hovertone(&words).ends_with(0).stdout;
    assert!(told.contains("mean of all") && told.contains("3.wav") && !told.contains("4.wav"), "{told}");
    // the same folder twice is a slip; a batch of the same recordings is unchanged
    refused_with(&["batch-compare", words[1], words[1]], &["is given twice", "the earlier batch"]);
    batch(&at("old"), &at("again"), &[]).ends_with(0);
    let itself = &hovertone(&["batch-compare", words[1], text(&at("again")), "--json"]).ends_with(0).json_lines()[0];
    assert_eq!(itself["rotors"][0]["has_changed"], false);
    assert!(itself["is_labelled"] == false && itself["rotors"][0]["is_rotor_known"] == true, "{itself}");
    let none = hovertone(&["batch-compare", text(&at("old")), words[2]]).ends_with(1);
    assert!(none.stderr.contains("`hovertone batch` did not write this folder"), "{}", none.stderr);
    fs::remove_file(at("out_old").join("recordings.parquet")).unwrap();
    let begun = hovertone(&words).ends_with(1).stderr;
    assert!(begun.contains("its batch has not ended (hint: run the same `hovertone batch` command again"), "{begun}");
}

/// A name that is no text in UTF-8 is shown as well as it can be, and its recording is heard.
#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_no_text_is_heard() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let (archive, out) = (folder.path().join("archive"), folder.path().join("out"));
    write_archive(&archive, 1);
    let odd = std::ffi::OsStr::from_bytes(b"fl\xffght.wav");
    fs::copy(archive.join("flight 0/0.wav"), archive.join(odd)).unwrap();
    batch(&archive, &out, &[]).ends_with(0);
    let files = texts(&table(&out.join("recordings.parquet")), "file");
    assert!(files.len() == 2 && files[1].ends_with("fl\u{fffd}ght.wav"), "{files:?}");
}

#[test]
fn the_progress_bar_has_the_counts_and_the_time_left() {
    let folder = tempfile::tempdir().unwrap();
    let (archive, out) = (folder.path().join("archive"), folder.path().join("out"));
    write_archive(&archive, 4);
    fs::write(archive.join("text.wav"), "this is no sound").unwrap();
    let program = env!("CARGO_BIN_EXE_hovertone");
    let line = format!("stty cols 100 rows 24; '{program}' batch '{}' -o '{}' --blades 2", text(&archive), text(&out));
    let run = Command::new("script").args(["-qec", &line, "/dev/null"]).stdin(Stdio::null()).output();
    let Ok(output) = run else {
        println!("skipped: no `script` of util-linux");
        return;
    };
    let shown = String::from_utf8_lossy(&output.stdout).into_owned();
    for words in ["hearing 5 recordings", " of 5: ", " with a speed, 0 without a speed, ", " left"] {
        assert!(shown.contains(words), "{words}: {shown}");
    }
}
