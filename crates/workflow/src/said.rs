//! Facts that a person gives about tone and vehicle, as settings of the analysis.

use hovertone::speed::{Config, Method, SpanConfig, ToneConfig};
use hovertone::tones::{Discovery, DiscoveryConfig, KnownRotor};
use hovertone_vehicle::{ConfigError, Contradiction, Gear, Order, QuantityError, SaidOfVehicle, Vehicle};

/// What is said before a recording is heard. All of it may be left out.
#[derive(Clone, Debug, Default)]
pub struct Said<'a> {
    /// A known vehicle.
    pub vehicle: Option<&'a Vehicle>,
    /// Blades of each propeller.
    pub blades: Option<u32>,
    /// Gear between motor and rotor.
    pub gear: Option<Gear>,
    /// Order of the tone.
    pub order: Option<f64>,
    /// Band in which the tone lies.
    pub band_hz: Option<(f64, f64)>,
    /// Number of harmonics to follow.
    pub harmonics: Option<u32>,
    /// Diameter of a propeller.
    pub diameter_m: Option<f64>,
    /// Mass as flown.
    pub mass_kg: Option<f64>,
    /// Number of rotors.
    pub rotors: Option<u32>,
    /// The method; where absent, it follows from the number of rotors.
    pub method: Option<Method>,
    /// Whether only the mean speed is wanted.
    pub mean_only: bool,
    /// The part of the recording to use.
    pub span: SpanConfig,
}

/// Reason for missing settings.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoSettings {
    /// A setting out of its range.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A quantity out of its range.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
    /// Facts that exclude each other.
    #[error(transparent)]
    Contradiction(#[from] Contradiction),
}

/// Sets how many rotors turn, and returns the method that follows. No more rotors are searched for in a tone that nobody has named.
pub fn set_rotors(config: &mut Config, rotor_count: Option<u32>, is_tone_named: bool) -> Method {
    config.rotors.count = rotor_count.unwrap_or(config.rotors.count);
    config.rotors.is_count_known = rotor_count.is_some();
    let may_be_several = config.rotors.count > 1 || !config.rotors.is_count_known && is_tone_named;
    if may_be_several { Method::Separated } else { Method::Harmonic }
}

impl Said<'_> {
    /// The settings of an analysis. The second part is the search for the tone, where its order does not follow from what is said.
    ///
    /// # Errors
    /// Values out of range, and facts that exclude each other.
    pub fn settings(&self) -> Result<(Config, Option<Discovery>), NoSettings> {
        let (tone, discovery) = match self.tone()? {
            Some(tone) => (tone, None),
            None => {
                let (tone, discovery) = self.discovery(false)?;
                let harmonics = self.harmonics.unwrap_or(tone.harmonics);
                (ToneConfig { band_hz: self.band_hz, harmonics, ..tone }, Some(discovery))
            }
        };
        let mut config = Config::for_tone(tone);
        config.known = self.known()?;
        let rotor_count = config.known.rotor_count;
        let default = set_rotors(&mut config, rotor_count, discovery.is_none());
        config.method = self.method.unwrap_or(if self.mean_only { Method::Harmonic } else { default });
        config.span = self.span;
        config.check()?;
        Ok((config, discovery))
    }

    /// The tone: the order has priority, then the gear, then the blades, as given or as the vehicle has them. A known number of blades
    /// helps to find the tone of a gear. `None` where the tone has to be searched for.
    ///
    /// # Errors
    /// Values out of range, and facts that exclude each other.
    pub fn tone(&self) -> Result<Option<ToneConfig>, NoSettings> {
        let vehicle = self.vehicle;
        self.gear.map_or(Ok(()), Gear::check)?;
        let order = self.order.map(Order::new).transpose()?;
        let said = SaidOfVehicle { blades: self.blades, gear: self.gear, order, ..SaidOfVehicle::default() };
        vehicle.map_or(Ok(()), |vehicle| vehicle.check_said(&said))?;
        let blades = self.blades.or_else(|| Some(vehicle?.blade_count?.value));
        let gear = self.gear.or_else(|| Some(vehicle?.gear?.value));
        let order = match (order, gear, blades) {
            (Some(order), ..) => Ok(order),
            (None, Some(gear), _) => gear.mesh_order(),
            (None, None, Some(blades)) => Order::from_blades(blades),
            (None, None, None) => return Ok(None),
        };
        let tone = ToneConfig::of_order(order?);
        let known = vehicle.and_then(|vehicle| vehicle.shaft_speed.as_ref());
        let tone = known.map_or_else(|| tone.clone(), |known| tone.clone().within(&known.value));
        let harmonics = self.harmonics.unwrap_or(tone.harmonics);
        let tone = ToneConfig { blades, band_hz: self.band_hz, harmonics, ..tone };
        // an order alone may be that of another source, such as a signal generator
        if gear.is_some() || blades.is_some() {
            tone.check_band()?;
        }
        Ok(Some(tone))
    }

    /// The search for a tone of unknown order, and settings for it whose order is a placeholder. `wants_all` lists all families of tones;
    /// otherwise the search ends at the family of the rotor.
    ///
    /// # Errors
    /// Values out of range, and facts that exclude each other.
    pub fn discovery(&self, wants_all: bool) -> Result<(ToneConfig, Discovery), NoSettings> {
        let known = self.known()?;
        let known = KnownRotor { blade_count: self.blades.or(known.blade_count), ..known };
        let said = SaidOfVehicle { blades: self.blades, ..SaidOfVehicle::default() };
        self.vehicle.map_or(Ok(()), |vehicle| vehicle.check_said(&said))?;
        let order = Order::new(1.0)?;
        Ok((ToneConfig::of_order(order), Discovery { config: DiscoveryConfig::default(), known, wants_all }))
    }

    /// What is known of the rotors before they are heard: what is said, and for the rest the vehicle.
    fn known(&self) -> Result<KnownRotor, NoSettings> {
        let of_vehicle = self.vehicle.map(KnownRotor::of_vehicle).unwrap_or_default();
        let known = KnownRotor {
            diameter_m: self.diameter_m.or(of_vehicle.diameter_m),
            mass_kg: self.mass_kg.or(of_vehicle.mass_kg),
            rotor_count: self.rotors.or(of_vehicle.rotor_count),
            ..of_vehicle
        };
        known.check()?;
        known.check_diameter()?;
        let said = SaidOfVehicle { rotors: self.rotors, mass_kg: self.mass_kg, ..SaidOfVehicle::default() };
        self.vehicle.map_or(Ok(()), |vehicle| vehicle.check_said(&said))?;
        // all rotors of a vehicle carry it, also where fewer of them turn on a bench
        KnownRotor { rotor_count: of_vehicle.rotor_count.or(self.rotors), ..known }.check_hover()?;
        Ok(known)
    }
}
