//! `hovertone spectrogram`: pictures of recordings.

use crate::testkit::{hovertone, steady_hover, text, write_hover, write_noise};
use hovertone_vehicle::RotorSpeed;
use std::fs;

/// Where a panel's axes lead: the values at its edges.
fn axes(svg: &str) -> Vec<[f64; 4]> {
    let drawn = roxmltree::Document::parse(svg).unwrap();
    drawn
        .descendants()
        .filter(|node| node.attribute("class") == Some("panel"))
        .map(|node| {
            ["data-x-from", "data-x-to", "data-y-from", "data-y-to"]
                .map(|name| node.attribute(name).unwrap().parse().unwrap())
        })
        .collect()
}

#[test]
fn a_recording_is_drawn_with_its_bands_and_its_ridge() {
    let folder = tempfile::tempdir().unwrap();
    let (wav, svg, png) = (folder.path().join("hover.wav"), folder.path().join("x.svg"), folder.path().join("x.png"));
    let speed = RotorSpeed::from_rev_s(60.0);
    write_hover(&wav, steady_hover("ardrone", speed, 4.0));
    let drawn = hovertone(&["spectrogram", "--order", "69", text(&wav), "-o", text(&svg)]).ends_with(0);
    assert!(!drawn.stderr.contains('±'), "{}", drawn.stderr);
    // the speed of rotors that are not separated has a large ±, and a picture has none
    let told = hovertone(&["speed", "--vehicle", "ardrone", text(&wav)]).ends_with(0).stderr;
    assert!(told.contains("could not be separated"), "{told}");
    let other = folder.path().join("other.svg");
    let of_vehicle = ["spectrogram", "--vehicle", "ardrone", text(&wav), "-o", text(&other)];
    let drawn = hovertone(&of_vehicle).ends_with(0).stderr;
    assert!(!drawn.contains("separated"), "{drawn}");
    hovertone(&["spectrogram", "--order", "69", text(&wav), "-o", text(&png), "--dpi", "150"]).ends_with(0);
    let drawing = fs::read_to_string(&svg).unwrap();
    let panels = axes(&drawing);
    assert_eq!(panels.len(), 2);
    let [from_s, to_s, hz_low, hz_high] = panels[0];
    assert!(from_s < 0.1 && to_s > 3.9 && hz_low == 0.0 && hz_high > 3.0 * 69.0 * 60.0, "{panels:?}");
    assert!(panels[1][2] < 69.0 * 60.0 && 69.0 * 60.0 < panels[1][3] && panels[1][3] < 1.2 * 69.0 * 60.0, "{panels:?}");
    assert!(
        drawing.contains("frequency / 69 (rev/s)")
            && drawing.contains("class=\"bands\"")
            && drawing.contains("class=\"track\"")
    );
    let bytes = fs::read(&png).unwrap();
    let width = u32::from_be_bytes(bytes[16..20].try_into().unwrap());
    // 180 mm at 150 dots per inch
    assert!(width.abs_diff(1063) <= 2, "{width}");
}

#[test]
fn without_a_rotor_there_is_a_picture_and_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let (wav, svg) = (folder.path().join("noise.wav"), folder.path().join("x.svg"));
    write_noise(&wav, 3.0);
    let run = hovertone(&["spectrogram", "--blades", "2", text(&wav), "-o", text(&svg)]).ends_with(3);
    assert!(run.stderr.contains("no rotor tone"), "{}", run.stderr);
    let drawing = fs::read_to_string(&svg).unwrap();
    assert_eq!(axes(&drawing).len(), 1);
    assert!(!drawing.contains("rev/s)"), "a shaft speed without a rotor");
}

#[test]
fn wrong_use_is_answered() {
    let folder = tempfile::tempdir().unwrap();
    let wav = folder.path().join("short.wav");
    write_noise(&wav, 0.02);
    let refused = |arguments: &[&str], code: i32, words: &str| {
        let run = hovertone(arguments).ends_with(code);
        assert!(run.stderr.contains(words), "{}", run.stderr);
    };
    let (jpg, png) = (folder.path().join("x.jpg"), folder.path().join("x.png"));
    refused(&["spectrogram", text(&wav), "-o", text(&jpg)], 2, ".png");
    refused(
        &["spectrogram", "--blades", "2", text(&wav), "-o", text(&png)],
        3,
        "no picture was written, because a picture needs",
    );
    refused(&["spectrogram", "--blades", "2", "nowhere.wav", "-o", text(&png)], 1, "nowhere.wav");
    refused(&["spectrogram", "--blades", "2", text(&wav)], 2, "-o PICTURE.png");
    assert!(!png.exists());
}
