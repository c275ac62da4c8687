//! A spectrogram as the pixels of a PNG: one byte for each cell, the index of its level in the colour map.

use crate::colour::{ColourMap, LEVEL_COUNT};
use crate::figure::FigureError;
use crate::geometry::Extent;
use crate::picture::Picture;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// Share of the cells below the darkest colour, so that the noise floor has one colour.
const FLOOR_SHARE: f64 = 0.5;
/// Largest level difference between the brightest and the darkest colour, dB. Fainter sounds beside a rotor are invisible anyway.
const LEVELS_DB_MAX: f64 = 60.0;
/// Most pixels on each side.
const PIXELS_MAX: usize = 4096;

/// A spectrogram as pixels.
#[derive(Clone, Debug)]
pub(crate) struct Raster {
    width: usize,
    height: usize,
    /// Index of the colour of every pixel, row by row from the top: high frequencies first.
    indices: Vec<u8>,
    map: ColourMap,
    /// Level of the darkest colour.
    pub(crate) level_db_low: f64,
    /// Level of the brightest colour.
    pub(crate) level_db_high: f64,
}

/// The levels of the darkest and the brightest colour: from a little above the noise floor to the loudest cell above a frequency. Where that is the
/// lowest line of a rotor, wind below it does not hide the rotor.
pub(crate) fn level_range_db<'a>(pictures: impl IntoIterator<Item = &'a Picture>, above_hz: f64) -> Extent {
    let of_picture = |picture: &'a Picture| {
        let row_hz = (picture.hz_high - picture.hz_low) / picture.row_count as f64;
        let first = ((above_hz - picture.hz_low) / row_hz).max(0.0) as usize;
        picture.level_db.chunks(picture.row_count).flat_map(move |column| column.iter().skip(first).copied())
    };
    let mut levels: Vec<f32> = pictures.into_iter().flat_map(of_picture).collect();
    if levels.is_empty() {
        return Extent::new(-100.0, 0.0);
    }
    let floor = ((levels.len() - 1) as f64 * FLOOR_SHARE) as usize;
    let (_, &mut floor_db, _) = levels.select_nth_unstable_by(floor, f32::total_cmp);
    let loudest_db = f64::from(levels.iter().copied().fold(f32::MIN, f32::max));
    Extent::new(f64::from(floor_db).max(loudest_db - LEVELS_DB_MAX).min(loudest_db - 1.0), loudest_db)
}

/// A spectrogram as levels.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureLevels {
    /// One byte for each cell, column by column from low frequency to high: 0 is the darkest colour, 255 the brightest.
    pub cells: Vec<u8>,
    /// Level of the darkest colour, dB re a full-scale sine.
    pub level_db_low: f64,
    /// Level of the brightest colour.
    pub level_db_high: f64,
}

/// The levels of a picture, for a screen that colours them itself.
pub fn levels_of_picture(picture: &Picture) -> PictureLevels {
    let levels_db = level_range_db([picture], 0.0);
    let cell = |&level_db: &f32| (levels_db.share_of(f64::from(level_db)).clamp(0.0, 1.0) * 255.0).round() as u8;
    PictureLevels {
        cells: picture.level_db.iter().map(cell).collect(),
        level_db_low: levels_db.low,
        level_db_high: levels_db.high,
    }
}

impl Raster {
    /// The part of a picture between two frequencies, in its own resolution. Pixels outside the picture have the darkest colour.
    pub(crate) fn from_picture(picture: &Picture, shown_hz: Extent, levels_db: Extent, map: ColourMap) -> Self {
        let row_hz = (picture.hz_high - picture.hz_low) / picture.row_count as f64;
        let height = (shown_hz.width() / row_hz).round().clamp(1.0, PIXELS_MAX as f64) as usize;
        let width = picture.column_count;
        let mut indices = Vec::with_capacity(width * height);
        for pixel in (0..height).rev() {
            let hz = shown_hz.low + (pixel as f64 + 0.5) / height as f64 * shown_hz.width();
            let row = ((hz - picture.hz_low) / row_hz).floor();
            let row = (row >= 0.0 && row < picture.row_count as f64).then_some(row as usize);
            indices.extend((0..width).map(|column| {
                let level_db = row.and_then(|row| picture.column(column).get(row));
                let share = level_db.map_or(0.0, |&level_db| levels_db.share_of(f64::from(level_db)));
                (share.clamp(0.0, 1.0) * (LEVEL_COUNT - 1) as f64).round() as u8
            }));
        }
        Self { width, height, indices, map, level_db_low: levels_db.low, level_db_high: levels_db.high }
    }

    /// All colours of a map in one row, darkest first.
    pub(crate) fn of_all_colours(map: ColourMap, levels_db: Extent) -> Self {
        let indices = (0..LEVEL_COUNT as u8).collect();
        Self { width: LEVEL_COUNT, height: 1, indices, map, level_db_low: levels_db.low, level_db_high: levels_db.high }
    }

    /// Pooled to at most the given size; each pixel keeps its loudest cell.
    pub(crate) fn at_most(self, width_max: usize, height_max: usize) -> Self {
        let (width, height) = (self.width.min(width_max.max(1)), self.height.min(height_max.max(1)));
        if (width, height) == (self.width, self.height) {
            return self;
        }
        let mut indices = vec![0; width * height];
        for (index, &level) in self.indices.iter().enumerate() {
            let (x, y) = (index % self.width * width / self.width, index / self.width * height / self.height);
            let pixel: &mut u8 = &mut indices[y * width + x];
            *pixel = (*pixel).max(level);
        }
        Self { width, height, indices, ..self }
    }

    /// As a PNG.
    pub(crate) fn png(&self) -> Result<Vec<u8>, FigureError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        encoder.set_palette(self.map.colours().concat());
        encoder.write_header()?.write_image_data(&self.indices)?;
        Ok(bytes)
    }

    /// As a data URI.
    pub(crate) fn data_uri(&self) -> Result<String, FigureError> {
        Ok(format!("data:image/png;base64,{}", STANDARD.encode(self.png()?)))
    }
}
