//! The facts that a person gave before a recording was heard.

use crate::recording::SpeedRecord;
use hovertone_analysis::GivenFacts;
use hovertone_vehicle::{BLADES_MAX, find_preset};
use serde_json::Value;

impl SpeedRecord {
    /// The facts that were given before the recording was heard. Diameter and mass are among them only where the named vehicle has others.
    pub fn given_facts(&self) -> GivenFacts {
        let vehicle = self.setting("/known/vehicle").and_then(Value::as_str);
        let preset = vehicle.and_then(find_preset);
        // the file of a user's own vehicle is not read here: its numbers count as the vehicle's
        let is_own_vehicle = vehicle.is_some() && preset.is_none();
        let is_beside = |place: &str, known: Option<f64>| {
            let given = self.setting(place).and_then(Value::as_f64);
            given.is_some() && given != known && !is_own_vehicle
        };
        let known_diameter_m = preset.and_then(|vehicle| Some(vehicle.propeller_diameter_m?.value));
        let known_mass_kg = preset.and_then(|vehicle| Some(vehicle.mass_kg?.value));
        let (is_order_given, is_mesh) = (self.found.is_none(), self.order.lines_per_turn() > BLADES_MAX);
        let are_blades_given = ["/tone/blades", "/known/blade_count"].iter().any(|place| self.setting(place).is_some());
        GivenFacts {
            vehicle: vehicle.is_some(),
            blades: are_blades_given,
            gear: is_order_given && is_mesh,
            order: is_order_given && !is_mesh && !are_blades_given,
            diameter: is_beside("/known/diameter_m", known_diameter_m),
            mass: is_beside("/known/mass_kg", known_mass_kg),
            band: self.setting("/tone/band_hz").is_some(),
            window: self.setting("/spectrogram/window_s").is_some(),
        }
    }

    /// A setting of the analysis, else of the search, that has a value.
    pub(crate) fn setting(&self, place: &str) -> Option<&Value> {
        let of_search = self.found.as_ref().map(|found| &found.settings);
        let settings = std::iter::once(&self.settings).chain(of_search);
        settings.filter_map(|settings| settings.pointer(place)).find(|value| !value.is_null())
    }
}
