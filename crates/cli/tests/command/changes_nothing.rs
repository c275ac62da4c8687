//! Flags that change nothing are refused, or said to change nothing.

use crate::testkit::refused_with;

#[test]
fn a_flag_that_changes_nothing_is_refused() {
    let speed = ["speed", "a.wav", "--blades", "2"];
    refused_with(&[&speed[..], &["--hop-share", "0.3"]].concat(), &["--hop-share changes nothing", "maximum_trace"]);
    refused_with(&[&speed[..], &["--window-s", "0.1"]].concat(), &["--window-s changes nothing", "maximum_trace"]);
    let trace = [&speed[..], &["--method", "maximum_trace", "--gaussian-threshold-share", "0.5"]].concat();
    refused_with(&trace, &["--gaussian-threshold-share changes nothing", "give --method gaussian"]);
    let plan = ["fit", "--plan", "--mass-kg", "0.413"];
    for flag in ["--temperature-c", "--pressure-hpa", "--humidity-percent"] {
        refused_with(&[&plan[..], &[flag, "20"]].concat(), &[flag, "a plan does not use the air"]);
    }
    refused_with(&[&plan[..], &["--height-m", "20"]].concat(), &["--height-m 20 alone does not tell gravity"]);
}

#[test]
fn a_check_and_a_picture_refuse_what_only_a_table_shows() {
    let verify = ["verify", "a.wav", "log.csv", "--vehicle", "ardrone"];
    let picture = ["spectrogram", "a.wav", "-o", "never.svg", "--vehicle", "ardrone"];
    for flags in [&["--condition"][..], &["--clock-ppm", "9"], &["--drift-m-max", "2"], &["--radial-speed-m-s-max", "2"]] {
        for command in [&verify[..], &picture[..]] {
            refused_with(&[command, flags].concat(), &[&format!("{} changes nothing", flags[0])]);
        }
    }
    refused_with(&[&picture[..], &["--dpi", "600"]].concat(), &["--dpi 600 changes nothing", ".png"]);
}
