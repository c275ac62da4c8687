//! What a log holds, and its signals row by row.

use crate::writers::{blackbox, dataflash};
use hovertone_logs::{ColumnNames, LogError, SignalRole, log_summary, signal_rows};

#[test]
fn rates_spans_and_ranges_are_those_of_the_flight() {
    let log = log_summary(&dataflash::flight(3)[..], &ColumnNames::default()).unwrap();
    let table = |name: &str| log.tables.iter().find(|table| table.name == name).unwrap();
    for (name, rate_hz, span_s, rows) in
        [("IMU[0]", 100.0, [1.0, 3.99], 300), ("RCOU", 50.0, [1.0, 3.98], 150), ("ESC[1]", 10.0, [1.0005, 3.9005], 30)]
    {
        let table = table(name);
        assert!((table.rate_hz.unwrap() - rate_hz).abs() < 1e-6, "{name}");
        let found_s = table.span_s.unwrap();
        assert!((0..2).all(|at| (found_s[at] - span_s[at]).abs() < 1e-9), "{name}: {found_s:?}");
        assert_eq!(table.row_count, rows, "{name}");
    }
    let speed = &table("ESC[3]").signals[0];
    let range = speed.range.unwrap();
    assert_eq!(speed.signal.role, Some(SignalRole::RotorSpeed(4)));
    assert!(range.low > 3600.0 / 60.0 && range.high < 4150.0 / 60.0, "{range:?}");
    assert!(log.has_rotor_speed());
}

#[test]
fn an_esc_that_never_turns_is_no_rotor_speed() {
    let mut log = dataflash::Writer::new(&[]);
    (0..10).for_each(|step| log.esc(1000 * step, 0, 0.0));
    let summary = log_summary(&log.bytes[..], &ColumnNames::default()).unwrap();
    assert!(!summary.has_rotor_speed() && summary.tables.len() == 1);
}

#[test]
fn signals_of_one_table_come_row_by_row() {
    let bytes = blackbox::flight(1000);
    let rows_of = |wanted: &[&str]| {
        let wanted: Vec<String> = wanted.iter().map(|name| (*name).to_owned()).collect();
        let (mut rows, mut width) = (0, 0);
        let loss = signal_rows(&bytes[..], &ColumnNames::default(), &wanted, |row| {
            (rows, width) = (rows + 1, row.values.len());
            assert_eq!(row.signals.len(), row.values.len());
            Ok(())
        });
        loss.map(|_| (rows, width))
    };
    assert_eq!(rows_of(&["main.motor[1]", "main.eRPM[0]"]).unwrap(), (500, 2));
    assert_eq!(rows_of(&["main", "main.eRPM[0]"]).unwrap(), (500, 18));
    let error = rows_of(&["main.motor[9]"]).unwrap_err();
    assert!(error.to_string().contains("no signal \"main.motor[9]\""), "{error}");
    let bytes = dataflash::flight(1);
    let wanted = ["ESC[0].RPM".to_owned(), "ESC[1].RPM".to_owned()];
    let error = signal_rows(&bytes[..], &ColumnNames::default(), &wanted, |_| Ok(())).unwrap_err();
    assert!(matches!(error, LogError::SeveralTables { .. }) && error.hint().contains("the signals of one table"));
    let full = |_: &hovertone_logs::SignalRow| Err(std::io::Error::other("the disk is full"));
    let error = signal_rows(&bytes[..], &ColumnNames::default(), &wanted[..1], full).unwrap_err();
    assert!(error.to_string().contains("the disk is full"), "{error}");
}
