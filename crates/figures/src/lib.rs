//! Results as figures: SVG for reading and printing, and the same as PNG. Pure functions; the caller decides where the bytes go.
//!
//! ```text
//! canvas      layers of drawing on one sheet, by plotters      axis      ranges, ticks and their labels
//! picture     sound → spectrograms of bounded size, and the mean spectrum of the hover
//! raster      a spectrogram as the pixels of a PNG             colour    colours for any colour vision
//! thumbnail   a spectrogram without axes
//! figure      name, texts and SVG of a figure                  bitmap    SVG → PNG
//! trial       input of the figures about a recording           joined    trials in sequence on one time axis
//! geometry    points and extents
//! ```
//!
//! One file for each figure: `database` (figure 5 of the paper), `load_spectrograms` (6), `spectrum` (7), `maximum_trace` (8), `gaussian`
//! (9), `fit`, `budget`, `rotors`, `motor_steps`, `verification`, `spectrogram` of one recording, and `distributions` of several sets of cases.
//! `readings` are the lines of an ambiguous tone over a spectrogram.

mod axis;
mod bitmap;
mod budget;
mod canvas;
mod colour;
mod database;
mod distributions;
mod experiment;
mod figure;
mod fit;
mod gaussian;
mod geometry;
mod grey_box;
mod joined;
mod load_spectrograms;
mod maximum_trace;
mod motor_steps;
mod picture;
mod raster;
mod readings;
mod rotors;
mod spectrogram;
mod spectrum;
mod thumbnail;
mod trial;
mod verification;

pub use bitmap::{DOTS_PER_INCH, figure_png};
pub use colour::{LEVEL_COUNT, level_colours, method_colour};
pub use distributions::{Distribution, distributions_figure};
pub use experiment::{ExperimentFigures, figures_of_experiment};
pub use figure::{Figure, FigureError, beginning, shortened, without_advice};
pub use grey_box::{DrawnSpeeds, grey_box_figure};
pub use motor_steps::{DrawnStep, motor_steps_figure};
pub use picture::{
    MeanSpectrum, Picture, PictureConfig, PictureError, PictureView, Pictures, pictures_from_source,
    views_of_recording, whitened,
};
pub use raster::{PictureLevels, levels_of_picture};
pub use rotors::rotors_figure;
pub use spectrogram::recording_figure;
pub use thumbnail::{Thumbnail, thumbnail_uri};
pub use trial::Trial;
pub use verification::verification_figure;
