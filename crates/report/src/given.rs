//! The facts that a person gave before a recording was heard.

use crate::recording::SpeedRecord;
use hovertone_analysis::GivenFacts;
use hovertone_vehicle::{BLADES_MAX, find_preset};
use serde_json::Value;

impl SpeedRecord {
    /// The facts that were given before the recording was heard. A fact that the given vehicle tells itself belongs to the vehicle.
    pub fn given_facts(&self) -> GivenFacts {
        let vehicle = self.setting("/known/vehicle");
        let preset = vehicle.and_then(Value::as_str).and_then(find_preset);
        // no preset is known for a vehicle of the user's own: all facts may be its own
        let is_own = |of_preset: Option<bool>| vehicle.is_none() || of_preset == Some(false);
        // it tells no mass of this flight: one that is known may have been given
        let is_of_user = vehicle.is_some() && preset.is_none();
        let differs = |place: &str, of_preset: Option<f64>| {
            self.setting(place).is_some_and(|value| is_own(preset.map(|_| value.as_f64() == of_preset)))
        };
        let (is_order_given, is_mesh) = (self.found.is_none(), self.order.lines_per_turn() > BLADES_MAX);
        let are_blades_given = match &self.found {
            Some(found) => found.are_blades_given(),
            None => self.are_blades_known(),
        };
        // the mass of a load cannot be left out
        let is_of_load = self.wording.has_loads;
        GivenFacts {
            vehicle: vehicle.is_some(),
            blades: are_blades_given && is_own(preset.map(|preset| preset.blade_count.is_some())),
            gear: is_order_given && is_mesh && is_own(preset.map(|preset| preset.gear.is_some())),
            order: is_order_given && !is_mesh && !are_blades_given,
            diameter: differs("/known/diameter_m", preset.and_then(|preset| Some(preset.propeller_diameter_m?.value))),
            is_load: is_of_load,
            mass: !is_of_load && differs("/known/mass_kg", preset.and_then(|preset| Some(preset.mass_kg?.value)))
                || is_of_user && !is_of_load && self.setting("/known/mass_kg").is_some(),
            band: self.setting("/tone/band_hz").is_some(),
            window: self.setting("/spectrogram/window_s").is_some(),
            rotors: vehicle.is_none() && self.setting("/known/rotor_count").is_some(),
        }
    }

    /// A setting of the analysis, else of the search, that has a value.
    pub(crate) fn setting(&self, place: &str) -> Option<&Value> {
        let of_search = self.found.as_ref().map(|found| &found.settings);
        let settings = std::iter::once(&self.settings).chain(of_search);
        settings.filter_map(|settings| settings.pointer(place)).find(|value| !value.is_null())
    }
}
