//! The lines of docs/batch.md for DuckDB, Polars, pandas and pyarrow, run as they stand on the results of a batch.

use crate::report_fixture::write_rotor;
use crate::testkit::{hovertone_with, repository};
use std::fs;
use std::process::Command;

const MODULES: &str = "import duckdb, pandas, polars, pyarrow.parquet";

/// A Python with the modules: that of `HOVERTONE_PYTHON`, which must have them, or the one of the system where it does.
fn python() -> Option<String> {
    let named = std::env::var("HOVERTONE_PYTHON").ok();
    let program = named.clone().unwrap_or_else(|| "python3".to_owned());
    let has_modules = Command::new(&program).args(["-c", MODULES]).output().is_ok_and(|run| run.status.success());
    assert!(has_modules || named.is_none(), "{program} cannot {MODULES}");
    if !has_modules {
        println!("skipped: no Python with duckdb, pandas, polars and pyarrow (set HOVERTONE_PYTHON)");
    }
    has_modules.then_some(program)
}

/// What stands between ```` ```python ```` and ```` ``` ````.
fn blocks(document: &str) -> Vec<&str> {
    document.split("```python\n").skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

#[test]
fn the_lines_for_other_programs_run() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir_all(folder.path().join("archive/first")).unwrap();
    for number in 0..3 {
        let place = folder.path().join(format!("archive/first/{number}.wav"));
        write_rotor(&place, 80.0 + f64::from(number), 0.0, 2.0, number);
    }
    fs::write(folder.path().join("archive/empty.wav"), "").unwrap();
    let words = ["batch", "archive", "-o", "speeds", "--blades", "2", "--rotors", "1"];
    hovertone_with(&words, |command| command.current_dir(folder.path())).ends_with(3);
    let document = fs::read_to_string(repository().join("docs/batch.md")).unwrap();
    let blocks = blocks(&document);
    assert_eq!(blocks.len(), 4);
    let expected = ["speed_rev_s rev/s mean shaft speed", "archive/empty.wav", "rotor", "expanded"];
    for (block, expected) in blocks.into_iter().zip(expected) {
        let run = Command::new(&python).args(["-c", block]).current_dir(folder.path()).output().unwrap();
        let (out, err) = (String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
        assert!(run.status.success() && out.contains(expected), "{block}\n{out}\n{err}");
    }
}
