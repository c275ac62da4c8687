//! A figure as pixels.

use crate::figure::{Figure, FigureError};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};
use std::sync::Arc;

/// What printers want of a figure.
pub const DOTS_PER_INCH: f64 = 300.0;
const MM_PER_INCH: f64 = 25.4;
/// Pixels that an SVG calls an inch.
const SVG_PIXELS_PER_INCH: f64 = 96.0;

/// The figure as a PNG of so many dots per inch. Its letters are those that the program carries, not the machine's: same figure, same bytes.
///
/// # Errors
/// A figure that is no SVG, or too large for memory.
pub fn figure_png(figure: &Figure, dots_per_inch: f64) -> Result<Vec<u8>, FigureError> {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    // what the first lacks
    fonts.load_font_data(epaint_default_fonts::HACK_REGULAR.to_vec());
    fonts.set_sans_serif_family("Ubuntu");
    let options = Options { fontdb: Arc::new(fonts), font_family: "Ubuntu".to_owned(), ..Options::default() };
    let pixels = |error: &dyn std::fmt::Display| FigureError::Pixels(error.to_string());
    let tree = Tree::from_str(&figure.svg, &options).map_err(|error| pixels(&error))?;
    let scale = (dots_per_inch / SVG_PIXELS_PER_INCH) as f32;
    let size = tree.size().to_int_size().scale_by(scale);
    let size = size.ok_or_else(|| pixels(&"it has no size"))?;
    let mut pixmap = Pixmap::new(size.width(), size.height()).ok_or_else(|| pixels(&"it is too large"))?;
    // a sheet that ends within a pixel has no dark edge
    pixmap.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    packed(&pixmap, dots_per_inch)
}

/// Opaque pixels with their density.
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
