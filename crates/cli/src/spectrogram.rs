//! `hovertone spectrogram`: a recording as a picture.

use crate::args::SpectrogramArguments;
use crate::drawing::drawing_of;
use crate::failure::{Ending, Failure};
use crate::figure_file::FigureKind;
use crate::inputs::{is_stdin, name_of, recording_of_stdin};
use crate::jobs::ending_of;
use crate::outputs::{Outputs, written};
use crate::progress::Progress;
use crate::recording::{Hearing, Job, Requests, records_of};
use crate::settings::{check_tips_heard, config_of, idle_mass, refuse_of_table};
use crate::terminal::Terminal;
use hovertone_figures::{DOTS_PER_INCH, recording_figure};
use hovertone_report::{Notice, NoticeKind};
use hovertone_workflow::trial_of;

/// Analyses a recording and draws it.
pub(crate) fn run(arguments: &SpectrogramArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let kind = FigureKind::of(&arguments.output, "use -o spectrogram.png or -o spectrogram.svg")?;
    refuse_of_table(&arguments.analysis, "a picture shows neither the ± nor the condition of the rotors")?;
    if let (FigureKind::Svg, Some(dpi)) = (kind, arguments.dpi) {
        let what = format!("--dpi {dpi} changes nothing, because an SVG picture has lines and no dots");
        return Err(Failure::usage(what, "leave --dpi out, or give a name that ends with .png"));
    }
    let (config, discovery) = config_of(&arguments.tone, &arguments.known, &arguments.analysis)?;
    if let Some(notice) = idle_mass(&arguments.known, &config.known) {
        terminal.tip(&notice);
    }
    let hearing = Hearing::of(&arguments.hearing);
    let outputs = Outputs::beside([&arguments.file], arguments.replace.force);
    outputs.check(&arguments.output)?;
    let name = name_of(&arguments.file);
    let path = if is_stdin(&arguments.file) { recording_of_stdin()? } else { arguments.file.clone() };
    let jobs = [Job { name, path, config, discovery, requests: Requests::default(), sha256: None, samples: None }];
    let progress = Progress::new("listening to", jobs.len(), !arguments.hearing.no_progress);
    let mut records = records_of(&jobs, hearing, &progress);
    progress.finish();
    // a picture has no ±
    let is_about_picture = |notice: &Notice| notice.kind != NoticeKind::LargeUncertainty;
    records.iter_mut().for_each(|record| record.notices.retain(is_about_picture));
    check_tips_heard(&arguments.known, &records)?;
    let ending = ending_of(&records);
    terminal.counted_notes(&records.iter().collect::<Vec<_>>());
    let [job] = &jobs;
    let Some(record) = records.first().filter(|record| !record.has_failed()) else { return Ok(ending) };
    let drawing = drawing_of(job, record, hearing, None)?;
    let reason = record.reason();
    let trial = trial_of("", record, reason.as_deref(), Some(&drawing));
    let Some(figure) = recording_figure(&trial, "spectrogram").map_err(Failure::internal)? else {
        terminal.say(match record.is_part_outside() {
            true => "no picture was written, because the chosen part lies after the end of the recording",
            false => "no picture was written, because a picture needs 0.1 s of sound or more",
        });
        return Ok(ending);
    };
    let bytes = kind.bytes(figure, arguments.dpi.map_or(DOTS_PER_INCH, f64::from))?;
    outputs.write(&arguments.output, bytes)?;
    terminal.say(&written(&arguments.output));
    Ok(ending)
}
