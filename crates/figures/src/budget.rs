//! The uncertainty budget as bars.

use crate::axis::Axis;
use crate::canvas::{Anchor, Canvas, Panel, Place, WIDTH};
use crate::colour::{INK, MUTED, SERIES};
use crate::figure::{Figure, FigureError};
use crate::geometry::{Extent, Point};
use hovertone_thrust::{BudgetLine, ThrustTable};

const ROW: i32 = 52;
const LEFT: i32 = 500;
/// Length of the axis over the longest bar: its words stand beside it.
const AXIS_OVER_LONGEST: f64 = 1.55;
/// Contributions below this share of the largest have no visible bar and are left out.
const SHARE_MIN: f64 = 0.002;

/// `None` without a budget.
pub(crate) fn figure(table: &ThrustTable) -> Result<Option<Figure>, FigureError> {
    let (Some(budget), Some(constant)) = (&table.budget, table.thrust_constant_total_n_s2) else { return Ok(None) };
    let percent = |contribution_n_s2: f64| 100.0 * contribution_n_s2.abs() / constant.value;
    let largest = budget.lines.iter().map(|line| line.contribution_n_s2.abs()).fold(0.0, f64::max);
    let mut lines: Vec<&BudgetLine> =
        budget.lines.iter().filter(|line| line.contribution_n_s2.abs() > SHARE_MIN * largest).collect();
    lines.sort_by(|a, b| b.contribution_n_s2.abs().total_cmp(&a.contribution_n_s2.abs()));
    let combined = percent(budget.combined_std_uncertainty_n_s2);
    if lines.is_empty() || !combined.is_finite() || combined <= 0.0 {
        return Ok(None);
    }
    let bottom = 40 + (lines.len() as i32 + 1) * ROW + 20;
    let panel = Panel {
        place: Place { left: LEFT, top: 30, right: WIDTH - 60, bottom },
        x: Axis::new(
            "contribution to the standard uncertainty of C_f (%)",
            Extent::new(0.0, AXIS_OVER_LONGEST * combined),
        )
        .with_ticks(8),
        y: Axis::new("", Extent::new(0.0, 1.0)).with_ticks(0),
        right: None,
        title: String::new(),
    };
    let mut canvas = Canvas::new("budget", bottom + 110);
    canvas.panel(&panel)?;
    let rows = lines
        .iter()
        .map(|line| (line.input.title(), percent(line.contribution_n_s2), Some(line.share)))
        .chain([("combined", combined, None)]);
    canvas.layer("bars", |sheet| {
        for (index, (title, percent, share)) in rows.enumerate() {
            let top = 40 + index as i32 * ROW;
            let length = percent / (AXIS_OVER_LONGEST * combined) * f64::from(panel.place.right - LEFT);
            let colour = if share.is_some() { SERIES[0] } else { INK };
            let place =
                Place { left: LEFT, top: top + 8, right: LEFT + length.round().max(1.0) as i32, bottom: top + ROW - 8 };
            sheet.text(title, Point::new(LEFT - 20, top + ROW / 2), Anchor::Right, INK)?;
            sheet.filled(place, colour, 1.0)?;
            let words = match share {
                Some(share) => format!("{percent:.3} % ({:.1} % of the variance)", 100.0 * share),
                None => format!("{percent:.3} %"),
            };
            sheet.text(&words, Point::new(place.right + 14, top + ROW / 2), Anchor::Left, MUTED)?;
        }
        Ok(())
    })?;
    let description = "What makes the thrust constant uncertain: each input's contribution to the standard uncertainty, largest first, and all of \
                       them combined (root of the sum of squares).";
    Ok(Some(canvas.finish("Uncertainty budget", description)))
}
