//! What a worker of the page holds, and all that the page can ask of it.

use crate::answer::Answer;
use crate::campaign::{self, LastIdentified};
use crate::coded::Coded;
use crate::heard_files::HeardFiles;
use crate::picture::{Levels, levels_of, sound_wav};
use crate::said::SaidOnPage;
use crate::slices::SlicedFile;
use hovertone_media::DecodedSound;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use wasm_bindgen::prelude::wasm_bindgen;

/// All that a worker of the page holds.
#[wasm_bindgen]
#[derive(Default)]
pub struct Desk {
    heard: HeardFiles,
    identified: Option<LastIdentified>,
}

#[wasm_bindgen]
impl Desk {
    /// An empty desk.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a file of the page by its number.
    pub fn add(&mut self, number: u32, name: &str, bytes: f64) {
        self.heard.add(SlicedFile { number, name: PathBuf::from(name), len: bytes as u64 });
    }

    /// Forgets a file.
    pub fn remove(&mut self, number: u32) {
        self.heard.remove(number);
    }

    /// The packets of a file that needs the decoder of the browser; nothing where hovertone decodes it, or knows no packets of it.
    pub fn coded(&self, number: u32) -> Option<Coded> {
        self.heard.coded(number).map(Coded::from)
    }

    /// Takes what the browser decoded of a file: interleaved 32-bit floats, in another file.
    pub fn add_decoded(
        &mut self,
        number: u32,
        decoded: u32,
        bytes: f64,
        channel_count: u32,
        sample_rate_hz: f64,
        first_packet_s: f64,
    ) {
        let samples = Arc::new(SlicedFile { number: decoded, name: PathBuf::new(), len: bytes as u64 });
        let channel_count = channel_count as usize;
        self.heard.add_decoded(number, DecodedSound { samples, channel_count, sample_rate_hz, first_packet_s });
    }

    /// Hears a file as `hovertone speed` does. `said` is JSON; so is the answer.
    ///
    /// # Errors
    /// One line: what is said has no meaning.
    pub fn hear(&mut self, number: u32, said: &str, on_share: &js_sys::Function) -> Result<String, String> {
        let said: SaidOnPage = serde_json::from_str(said).map_err(|error| error.to_string())?;
        let (config, discovery) = said.said().settings().map_err(|error| error.to_string())?;
        let record = self.heard.record_of(number, &config, discovery, &mut shown_by(on_share));
        Ok(json_of(&Answer::new(record)))
    }

    /// The levels of a part of a file between two frequencies.
    ///
    /// # Errors
    /// The reason of the file that cannot be read.
    #[allow(clippy::too_many_arguments)] // of a binding: numbers of JavaScript
    pub fn levels(
        &self,
        number: u32,
        from_s: f64,
        to_s: f64,
        hz_low: f64,
        hz_high: f64,
        columns: usize,
        rows: usize,
    ) -> Result<Levels, String> {
        levels_of(&mut self.heard.opened(number, 0.0)?, [from_s, to_s], [hz_low, hz_high], [columns, rows])
    }

    /// A part of the sound as a WAV file, for browsers that cannot play the file itself.
    ///
    /// # Errors
    /// The reason of the file that cannot be read.
    pub fn sound(&self, number: u32, from_s: f64, to_s: f64) -> Result<Vec<u8>, String> {
        sound_wav(&mut self.heard.opened(number, 0.0)?, [from_s, to_s])
    }

    /// Identifies an experiment as `hovertone identify` does. `text` is the experiment file, `files` a JSON object of the numbers of its
    /// recordings by their names. The answer is JSON.
    ///
    /// # Errors
    /// One line: the experiment file has no meaning, or a recording is missing.
    pub fn identify(&mut self, text: &str, files: &str, on_share: &js_sys::Function) -> Result<String, String> {
        self.identified = None;
        let files: BTreeMap<String, u32> = serde_json::from_str(files).map_err(|error| error.to_string())?;
        let identified = campaign::identify(&mut self.heard, text, &files, &mut shown_by(on_share))?;
        let answer = identified.answer();
        self.identified = Some(identified);
        answer
    }

    /// The report of the last identified experiment: one HTML page with everything inside.
    ///
    /// # Errors
    /// A recording that cannot be read again.
    pub fn report(&self, on_share: &js_sys::Function) -> Result<String, String> {
        let identified = self.identified.as_ref().ok_or("there is no result yet")?;
        // an ISO date begins with its ten letters of year, month and day
        let date: String = String::from(js_sys::Date::new_0().to_iso_string()).chars().take(10).collect();
        identified.report(&self.heard, &date, &mut shown_by(on_share))
    }
}

/// Calls a function of the page with the share that is done.
fn shown_by(on_share: &js_sys::Function) -> impl FnMut(f64) {
    move |share| {
        // a page that fails to show progress still gets its answer
        let _ = on_share.call1(&wasm_bindgen::JsValue::NULL, &share.into());
    }
}

/// JSON of an answer; an answer that cannot be written is the word null.
fn json_of<T: serde::Serialize>(answer: &Result<T, serde_json::Error>) -> String {
    answer.as_ref().ok().and_then(|answer| serde_json::to_string(answer).ok()).unwrap_or_else(|| "null".to_owned())
}
