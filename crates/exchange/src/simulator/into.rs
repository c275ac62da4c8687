//! A model in which only the measured numbers are changed: all other text stays as it is, byte for byte.

use super::header::number;
use super::xml::Rooted;
use super::{ModelError, SimulatorFormat, format_of, model_from_text};
use crate::identified::IdentifiedRotor;
use crate::units::ConstantUnits;
use roxmltree::{Document, Node};
use std::f64::consts::TAU;
use std::ops::Range;

/// Relative difference up to which the constant of the new file is the measured one: it is written with eight digits.
const TOLERANCE: f64 = 1e-6;

/// A line of the file before and after.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChangedLine {
    /// Its number, counted from 1.
    pub line_number: usize,
    /// The line before, with a carriage return where its end is CR LF.
    pub before: String,
    /// The line after, with the same end.
    pub after: String,
    /// Whether the text ends with this line, without an end of a line.
    pub is_unended: bool,
}

/// A model with the measured numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UpdatedModel {
    /// The whole text.
    pub text: String,
    /// What differs.
    pub changes: Vec<ChangedLine>,
}

impl UpdatedModel {
    /// The lines that still have a number which a changed line had before: comments, most probably. Counted from 1.
    pub fn lines_with_old_number(&self) -> Vec<usize> {
        let is_changed = |line: usize| self.changes.iter().any(|change| change.line_number == line);
        let old: Vec<f64> = (self.changes.iter())
            .flat_map(|change| {
                let after: Vec<f64> = numbers_in(&change.after).collect();
                numbers_in(&change.before).filter(move |number| !after.contains(number))
            })
            .collect();
        let lines = self.text.lines().enumerate().map(|(index, line)| (index + 1, line));
        let unchanged = lines.filter(|(number, _)| !is_changed(*number));
        let stale = unchanged.filter(|(_, line)| numbers_in(line).any(|number| old.contains(&number)));
        stale.map(|(number, _)| number).collect()
    }
}

fn numbers_in(line: &str) -> impl Iterator<Item = f64> {
    let words = line.split(|letter: char| !letter.is_ascii_alphanumeric() && !".+-".contains(letter));
    words.filter_map(|word| word.parse().ok())
}

/// A part of the text and its replacement.
struct Edit {
    range: Range<usize>,
    new: String,
}

