//! From a figure to pixels.

use crate::figure::{Figure, FigureError};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};
use std::sync::Arc;

/// Resolution for print.
pub const DOTS_PER_INCH: f64 = 300.0;
const MM_PER_INCH: f64 = 25.4;
/// Pixels per inch of an SVG.
const SVG_PIXELS_PER_INCH: f64 = 96.0;

/// The figure as a PNG with the given resolution. Its fonts are part of the program, so that equal figures give equal bytes on every
/// machine.
///
/// # Errors
/// An invalid SVG, or a figure that is too large for memory.
pub fn figure_png(figure: &Figure, dots_per_inch: f64) -> Result<Vec<u8>, FigureError> {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    // the second font has the letters that the first lacks
    fonts.load_font_data(epaint_default_fonts::HACK_REGULAR.to_vec());
    fonts.set_sans_serif_family("Ubuntu");
    let options = Options { fontdb: Arc::new(fonts), font_family: "Ubuntu".to_owned(), ..Options::default() };
    let pixels = |error: &dyn std::fmt::Display| FigureError::Pixels(error.to_string());
    let tree = Tree::from_str(&figure.svg, &options).map_err(|error| pixels(&error))?;
    let scale = (dots_per_inch / SVG_PIXELS_PER_INCH) as f32;
    let size = tree.size().to_int_size().scale_by(scale);
    let size = size.ok_or_else(|| pixels(&"it has no size"))?;
    let mut pixmap = Pixmap::new(size.width(), size.height()).ok_or_else(|| pixels(&"it is too large"))?;
    // white below the figure, so that a sheet that ends within a pixel has no dark edge
    pixmap.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    packed(&pixmap, dots_per_inch)
}

/// Opaque pixels with their resolution, as a PNG.
fn packed(pixmap: &Pixmap, dots_per_inch: f64) -> Result<Vec<u8>, FigureError> {
    let colours: Vec<u8> =
        pixmap.pixels().iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixmap.width(), pixmap.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let per_metre = (dots_per_inch / MM_PER_INCH * 1e3).round() as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit: png::Unit::Meter }));
    encoder.write_header()?.write_image_data(&colours)?;
    Ok(bytes)
}
