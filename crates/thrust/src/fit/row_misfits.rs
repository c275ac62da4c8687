//! Rows of a table that do not fit the law through the others.

use crate::square_law::PointVerdict;
use crate::warning::ThrustWarning;
use crate::warning_words::NAMES_MAX;

/// Up to this number of rows that do not fit, each has a warning of its own. *Decision.*
const MISFITS_BY_NAME: usize = 3;

/// The warnings about rows that do not fit, in the order of the table. `gravity_m_s2` is given where the rows are masses that hover.
pub(super) fn warnings_of_misfits(points: &[PointVerdict], gravity_m_s2: Option<f64>) -> Vec<ThrustWarning> {
    let mass_kg = |force_n: Option<f64>| Some(force_n? / gravity_m_s2?);
    let misfit = |point: &PointVerdict| ThrustWarning::LoadDoesNotFit {
        name: point.name.clone(),
        is_row: true,
        mass_that_fits_kg: mass_kg(point.force_that_fits_n),
        mass_that_fits_std_kg: mass_kg(point.force_that_fits_std_n),
        is_left_out: point.is_gross,
    };
    let misfits: Vec<&PointVerdict> = points.iter().filter(|point| point.fits == Some(false)).collect();
    if misfits.len() > 1 && misfits.len() == points.len() {
        let names = names_of(&misfits);
        return vec![ThrustWarning::LoadsDisagree {
            names,
            are_rows: true,
            has_added_mass: false,
            masses_that_fit_kg: vec![],
        }];
    }
    if misfits.len() <= MISFITS_BY_NAME {
        return misfits.into_iter().map(misfit).collect();
    }
    let of_kind = |are_left_out: bool| {
        let of_kind: Vec<&PointVerdict> =
            misfits.iter().copied().filter(|point| point.is_gross == are_left_out).collect();
        let names = names_of(&of_kind);
        (!names.is_empty()).then_some(ThrustWarning::RowsDoNotFit { names, are_left_out })
    };
    [true, false].into_iter().filter_map(of_kind).collect()
}

/// The names of rows in the order of the table. A warning cuts a long list: the rows that are farthest off come first, in the same order.
fn names_of(misfits: &[&PointVerdict]) -> Vec<String> {
    let log_ratio = |point: &PointVerdict| point.deviation_share.map_or(0.0, |share| share.ln_1p().abs());
    let mut worst: Vec<(usize, &PointVerdict)> = misfits.iter().copied().enumerate().collect();
    worst.sort_by(|(_, a), (_, b)| log_ratio(b).total_cmp(&log_ratio(a)));
    let mut others = worst.split_off(worst.len().min(NAMES_MAX));
    worst.sort_by_key(|(index, _)| *index);
    others.sort_by_key(|(index, _)| *index);
    worst.into_iter().chain(others).map(|(_, point)| point.name.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_long_list_the_five_worst_rows_come_first_in_their_order() {
        let point = |(row, share): (usize, f64)| PointVerdict {
            name: format!("line {row}"),
            deviation_share: Some(share),
            thrust_constant_of_others_n_s2: None,
            p_value: None,
            fits: Some(false),
            is_gross: false,
            force_that_fits_n: None,
            force_that_fits_std_n: None,
        };
        let all = [(2, -0.05), (3, 0.02), (5, 0.3), (7, -0.1), (10, 0.2), (14, -0.15)].map(point);
        let names = names_of(&all.iter().collect::<Vec<_>>());
        assert_eq!(names, ["line 2", "line 5", "line 7", "line 10", "line 14", "line 3"]);
    }
}
