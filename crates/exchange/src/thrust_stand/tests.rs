//! Valid and invalid tables.

use super::*;

fn thrusts(table: &StandTable) -> Vec<f64> {
    let thrust = |row: &StandRow| match row.force {
        StandForce::Thrust { thrust_n } => thrust_n,
        StandForce::Mass { .. } => panic!("a thrust"),
    };
    table.groups.iter().flat_map(|group| &group.rows).map(thrust).collect()
}

#[test]
fn a_table_of_rcbenchmark() {
    let text = "\u{feff}Time (s),Thrust (gf),Voltage (V),Current (A),Motor Electrical Speed (RPM),Motor Optical Speed (RPM),App message,\n\
                0,-1.3,11.1,0.03,2,0,,\n1,-100.0,11.1,1,4122,0,,\n2,-400.0,11.0,2,8244,0,,\n";
    let table = table_from_csv(text).unwrap();
    assert_eq!(
        (table.speed_column.as_str(), table.force_column.as_str()),
        ("Motor Electrical Speed (RPM)", "Thrust (gf)")
    );
    assert_eq!(table.groups.len(), 1);
    let rows = &table.groups[0].rows;
    assert_eq!(rows.iter().map(|row| row.line_number).collect::<Vec<_>>(), [3, 4]);
    assert!((thrusts(&table)[1] - 0.4 * 9.80665).abs() < 1e-12);
    assert!((rows[1].power_w.unwrap() - 22.0).abs() < 1e-12 && rows[1].torque_n_m.is_none());
    assert_eq!(table.notes.len(), 2, "{:?}", table.notes);
}

