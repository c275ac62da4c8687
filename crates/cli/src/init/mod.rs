//! `hovertone init`: an experiment file from flags, or from answers at the terminal.

mod dialog;
mod questions;

use crate::args::InitArguments;
use crate::draft::{Draft, recordings_from};
use crate::failure::{Ending, Failure};
use crate::files::files_of;
use crate::identify::{ExperimentSource, jobs_of};
use crate::outputs::{Outputs, written};
use crate::recording::Hearing;
use crate::recording_files::recordings_of;
use crate::rights::{CLOSED_FOLDER, GET_RIGHT, closed_folder};
use crate::terminal::{Terminal, width_of};
use crate::text_file::{TextFormat, TextKind};
use crate::typed::quoted;
use crate::vehicles::preset;
use dialog::Dialog;
use hovertone_report::VERSION;
use hovertone_vehicle::Vehicle;
use std::io::{self, IsTerminal};
use std::path::Path;

const EXPERIMENT: TextKind =
    TextKind { content: "an experiment file", format: TextFormat::Toml, example: "-o experiment.toml" };

/// Asks for what the flags leave out, and writes the file.
pub(crate) fn run(arguments: &InitArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let nothing: [&Path; 0] = [];
    Outputs::beside(nothing, arguments.replace.force).check_text(&arguments.output, EXPERIMENT)?;
    let vehicle = arguments.draft.vehicle.as_deref().map(preset).transpose()?;
    let draft = with_recordings(Draft::from_arguments(&arguments.draft, vehicle)?)?;
    let can_ask = io::stdin().is_terminal() && io::stderr().is_terminal();
    let draft = match draft.missing(vehicle) {
        missing if missing.is_empty() => draft,
        _ if can_ask => questions::complete(
            draft,
            Path::new(""),
            &mut Dialog::new(io::stdin().lock(), io::stderr(), width_of(&io::stderr())),
        )?,
        missing => {
            let what = "init asks questions, and needs a terminal for them";
            let hint = format!("run it in a terminal, or add flags: {}", missing.join("; and "));
            return Err(Failure::usage(what, hint));
        }
    };
    let vehicle = draft.preset.as_deref().map(preset).transpose()?;
    let text = file_text(&draft, vehicle, &arguments.output)?;
    // a draft that means nothing is refused with its reason, and not written
    let source = ExperimentSource::of_flags(&text, arguments.output.clone(), "init")?;
    let recordings = jobs_of(&source, None).map_err(|failure| match failure {
        // the file that would name it twice is not there yet
        Failure::Usage { what, .. } => Failure::usage(what, "name each recording once"),
        failure => failure,
    })?;
    for recording in recordings {
        let opened = recording.job.open(Hearing::default());
        opened.map_err(|error| Failure::failed(error.to_string(), "", Path::new(&recording.job.name)))?;
    }
    let recordings = draft.loads.iter().flat_map(|load| &load.recordings).flat_map(|name| files_of(Path::new(name)));
    Outputs::beside(recordings, arguments.replace.force).write(&arguments.output, &text)?;
    terminal.say(&written(&arguments.output));
    let name = quoted(&arguments.output.display().to_string());
    let known = &source.experiment.config.known;
    if known.diameter_m.is_none() && known.shaft_speed.is_none() {
        terminal.say("The file does not have the diameter of the propellers. Measure it, and write it as propeller_diameter_m under \
             [vehicle]: then hovertone can rule out half and double the true speed.");
    }
    terminal.say(&format!("Check the file:           hovertone identify {name} --check"));
    terminal.say(&format!("Identify the constant:    hovertone identify {name} -o results"));
    Ok(Ending::Done)
}

/// The draft with patterns in place of folders. A name without a recording is refused, as `identify` would refuse it later.
fn with_recordings(mut draft: Draft) -> Result<Draft, Failure> {
    for load in &mut draft.loads {
        let mut found = Vec::new();
        for name in &load.recordings {
            match recordings_of(name, Path::new("")) {
                names if names.is_empty() => {
                    if let Some(folder) = closed_folder(Path::new(name)) {
                        return Err(Failure::failed(CLOSED_FOLDER, GET_RIGHT, &folder));
                    }
                    let what = "no recording has this name or matches this pattern: nothing was written";
                    return Err(Failure::failed(
                        what,
                        "correct the name: it is relative to the current folder",
                        Path::new(name),
                    ));
                }
                names => found.extend(names),
            }
        }
        load.recordings = found;
    }
    Ok(draft)
}

/// The text of the file. Its recordings count from its own folder.
fn file_text(draft: &Draft, vehicle: Option<&Vehicle>, output: &Path) -> Result<String, Failure> {
    let folder = output.parent().unwrap_or(Path::new(""));
    let mut draft = draft.clone();
    for name in draft.loads.iter_mut().flat_map(|load| &mut load.recordings) {
        *name = recordings_from(name, Path::new(""), folder)?;
    }
    let name = output.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let head = format!(
        "# Written by `hovertone init` (hovertone {VERSION}). You can change it: docs/formats.md lists all keys.\n\
         # Check this file:        hovertone identify {name} --check\n\
         # Identify the constant:  hovertone identify {name} -o results\n"
    );
    Ok(draft.experiment_text(&head, vehicle))
}
