//! The numbers of the settings, each by name, and the settings with one of them changed.

use hovertone::speed::Config;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// A number above this is a share that is nearly all, or a belief: its distance from 1 changes.
const NEARLY_ALL: f64 = 0.5;

/// The settings of one stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Group {
    Evidence,
    Levels,
    Hover,
    Ridge,
}

impl Group {
    const ALL: [Self; 4] = [Self::Evidence, Self::Levels, Self::Hover, Self::Ridge];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Evidence => "evidence",
            Self::Levels => "evidence.levels",
            Self::Hover => "hover",
            Self::Ridge => "ridge",
        }
    }

    fn value(self, config: &Config) -> Result<Value, String> {
        match self {
            Self::Evidence => to_value(&config.evidence),
            Self::Levels => to_value(&config.evidence.levels),
            Self::Hover => to_value(&config.hover),
            Self::Ridge => to_value(&config.ridge),
        }
    }

    fn put(self, config: &mut Config, value: Value) -> Result<(), String> {
        match self {
            Self::Evidence => config.evidence = from_value(value)?,
            Self::Levels => config.evidence.levels = from_value(value)?,
            Self::Hover => config.hover = from_value(value)?,
            Self::Ridge => config.ridge = from_value(value)?,
        }
        Ok(())
    }
}

fn to_value(settings: &impl Serialize) -> Result<Value, String> {
    serde_json::to_value(settings).map_err(|error| error.to_string())
}

fn from_value<T: DeserializeOwned>(value: Value) -> Result<T, String> {
    serde_json::from_value(value).map_err(|error| error.to_string())
}

/// One number of the settings.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Number {
    pub(super) group: Group,
    pub(super) name: String,
    pub(super) value: f64,
    is_whole: bool,
}

impl Number {
    /// All numbers of the settings, in their order.
    pub(super) fn all(config: &Config) -> Result<Vec<Self>, String> {
        let mut numbers = Vec::new();
        for group in Group::ALL {
            let Value::Object(fields) = group.value(config)? else { continue };
            numbers.extend(fields.iter().filter_map(|(name, value)| {
                let is_whole = value.is_u64();
                Some(Self { group, name: name.clone(), value: value.as_f64()?, is_whole })
            }));
        }
        Ok(numbers)
    }

    /// The name with that of its group: `evidence.levels.echo`.
    pub(super) fn full_name(&self) -> String {
        format!("{}.{}", self.group.name(), self.name)
    }

    /// The number times a factor. Of a share that is nearly all, the distance from 1 is changed.
    pub(super) fn times(&self, factor: f64) -> f64 {
        let is_nearly_all = self.value > NEARLY_ALL && self.value < 1.0;
        let value = if is_nearly_all { 1.0 - (1.0 - self.value) * factor } else { self.value * factor };
        if self.is_whole { value.round() } else { value }
    }

    /// The settings with another value of this number.
    pub(super) fn put(&self, config: &Config, value: f64) -> Result<Config, String> {
        let mut changed = config.clone();
        let mut fields: Map<String, Value> = from_value(self.group.value(config)?)?;
        let value = if self.is_whole { Value::from(value as u64) } else { Value::from(value) };
        fields.insert(self.name.clone(), value);
        self.group.put(&mut changed, Value::Object(fields))?;
        changed.check().map_err(|error| error.to_string())?;
        Ok(changed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone::speed::ToneConfig;
    use hovertone_vehicle::Order;

    fn config() -> Config {
        Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap()))
    }

    fn number(group: Group, name: &str) -> Number {
        let all = Number::all(&config()).unwrap();
        all.into_iter().find(|number| number.group == group && number.name == name).unwrap()
    }

    #[test]
    fn each_number_can_be_changed_alone() {
        let config = config();
        let numbers = Number::all(&config).unwrap();
        assert!(numbers.len() > 50, "{}", numbers.len());
        for number in &numbers {
            assert_eq!(number.put(&config, number.value).unwrap(), config, "{}", number.name);
            if let Ok(changed) = number.put(&config, number.times(1.4)) {
                assert_ne!(changed, config, "{}", number.name);
            }
        }
    }

    #[test]
    fn a_share_that_is_nearly_all_stays_a_share() {
        let belief = number(Group::Evidence, "belief_min");
        assert!((belief.times(1.4) - 0.986).abs() < 1e-12 && (belief.times(0.7) - 0.993).abs() < 1e-12);
        assert_eq!(number(Group::Hover, "survey_rows_max").times(0.7), 179.0);
        let foreign = number(Group::Levels, "foreign");
        assert!((foreign.times(1.4) - 0.07).abs() < 1e-12);
    }
}
