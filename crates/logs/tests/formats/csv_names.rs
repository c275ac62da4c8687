//! CSV whose headers do not tell their quantities.

use hovertone_logs::{ColumnNames, LogError, flight_from_log, log_summary};

const TEXT: &str = "Zeit;Drehzahl;Stellgröße;Notiz\n0;600;10;a\n500;660;11;b\n";

fn names(pairs: &[(&str, &str)]) -> ColumnNames {
    let mut names = ColumnNames::default();
    pairs.iter().for_each(|(header, name)| names.add(header, name).unwrap());
    names
}

#[test]
fn a_column_with_a_name_is_read_as_that_name() {
    let names = names(&[("Zeit", "time_ms"), ("Drehzahl", "rotor1_rpm"), ("Stellgröße", "motor1_pwm")]);
    let flight = flight_from_log(TEXT.as_bytes(), &names).unwrap();
    let (speeds, commands) = (flight.speeds_rev_s.unwrap(), flight.commands.unwrap());
    assert_eq!((speeds.time_s, &speeds.values[0][..]), (vec![0.0, 0.5], &[10.0, 11.0][..]));
    assert_eq!((commands.names, &commands.values[0][..]), (vec!["motor 1".to_owned()], &[10.0, 11.0][..]));
    let summary = log_summary(TEXT.as_bytes(), &names).unwrap();
    let listed: Vec<&str> = summary.tables[0].signals.iter().map(|signal| signal.signal.name.as_str()).collect();
    assert_eq!((listed, summary.has_rotor_speed()), (vec!["rotor1_rpm", "motor1_pwm", "Notiz"], true));
}

#[test]
fn names_that_fit_nothing_are_refused_with_what_to_do() {
    let mut without_meaning = ColumnNames::default();
    for name in ["speed", "time", "Drehzahl"] {
        let error = without_meaning.add("Drehzahl", name).unwrap_err();
        assert!(
            error.to_string().contains("no column name that hovertone knows") && error.hint().contains("rotor1_rpm"),
            "{error}"
        );
    }
    let error = log_summary(TEXT.as_bytes(), &names(&[("Zeit", "time_ms"), ("zeit", "time_s")])).unwrap_err();
    assert!(matches!(&error, LogError::NoSuchColumn { columns, .. } if columns == "Zeit, Drehzahl, Stellgröße, Notiz"));
    let bytes = crate::writers::dataflash::flight(1);
    let error = log_summary(&bytes[..], &names(&[("Zeit", "time_ms")])).unwrap_err();
    assert!(error.to_string().contains("have fixed names"), "{error}");
}
