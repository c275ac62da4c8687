//! `hovertone demo`: the paper's experiment in simulated flight, identified like any other recordings.

mod folder;
mod low_level;
mod render;

use crate::args::DemoArguments;
use crate::failure::{Ending, Failure};
use crate::identify::{ExperimentSource, identify, jobs_of, page_line};
use crate::recording::Hearing;
use crate::report_folder::PAGE;
use crate::terminal::Terminal;
use crate::today::today;
use crate::typed::typed_command;
use hovertone::speed::Method;
use hovertone::thrust::ThrustTable;
use hovertone_report::{
    LOADS_FOOTNOTE, PrintedRow, TextTable, TitledTable, comparison_with_paper, comparison_with_truth, counted,
    table_text,
};
use hovertone_sim::paper::{LOADS, PaperLoad};
use hovertone_workflow::ReportExtras;

/// Simulates, writes, identifies and compares.
pub(crate) fn run(arguments: &DemoArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    if arguments.low_level {
        return low_level::run(arguments, terminal);
    }
    let folder = &folder::prepare(&arguments.output, arguments.replace.force)?;
    // the experiment file marks the folder: after an interrupt the demo can simply be run again
    let experiment = folder::write_experiment(folder, arguments.seed)?;
    let truths = render::render_all(arguments.seed, folder, !arguments.no_progress)?;
    folder::write_truth(folder, &truths)?;
    let source = ExperimentSource::read(&experiment)?;
    let recordings = jobs_of(&source, None)?;
    let hearing = Hearing { wants_hash: true, wants_samples: true, ..Hearing::default() };
    let method = source.experiment.config.method;
    let identified = identify(source, recordings, hearing, method, !arguments.no_progress)?;
    let compared: Vec<(Method, TextTable)> = identified
        .tables()
        .iter()
        .map(|table| (table.method, comparison_with_paper(table, &printed_rows(table))))
        .collect();
    let against_truth = comparison_with_truth(identified.tables(), &render::truth_of_loads(&truths));
    let width = terminal.fold_width();
    let mut text = format!(
        "The experiment of the paper (Pizetta et al., AR.Drone) in simulated flight: {}, {}, seed {}; {}\n",
        counted(LOADS.len(), "load"),
        counted(truths.len(), "recording"),
        arguments.seed,
        identified.warnings_counted(),
    );
    for (table, (_, compared)) in identified.tables().iter().zip(&compared) {
        text += &format!("\n{}\n{}", title_beside_paper(table), table_text(compared, width));
    }
    text += &format!("{LOADS_FOOTNOTE}\n\n{TRUTH_TITLE}\n{}", table_text(&against_truth, width));
    identified.say_notes(terminal);
    terminal.text(&(text + "\n" + &identified.summary(width) + FOOTNOTE + "\n" + &identified.quote()))?;
    terminal.flush()?;
    let extras = ReportExtras {
        compared: &compared,
        more_tables: &[TitledTable::new(TRUTH_TITLE, against_truth)],
        command: &typed_command(),
        date: &today(),
    };
    identified.write(folder, &extras)?;
    terminal.text(&page_line(&folder.place(PAGE)))?;
    Ok(identified.ending())
}

const TRUTH_TITLE: &str = "Compared with the simulated truth";

const FOOTNOTE: &str = "
Maximum trace and Gaussian approximation are the methods of the paper.
The columns \"paper\" have the numbers of the paper, in rpm, in rad/s, and in 1e-5 N s² for the whole
vehicle. For the big hull, the paper gives 462 g but calculated with 472 g, so its C_f is larger there.
The simulation flies 462 g. With 462 g, the paper's speeds give C_f = 2.8291e-5 N s² (table 1) and
2.8260e-5 N s² (table 2).
";

fn title_beside_paper(table: &ThrustTable) -> String {
    let (number, how) = match table.method {
        Method::Gaussian => (2, " (the middle of a Gaussian curve in each short piece of sound)"),
        Method::MaximumTrace => (1, " (the strongest frequency of each short piece of sound)"),
        _ => (1, ""),
    };
    format!("{}{how}, beside the paper's table {number}", table.title())
}

fn printed_rows(table: &ThrustTable) -> Vec<PrintedRow> {
    let row = |load: &PaperLoad| {
        let row = if table.method == Method::Gaussian { load.table_2 } else { load.table_1 };
        PrintedRow {
            speed_rpm: row.speed_rpm,
            spread_rpm: row.spread_rpm,
            speed_rad_s: row.speed_rad_s,
            thrust_constant_total_n_s2: row.thrust_constant_total_n_s2,
        }
    };
    LOADS.iter().map(row).collect()
}