/// The text of a simulator's model with the measured thrust constant, and with the torque constant where that was measured. Polynomials get
/// the square alone, as it was identified. AirSim's coefficient is for the air and the diameter that the file has.
///
/// # Errors
/// As of [`model_from_text`]; a number that is an expression; a file of this project, which is written again instead.
pub fn updated_model(text: &str, rotor: &IdentifiedRotor) -> Result<UpdatedModel, ModelError> {
    let format = format_of(text)?;
    // a file that cannot be read is not changed
    let before = model_from_text(text)?;
    let thrust = ConstantUnits::from_n_s2(rotor.thrust_constant_n_s2);
    let torque = rotor.torque_constant_n_m_s2.map(ConstantUnits::from_n_s2);
    let moment_m = rotor.moment_constant_m();
    let mut edits = match format {
        SimulatorFormat::Gazebo => xml_edits(text, "SDF", |node| {
            let new = match node.tag_name().name() {
                "motorConstant" => Some(thrust.n_s2()),
                "momentConstant" => moment_m,
                _ => None,
            };
            new.map(|new| (None, new))
        })?,
        SimulatorFormat::Rotors => xml_edits(text, "xacro", |node| {
            let is_property = node.tag_name().name() == "property";
            let new = match node.attribute("name").filter(|_| is_property)? {
                "motor_constant" => thrust.n_s2(),
                "moment_constant" => moment_m?,
                _ => return None,
            };
            Some((Some("value"), new))
        })?,
        SimulatorFormat::GymPybulletDrones => {
            let of = |name: &'static str, value: Option<f64>| {
                xml_edits(text, "URDF", |node| {
                    let has = node.tag_name().name() == "properties" && node.has_attribute(name);
                    value.filter(|_| has).map(|value| (Some(name), value))
                })
            };
            [of("kf", Some(thrust.n_rpm2()))?, of("km", torque.map(ConstantUnits::n_rpm2))?]
                .into_iter()
                .flatten()
                .collect()
        }
        SimulatorFormat::Rotorpy => {
            let of = |name: &str, value: Option<f64>| entry_edits(text, name, ':', "#", value.map(number));
            [of("k_eta", Some(thrust.n_s2()))?, of("k_m", torque.map(ConstantUnits::n_s2))?]
                .into_iter()
                .flatten()
                .collect()
        }
        SimulatorFormat::Flightmare => {
            let map = format!("[{}, 0.0, 0.0]", number(thrust.n_s2()));
            let of = |name: &str, new: Option<String>| entry_edits(text, name, ':', "#", new);
            [of("thrust_map", Some(map))?, of("kappa", moment_m.map(number))?].into_iter().flatten().collect()
        }
        SimulatorFormat::Crazyflow => {
            let list = |constant: ConstantUnits| format!("[0.0, 0.0, {}]", number(constant.n_rpm2()));
            let of = |name: &str, new: Option<String>| entry_edits(text, name, '=', "#", new);
            [of("rpm2thrust", Some(list(thrust)))?, of("rpm2torque", torque.map(list))?].into_iter().flatten().collect()
        }
        SimulatorFormat::Airsim => {
            // the coefficients change as the constants do: air and diameter stay
            let old_n_s2 = before.thrust_constant_n_s2;
            let density_diameter4 = |c_t: f64| old_n_s2 * TAU.powi(2) / c_t;
            let diameter_m = before.propeller_diameter_m.unwrap_or(1.0);
            let of = |name: &str, new: &dyn Fn(f64) -> Option<f64>| coefficient_edits(text, name, new);
            let old_c_t = first_coefficient(text, "C_T").ok_or(ModelError::Unknown)?;
            let c_p = torque.map(|torque| torque.n_s2() * TAU.powi(3) / (density_diameter4(old_c_t) * diameter_m));
            [of("C_T", &|old| Some(old * thrust.n_s2() / old_n_s2))?, of("C_P", &|_| c_p)?]
                .into_iter()
                .flatten()
                .collect()
        }
        SimulatorFormat::Json | SimulatorFormat::Yaml => return Err(ModelError::OwnExport),
    };
    edits.sort_by_key(|edit| edit.range.start);
    let text_after = edited(text, &edits);
    let after = model_from_text(&text_after)?;
    if (after.thrust_constant_n_s2 / thrust.n_s2() - 1.0).abs() > TOLERANCE {
        let reason = "the place of its constant was not found".to_owned();
        return Err(ModelError::Broken { format: "a model that can be changed", reason });
    }
    Ok(UpdatedModel { changes: changed_lines(text, &text_after), text: text_after })
}

fn edited(text: &str, edits: &[Edit]) -> String {
    let mut after = String::with_capacity(text.len());
    let mut end = 0;
    for Edit { range, new } in edits {
        after += &text[end..range.start];
        after += new;
        end = range.end;
    }
    after + &text[end..]
}

/// Edits replace parts of lines, so both texts have the same lines.
fn changed_lines(before: &str, after: &str) -> Vec<ChangedLine> {
    // a patch needs the carriage returns, which `lines` takes away
    let pairs = (1..).zip(before.split_inclusive('\n').zip(after.split_inclusive('\n')));
    let differs = pairs.filter(|(_, (before, after))| before != after);
    let whole = |line: &str| line.strip_suffix('\n').unwrap_or(line).to_owned();
    let line = |(line_number, (before, after)): (usize, (&str, &str))| ChangedLine {
        line_number,
        before: whole(before),
        after: whole(after),
        is_unended: !before.ends_with('\n'),
    };
    differs.map(line).collect()
}

