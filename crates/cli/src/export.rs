//! `hovertone export`: the model of a simulator with the constant, new or changed in place.

use crate::args::ExportArguments;
use crate::caller::command_word;
use crate::failure::{Ending, Failure};
use crate::identify::names_loads;
use crate::inputs::{is_stdin, read_text};
use crate::model_file::{model_failure, model_hint};
use crate::outputs::{Outputs, written};
use crate::terminal::Terminal;
use crate::unused_facts::{Unused, no_place_in, say_unused};
use hovertone::thrust::ThrustCoefficients;
use hovertone_exchange::{
    ChangedLine, IdentifiedRotor, ModelError, ResultsError, export_text, identified_from_results, model_from_text,
    updated_model,
};
use hovertone_report::{Notice, fixed, printable, significant};
use hovertone_vehicle::{check_diameter, check_positive, check_range, in_list};
use std::ops::RangeInclusive;
use std::path::Path;

/// Masses that differ by less are of one vehicle.
const MASS_SHARE: f64 = 0.02;
/// A new constant over the old one: what another propeller or air does.
const LIKELY_CHANGE: RangeInclusive<f64> = 0.5..=2.0;
/// Torque per thrust, m: a propeller as large as a house has less.
const TORQUE_PER_THRUST_M_MAX: f64 = 1.0;
/// Densities of air: from the highest mountain in summer to a pole in winter.
const AIR_DENSITY_KG_M3: RangeInclusive<f64> = 0.3..=1.8;

/// Writes or prints the lines.
pub(crate) fn run(arguments: &ExportArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let rotor = resolve(arguments)?;
    say_doubts(&rotor, &arguments.results, terminal);
    let Some(format) = arguments.to else {
        return match &arguments.into {
            Some(model) => change(model, &rotor, arguments, terminal),
            None => Err(Failure::usage("neither --to nor --into is given", "see `hovertone export --help`")),
        };
    };
    let text = export_text(&rotor, format).map_err(|error| Failure::usage(error.to_string(), hint_of(&error)))?;
    let why = Unused {
        without_place: &|given| no_place_in(format, given, &rotor),
        same: Notice::new("the results have this number already", "leave the flag out"),
    };
    say_unused(&rotor, arguments, &why, |rotor| export_text(rotor, format), terminal);
    match &arguments.output {
        Some(path) => {
            Outputs::beside([&arguments.results], arguments.replace.force).write(path, text)?;
            terminal.say(&written(path));
        }
        None => terminal.data(&text)?,
    }
    Ok(ending_of(&rotor))
}

/// What to do about lines that cannot be written.
fn hint_of(error: &ModelError) -> String {
    match error {
        ModelError::Needs { flags, .. } => format!("give {flags}"),
        _ => "see `hovertone export --help`".to_owned(),
    }
}

/// Lines with a constant that must not be used are no complete answer.
pub(crate) fn ending_of(rotor: &IdentifiedRotor) -> Ending {
    if rotor.forbids_use { Ending::Incomplete } else { Ending::Done }
}

/// Changes the numbers of a model: in place, which is what was asked for, or into another file. Prints the difference.
fn change(
    model: &Path,
    rotor: &IdentifiedRotor,
    arguments: &ExportArguments,
    terminal: &mut Terminal,
) -> Result<Ending, Failure> {
    if is_stdin(model) && arguments.output.is_none() {
        return Err(Failure::usage(
            "--into cannot change stdin, because stdin is not a file",
            "write the changed model to a file with -o FILE",
        ));
    }
    if rotor.forbids_use {
        return Err(Failure::failed(
            "the warnings of these results say not to use their constant: nothing was written",
            "correct what the warnings name, then make the results again with `hovertone identify`, or with \
             `hovertone fit --json`",
            &arguments.results,
        ));
    }
    let text = read_text(model, "the model")?;
    let before = model_from_text(&text).map_err(|error| model_failure(&error, model))?;
    let updated = updated_model(&text, rotor).map_err(|error| unchanged(&error, model, arguments))?;
    let why = Unused {
        without_place: &|_| {
            Notice::new(
                "this model has no number for it, and --into adds no new numbers",
                "leave the flag out; or add the number to the model by hand, and --into then sets it; or write a new model with --to gazebo",
            )
        },
        same: Notice::new("this model has the same number already", "leave the flag out"),
    };
    say_unused(rotor, arguments, &why, |rotor| Ok(updated_model(&text, rotor)?.text), terminal);
    let place = arguments.output.as_deref().unwrap_or(model);
    if updated.changes.is_empty() {
        terminal
            .say(&format!("nothing to change: {} has this constant already", printable(&model.display().to_string())));
        if arguments.output.is_none() {
            say_other_mass(before.mass_kg, rotor.mass_kg, terminal);
            return Ok(Ending::Done);
        }
    }
    let ratio = rotor.thrust_constant_n_s2 / before.thrust_constant_n_s2;
    if !LIKELY_CHANGE.contains(&ratio) {
        let text = format!("the new constant is {} times the old constant of the model", fixed(ratio, 2));
        let hint = "check that the results and the model belong to the same vehicle, and that the units are right";
        terminal.warning(&Notice::new(text, hint), "");
    }
    match &arguments.output {
        Some(output) => {
            Outputs::beside([&arguments.results, model], arguments.replace.force).write(output, &updated.text)?
        }
        None => Outputs::beside([&arguments.results], true).write(model, &updated.text)?,
    }
    if !updated.changes.is_empty() {
        terminal.data(&difference(model, place, &updated.changes))?;
    }
    terminal.flush()?;
    terminal.say(&written(place));
    if let Some(expanded_n_s2) = rotor.expanded_uncertainty_n_s2 {
        let percent = fixed(100.0 * expanded_n_s2 / rotor.thrust_constant_n_s2, 1);
        terminal.say(&format!("± of the constant: {percent} % (k = 2)"));
    }
    if let Some(notice) = stale_comments(&updated.lines_with_old_number()) {
        terminal.warning(&notice, "");
    }
    say_other_mass(before.mass_kg, rotor.mass_kg, terminal);
    Ok(Ending::Done)
}

