//! Figure 6 of the paper: the spectrogram of each load, its trials joined.

use crate::axis::Axis;
use crate::canvas::{Canvas, Panel, Place, WIDTH};
use crate::colour::{ColourMap, OVER_PICTURE};
use crate::figure::{Figure, FigureError};
use crate::geometry::{Extent, Point};
use crate::joined::{NAMES, end_s, joined_by_load, joined_words};
use crate::raster::{Raster, level_range_db};
use crate::trial::Trial;
use plotters::style::Color;

const PANEL: i32 = 400;
const PITCH: i32 = 600;
const TOP: i32 = 140;
/// Room for the axis below the last panel.
const BELOW: i32 = 110;
/// Most rows of a picture, 150 dpi in height.
const ROWS_MAX: usize = 240;
/// Most columns of all trials of a panel together.
const COLUMNS_MAX: usize = 1200;

/// `None` without pictures.
pub(crate) fn figure(trials: &[Trial<'_>]) -> Result<Option<Figure>, FigureError> {
    let loads = joined_by_load(trials);
    let all = || loads.iter().flat_map(|(_, joined)| joined);
    let Some(hz_max) = all().filter_map(|joined| Some(joined.trial.whole()?.hz_high)).reduce(f64::max) else {
        return Ok(None);
    };
    let order = all().find_map(|joined| joined.trial.tone_order());
    let lowest_hz = all().map(|joined| joined.trial.lowest_line_hz()).reduce(f64::min).unwrap_or(0.0);
    let levels_db = level_range_db(all().filter_map(|joined| joined.trial.whole()), lowest_hz);
    let mut canvas = Canvas::new("figure-6-spectrograms", TOP + (loads.len() as i32 - 1) * PITCH + PANEL + BELOW);
    canvas.colour_bar(ColourMap::Viridis, levels_db)?;
    for (index, (load, joined)) in loads.iter().enumerate() {
        let top = TOP + index as i32 * PITCH;
        let panel = Panel {
            place: Place { left: 180, top, right: WIDTH - 180, bottom: top + PANEL },
            x: Axis::new("joined time of the trials (s)", Extent::new(0.0, end_s(joined))).with_ticks(11),
            y: Axis::new("frequency (kHz)", Extent::new(0.0, hz_max / 1e3)).with_ticks(7),
            right: order.map(|order| (format!("frequency / {order} (rev/s)"), order / 1e3)),
            title: String::new(),
        };
        canvas.panel(&panel)?;
        let columns = (COLUMNS_MAX / joined.len()).max(16);
        for one in joined {
            let Some(picture) = one.trial.whole() else { continue };
            let raster = Raster::from_picture(picture, Extent::new(0.0, hz_max), levels_db, ColourMap::Viridis);
            canvas.picture(&panel, one.extent_s(), &raster.at_most(columns, ROWS_MAX))?;
        }
        canvas.plot(&panel, "trial-borders", |plot| {
            joined.iter().skip(1).try_for_each(|one| {
                let at_s = one.extent_s().low;
                plot.line(&[Point::new(at_s, 0.0), Point::new(at_s, hz_max / 1e3)], OVER_PICTURE.stroke_width(3))
            })
        })?;
        joined_words(&mut canvas, &panel, load, joined)?;
    }
    let description = format!(
        "Level of the sound over time and frequency, one picture for each load, its trials joined as in figure 6 of the \
                       paper. The bright lines are the tone of the rotors and its harmonics; heavier loads have them higher. {NAMES}"
    );
    Ok(Some(canvas.finish("Figure 6: spectrogram of each load", description)))
}
