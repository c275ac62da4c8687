//! The comment above every export: name of the constant, its uncertainty, and its value in other units.

use crate::identified::IdentifiedRotor;
use crate::units::ConstantUnits;

/// A number with eight significant digits, more than any uncertainty needs.
pub(super) fn number(value: f64) -> String {
    if (0.1..1e5).contains(&value.abs()) { plain(value) } else { format!("{value:.7e}") }
}

/// A number with up to eight decimals and without an exponent, for quantities that people write that way.
pub(super) fn plain(value: f64) -> String {
    let text = format!("{value:.8}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Lines of the comment without a comment sign. Line breaks in names would end the comment, as would a backslash in C++.
pub(super) fn lines(rotor: &IdentifiedRotor) -> Vec<String> {
    let tame = |c: char| if c.is_control() || c == '\\' { ' ' } else { c };
    described(rotor).iter().map(|line| line.chars().map(tame).collect()).collect()
}

fn described(rotor: &IdentifiedRotor) -> Vec<String> {
    let units = ConstantUnits::from_n_s2(rotor.thrust_constant_n_s2);
    let mut lines = vec![
        format!("{}: thrust constant of ONE rotor, F = C_f w^2 (F: thrust, w: speed in rad/s)", rotor.vehicle_name),
        rotor.origin.clone(),
        match rotor.expanded_uncertainty_n_s2 {
            Some(expanded) => format!(
                "C_f = {} N/(rad/s)^2, expanded uncertainty (k = 2) {} N/(rad/s)^2 = {:.2} %",
                number(units.n_s2()),
                number(expanded),
                100.0 * expanded / units.n_s2()
            ),
            None => format!("C_f = {} N/(rad/s)^2, uncertainty not known", number(units.n_s2())),
        },
        format!(
            "in other units: {} N/(rev/s)^2 = {} N/rpm^2 = {} g/rpm^2",
            number(units.n_rev_s2()),
            number(units.n_rpm2()),
            number(units.g_rpm2())
        ),
    ];
    if rotor.rotor_count > 1 {
        lines.push(format!(
            "{} rotors together: {} N/(rad/s)^2",
            rotor.rotor_count,
            number(units.n_s2() * f64::from(rotor.rotor_count))
        ));
    }
    if let (Some(density), Some(diameter_m)) = (rotor.air_density_kg_m3, rotor.propeller_diameter_m) {
        lines.push(format!(
            "C_T = F/(rho n^2 D^4) = {} with rho = {density:.4} kg/m^3, D = {diameter_m:.4} m; C_f is proportional to \
            rho",
            number(units.coefficient(density, diameter_m))
        ));
    }
    if let (Some(mass_kg), Some(speed_rad_s)) = (rotor.mass_kg, rotor.hover_speed_by_balance_rad_s()) {
        lines.push(format!(
            "hover of {mass_kg:.4} kg at g = {:.4} m/s^2: {speed_rad_s:.3} rad/s = {:.1} rpm",
            rotor.gravity_m_s2,
            speed_rad_s * 60.0 / std::f64::consts::TAU
        ));
        if let Some(command) = rotor.hover_command {
            let thrust_n = mass_kg * rotor.gravity_m_s2 / f64::from(rotor.rotor_count);
            lines.push(format!(
                "hover at command {command}: {} N/command^2 for one rotor, if the thrust is proportional to the \
                square of the command",
                number(thrust_n / command.powi(2))
            ));
        }
    }
    lines
}

/// The line about a torque that was not measured.
pub(super) fn missing_torque(name: &str) -> String {
    format!("{name}: MISSING. The thrust does not tell the torque: measure the torque, or keep the value of your model")
}

/// The lines with a comment sign in front.
pub(super) fn commented(rotor: &IdentifiedRotor, sign: &str) -> String {
    lines(rotor).iter().map(|line| format!("{sign} {line}\n")).collect()
}

/// The lines as one XML comment, which must not contain a double hyphen.
pub(super) fn xml_comment(rotor: &IdentifiedRotor) -> String {
    let text: String =
        lines(rotor).iter().map(|line| format!("  {}\n", line.replace("--", "- -").replace("--", "- -"))).collect();
    format!("<!--\n{text}-->\n")
}