/// Says that the vehicle of the model has another mass: `--into` does not change it.
fn say_other_mass(of_model_kg: Option<f64>, of_results_kg: Option<f64>, terminal: &mut Terminal) {
    if let Some((theirs_kg, heard_kg)) =
        of_model_kg.zip(of_results_kg).filter(|(theirs, heard)| !are_alike(*theirs, *heard))
    {
        let text = format!(
            "the vehicle weighs {theirs_kg} kg in the model, but {heard_kg} kg in the results: in the simulator, it will hover at another \
             rotor speed"
        );
        terminal.warning(
            &Notice::new(text, "change the mass in the model file yourself: --into does not change masses"),
            "",
        );
    }
}

/// That comments still have the old number; `None` without such lines.
fn stale_comments(line_numbers: &[usize]) -> Option<Notice> {
    let numbers: Vec<String> = line_numbers.iter().map(usize::to_string).collect();
    let (lines, hint) = match &numbers[..] {
        [] => return None,
        [only] => (format!("a comment in line {only} still has"), "correct or remove the comment"),
        _ => (format!("comments in lines {} still have", in_list(&numbers, "and")), "correct or remove the comments"),
    };
    Some(Notice::new(format!("{lines} the old number: --into does not change comments"), hint))
}

/// The failure of a model that cannot be changed.
fn unchanged(error: &ModelError, model: &Path, arguments: &ExportArguments) -> Failure {
    if matches!(error, ModelError::Expression { .. }) {
        return model_failure(error, model);
    }
    let hint = model_hint(error);
    let hint = match arguments.torque_constant_n_m_s2 {
        Some(_) => format!("{hint}; to keep the torque of the model, leave --torque-constant-n-m-s2 out"),
        None => hint.to_owned(),
    };
    let what = format!("{error}: nothing was written");
    Failure::Usage { what, hint, path: Some(model.to_owned()) }
}

/// Says what weakens the constant of results.
pub(crate) fn say_doubts(rotor: &IdentifiedRotor, results: &Path, terminal: &mut Terminal) {
    terminal.warning_count_of(rotor.doubts.len(), Some(&results.display().to_string()));
    for doubt in &rotor.doubts {
        terminal.warning(&Notice::new(&doubt.text, &doubt.hint), "");
    }
}

/// Whether two masses may be of one vehicle, with the rounding of a scale.
fn are_alike(one_kg: f64, other_kg: f64) -> bool {
    (one_kg / other_kg - 1.0).abs() < MASS_SHARE
}

/// The changed lines as a unified diff without lines around them.
fn difference(before: &Path, after: &Path, changes: &[ChangedLine]) -> String {
    let mut text =
        format!("--- {}\n+++ {}\n", printable(&before.display().to_string()), printable(&after.display().to_string()));
    for ChangedLine { line_number, before, after, is_unended } in changes {
        let end = if *is_unended { "\n\\ No newline at end of file\n" } else { "\n" };
        text += &format!("@@ -{line_number} +{line_number} @@\n-{before}{end}+{after}{end}");
    }
    text
}

