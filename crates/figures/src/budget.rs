//! The uncertainty budget as bars.

use crate::axis::Axis;
use crate::canvas::{Anchor, Canvas, Panel, Place, WIDTH, text_width};
use crate::colour::{INK, MUTED, SERIES};
use crate::figure::{Figure, FigureError};
use crate::geometry::{Extent, Point};
use hovertone_thrust::{BudgetLine, ThrustTable};

const ROW: i32 = 52;
const LEFT: i32 = 500;
const RIGHT: i32 = WIDTH - 60;
/// Gap between a bar and its words.
const GAP: i32 = 14;
/// Significant digits of a percentage.
const DIGITS: i32 = 3;
/// Most decimals of a percentage.
const DECIMALS_MAX: i32 = 3;
/// Contributions below this share of the largest have no visible bar and are left out.
const SHARE_MIN: f64 = 0.002;

/// A row of the figure.
struct Bar {
    title: &'static str,
    percent: f64,
    words: String,
    /// Whether it is all inputs together.
    is_sum: bool,
}

impl Bar {
    fn new(title: &'static str, percent: f64, share: Option<f64>) -> Self {
        let words = match share {
            Some(share) => format!("{} % ({:.1} % of the variance)", rounded(percent), 100.0 * share),
            None => format!("{} %", rounded(percent)),
        };
        Self { title, percent, words, is_sum: share.is_none() }
    }

    /// Length of the axis over which the bar leaves room for its words.
    fn axis_percent(&self) -> f64 {
        let room = RIGHT - LEFT;
        let words = GAP + text_width(&self.words);
        self.percent * f64::from(room) / f64::from(room - words)
    }
}

/// A percentage with [`DIGITS`]: "310", "0.502".
fn rounded(percent: f64) -> String {
    let decimals = (DIGITS - 1 - percent.abs().log10().floor() as i32).clamp(0, DECIMALS_MAX);
    format!("{percent:.*}", decimals as usize)
}

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
    let rows: Vec<Bar> = lines
        .iter()
        .map(|line| Bar::new(line.input.title(), percent(line.contribution_n_s2), Some(line.share)))
        .chain([Bar::new("combined", combined, None)])
        .collect();
    // each bar leaves room for its words
    let axis_percent = rows.iter().map(Bar::axis_percent).fold(combined, f64::max);
    let bottom = 40 + (lines.len() as i32 + 1) * ROW + 20;
    let panel = Panel {
        place: Place { left: LEFT, top: 30, right: RIGHT, bottom },
        x: Axis::new("contribution to the standard uncertainty of C_f (%)", Extent::new(0.0, axis_percent))
            .with_ticks(8),
        y: Axis::new("", Extent::new(0.0, 1.0)).with_ticks(0),
        right: None,
        title: String::new(),
    };
    let mut canvas = Canvas::new("budget", bottom + 110);
    canvas.panel(&panel)?;
    canvas.layer("bars", |sheet| {
        for (index, Bar { title, percent, words, is_sum }) in rows.iter().enumerate() {
            let top = 40 + index as i32 * ROW;
            let length = percent / axis_percent * f64::from(RIGHT - LEFT);
            let colour = if *is_sum { INK } else { SERIES[0] };
            let place =
                Place { left: LEFT, top: top + 8, right: LEFT + length.round().max(1.0) as i32, bottom: top + ROW - 8 };
            sheet.text(title, Point::new(LEFT - 20, top + ROW / 2), Anchor::Right, INK)?;
            sheet.filled(place, colour, 1.0)?;
            sheet.text(words, Point::new(place.right + GAP, top + ROW / 2), Anchor::Left, MUTED)?;
        }
        Ok(())
    })?;
    let description = "What makes the thrust constant uncertain: each input's contribution to the standard uncertainty, largest first, and all of \
                       them combined (root of the sum of squares).";
    Ok(Some(canvas.finish("Uncertainty budget", description)))
}
