//! Notices about a fitted table: what was done with its columns, and numbers that no propeller has.

use super::Plan;
use hovertone::thrust::{
    ForceLaw, ForcePoint, LoadRange, RangeDoubt, SquareLawFit, ThrustCoefficients, ThrustWarning, least_diameter_m,
    least_tip_mach, range_text,
};
use hovertone_exchange::{StandGroup, StandTable};
use hovertone_report::{Notice, fixed, significant};
use hovertone_vehicle::{AIR_KG_M3, Estimate, RotorSpeed, THRUST_COEFFICIENT, TIP_MACH_MAX};

/// The air changes C_T by less: thin air on the highest mountains has a third of the density at sea level.
const FAR_OFF_FACTOR: f64 = 3.0;
/// Propellers of the largest multirotors are smaller.
const DIAMETER_M_MAX: f64 = 2.0;
/// A Mach number above this has an exponent.
const MACH_WITH_DECIMALS_MAX: f64 = 1e6;

/// The row whose force differs most from that of the square law, and by which share.
pub(super) struct WorstRow<'a> {
    name: &'a str,
    share: f64,
}

impl<'a> WorstRow<'a> {
    /// Of the rows that the fit uses.
    pub(super) fn of(points: &'a [ForcePoint], fit: &SquareLawFit) -> Option<Self> {
        let constant = fit.thrust_constant_n_s2.value;
        let share = |point: &ForcePoint| constant * point.speed_square_rad2_s2 / point.force_n - 1.0;
        let used = points.iter().zip(&fit.points).filter(|(_, verdict)| !verdict.is_gross).map(|(point, _)| point);
        let rows = used.map(|point| Self { name: &point.name, share: share(point) });
        rows.max_by(|a, b| a.share.abs().total_cmp(&b.share.abs()))
    }
}

/// What the notices say of the table of a fit.
pub(super) struct FittedRows<'a> {
    /// Header of the column with the speed.
    pub(super) speed_column: &'a str,
    /// Headers of the columns with uncertainties, where all rows have one.
    pub(super) stated: &'a [String],
    /// Whether the speeds have uncertainties.
    pub(super) has_speed_std: bool,
    /// Whether the rows differ from the law by far less than the stated uncertainties say.
    pub(super) is_quiet: bool,
    pub(super) worst: Option<WorstRow<'a>>,
}

impl FittedRows<'_> {
    /// What makes it uncertain whether the forces show the law.
    fn doubt(&self) -> RangeDoubt {
        match (self.stated.is_empty(), self.has_speed_std) {
            (true, _) => RangeDoubt::Scatter,
            (false, true) => RangeDoubt::Speeds,
            (false, false) => RangeDoubt::Forces,
        }
    }

    /// What to check where a speed may be a multiple of the right one.
    fn pole_pairs(&self) -> String {
        match is_electrical(self.speed_column) {
            true => format!(
                "; the stand calculates the column \"{}\" with the number of pole pairs of the motor (half of its magnets): check this number in the settings of the stand",
                self.speed_column
            ),
            false => String::new(),
        }
    }
}

/// Whether a column is the speed of the electrical field over a number of pole pairs, as stands without a tachometer have it.
fn is_electrical(header: &str) -> bool {
    header.to_lowercase().contains("electrical")
}