fn resolve(arguments: &ExportArguments) -> Result<IdentifiedRotor, Failure> {
    let rotor = identified(&arguments.results, arguments.of.group.as_deref())?;
    let (torque, command) = (arguments.torque_constant_n_m_s2, arguments.hover_command);
    torque.map_or(Ok(()), |torque| check_torque(torque, rotor.thrust_constant_n_s2))?;
    command.map_or(Ok(()), |command| check_positive("hover_command", command))?;
    command.map_or(Ok(()), |command| check_range("hover_command", command, 0.0, 1.0))?;
    arguments.diameter_m.map_or(Ok(()), |diameter_m| check_diameter("diameter_m", diameter_m))?;
    let (thinnest, densest) = (*AIR_DENSITY_KG_M3.start(), *AIR_DENSITY_KG_M3.end());
    let density = arguments.air_density_kg_m3;
    density.map_or(Ok(()), |density| check_range("air_density_kg_m3", density, thinnest, densest))?;
    let rotor = IdentifiedRotor {
        torque_constant_n_m_s2: arguments.torque_constant_n_m_s2.or(rotor.torque_constant_n_m_s2),
        hover_command: arguments.hover_command,
        propeller_diameter_m: arguments.diameter_m.or(rotor.propeller_diameter_m),
        air_density_kg_m3: arguments.air_density_kg_m3.or(rotor.air_density_kg_m3),
        ..rotor
    };
    if let (Some(diameter_m), Some(density)) = (arguments.diameter_m, rotor.air_density_kg_m3) {
        let coefficients = ThrustCoefficients::of_rotor(rotor.thrust_constant_n_s2, diameter_m, density);
        if !coefficients.is_plausible {
            let coefficient = coefficients.propeller;
            let what = format!(
                "diameter_m = {diameter_m} would give a thrust coefficient C_T of {coefficient:.2e}, but no propeller has this value"
            );
            return Err(Failure::usage(
                what,
                "check --diameter-m: it is the diameter from tip to tip, in m, or with a unit, as in 24cm or 8in",
            ));
        }
    }
    Ok(rotor)
}

/// A torque per thrust is a length: about a tenth of the diameter of the propeller.
fn check_torque(torque_constant_n_m_s2: f64, thrust_constant_n_s2: f64) -> Result<(), Failure> {
    check_positive("torque_constant_n_m_s2", torque_constant_n_m_s2)?;
    let arm_m = torque_constant_n_m_s2 / thrust_constant_n_s2;
    if arm_m <= TORQUE_PER_THRUST_M_MAX {
        return Ok(());
    }
    let what = format!(
        "torque_constant_n_m_s2 = {torque_constant_n_m_s2} is too large: divided by the thrust constant of one rotor, it gives {} m, and for every \
         propeller this ratio is less than {TORQUE_PER_THRUST_M_MAX} m",
        significant(arm_m, 2)
    );
    // the momentConstant of a model is this ratio
    if torque_constant_n_m_s2 <= TORQUE_PER_THRUST_M_MAX {
        let hint = format!(
            "check the number and its unit; if {torque_constant_n_m_s2} is the momentConstant in a model of Gazebo, it is this ratio (in m), and the torque constant is --torque-constant-n-m-s2 {:.3e}",
            torque_constant_n_m_s2 * thrust_constant_n_s2
        );
        return Err(Failure::usage(what, hint));
    }
    Err(Failure::usage(
        what,
        "give C_τ of the law torque = C_τ ω², in N m/(rad/s)²; small propellers have 1e-9 to 1e-6",
    ))
}

/// Reads results.json, or one group of the results of a table.
pub(crate) fn identified(path: &Path, group: Option<&str>) -> Result<IdentifiedRotor, Failure> {
    refuse_number(path)?;
    let text = read_text(path, "the results")?;
    identified_from_results(&text, group).map_err(|error| match error {
        _ if model_from_text(&text).is_ok() => Failure::Usage {
            what: "this is a model of a simulator, but results.json of `hovertone identify` is needed here".to_owned(),
            hint: "give results.json first; the model comes after it for `hovertone compare`, and after --into for \
                   `hovertone export`"
                .to_owned(),
            path: Some(path.to_owned()),
        },
        ResultsError::NotJson(_) if names_loads(&text) => Failure::failed(
            "this is an experiment file, but results.json is needed here",
            "run `hovertone identify EXPERIMENT.toml -o DIR`, then give DIR/results.json",
            path,
        ),
        ResultsError::SeveralGroups { .. } | ResultsError::NoSuchGroup { .. } => {
            let hint = "give one of these names with --group".to_owned();
            Failure::Usage { what: error.to_string(), hint, path: Some(path.to_owned()) }
        }
        ResultsError::NoGroups { .. } => Failure::Usage {
            what: error.to_string(),
            hint: "leave --group out".to_owned(),
            path: Some(path.to_owned()),
        },
        ResultsError::NothingIdentified => Failure::failed(
            error.to_string(),
            "`hovertone identify` tells why each recording has no speed: follow its advice, and run it again",
            path,
        ),
        _ => {
            let hint = "give the results.json that `hovertone identify EXPERIMENT.toml -o DIR` wrote, or the output of \
                        `hovertone fit --json`";
            Failure::failed(error.to_string(), hint, path)
        }
    })
}

/// Refuses a number where the file of the results is needed.
fn refuse_number(path: &Path) -> Result<(), Failure> {
    let number = path.to_str().filter(|text| text.parse::<f64>().is_ok() && !path.exists());
    number.map_or(Ok(()), |number| {
        let whole = format!("the constant of the whole vehicle: --constant-n-s2 {number}");
        let hint = match command_word().as_str() {
            "weigh" => format!("give the number as {whole}, and also --vehicle or --blades; or give the results.json of `hovertone identify`"),
            _ => format!("give the results.json that `hovertone identify` wrote; only `hovertone weigh` takes a number, {whole}"),
        };
        Err(Failure::usage(format!("{number} is a number, but the file results.json is needed here"), hint))
    })
}
