//! The questions of `hovertone init`, for what the flags leave out.

use super::dialog::Dialog;
use crate::args::{gear, length_m};
use crate::draft::{Draft, LoadDraft, mass_kg_from_text, mass_words, put_load};
use crate::failure::Failure;
use crate::nearest::nearest;
use crate::recording_files::{RecordingGroup, groups_below, groups_in, recordings_of};
use crate::vehicles::known_vehicles;
use hovertone::vehicle::PROPELLER_DIAMETER_M;
use hovertone_report::{counted, printable, wrapped};
use hovertone_vehicle::{BLADE_COUNT_MAX, Contradiction, Gear, ROTORS_MAX, SaidOfVehicle, Vehicle};
use std::io::{BufRead, Write};
use std::path::Path;

/// Number of rotors of most multirotors: offered, never assumed.
const ROTORS_OFFERED: u32 = 4;
/// Columns of a long line.
const WIDTH: usize = 80;

/// Asks for everything that the draft lacks. Recordings are looked for in `folder`.
pub(super) fn complete<R: BufRead, W: Write>(
    mut draft: Draft,
    folder: &Path,
    dialog: &mut Dialog<R, W>,
) -> Result<Draft, Failure> {
    dialog.say("hovertone asks a few questions, then writes the experiment file. Press Enter to take the answer in brackets.\n");
    let known = known_vehicles()?;
    if draft.preset.is_none() && draft.blades.is_none() && draft.gear.is_none() {
        draft.preset = ask_vehicle(&known, dialog)?;
    }
    let vehicle = draft.preset.as_deref().and_then(|id| known.iter().find(|vehicle| vehicle.id == id));
    if draft.missing(vehicle).iter().any(|flag| flag.contains("--blades")) {
        draft.blades = Some(dialog.ask("Blades of each propeller:", |answer| number(answer, None, BLADE_COUNT_MAX))?);
        if vehicle.is_none() && draft.gear.is_none() {
            let question = "Gear between motor and rotor, as numbers of teeth PINION:WHEEL, such as 8:69 [none]:";
            draft.gear = dialog.ask(question, gear_of)?;
        }
    }
    if vehicle.is_none() && draft.rotors.is_none() {
        let question = format!("Rotors [{ROTORS_OFFERED}]:");
        draft.rotors = Some(dialog.ask(&question, |answer| number(answer, Some(ROTORS_OFFERED), ROTORS_MAX))?);
    }
    let knows_diameter = vehicle.is_some_and(|vehicle| vehicle.propeller_diameter_m.is_some());
    if draft.diameter_m.is_none() && !knows_diameter {
        dialog.say("\nWith the diameter of the propellers, hovertone can rule out half and double the true speed.");
        draft.diameter_m = dialog.ask(
            "Diameter of a propeller from tip to tip, such as 200mm, 8in or 0.2 (in m) [not known]:",
            diameter_m,
        )?;
    }
    if draft.loads.is_empty() {
        draft.loads = ask_loads(vehicle, folder, dialog)?;
    }
    dialog.say("");
    Ok(draft)
}

fn ask_vehicle<R: BufRead, W: Write>(known: &[Vehicle], dialog: &mut Dialog<R, W>) -> Result<Option<String>, Failure> {
    let names: Vec<&str> = known.iter().map(|vehicle| vehicle.id).collect();
    wrapped(&format!("Known vehicles: {}", names.join(", ")), WIDTH).iter().for_each(|line| dialog.say(line));
    dialog.ask("Vehicle [none of these]:", |answer| match answer {
        None => Ok(None),
        Some(typed) if names.contains(&typed) => Ok(Some(typed.to_owned())),
        Some(typed) => Err(match nearest(typed, names.iter().copied()) {
            Some(name) => format!("There is no vehicle \"{typed}\". Did you mean \"{name}\"?"),
            None => format!("There is no vehicle \"{typed}\". Press Enter to go on without a known vehicle."),
        }),
    })
}

