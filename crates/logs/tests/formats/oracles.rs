//! Other programs read the same logs: pymavlink, orangebox and pyulog (`pip install pymavlink orangebox pyulog`).

use crate::real::real;
use crate::signals_of;
use crate::writers::{blackbox, dataflash};
use hovertone_logs::SignalTable;
use std::process::Command;

/// Prints a table row per message: its name, its instance or −, time in s, and values.
const PYMAVLINK: &str = "
import sys
from pymavlink import DFReader
log = DFReader.DFReader_binary(sys.argv[1], zero_time_base=False)
while (m := log.recv_msg()) is not None:
    if m.get_type() == 'ESC':
        print('ESC[%d]' % m.Instance, m.TimeUS * 1e-6, m.RPM / 60, m.Volt, m.Temp, m.Curr)
    elif m.get_type() == 'IMU':
        print('IMU[%d]' % m.I, m.TimeUS * 1e-6, m.GyrX, m.GyrY, m.GyrZ, m.AccX, m.AccY, m.AccZ)
    elif m.get_type() == 'RCOU':
        print('RCOU', m.TimeUS * 1e-6, m.C1, m.C2, m.C3, m.C4, m.C5, m.C6)
";
/// The same for the main frames, without their numbers and the values of slow frames; with the factors of the test's header.
const ORANGEBOX: &str = "
import sys, math
from orangebox import Parser
parser = Parser.load(sys.argv[1])
factors = {'gyro': math.tau / 360, 'eRPM': 100 / 60 / 6}
names = parser.field_names[:20]
for frame in parser.frames():
    values = frame.data[:20]
    print('main', values[1] * 1e-6, *[v * factors.get(n[:4], 1) for n, v in zip(names[2:], values[2:])])
";
const PYULOG: &str = "
import sys
from pyulog import ULog
log = ULog(sys.argv[1], ['esc_status', 'actuator_outputs'])
for d in log.data_list:
    name = d.name + ('[%d]' % d.multi_id if d.multi_id else '')
    fields = ['esc[%d].esc_rpm' % i for i in range(4)] if d.name == 'esc_status' else ['output[%d]' % i for i in range(16)]
    scale = 1 / 60 if d.name == 'esc_status' else 1
    for row in range(len(d.data['timestamp'])):
        print(name, d.data['timestamp'][row] * 1e-6, *[float(d.data[f][row]) * scale for f in fields])
";

/// A row as another program reads it.
struct Row {
    table: String,
    numbers: Vec<f64>,
}

/// The rows that a script prints about a log; `None` without the program, which is said on a line that the run counts.
fn rows_by(script: &str, program: &str, log: &[u8]) -> Option<Vec<Row>> {
    let folder = tempfile::tempdir().unwrap();
    // pymavlink tells the kind of a log by its name
    let path = folder.path().join("log.bin");
    std::fs::write(&path, log).unwrap();
    let python = std::env::var("HOVERTONE_TEST_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has_program = Command::new(&python).args(["-c", &format!("import {program}")]).output();
    if !has_program.is_ok_and(|output| output.status.success()) {
        println!("skipped: {python} has no {program} (set HOVERTONE_TEST_PYTHON)");
        return None;
    }
    let output = Command::new(&python).args(["-c", script]).arg(&path).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let row = |line: &str| {
        let (table, numbers) = line.split_once(' ').unwrap();
        Row { table: table.to_owned(), numbers: numbers.split(' ').map(|number| number.parse().unwrap()).collect() }
    };
    Some(text.lines().map(row).collect())
}

/// Asserts that the rows of a table are the same, in the sequence of the log; returns their number. `columns` are the compared signals.
fn assert_same(table: &SignalTable, rows: &[Row], columns: &[usize]) -> usize {
    let of_table: Vec<&Row> = rows.iter().filter(|row| row.table == table.name).collect();
    assert_eq!(of_table.len(), table.time_s.len(), "{}", table.name);
    for (at, row) in of_table.iter().enumerate() {
        assert!((row.numbers[0] - table.time_s[at]).abs() < 1e-9, "{} row {at}", table.name);
        for (&column, number) in columns.iter().zip(&row.numbers[1..]) {
            let value = table.values[column][at];
            let is_gap = value.is_nan() && number.is_nan();
            assert!(
                is_gap || (value - number).abs() <= 1e-9 * number.abs().max(1.0),
                "{} row {at}: {value} {number}",
                table.name
            );
        }
    }
    of_table.len()
}

#[test]
#[ignore = "exam: needs Python with pymavlink"]
fn pymavlink_reads_the_same_from_dataflash() {
    let bytes = dataflash::flight(5);
    let Some(rows) = rows_by(PYMAVLINK, "pymavlink", &bytes) else { return };
    let log = signals_of(&bytes);
    // pymavlink leaves a temperature of type h in its unit, as the log says
    let tables = log.tables.iter();
    let compared: usize = tables
        .map(|table| match table.name.starts_with("ESC") {
            true => assert_same(table, &without_temperature(&rows), &[0, 1, 3]),
            false => assert_same(table, &rows, &[0, 1, 2, 3, 4, 5]),
        })
        .sum();
    assert_eq!(compared, 5 * (2 * 100 + 50 + 4 * 10));
}

/// ESC rows without the temperature, whose factor of 0.01 pymavlink leaves to the reader.
fn without_temperature(rows: &[Row]) -> Vec<Row> {
    let kept = |row: &Row| {
        let mut numbers = row.numbers.clone();
        if row.table.starts_with("ESC") {
            numbers.remove(3);
        }
        Row { table: row.table.clone(), numbers }
    };
    rows.iter().map(kept).collect()
}

#[test]
#[ignore = "exam: needs Python with orangebox"]
fn orangebox_reads_the_same_from_blackbox() {
    let bytes = blackbox::flight(8000);
    let Some(rows) = rows_by(ORANGEBOX, "orangebox", &bytes) else { return };
    let log = signals_of(&bytes);
    let columns: Vec<usize> = (0..18).collect();
    assert_eq!(assert_same(&log.tables[0], &rows, &columns), 4000);
}

#[test]
#[ignore = "exam: needs Python with pyulog"]
fn pyulog_reads_the_same_from_a_real_flight() {
    let Some(bytes) = real("px4_esc_status.ulg") else { return };
    let Some(rows) = rows_by(PYULOG, "pyulog", &bytes) else { return };
    let log = signals_of(&bytes);
    let mut compared = 0;
    for table in log.tables.iter().filter(|table| rows.iter().any(|row| row.table == table.name)) {
        let is_compared = |name: &str| match table.name.starts_with("esc_status") {
            true => name.ends_with("esc_rpm"),
            false => name.starts_with("output["),
        };
        let columns: Vec<usize> = (0..table.signals.len()).filter(|at| is_compared(&table.signals[*at].name)).collect();
        compared += assert_same(table, &rows, &columns[..columns.len().min(16)]);
    }
    assert!(compared > 1000, "{compared}");
}
