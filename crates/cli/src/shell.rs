//! `hovertone completions` and `hovertone man`: the command line, described for shells and for `man`.

use crate::args::{Arguments, CompletionsArguments, ManArguments};
use crate::failure::{Ending, Failure};
use crate::nearest::nearest;
use crate::output_folder::{FolderContent, OutputFolder};
use crate::outputs::{Outputs, written};
use crate::terminal::Terminal;
use crate::vehicles::known_vehicles;
use clap::builder::PossibleValuesParser;
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use hovertone_vehicle::presets;
use std::io;
use std::path::Path;

const NAME: &str = "hovertone";

/// Prints the completions of a shell.
pub(crate) fn run_completions(arguments: &CompletionsArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut with_vehicles(Arguments::command()), NAME, &mut script);
    terminal.data(&String::from_utf8(script).map_err(Failure::internal)?)?;
    Ok(Ending::Done)
}

/// The command line whose `--vehicle` has the names of the known vehicles. A run takes other names as well: files, and vehicles added later.
fn with_vehicles(program: Command) -> Command {
    // a broken file of own vehicles is told when a vehicle is used
    let known = known_vehicles().unwrap_or_else(|_| presets().to_vec());
    let names: Vec<&str> = known.iter().map(|vehicle| vehicle.id).collect();
    program.mut_subcommands(|command| {
        command.mut_args(|argument| match argument.get_id().as_str() {
            "vehicle" => argument.value_parser(PossibleValuesParser::new(names.iter().copied())),
            _ => argument,
        })
    })
}

/// Prints the page of a command, or writes all pages into a folder.
pub(crate) fn run_man(arguments: &ManArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let program = built();
    if let Some(folder) = &arguments.output {
        return write_all(&program, folder, arguments.replace.force, terminal);
    }
    let command = match &arguments.command {
        Some(name) => subcommand(&program, name)?,
        None => &program,
    };
    terminal.data(&page(command)?)?;
    Ok(Ending::Done)
}

/// The whole command line, with the arguments that clap adds. The pages of commands are named hovertone-COMMAND.
fn built() -> Command {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    program
}

fn subcommand<'a>(program: &'a Command, name: &str) -> Result<&'a Command, Failure> {
    program.find_subcommand(name).ok_or_else(|| {
        let names = program.get_subcommands().map(Command::get_name);
        let hint = match nearest(name, names) {
            Some(nearest) => format!("did you mean \"{nearest}\"? `hovertone --help` lists all commands"),
            None => "`hovertone --help` lists all commands".to_owned(),
        };
        Failure::usage(format!("there is no command \"{name}\""), hint)
    })
}

fn write_all(program: &Command, folder: &Path, force: bool, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let nothing: [&Path; 0] = [];
    let content = FolderContent { name: "of the same command", run: "man", files: &[] };
    let folder = OutputFolder::prepare(folder, Outputs::beside(nothing, force), &content)?;
    for command in [program].into_iter().chain(program.get_subcommands()) {
        let name = format!("{}.1", command.get_display_name().unwrap_or_else(|| command.get_name()));
        folder.write(&name, page(command)?)?;
        terminal.say(&written(&folder.place(&name)));
    }
    Ok(Ending::Done)
}

fn page(command: &Command) -> Result<String, Failure> {
    let mut text = Vec::new();
    let manual = format!("hovertone {}", env!("CARGO_PKG_VERSION"));
    let man = Man::new(command.clone()).source(manual);
    let mut render = || -> io::Result<()> {
        man.render_title(&mut text)?;
        man.render_name_section(&mut text)?;
        man.render_synopsis_section(&mut text)?;
        man.render_description_section(&mut text)?;
        man.render_options_section(&mut text)?;
        if command.has_subcommands() {
            man.render_subcommands_section(&mut text)?;
        }
        text.extend(as_it_stands(command).into_bytes());
        match command.get_version() {
            Some(_) => man.render_version_section(&mut text),
            None => Ok(()),
        }
    };
    render().map_err(Failure::internal)?;
    String::from_utf8(text).map_err(Failure::internal)
}

/// The notes and examples below the help: lines that must not be joined, with the signs escaped that mean something to `man`.
fn as_it_stands(command: &Command) -> String {
    let Some(notes) = command.get_after_long_help().or_else(|| command.get_after_help()) else { return String::new() };
    let escaped = |line: &str| {
        let line = line.replace('\\', "\\e").replace('-', "\\-");
        if line.starts_with(['.', '\'']) { format!("\\&{line}\n") } else { format!("{line}\n") }
    };
    let lines: String = notes.to_string().lines().map(escaped).collect();
    format!(".SH \"NOTES AND EXAMPLES\"\n.nf\n{lines}.fi\n")
}
