//! All settings of an analysis. The settings of a stage, with their defaults and reasons, stand in the stage's folder.

use crate::evidence::EvidenceConfig;
use crate::hover::{HoverConfig, HoverPart};
use crate::ridge::{RidgeConfig, SpectrogramConfig};
use crate::rotors::RotorsConfig;
use crate::speed::{BudgetConfig, SampleConfig};
use crate::survey::SpanConfig;
use crate::tone::ToneConfig;
use hovertone_analysis::Method;
use hovertone_vehicle::{ConfigError, KnownRotor};
use serde::Serialize;

/// All settings of an analysis. `Default` holds the recommended values; the tone's order has none and must be said.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Config {
    /// Which tone of the rotor is followed.
    pub tone: ToneConfig,
    /// What is known of the vehicle before its sound is heard: a prior on the speed.
    pub known: KnownRotor,
    /// When a rotor counts as heard, and its octave as decided.
    pub evidence: EvidenceConfig,
    /// How many rotors sound, and where they are looked for.
    pub rotors: RotorsConfig,
    /// Which part of the recording is used.
    pub span: SpanConfig,
    /// How hovering is told from the rest.
    pub hover: HoverConfig,
    /// The part of the hover that is analysed.
    #[serde(skip)]
    pub hover_part: HoverPart,
    /// How a hover is cut into samples.
    pub samples: SampleConfig,
    /// Frames and their spectra.
    pub spectrogram: SpectrogramConfig,
    /// How a ridge is drawn and when it counts as a tone.
    pub ridge: RidgeConfig,
    /// What else makes the speed uncertain.
    pub budget: BudgetConfig,
    /// The method whose speed is the answer.
    pub method: Method,
    /// Whether the other methods are computed beside it, for comparison. The two of the paper cost more time than the harmonic likelihood.
    pub all_methods: bool,
}

impl Config {
    /// The recommended settings for a tone.
    pub fn for_tone(tone: ToneConfig) -> Self {
        Self {
            tone,
            known: KnownRotor::default(),
            evidence: EvidenceConfig::default(),
            rotors: RotorsConfig::default(),
            span: SpanConfig::default(),
            hover: HoverConfig::default(),
            hover_part: HoverPart::default(),
            samples: SampleConfig::default(),
            spectrogram: SpectrogramConfig::default(),
            ridge: RidgeConfig::default(),
            budget: BudgetConfig::default(),
            method: Method::default(),
            all_methods: false,
        }
    }

    /// The same settings for several rotors, which are separated.
    pub(crate) fn with_several_rotors(&self) -> Self {
        Self { rotors: self.rotors.with_several(), ..self.clone() }
    }

    /// The methods that are computed.
    pub(crate) fn methods(&self) -> impl Iterator<Item = Method> {
        let is_possible = |method: &Method| *method != Method::Separated || self.rotors.are_several();
        let is_wanted = |method: &Method| {
            // beside separated rotors stands the answer for a single one
            let is_instead = self.method == Method::Separated && *method == Method::Harmonic;
            self.all_methods || *method == self.method || is_instead
        };
        Method::ALL.into_iter().filter(is_possible).filter(is_wanted)
    }

    /// Whether several rotors are separated.
    pub(crate) fn wants_rotors(&self) -> bool {
        self.methods().any(|method| method == Method::Separated)
    }

    /// Whether a method is computed that reads ridges.
    pub(crate) fn wants_ridges(&self) -> bool {
        self.methods().any(Method::reads_ridges)
    }

    /// Refuses settings that mean nothing, by name, value and limit.
    pub fn check(&self) -> Result<(), ConfigError> {
        self.tone.check()?;
        self.known.check()?;
        self.evidence.check()?;
        self.rotors.check()?;
        self.span.check()?;
        self.hover.check()?;
        self.samples.check()?;
        self.spectrogram.check()?;
        self.budget.check()?;
        self.ridge.check()
    }
}
