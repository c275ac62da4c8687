//! Other values of some settings, as a person wants them: `--try evidence.levels.echo=0.1,evidence.belief_min=0.995`.

use super::numbers::Number;
use hovertone::speed::Config;

/// Settings with other values.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    values: Vec<(Number, f64)>,
}

impl Trial {
    /// Reads pairs of a name and a value.
    pub(super) fn read(text: &str, numbers: &[Number]) -> Result<Self, String> {
        let value = |pair: &str| {
            let (name, value) = pair.split_once('=').ok_or_else(|| format!("--try {pair}: write NAME=VALUE"))?;
            let number = numbers.iter().find(|number| number.full_name() == name);
            let number = number
                .ok_or_else(|| format!("--try {name}: no setting has this name; docs/sensitivity.md lists them"))?;
            let value = value.parse().map_err(|_| format!("--try {pair}: {value} is no number"))?;
            Ok((number.clone(), value))
        };
        Ok(Self { values: text.split(',').map(value).collect::<Result<_, String>>()? })
    }

    /// The settings with these values.
    pub(super) fn applied(&self, config: Config) -> Result<Config, String> {
        self.values.iter().try_fold(config, |config, (number, value)| number.put(&config, *value))
    }
}