/// The numbers of XML that are replaced: `wanted` names the attribute of an element (its text where absent) and the new number.
fn xml_edits(
    text: &str,
    format: &'static str,
    wanted: impl Fn(&Node<'_, '_>) -> Option<(Option<&'static str>, f64)>,
) -> Result<Vec<Edit>, ModelError> {
    let rooted = Rooted::of(text);
    let document =
        Document::parse(&rooted.text).map_err(|error| ModelError::Broken { format, reason: error.to_string() })?;
    let mut edits = Vec::new();
    for node in document.descendants().filter(Node::is_element) {
        let Some((attribute, new)) = wanted(&node) else { continue };
        let range = match attribute {
            Some(name) => node.attribute_node(name).map(|attribute| attribute.range_value()),
            None => node.first_child().filter(Node::is_text).map(|text| text.range()),
        };
        let Some(range) = range else { continue };
        edits.push(number_edit(text, rooted.range_in_original(range), number(new), node.tag_name().name())?);
    }
    Ok(edits)
}

/// The values of all entries `name: value` or `name = value` outside of comments, up to a comma, a comment or the end of the line. Quotes
/// around the name do not count.
fn entry_edits(
    text: &str,
    name: &str,
    equals: char,
    comment: &str,
    new: Option<String>,
) -> Result<Vec<Edit>, ModelError> {
    let Some(new) = new else { return Ok(Vec::new()) };
    let mut edits = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let code = line.split(comment).next().unwrap_or("");
        if let Some((key, value)) = code.split_once(equals)
            && key.trim().trim_matches(['\'', '"']) == name
        {
            let from = start + key.len() + equals.len_utf8();
            let is_list = value.trim_start().starts_with('[');
            let length = match is_list {
                true => value.find(']').map(|end| end + 1).ok_or_else(|| expression(name, value))?,
                false => value.find(',').unwrap_or(value.len()),
            };
            let range = trimmed(text, from..from + length);
            let parts = text[range.clone()].trim_matches(['[', ']']).split(',').map(str::trim);
            if !parts.clone().all(|part| part.parse::<f64>().is_ok()) {
                return Err(expression(name, &text[range]));
            }
            edits.push(Edit { range, new: new.clone() });
        }
        start += line.len();
    }
    Ok(edits)
}

/// The numbers of all `name = 0.1f;` in C++, each with its new value.
fn coefficient_edits(text: &str, name: &str, new: &dyn Fn(f64) -> Option<f64>) -> Result<Vec<Edit>, ModelError> {
    let ranges = coefficient_ranges(text, name);
    let of_range = |range: Range<usize>| -> Option<Result<Edit, ModelError>> {
        let Ok(old) = text[range.clone()].parse::<f64>() else { return Some(Err(expression(name, &text[range]))) };
        new(old).map(|new| Ok(Edit { range, new: number(new) }))
    };
    ranges.into_iter().filter_map(of_range).collect()
}

fn first_coefficient(text: &str, name: &str) -> Option<f64> {
    coefficient_ranges(text, name).into_iter().find_map(|range| text[range].parse().ok())
}

/// The values of a C++ member, without the `f` behind them.
fn coefficient_ranges(text: &str, name: &str) -> Vec<Range<usize>> {
    let mut ranges = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let code = line.split("//").next().unwrap_or("");
        if let Some((key, value)) = code.split_once('=')
            && key.split_whitespace().last() == Some(name)
            && let Some(end) = value.find(';')
        {
            let from = start + key.len() + 1;
            let range = trimmed(text, from..from + end);
            let without_f = text[range.clone()].trim_end_matches('f').len();
            ranges.push(range.start..range.start + without_f);
        }
        start += line.len();
    }
    ranges
}

fn number_edit(text: &str, range: Range<usize>, new: String, name: &str) -> Result<Edit, ModelError> {
    let range = trimmed(text, range);
    match text[range.clone()].parse::<f64>() {
        Ok(_) => Ok(Edit { range, new }),
        Err(_) => Err(expression(name, &text[range])),
    }
}

fn expression(name: &str, value: &str) -> ModelError {
    ModelError::Expression { name: name.to_owned(), value: value.trim().to_owned() }
}

/// Without the space around it.
fn trimmed(text: &str, range: Range<usize>) -> Range<usize> {
    let part = &text[range.clone()];
    let start = range.start + (part.len() - part.trim_start().len());
    start..start + part.trim().len()
}