/// The recordings that are in the folder, with a mass each; then any others.
fn ask_loads<R: BufRead, W: Write>(
    vehicle: Option<&Vehicle>,
    folder: &Path,
    dialog: &mut Dialog<R, W>,
) -> Result<Vec<LoadDraft>, Failure> {
    let mut loads = Vec::new();
    let found = offered(folder);
    if !found.is_empty() {
        dialog.say(
            "\nFor each name, give the mass in flight, with battery and load, in kg (0.413) or g (413g). Press \
             Enter to leave these recordings out.",
        );
    }
    for Offer { name, words } in found {
        let mass = dialog.ask(&format!("{words}:"), |answer| optional_mass(answer, vehicle))?;
        if let Some(mass_kg) = mass {
            put_load(&mut loads, LoadDraft { mass_kg, recordings: vec![name] });
        }
    }
    loop {
        let (question, ends) = match loads.is_empty() {
            true => {
                ("\nRecordings of flights with the same mass, as a folder, a file or a pattern such as *.mov:", false)
            }
            false => ("More recordings with one mass, as a folder, a file or a pattern [no more]:", true),
        };
        let names = dialog.ask(question, |answer| match answer {
            None if ends => Ok(Vec::new()),
            None => {
                Err("A recording is needed, such as hover.mov, or a folder of recordings with one mass.".to_owned())
            }
            Some(typed) => names_of(typed, folder),
        })?;
        if names.is_empty() {
            return Ok(loads);
        }
        let question = "Mass in flight in these recordings, in kg (0.413) or g (413g) [leave these recordings out]:";
        let mass = dialog.ask(question, |answer| optional_mass(answer, vehicle))?;
        if let Some(mass_kg) = mass {
            put_load(&mut loads, LoadDraft { mass_kg, recordings: names });
        }
    }
}

/// Recordings that belong to one mass.
struct Offer {
    /// Their name or pattern.
    name: String,
    /// The same for people.
    words: String,
}

/// The recordings of a folder, one by one, and those of the folders in it, together.
fn offered(folder: &Path) -> Vec<Offer> {
    let plain = |path: &Path| path.to_string_lossy().replace('\\', "/");
    let single = groups_in(folder).into_iter().flat_map(|group| group.files);
    let single = single.map(|file| Offer { words: printable(&plain(&file)), name: plain(&file) });
    let together = groups_below(folder).into_iter().map(|RecordingGroup { pattern, files }| {
        let words = format!("{} ({})", printable(&plain(&pattern)), counted(files.len(), "recording"));
        Offer { name: plain(&pattern), words }
    });
    single.chain(together).collect()
}

/// The names that a typed folder, file or pattern means; at least one file must be there.
fn names_of(typed: &str, folder: &Path) -> Result<Vec<String>, String> {
    match recordings_of(typed, folder) {
        names if !names.is_empty() => Ok(names),
        _ if folder.join(typed).is_dir() => Err(format!("{typed} is a folder without recordings.")),
        _ if typed.contains(char::is_whitespace) => {
            Err(format!("No file matches {typed}. Type one name or pattern at a time; more can follow."))
        }
        _ => Err(format!("No file matches {typed}.")),
    }
}

fn optional_mass(answer: Option<&str>, vehicle: Option<&Vehicle>) -> Result<Option<f64>, String> {
    let Some(typed) = answer else { return Ok(None) };
    let mass_kg = mass_kg_from_text(typed)?;
    let said = SaidOfVehicle { mass_kg: Some(mass_kg), ..SaidOfVehicle::default() };
    match vehicle.map(|vehicle| vehicle.check_said(&said)) {
        Some(Err(Contradiction::Mass { known_kg, .. })) => Err(format!(
            "That is {}, but this vehicle weighs about {}. Check the number and its unit.",
            mass_words(mass_kg),
            mass_words(known_kg)
        )),
        _ => Ok(Some(mass_kg)),
    }
}

fn number(answer: Option<&str>, offered: Option<u32>, most: u32) -> Result<u32, String> {
    let typed = answer.map_or(Ok(offered), |typed| typed.parse().map(Some));
    match typed {
        Ok(Some(number)) if (1..=most).contains(&number) => Ok(number),
        _ => Err(format!("A whole number from 1 to {most} is needed.")),
    }
}

fn gear_of(answer: Option<&str>) -> Result<Option<Gear>, String> {
    let Some(typed) = answer.filter(|typed| *typed != "none") else { return Ok(None) };
    let gear = gear(typed)?;
    gear.check().map_err(|contradiction| format!("{contradiction}: {}", contradiction.hint()))?;
    Ok(Some(gear))
}

/// A larger diameter needs a unit: propellers of multirotors are smaller, in metres.
const DIAMETER_ALONE_M_MAX: f64 = 2.0;

