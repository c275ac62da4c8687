//! Colours that people with any colour vision can distinguish, in print and on screens.

use colorous::Gradient;
use hovertone_analysis::Method;
use plotters::style::RGBColor;

/// Text and axes.
pub(crate) const INK: RGBColor = RGBColor(0x1b, 0x1b, 0x1f);
/// Secondary text: units, notes, unused parts.
pub(crate) const MUTED: RGBColor = RGBColor(0x6b, 0x70, 0x78);
/// Grid lines.
pub(crate) const GRID: RGBColor = RGBColor(0xd9, 0xdc, 0xe1);
/// Background of the sheet.
pub(crate) const PAPER: RGBColor = RGBColor(0xff, 0xff, 0xff);
/// Bands.
pub(crate) const BAND: RGBColor = RGBColor(0xe6, 0x9f, 0x00);
/// Lines over a spectrogram.
pub(crate) const OVER_PICTURE: RGBColor = RGBColor(0xfe, 0xfe, 0xfe);

/// Colours of several objects of one kind, distinguishable with any colour vision (Okabe and Ito 2008).
pub(crate) const SERIES: [RGBColor; 6] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0xe6, 0x9f, 0x00),
];

/// The colour of a method in every figure, as `#rrggbb`.
pub fn method_colour(method: Method) -> String {
    let RGBColor(red, green, blue) = colour_of_method(method);
    format!("#{red:02X}{green:02X}{blue:02X}")
}

pub(crate) fn colour_of_method(method: Method) -> RGBColor {
    match method {
        Method::Harmonic => SERIES[0],
        Method::MaximumTrace => SERIES[1],
        Method::Gaussian => SERIES[3],
        _ => SERIES[2],
    }
}

/// Number of levels of a colour map. Finer levels are invisible and make files larger.
pub const LEVEL_COUNT: usize = 64;

/// Colours of the levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ColourMap {
    /// Viridis: its lightness increases evenly, for any colour vision and for grey print.
    Viridis,
    /// White to black, under coloured lines.
    Greys,
}

/// Viridis from the lowest level to the highest as red, green and blue: the colours of every spectrogram.
pub fn level_colours() -> [[u8; 3]; LEVEL_COUNT] {
    ColourMap::Viridis.colours()
}

impl ColourMap {
    pub(crate) fn colours(self) -> [[u8; 3]; LEVEL_COUNT] {
        let gradient: Gradient = match self {
            Self::Viridis => colorous::VIRIDIS,
            Self::Greys => colorous::GREYS,
        };
        std::array::from_fn(|level| gradient.eval_rational(level, LEVEL_COUNT).as_array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_rises_in_lightness() {
        let lightness = |[red, green, blue]: [u8; 3]| {
            0.2126 * f64::from(red) + 0.7152 * f64::from(green) + 0.0722 * f64::from(blue)
        };
        let colours = level_colours();
        assert!(colours.windows(2).all(|pair| lightness(pair[0]) < lightness(pair[1])));
        let mut distinct = colours.to_vec();
        distinct.dedup();
        assert_eq!(distinct.len(), LEVEL_COUNT, "two levels share a colour: a level could not be read back");
    }
}
