//! What the page says of vehicle, tone and span.

use hovertone::speed::SpanConfig;
use hovertone_vehicle::{Gear, find_preset};
use hovertone_workflow::Said;
use serde::Deserialize;

/// As JSON from the page; all of it may be left out.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct SaidOnPage {
    preset: Option<String>,
    blades: Option<u32>,
    gear: Option<Gear>,
    diameter_m: Option<f64>,
    mass_kg: Option<f64>,
    rotors: Option<u32>,
    band_hz: Option<(f64, f64)>,
    from_s: Option<f64>,
    to_s: Option<f64>,
}

impl SaidOnPage {
    /// The same, as the analysis takes it.
    pub(crate) fn said(&self) -> Said<'static> {
        Said {
            vehicle: self.preset.as_deref().and_then(find_preset),
            blades: self.blades,
            gear: self.gear,
            diameter_m: self.diameter_m,
            mass_kg: self.mass_kg,
            rotors: self.rotors,
            band_hz: self.band_hz,
            span: SpanConfig { from_s: self.from_s, to_s: self.to_s },
            ..Said::default()
        }
    }
}
