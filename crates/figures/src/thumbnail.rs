//! A spectrogram alone, without axes, for sheets of many recordings.

use crate::colour::ColourMap;
use crate::figure::FigureError;
use crate::geometry::Extent;
use crate::picture::Picture;
use crate::raster::Raster;

/// Settings of a thumbnail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thumbnail {
    /// Highest frequency; the lowest is 0.
    pub hz_high: f64,
    /// Level of white.
    pub level_db_low: f64,
    /// Level of black.
    pub level_db_high: f64,
    /// Most pixels from left to right.
    pub width_max: usize,
    /// Most pixels from bottom to top.
    pub height_max: usize,
}

/// A picture in greys as a data URI of a PNG, to have coloured lines drawn over it. Pixels outside the picture are white.
///
/// # Errors
/// Errors of the PNG encoder.
pub fn thumbnail_uri(picture: &Picture, thumbnail: &Thumbnail) -> Result<String, FigureError> {
    let &Thumbnail { hz_high, level_db_low, level_db_high, width_max, height_max } = thumbnail;
    let levels_db = Extent::new(level_db_low, level_db_high);
    let raster = Raster::from_picture(picture, Extent::new(0.0, hz_high), levels_db, ColourMap::Greys);
    raster.at_most(width_max, height_max).data_uri()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::PictureView;
    use hovertone_analysis::Span;

    #[test]
    fn a_thumbnail_is_a_png_of_bounded_size() {
        let view = PictureView { harmonic: None, hz_low: 0.0, hz_high: 100.0, window_s: 0.1 };
        let picture = Picture {
            view,
            span: Span { from_s: 0.0, to_s: 1.0 },
            hz_low: 0.0,
            hz_high: 100.0,
            column_count: 40,
            row_count: 20,
            level_db: vec![-3.0; 800],
        };
        let thumbnail =
            Thumbnail { hz_high: 200.0, level_db_low: -10.0, level_db_high: 0.0, width_max: 10, height_max: 8 };
        let uri = thumbnail_uri(&picture, &thumbnail).unwrap();
        let base64 = uri.strip_prefix("data:image/png;base64,").unwrap();
        let bytes = base64::Engine::decode(&base64::engine::general_purpose::STANDARD, base64).unwrap();
        let info = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap().info().clone();
        assert_eq!((info.width, info.height), (10, 8));
    }
}