/// A length with its unit; without one in metres.
fn diameter_m(answer: Option<&str>) -> Result<Option<f64>, String> {
    let Some(typed) = answer else { return Ok(None) };
    if let Ok(metres) = typed.trim().parse::<f64>()
        && metres > DIAMETER_ALONE_M_MAX
    {
        return Err(format!(
            "{typed} without a unit is {typed} m: did you mean {typed}in or {typed}cm? If it is that large, write {typed}m."
        ));
    }
    match length_m(typed).ok().filter(|length_m| PROPELLER_DIAMETER_M.contains(length_m)) {
        Some(length_m) => Ok(Some(length_m)),
        None => Err("A length from 10 mm to 10 m is needed, such as 200mm, 8in or 0.2 (in m).".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// The draft after these answers, and what was asked.
    fn answered(draft: Draft, folder: &Path, answers: &str) -> (Result<Draft, Failure>, String) {
        let mut asked = Vec::new();
        let draft = complete(draft, folder, &mut Dialog::new(answers.as_bytes(), &mut asked, None));
        (draft, String::from_utf8(asked).unwrap())
    }

    #[test]
    fn long_lines_are_wrapped_at_words() {
        let folder = folder_with(&["no_hull/1.MOV"]);
        let mut asked = Vec::new();
        let answers = "ardrone\n\n413g\n\n".as_bytes();
        complete(Draft::default(), folder.path(), &mut Dialog::new(answers, &mut asked, Some(40))).unwrap();
        let asked = String::from_utf8(asked).unwrap();
        // the answers end the lines of the questions, and are not in what was asked
        let lines: Vec<&str> = asked.lines().filter(|line| !line.contains(": ")).collect();
        assert!(lines.len() > 5 && lines.iter().all(|line| line.chars().count() <= 40), "{asked}");
    }

    fn folder_with(names: &[&str]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for name in names {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        folder
    }

    #[test]
    fn the_recordings_of_the_folder_are_offered_and_masses_taken() {
        let folder = folder_with(&["no_hull/1.MOV", "no_hull/2.MOV", "small/1.MOV", "talk.mp3"]);
        let (draft, asked) = answered(Draft::default(), folder.path(), "ardrone\n203mm\n\n413g\n0.444\n\n");
        let draft = draft.unwrap();
        assert_eq!((draft.preset.as_deref(), draft.rotors, draft.diameter_m), (Some("ardrone"), None, Some(0.203)));
        let masses: Vec<f64> = draft.loads.iter().map(|load| load.mass_kg).collect();
        assert_eq!(masses, [0.413, 0.444], "{asked}");
        assert!(draft.loads[0].recordings[0].ends_with("no_hull/*.MOV"), "{draft:?}");
        for words in ["half and double the true speed", "2 recordings", "talk.mp3:", "Known vehicles: ardrone"] {
            assert!(asked.contains(words), "{words}:\n{asked}");
        }
    }

    #[test]
    fn another_vehicle_is_described_and_slips_are_asked_again() {
        let folder = folder_with(&["hover.mov"]);
        let answers = "ardron\n\ntwo\n13\n3\n69:8\n8:69\n\n25\n8ft\n8in\n413\n413g\nmissing/*.mov\n\n";
        let (draft, asked) = answered(Draft::default(), folder.path(), answers);
        let draft = draft.unwrap();
        assert_eq!((draft.blades, draft.rotors, draft.diameter_m), (Some(3), Some(4), Some(0.2032)), "{asked}");
        assert_eq!(draft.gear, Some(Gear { pinion: 8, wheel: 69 }));
        assert_eq!(draft.loads.len(), 1);
        for words in [
            "Did you mean \"ardrone\"",
            "A whole number from 1 to 12 is needed.",
            "swapped",
            "did you mean 25in",
            "from 10 mm",
            "413g",
            "No file matches",
        ] {
            assert!(asked.contains(words), "{words}:\n{asked}");
        }
    }

    /// A name may be the wrong one, or its mass unknown.
    #[test]
    fn named_recordings_can_be_left_out() {
        let folder = folder_with(&["hover.mov"]);
        let flags = Draft { blades: Some(2), rotors: Some(4), diameter_m: Some(0.2), ..Draft::default() };
        let (draft, asked) = answered(flags, folder.path(), "0.5\nhover.mov\n\n\n");
        let loads = draft.unwrap().loads;
        assert_eq!((loads.len(), loads[0].recordings.len()), (1, 1), "{asked}");
        assert!(asked.contains("[leave these recordings out]:"), "{asked}");
    }

    #[test]
    fn flags_are_not_asked_again_and_an_end_writes_nothing() {
        let folder = folder_with(&["hover.mov"]);
        let flags = Draft { blades: Some(2), rotors: Some(4), diameter_m: Some(0.2), ..Draft::default() };
        let (draft, asked) = answered(flags.clone(), folder.path(), "0.5\n\n");
        assert_eq!(draft.unwrap().loads.len(), 1);
        assert!(!asked.contains("Vehicle") && !asked.contains("Blades") && !asked.contains("Rotors ["), "{asked}");
        assert!(matches!(answered(flags, folder.path(), "0.5\n").0, Err(Failure::Usage { .. })));
    }
}
