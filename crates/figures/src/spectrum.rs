//! Figure 7 of the paper: the spectrum, and the bands of the fundamental and its harmonics.

use crate::axis::{Axis, range_with_margin};
use crate::canvas::{Canvas, Panel, Place, WIDTH};
use crate::colour::{BAND, SERIES};
use crate::figure::{Figure, FigureError, shortened};
use crate::geometry::{Extent, Point};
use crate::picture::MeanSpectrum;
use crate::trial::Trial;
use hovertone_analysis::Band;
use plotters::style::Color;

/// Most points of a curve: two per half millimetre.
const POINTS_MAX: usize = 700;
/// Lowest frequency of the scale, Hz: below it there is wind and handling noise, and no rotor.
const HZ_LOW: f64 = 20.0;

/// `None` where no trial has a tone.
pub(crate) fn figure(trials: &[Trial<'_>]) -> Result<Option<Figure>, FigureError> {
    let shown = |trial: &&Trial<'_>| !trial.bands().is_empty() && trial.pictures.is_some_and(|p| p.spectrum.is_some());
    let Some(trial) = trials.iter().find(shown) else { return Ok(None) };
    let Some(spectrum) = trial.pictures.and_then(|pictures| pictures.spectrum.as_ref()) else { return Ok(None) };
    let bands = trial.bands();
    let hz_max = trial.whole().map_or(spectrum.bin_hz * spectrum.level_db.len() as f64, |picture| picture.hz_high);
    let all = points(spectrum, Extent::new(HZ_LOW, hz_max));
    let Some(levels_db) = range_with_margin(all.iter().map(|point| point.y), 0.06) else { return Ok(None) };
    let mut canvas = Canvas::new("figure-7-spectrum", 1180);
    let panel = Panel {
        place: Place { left: 180, top: 70, right: WIDTH - 60, bottom: 500 },
        x: Axis::new("frequency (Hz)", Extent::new(0.0, hz_max)).with_ticks(10),
        y: Axis::new("level (dB re full scale)", levels_db),
        right: None,
        title: format!("(a) mean spectrum of the hover of {}", shortened(trial.recording, 50)),
    };
    canvas.panel(&panel)?;
    canvas.plot(&panel, "bands", |plot| {
        bands.iter().try_for_each(|band| plot.block(extent_hz(band), levels_db, BAND, 0.35))
    })?;
    canvas.plot(&panel, "spectrum", |plot| plot.line(&all, SERIES[0].stroke_width(2)))?;
    let (count, gap) = (bands.len() as i32, 170);
    let width = (WIDTH - 60 - 180 - (count - 1) * gap) / count;
    for (index, band) in bands.iter().enumerate() {
        let left = 180 + index as i32 * (width + gap);
        let margin_hz = 0.25 * band.width_hz();
        let around_hz = Extent::new(band.band_hz_low - margin_hz, band.band_hz_high + margin_hz);
        let curve = points(spectrum, around_hz);
        let levels_db = range_with_margin(curve.iter().map(|point| point.y), 0.08).unwrap_or(levels_db);
        let panel = Panel {
            place: Place { left, top: 710, right: left + width, bottom: 1060 },
            x: Axis::new("frequency (Hz)", around_hz).with_ticks(4),
            y: Axis::new(if index == 0 { "level (dB)" } else { "" }, levels_db).with_ticks(5),
            right: None,
            title: format!("{} {}", if index == 0 { "(b)" } else { "" }, harmonic_name(band.harmonic))
                .trim()
                .to_owned(),
        };
        canvas.panel(&panel)?;
        canvas.plot(&panel, "bands", |plot| plot.block(extent_hz(band), levels_db, BAND, 0.35))?;
        canvas.plot(&panel, &format!("spectrum harmonic-{}", band.harmonic), |plot| {
            plot.line(&curve, SERIES[0].stroke_width(3))
        })?;
    }
    let description = format!(
        "Mean spectrum of a hover ({}). Shaded: the bands in which the fundamental and its harmonics are looked for, as the band-pass filters of \
         figure 7 of the paper; below, each of them enlarged.",
        trial.recording
    );
    Ok(Some(canvas.finish("Figure 7: spectrum with the bands of the fundamental and its harmonics", description)))
}

fn extent_hz(band: &Band) -> Extent {
    Extent::new(band.band_hz_low, band.band_hz_high)
}

/// "fundamental", "2nd harmonic".
pub(crate) fn harmonic_name(harmonic: u32) -> String {
    match harmonic {
        1 => "fundamental".to_owned(),
        2 => "2nd harmonic".to_owned(),
        3 => "3rd harmonic".to_owned(),
        _ => format!("{harmonic}th harmonic"),
    }
}

/// The spectrum between two frequencies. Of neighbouring bins that share a point the loudest is shown.
fn points(spectrum: &MeanSpectrum, shown_hz: Extent) -> Vec<Point> {
    let first = (shown_hz.low.max(0.0) / spectrum.bin_hz).ceil() as usize;
    let end = ((shown_hz.high / spectrum.bin_hz).floor() as usize + 1).min(spectrum.level_db.len());
    let bins: Vec<usize> = (first..end).collect();
    let group = bins.len().div_ceil(POINTS_MAX).max(1);
    let loudest =
        |bins: &[usize]| bins.iter().copied().max_by(|&a, &b| spectrum.level_db[a].total_cmp(&spectrum.level_db[b]));
    bins.chunks(group)
        .filter_map(loudest)
        .map(|bin| Point::new(bin as f64 * spectrum.bin_hz, f64::from(spectrum.level_db[bin])))
        .collect()
}
