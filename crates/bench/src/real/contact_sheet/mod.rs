//! One small spectrogram for each recording, with our tracks and the truth, so that a person can judge at a glance.

mod drawing;
mod tile;

use super::cases::TruthSet;
use super::program::Program;
use super::progress::Progress;
use super::rows::Row;
use crate::accuracy::drawn;
use drawing::sheet;
use hovertone_figures::figure_png;
use tile::{tile_cases, tile_of};

/// One pixel for each unit of the drawing.
const DOTS_PER_INCH: f64 = 96.0;

/// The sheet as a PNG.
pub(super) fn contact_sheet(set: &TruthSet, program: &Program, rows: &[Row]) -> Result<Vec<u8>, String> {
    let cases = tile_cases(set);
    let progress = Progress::new("tiles of the contact sheet", cases.len());
    let tiles = drawn(cases.len(), |number| {
        let tile = tile_of(&cases[number], set, program, rows)?;
        progress.step();
        Ok(tile)
    })?;
    figure_png(&sheet(&tiles), DOTS_PER_INCH).map_err(|error| error.to_string())
}