#[test]
fn words_make_groups_and_uncertainties_are_read() {
    let text =
        "motor;mass_g;mass_std_g;rpm;speed_std_rpm\na;413;0.5;3610;8.9\nb;444;0.5;3742;9.7\na;462;0.5;3820;9.5\n";
    let table = table_from_csv(text).unwrap();
    assert_eq!(table.groups.iter().map(|group| group.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
    let row = table.groups[0].rows[1];
    assert_eq!(row.force, StandForce::Mass { mass_kg: 0.462 });
    assert_eq!(row.force_std, Some(0.0005));
    assert!((row.speed_std_rad_s.unwrap() - 9.5 * TAU / 60.0).abs() < 1e-12);
}

#[test]
fn of_two_speeds_the_rotors_is_fitted_and_what_is_not_used_is_named() {
    let text = "motor_rpm,rotor_rpm,mass_g,thrust_g\n31000,3610,500,413\n32200,3742,500,444\n";
    let table = table_from_csv(text).unwrap();
    assert_eq!((table.speed_column.as_str(), table.force_column.as_str()), ("rotor_rpm", "thrust_g"));
    let notes = [
        "column \"motor_rpm\" is not used: the speed comes from column \"rotor_rpm\"",
        "column \"mass_g\" is not used: the force comes from column \"thrust_g\"",
    ];
    assert_eq!(table.notes.iter().map(TableNote::to_string).collect::<Vec<_>>(), notes);
}

#[test]
fn words_that_all_differ_name_rows() {
    let names = |text: &str| -> Vec<String> {
        table_from_csv(text).unwrap().groups.into_iter().map(|group| group.name).collect()
    };
    assert_eq!(names("load,mass_g,rpm\nnone,413,3610\nsmall,444,3742\nbig,462,3820\n"), [""]);
    // the tables of loads that hovertone writes itself
    let by_method = "method,load,mass_g,rpm\na,none,413,3610\na,small,444,3742\nb,none,413,3611\nb,small,444,3743\n";
    assert_eq!(names(by_method), ["a", "b"]);
    assert_eq!(names("motor,prop,mass_g,rpm\na,x,413,3610\na,x,444,3742\nb,y,413,3611\n"), ["a, x", "b, y"]);
}

#[test]
fn what_means_nothing_is_refused_with_its_line() {
    for (text, words) in [
        ("rpm,mass_kg\n3610,0\n", ["line 2", "above 0"]),
        ("rpm,mass_kg\n3610,0.4\n3700,-0.4\n", ["line 3", "above 0"]),
        ("rpm,mass_kg\n3610,NaN\n", ["line 2", "no number"]),
        ("rpm,thrust_n\n3610,heavy\n", ["line 2", "heavy"]),
        (
            "rpm,thrust_g,thrust_std_g\n3610,1,-1\n",
            ["line 2", "-1 is negative, but a standard uncertainty must be 0 or more"],
        ),
        ("rpm,volts\n1,2\n", ["thrust", "rpm, volts"]),
        ("a,thrust_n\n1,2\n", ["speed", "a, thrust_n"]),
        ("rpm,thrust_n\n3000,0.7\n-3610,1\n", ["line 3", "-3610 is negative, but a speed must be 0 or more"]),
        ("rpm,thrust_n\n-3000,0.7\n-3610,1\n", ["line 2", "0 or more"]),
        (
            "speed_rev_s,thrust_n\n60,0.7\n3610,1\n",
            ["line 3", "3610 is too fast for a rotor, which turns at 1500 rev/s"],
        ),
        (
            "speed_rev_s,thrust_n\n50,0.5\n3000,0.7\n3610,1\n",
            ["2 of 3 numbers are too fast", "the largest one is 3610"],
        ),
        ("rpm,thrust_n\n50,0.7\n58,1\n", ["2 of 2 numbers are too slow", "the largest one is 58"]),
        ("rpm,mass_kg\n3610,0.413\n3742,444\n", ["line 3", "444 is heavier than most multirotors"]),
        ("rpm,mass_kg\n3610,413\n3742,444\n", ["2 of 2 numbers", "heavier than most multirotors"]),
        ("rpm,mass_g\n3610,0.413\n3742,0.444\n", ["2 of 2 numbers", "lighter than any multirotor"]),
        ("rpm,thrust_n\n0,0\n", ["nothing", "fit"]),
        ("rpm,thrust_n\n", ["header", "no row"]),
    ] {
        let message = table_from_csv(text).unwrap_err().to_string();
        assert!(words.iter().all(|word| message.contains(word)), "{text:?}: {message}");
    }
    assert_eq!(table_from_csv("").unwrap_err().to_string(), "this file is empty");
}

#[test]
fn a_thrust_against_the_others_is_left_out_and_said() {
    let table = table_from_csv("rpm,thrust_n\n1000,0.1\n2000,-0.4\n3000,0.9\n").unwrap();
    assert_eq!(thrusts(&table), [0.1, 0.9]);
    assert!(table.notes[0].to_string().contains("line 3"), "{:?}", table.notes);
}

#[test]
fn rows_with_an_empty_cell_are_left_out_and_said() {
    let table = table_from_csv("rpm,thrust_n\n1000,0.1\n2000,\n3000,0.9\n").unwrap();
    assert_eq!(thrusts(&table), [0.1, 0.9]);
    assert_eq!(table.notes[0].to_string(), "line 3 is left out: its speed or force is empty");
}

#[test]
fn semicolons_tabs_and_decimal_commas() {
    for text in ["rpm;thrust_n\n1000;0,1\n2000;0,4\n", "rpm\tthrust_n\n1000\t0.1\n2000\t0.4\n"] {
        assert_eq!(thrusts(&table_from_csv(text).unwrap()), [0.1, 0.4], "{text}");
    }
    assert_eq!(thrusts(&table_from_csv("rpm;thrust_n\n1000;0,100\n2000;0,400\n").unwrap()), [0.1, 0.4]);
    // "3,610" is ambiguous: a thousands separator, or a decimal comma with three decimals
    let message = table_from_csv("rpm;thrust_n\n1,000;1\n").unwrap_err().to_string();
    assert!(message.contains("\"1,000\" is no number"), "{message}");
}

#[test]
fn a_torque_in_another_unit_is_converted_and_in_none_left_out() {
    let table = table_from_csv("rpm,thrust_lbf,torque (lbf·in)\n3000,1,2\n").unwrap();
    assert!((table.groups[0].rows[0].torque_n_m.unwrap() - 2.0 * 0.112_984_829).abs() < 1e-8);
    let table = table_from_csv("rpm,thrust_n,torque\n3000,1,2\n").unwrap();
    assert_eq!(table.groups[0].rows[0].torque_n_m, None);
    assert!(table.notes[0].to_string().contains("\"torque\" is not used"), "{:?}", table.notes);
}

#[test]
fn a_column_of_scatter_is_never_the_thrust() {
    let table = table_from_csv("thrust_n_stddev,rpm,thrust_n\n0.02,1000,0.1\n0.02,2000,0.4\n").unwrap();
    assert_eq!(table.force_column, "thrust_n");
    assert_eq!(table.groups[0].rows[0].force_std, Some(0.02));
}

#[test]
fn a_sensor_at_rest_may_show_less_than_nothing() {
    let table = table_from_csv("rpm,thrust_n\n-3,0.0\n3000,0.7\n3610,1\n").unwrap();
    assert_eq!(thrusts(&table), [0.7, 1.0]);
}

/// RCbenchmark's rows end before the columns of its comments, where these are empty.
#[test]
fn a_row_may_end_after_the_last_column_that_is_used() {
    let table = table_from_csv("rpm,thrust_n,App message\n3000,1.0\n3600,1.44,\n4000,1.78,warm,\n").unwrap();
    assert_eq!(table.groups.iter().map(|group| group.rows.len()).sum::<usize>(), 3);
    for (row, cells) in [("3500", 1), ("3500,1,36,,7", 5)] {
        let error = table_from_csv(&format!("rpm,thrust_n,App message\n3000,1.0,\n{row}\n")).unwrap_err();
        let TableError::Csv(error @ CsvError::RaggedRow { line: 3, .. }) = error else { panic!("{error}") };
        let noun = if cells == 1 { "cell" } else { "cells" };
        let words = format!("the row has {cells} {noun}, but the header has 3");
        assert!(error.to_string().contains(&words), "{error}");
    }
}

#[test]
fn a_thrust_without_a_unit_is_named_and_a_torque_is_not() {
    let said = |text: &str| table_from_csv(text).unwrap_err().to_string();
    let thrust = said("rpm,torque,thrust\n3000,1,2\n");
    assert!(thrust.starts_with("column \"thrust\" has no unit that hovertone knows"), "{thrust}");
    assert!(said("rpm,torque\n3000,1\n").starts_with("no column holds a thrust"));
}

#[test]
fn long_numbers_have_an_exponent() {
    let said = table_from_csv("rpm,thrust_n\n1e305,2\n3000,2\n").unwrap_err().to_string();
    assert!(said.contains("line 2, column \"rpm\": 1e305 is too fast for a rotor"), "{said}");
}

#[test]
fn columns_of_stated_uncertainties_are_named() {
    let table = table_from_csv("rpm,thrust_g,thrust_std_g,mass_std_g\n3000,1,2,3\n4000,2,2,3\n").unwrap();
    assert_eq!(table.std_columns, ["thrust_std_g"]);
}

#[test]
fn an_uncertainty_in_percent_is_that_of_its_row() {
    let table =
        table_from_csv("rpm,speed_std_percent,thrust_g,thrust_std_%\n3000,0.1,100,1\n4000,0.2,180,2\n").unwrap();
    let row = &table.groups[0].rows[1];
    assert!((row.force_std.unwrap() / (0.18 * 9.80665) - 0.02).abs() < 1e-12);
    assert!((row.speed_std_rad_s.unwrap() / row.speed_rad_s - 0.002).abs() < 1e-12);
    let unnamed = table_from_csv("rpm,thrust_g,u_percent\n3000,100,1\n4000,180,2\n").unwrap();
    assert_eq!(unnamed.groups[0].rows[0].force_std, None);
    assert_eq!(unnamed.notes, [TableNote::QuantityMissing { column: "u_percent".to_owned() }]);
}

#[test]
fn a_row_without_the_uncertainty_of_the_others_is_refused() {
    let error = table_from_csv("rpm,thrust_g,thrust_std_g\n3000,100,1\n4000,180,\n").unwrap_err();
    assert_eq!(
        error.to_string(),
        "line 3, column \"thrust_std_g\": the cell is empty, but other rows have an uncertainty there"
    );
    // another group may state none
    let groups = "motor,rpm,thrust_g,thrust_std_g\na,3000,100,1\na,4000,180,1\nb,3000,90,\nb,4000,160,\n";
    assert_eq!(table_from_csv(groups).unwrap().groups[1].rows[0].force_std, None);
}

#[test]
fn a_note_about_rows_belongs_to_their_group() {
    let table = table_from_csv("motor,rpm,thrust_g\na,3000,100\na,4000,180\nb,3000,90\nb,,160\nb,5000,250\n").unwrap();
    let [note] = &table.notes[..] else { panic!("{:?}", table.notes) };
    assert!(note.is_of("b") && !note.is_of("a"), "{note}");
    let in_hz = table_from_csv("speed_hz,thrust_g\n50,100\n60,150\n").unwrap();
    assert_eq!(in_hz.notes, [TableNote::SpeedInHz { column: "speed_hz".to_owned() }]);
}

#[test]
fn an_expanded_uncertainty_is_divided_by_its_factor_and_said() {
    for (header, factor, advice) in [
        ("thrust_expanded_uncertainty_g", 2.0, "remove \"expanded\" from the name"),
        ("U_thrust_g", 2.0, "rename the column to \"std_thrust_g\""),
        ("thrust_uncertainty_k2_g", 2.0, "remove \"k2\" from the name"),
        ("thrust_g_std_k=2", 2.0, "remove \"k=2\" from the name"),
        ("thrust_std_g (k = 2)", 2.0, "remove \"k = 2\" from the name"),
        ("thrust_uncertainty_k=3_g", 3.0, "remove \"k=3\" from the name"),
        ("thrust_expanded_k=2.5_g", 2.5, "rename the column to \"std_thrust_g\""),
        ("thrust_uncertainty_95%_g", 2.0, "remove \"95%\" from the name"),
        ("Thrust uncertainty 99.7 % (g)", 3.0, "remove \"99.7 %\" from the name"),
        ("±thrust_g", 2.0, "rename the column to \"std_thrust_g\""),
        ("+-thrust_g", 2.0, "rename the column to \"std_thrust_g\""),
    ] {
        // the thrust is the second column, so that the first could be taken for it
        let table = table_from_csv(&format!("rpm;{header};thrust_g\n3000;2;100\n4000;3;180\n")).unwrap();
        assert_eq!(table.force_column, "thrust_g", "{header}");
        let std_n = table.groups[0].rows[0].force_std.unwrap();
        assert!((std_n - 2.0 / factor * 1e-3 * 9.80665).abs() < 1e-9, "{header}: {std_n}");
        let [note] = &table.notes[..] else { panic!("{header}: {:?}", table.notes) };
        let words =
            format!("is read as expanded uncertainties with k = {factor}, so its numbers are divided by {factor}");
        assert!(note.to_string().contains(&words) && note.hint().contains(advice), "{note} {}", note.hint());
    }
    for header in ["thrust_std_g", "std_thrust_g", "thrust_uncertainty_68%_g", "u(thrust)_g", "U_thrust_g (k=1)"] {
        let table = table_from_csv(&format!("rpm;thrust_g;{header}\n3000;100;2\n4000;180;3\n")).unwrap();
        assert!((table.groups[0].rows[0].force_std.unwrap() - 2e-3 * 9.80665).abs() < 1e-9, "{header}");
        assert!(table.notes.is_empty(), "{header}: {:?}", table.notes);
    }
    let share = table_from_csv("rpm,thrust_g,thrust_uncertainty_k=3_%\n3000,100,3\n4000,180,3\n").unwrap();
    assert!((share.groups[0].rows[0].force_std.unwrap() - 1e-3 * 9.80665).abs() < 1e-9);
}

#[test]
fn of_two_uncertainties_the_first_is_used() {
    let two = table_from_csv("rpm,thrust_g,thrust_std_g,thrust_uncertainty_g\n3000,100,1,2\n4000,180,1,3\n").unwrap();
    assert!((two.groups[0].rows[0].force_std.unwrap() - 1e-3 * 9.80665).abs() < 1e-9);
    let [note] = &two.notes[..] else { panic!("{:?}", two.notes) };
    assert_eq!(
        note.to_string(),
        "column \"thrust_uncertainty_g\" is not used: the uncertainty comes from column \"thrust_std_g\""
    );
}

#[test]
fn an_uncertainty_that_is_not_used_is_named() {
    for (header, words, advice) in [
        ("thrust_error_g", "does not say whether these are standard uncertainties", "write std into its name"),
        ("thrust_tolerance_g", "does not say whether", "as in thrust_std_n"),
        ("mass_error_g", "does not say whether", "as in thrust_uncertainty_k=2_n"),
        ("thrust_uncertainty_80%_g", "does not know the coverage \"80%\"", "in place of \"80%\""),
        ("thrust_uncertainty_k=0_g", "does not know the coverage \"k=0\"", "in place of \"k=0\""),
        ("± (g)", "does not say which quantity", "write the quantity into its name"),
    ] {
        let table = table_from_csv(&format!("rpm,thrust_g,{header}\n3000,100,2\n4000,180,3\n")).unwrap();
        assert_eq!(table.groups[0].rows[0].force_std, None, "{header}");
        let [note] = &table.notes[..] else { panic!("{header}: {:?}", table.notes) };
        assert!(note.to_string().contains(words) && note.hint().contains(advice), "{note} {}", note.hint());
    }
    // an uncertainty is never the force
    let alone = table_from_csv("rpm,±thrust_n\n3000,100\n4000,180\n").unwrap_err().to_string();
    assert!(alone.starts_with("no column holds a thrust"), "{alone}");
}

#[test]
fn a_column_of_coverage_factors_is_said_where_another_one_is_used() {
    let notes = |header: &str, k: &str| {
        table_from_csv(&format!("rpm,thrust_n,{header},k\n3000,1,0.02,{k}\n4000,2,0.03,{k}\n")).unwrap().notes
    };
    let [note] = &notes("u(thrust)_mN", "2")[..] else { panic!("one note") };
    assert_eq!(
        note.to_string(),
        "column \"k\" is not used: column \"u(thrust)_mN\" is read as uncertainties with k = 1"
    );
    assert!(note.hint().contains("into the name of column \"u(thrust)_mN\""), "{}", note.hint());
    assert!(notes("u(thrust)_mN", "1").is_empty() && notes("u(thrust)_mN", "293").is_empty());
    assert_eq!(notes("U(thrust)_mN", "2").len(), 1, "only that the numbers are divided by 2");
}

#[test]
fn rows_that_are_mostly_copies_are_said() {
    let rows = ["3000,0.7\n", "3600,1.02\n", "4000,1.25\n"];
    let notes = |rows: &str| table_from_csv(&format!("rpm,thrust_n\n{rows}")).unwrap().notes;
    let copied = TableNote::Copies { group: String::new(), count: 6, of: 9 };
    assert_eq!(notes(&rows.concat().repeat(3)), [copied]);
    assert_eq!(notes(&rows.concat().repeat(2)).len(), 1);
    // one row twice is a coincidence
    assert!(notes(&(rows.concat() + rows[0])).is_empty());
    let note = TableNote::Copies { group: String::new(), count: 6, of: 9 };
    assert!(note.to_string().starts_with("6 of 9 rows are exact copies of other rows"), "{note}");
}
