//! A figure as a file: SVG or PNG, by the ending of its name.

use crate::failure::Failure;
use hovertone_figures::{Figure, figure_png};
use std::path::Path;

/// Kind of a picture.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum FigureKind {
    Png,
    Svg,
}

impl FigureKind {
    /// The kind that the ending of a name tells; `hint` says which names to use.
    pub(crate) fn of(output: &Path, hint: &str) -> Result<Self, Failure> {
        let extension = output.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("png") => Ok(Self::Png),
            Some("svg") => Ok(Self::Svg),
            _ => Err(Failure::Usage {
                what: "the name of the picture must end with .png or .svg".to_owned(),
                hint: hint.to_owned(),
                path: Some(output.to_owned()),
            }),
        }
    }

    /// The content of the file, with the resolution of a PNG.
    pub(crate) fn bytes(self, figure: Figure, dots_per_inch: f64) -> Result<Vec<u8>, Failure> {
        match self {
            Self::Svg => Ok(figure.svg.into_bytes()),
            Self::Png => figure_png(&figure, dots_per_inch).map_err(Failure::internal),
        }
    }
}
