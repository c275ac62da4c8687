//! The microphone of the page: blocks of samples in, what is heard now as JSON out; and the samples of a trial as a WAV file.

use crate::picture::wav_of_floats;
use crate::said::SaidOnPage;
use hovertone::live::{Listener, LiveConfig, LiveSpeed};
use hovertone_report::LiveWords;
use hovertone_workflow::{live_remark, live_status_in_words, live_words, possible_in_words};
use serde::Serialize;
use wasm_bindgen::prelude::wasm_bindgen;

/// Listens to the microphone.
#[wasm_bindgen]
pub struct Ear {
    listener: Listener,
    sample_rate_hz: f64,
    trial: Option<Trial>,
}

/// The sound of a trial. It has its full length and no more, however late the page ends it.
struct Trial {
    samples: Vec<f32>,
    full_len: usize,
}

impl Trial {
    fn take(&mut self, block: &[f32]) {
        let missing = self.full_len - self.samples.len();
        self.samples.extend_from_slice(&block[..missing.min(block.len())]);
    }
}

/// What is told of a block.
#[derive(Serialize)]
struct Told {
    speeds: Vec<ToldSpeed>,
    /// What the last review found.
    rotors_rev_s: Vec<f64>,
    choices: Vec<Choice>,
    /// Length of the trial so far.
    recorded_s: Option<f64>,
}

#[derive(Serialize)]
struct ToldSpeed {
    #[serde(flatten)]
    speed: LiveSpeed,
    words: Option<LiveWords>,
    status_words: String,
}

/// One of several possible speeds.
#[derive(Serialize)]
struct Choice {
    words: String,
    blades: Option<u32>,
}

#[wasm_bindgen]
impl Ear {
    /// For sound at this rate. `said` is JSON: what the page says of the vehicle.
    ///
    /// # Errors
    /// One line: what is said has no meaning.
    #[wasm_bindgen(constructor)]
    pub fn new(sample_rate_hz: f64, said: &str) -> Result<Self, String> {
        let said: SaidOnPage = serde_json::from_str(said).map_err(|error| error.to_string())?;
        let (config, discovery) = said.said().settings().map_err(|error| error.to_string())?;
        let listener = Listener::new(sample_rate_hz, LiveConfig::of_analysis(config, discovery));
        let listener = listener.map_err(|error| error.to_string())?;
        Ok(Self { listener, sample_rate_hz, trial: None })
    }

    /// Takes in a block, and returns what is heard as JSON; an empty text where nothing is due.
    ///
    /// # Errors
    /// Settings that the sample rate does not allow.
    pub fn push(&mut self, block: &[f32]) -> Result<String, String> {
        if let Some(trial) = &mut self.trial {
            trial.take(block);
        }
        let mut heard = Vec::new();
        let mut rest = block;
        while !rest.is_empty() {
            rest = self.listener.push(rest, &mut |speed| heard.push(speed));
            if self.listener.wants_review() {
                self.listener.review().map_err(|error| error.to_string())?;
            }
        }
        if heard.is_empty() {
            return Ok(String::new());
        }
        serde_json::to_string(&self.told(&heard)).map_err(|error| error.to_string())
    }

    fn told(&self, heard: &[LiveSpeed]) -> Told {
        let remark = live_remark(&self.listener);
        let told = |speed: &LiveSpeed| ToldSpeed {
            speed: *speed,
            words: live_words(speed),
            status_words: live_status_in_words(speed.status, &remark),
        };
        let possible = self.listener.possible();
        Told {
            speeds: heard.iter().map(told).collect(),
            rotors_rev_s: self.listener.rotors_rev_s().to_vec(),
            choices: possible
                .iter()
                .map(|possible| Choice { words: possible_in_words(possible), blades: possible.blades })
                .collect(),
            recorded_s: self.trial.as_ref().map(|trial| trial.samples.len() as f64 / self.sample_rate_hz),
        }
    }

    /// Decides for one of the possible speeds.
    pub fn choose(&mut self, possible: usize) {
        self.listener.choose(possible);
    }

    /// Takes what the page says of the vehicle now, and listens anew by it. A trial goes on.
    ///
    /// # Errors
    /// One line: what is said has no meaning.
    pub fn hear_by(&mut self, said: &str) -> Result<(), String> {
        self.listener = Self::new(self.sample_rate_hz, said)?.listener;
        Ok(())
    }

    /// Begins a trial: the samples of the next `length_s` seconds are kept.
    pub fn begin(&mut self, length_s: f64) {
        let full_len = (length_s * self.sample_rate_hz).ceil() as usize;
        self.trial = Some(Trial { samples: Vec::new(), full_len });
    }

    /// Ends the trial and returns its samples as a WAV file of 32-bit floats: the samples as the browser gave them. Empty without a trial.
    ///
    /// # Errors
    /// None is known.
    pub fn end(&mut self) -> Result<Vec<u8>, String> {
        let Some(trial) = self.trial.take() else { return Ok(Vec::new()) };
        wav_of_floats(&trial.samples, self.sample_rate_hz.round() as u32)
    }
}
