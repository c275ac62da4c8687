//! What the output of `cargo test` says: programs and their times, and how many tests passed, were ignored or had nothing to test.

#[derive(Default)]
pub(super) struct TestLog {
    pub(super) passed: u32,
    pub(super) ignored: u32,
    /// The lines `skipped: …` of tests that found nothing to test, as without recordings.
    pub(super) skipped: Vec<String>,
    /// Are lines printed as they come?
    is_shown: bool,
    programs: Vec<TestProgram>,
    /// The program whose output is being read.
    running: Option<String>,
}

pub(super) struct TestProgram {
    pub(super) name: String,
    pub(super) seconds: f64,
}

impl TestLog {
    /// A log that prints the lines as they come.
    pub(super) fn shown() -> Self {
        Self { is_shown: true, ..Self::default() }
    }

    pub(super) fn add(&mut self, line: &str) {
        if self.is_shown {
            println!("{line}");
        }
        if let Some(result) = line.strip_prefix("test result: ") {
            self.passed += count_before("passed", result);
            self.ignored += count_before("ignored", result);
            let name = self.running.clone().unwrap_or_else(|| "an unknown program".to_owned());
            self.programs.push(TestProgram { name, seconds: seconds(result) });
        } else if line.starts_with("skipped:") {
            self.skipped.push(line.to_owned());
        } else if let Some(name) = program_name(line) {
            self.running = Some(name);
        }
    }

    /// The programs that ran longest, the slowest first.
    pub(super) fn slowest(&self, count: usize) -> Vec<&TestProgram> {
        let mut programs: Vec<&TestProgram> = self.programs.iter().collect();
        programs.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
        programs.truncate(count);
        programs
    }
}

/// The number before a word in the closing line of a test program.
fn count_before(word: &str, result: &str) -> u32 {
    let words: Vec<&str> = result.split_whitespace().collect();
    words.windows(2).find(|pair| pair[1].starts_with(word)).and_then(|pair| pair[0].parse().ok()).unwrap_or(0)
}

/// The time in the closing line of a test program.
fn seconds(result: &str) -> f64 {
    let time = result.rsplit_once("finished in ").map_or("", |(_, time)| time);
    time.trim_end().trim_end_matches('s').parse().unwrap_or(0.0)
}

/// The program that cargo announces: `Running tests/a.rs (target/debug/deps/a-0123)`, `Doc-tests a`.
fn program_name(line: &str) -> Option<String> {
    let line = line.trim();
    if let Some(name) = line.strip_prefix("Doc-tests ") {
        return Some(format!("documentation of {name}"));
    }
    let (source, program) = line.strip_prefix("Running ")?.strip_suffix(')')?.split_once(" (")?;
    let file = program.rsplit(['/', '\\']).next().unwrap_or(program);
    let name = file.rsplit_once('-').map_or(file, |(name, _)| name);
    Some(format!("{name} ({source})"))
}

#[cfg(test)]
mod tests {
    use super::TestLog;

    const OUTPUT: &str = "   Compiling a v0.1.0
    Finished `test` profile [optimized + debuginfo] target(s) in 1.00s
     Running unittests src/lib.rs (target/debug/deps/hovertone_signal-0b5c2a)
test a ... ok
test result: ok. 33 passed; 0 failed; 2 ignored; 0 measured; 0 filtered out; finished in 0.06s
     Running tests/rotors.rs (/elsewhere/debug/deps/rotors-77aa)
skipped: no recordings
test result: ok. 1 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 61.50s
   Doc-tests hovertone_signal
test result: ok. 4 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 2.00s";

    #[test]
    fn tests_times_and_reasons_are_read() {
        let mut log = TestLog::default();
        OUTPUT.lines().for_each(|line| log.add(line));
        assert_eq!((log.passed, log.ignored), (38, 3));
        assert_eq!(log.skipped, ["skipped: no recordings"]);
        let slowest: Vec<(&str, f64)> =
            log.slowest(2).iter().map(|program| (program.name.as_str(), program.seconds)).collect();
        assert_eq!(slowest, [("rotors (tests/rotors.rs)", 61.5), ("documentation of hovertone_signal", 2.0)]);
        assert_eq!(log.slowest(10)[2].name, "hovertone_signal (unittests src/lib.rs)");
    }

    #[test]
    fn nonsense_counts_as_nothing() {
        let mut log = TestLog::default();
        log.add("test result: nonsense");
        log.add("Running late");
        assert_eq!((log.passed, log.ignored, log.slowest(1)[0].seconds), (0, 0, 0.0));
    }
}