/// A warning about the fit. Where uncertainties are stated, they too may be why rows do not fit.
pub(super) fn notice_of(warning: &ThrustWarning, rows: &FittedRows<'_>) -> Notice {
    let stated = rows.stated;
    let is_of_rows = matches!(
        warning,
        ThrustWarning::LoadDoesNotFit { is_row: true, .. }
            | ThrustWarning::LoadsDisagree { are_rows: true, .. }
            | ThrustWarning::RowsDoNotFit { .. }
    );
    match warning {
        ThrustWarning::NarrowLoadRange(range @ LoadRange { force_ratio_needed: None, .. }) => {
            let too_large = match stated.is_empty() {
                true => String::new(),
                false => format!("check whether the uncertainties in {} are too large; ", stated.join(" or ")),
            };
            let hint = format!("{too_large}correct the rows that do not fit; if all is right, measure more rows");
            Notice::new(range_text(range, rows.doubt()), hint)
        }
        ThrustWarning::NarrowLoadRange(range) if rows.is_quiet && !stated.is_empty() => Notice::new(
            range_text(range, rows.doubt()),
            format!(
                "the rows differ from the law by far less than {} says: is it too large, or an expanded uncertainty? If not, measure a wider range \
                 of forces; C_f is still valid near these forces",
                stated.join(" or ")
            ),
        ),
        ThrustWarning::NarrowLoadRange(range) => Notice::new(
            range_text(range, rows.doubt()),
            "C_f is still valid near these forces; to test the law, measure a wider range of forces",
        ),
        ThrustWarning::OtherLawPreferred { law, .. } if let Some(WorstRow { name, share }) = &rows.worst => {
            let zero =
                if *law == ForceLaw::SquareWithIntercept { "check that the scale showed 0 at rest; " } else { "" };
            let (percent, size) = (fixed(100.0 * share.abs(), 1), if *share < 0.0 { "small" } else { "large" });
            let hint = format!(
                "{zero}simulators use F = C_f ω². Its largest error is at {name} of the file: the force that it gives there is {percent} % too {size}. If this is too \
                 much, fit a copy of the file that has only the rows near the speeds that you need"
            );
            Notice::new(warning.to_string(), hint)
        }
        ThrustWarning::SingleLoad => {
            Notice::new("only one row can be used, so the law cannot be tested", "measure more rows, at other speeds")
        }
        // a table has no recordings, and no tone
        ThrustWarning::ConstantsSplit => Notice::new(
            warning.to_string(),
            "do not use this constant: check the speeds, the forces and their units in all rows, and the number of \
             rotors; then measure more rows",
        ),
        // a table has no blades and no gear
        ThrustWarning::ImplausibleThrustCoefficient { .. } => {
            let (least, most) = (*THRUST_COEFFICIENT.start(), *THRUST_COEFFICIENT.end());
            let hint = format!(
                "propellers have {least} to {most}: check --diameter-m (it is used for all propellers of the file), --rotors, and the units of the forces and of the speeds{}",
                rows.pole_pairs()
            );
            Notice::new(warning.to_string(), hint)
        }
        _ if is_of_rows && !stated.is_empty() => {
            let no_speed = if rows.has_speed_std {
                ""
            } else {
                "; if the speeds are uncertain too, add a column with their uncertainties, for example speed_std_rpm"
            };
            let hint = format!(
                "{}; if nothing is wrong there, the uncertainties in column {} may be too small: check them{no_speed}",
                warning.hint(),
                stated.join(" or ")
            );
            Notice::new(warning.to_string(), hint)
        }
        _ => Notice::from(warning),
    }
}

/// A notice where several rotors make the forces, or seem to, and the user does not say so.
pub(super) fn rotors_notice(table: &StandTable, is_weighed: bool, plan: &Plan) -> Option<Notice> {
    match table.rotor_count.filter(|count| *count > 1) {
        _ if plan.given_rotors.is_some() => None,
        Some(count) => Some(Notice::new(
            format!("the table names {count} rotors: hovertone divides each force equally between them"),
            "if one rotor made the force alone, give --rotors 1",
        )),
        None if is_weighed => Some(Notice::new(
            "hovertone uses each mass as if one rotor carried it",
            "if N rotors carried the mass together, give --rotors N; if one rotor carried it, give --rotors 1",
        )),
        None => None,
    }
}

/// Says that C_T is far outside the range of propellers in the air of any place.
pub(super) fn far_off_notice(per_rotor: Estimate, diameter_m: f64, rows: &FittedRows<'_>) -> Option<Notice> {
    let coefficient = ThrustCoefficients::of_rotor(per_rotor.value, diameter_m, AIR_KG_M3).propeller;
    let (least, most) = (*THRUST_COEFFICIENT.start(), *THRUST_COEFFICIENT.end());
    let is_far = coefficient < least / FAR_OFF_FACTOR || coefficient > most * FAR_OFF_FACTOR;
    let text = format!(
        "with this diameter, the thrust coefficient C_T would be {} in air of {AIR_KG_M3} kg/m³, but propellers have {least} to {most}",
        significant(coefficient, 2)
    );
    let hint = format!(
        "check the units of the forces and of the speeds (rpm, rev/s or rad/s), the diameter, and --rotors{}",
        rows.pole_pairs()
    );
    is_far.then(|| Notice::new(text, hint))
}

/// Says that a propeller with such a constant would be larger than any multirotor's.
pub(super) fn too_large_notice(per_rotor: Estimate) -> Option<Notice> {
    let diameter_m = least_diameter_m(per_rotor.value);
    let text = format!(
        "a propeller with this thrust constant would have a diameter of {} m or more",
        significant(diameter_m, 2)
    );
    let hint = "check whether the columns of speed and force are swapped, and check their units";
    (diameter_m > DIAMETER_M_MAX).then(|| Notice::new(text, hint))
}

/// Says that no propeller has such a thrust.
pub(super) fn too_strong_notice(group: &StandGroup, per_rotor: Estimate, is_count_given: bool) -> Option<Notice> {
    let fastest_rad_s = group.rows.iter().map(|row| row.speed_rad_s).fold(0.0, f64::max);
    let tip_mach = least_tip_mach(per_rotor.value, RotorSpeed::from_rad_s(fastest_rad_s));
    let mach = if tip_mach < MACH_WITH_DECIMALS_MAX { fixed(tip_mach, 2) } else { format!("{tip_mach:.0e}") };
    let text = format!(
        "no propeller has this thrust at this speed: its blade tips would move at Mach {mach} (times the speed of sound) or faster, and no multirotor \
         exceeds Mach {TIP_MACH_MAX}"
    );
    let rotors = match is_count_given {
        true => "and --rotors",
        false => {
            "such as grams under a header of kilograms; if several rotors made the force, give their number with --rotors"
        }
    };
    let hint = format!("check the units of the forces and of the speeds, {rotors}");
    (tip_mach > TIP_MACH_MAX).then(|| Notice::new(text, hint))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows<'a>(stated: &'a [String], speed_column: &'a str) -> FittedRows<'a> {
        FittedRows { speed_column, stated, has_speed_std: false, is_quiet: false, worst: None }
    }

    #[test]
    fn stated_uncertainties_are_named_where_rows_do_not_fit() {
        let columns = ["thrust_std_g".to_owned()];
        let of_rows = ThrustWarning::RowsDoNotFit { names: vec!["line 3".to_owned()], are_left_out: false };
        assert!(
            notice_of(&of_rows, &rows(&columns, "rpm"))
                .hint
                .contains("; if nothing is wrong there, the uncertainties in column thrust_std_g may be too small: check them; if the speeds are uncertain too, add")
        );
        assert_eq!(notice_of(&of_rows, &rows(&[], "rpm")), Notice::from(&of_rows));
        // a table has rows, not loads
        assert!(notice_of(&ThrustWarning::SingleLoad, &rows(&columns, "rpm")).text.starts_with("only one row"));
    }

    #[test]
    fn a_table_is_not_asked_for_a_tone_or_a_flight() {
        let split = notice_of(&ThrustWarning::ConstantsSplit, &rows(&[], "rpm")).hint;
        assert!(split.starts_with("do not use this constant: check the speeds"), "{split}");
        assert!(!split.contains("tone") && !split.contains("load"), "{split}");
    }

    #[test]
    fn a_thrust_coefficient_is_not_blamed_on_flags_that_a_fit_lacks() {
        let low = ThrustWarning::ImplausibleThrustCoefficient { propeller: 0.026 };
        let [optical, electrical] = ["Motor Optical Speed (RPM)", "Motor Electrical Speed (RPM)"]
            .map(|speed| notice_of(&low, &rows(&[], speed)).hint);
        assert!(!optical.contains("blades") && !optical.contains("gear") && !optical.contains("pole"), "{optical}");
        assert!(electrical.contains("with the number of pole pairs of the motor"), "{electrical}");
    }

    #[test]
    fn forces_that_are_too_alike_are_not_blamed_on_what_the_table_does_not_have() {
        let range = LoadRange {
            force_ratio: 2.55,
            intercept_std_share: 0.03,
            shows_intercept: false,
            force_ratio_needed: Some(2.84),
        };
        let narrow = ThrustWarning::NarrowLoadRange(range);
        let columns = ["thrust_std_g".to_owned()];
        let said = |rows: FittedRows<'_>| notice_of(&narrow, &rows).text;
        assert!(said(rows(&[], "rpm")).contains("but with as much scatter as in these rows, it must be 2.84 times"));
        assert!(said(rows(&columns, "rpm")).contains("but with forces as uncertain as these, it must be"));
        let both = FittedRows { has_speed_std: true, ..rows(&columns, "rpm") };
        assert!(said(both).contains("but with speeds as uncertain as these, it must be"));
    }
}
