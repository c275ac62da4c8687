//! Sound that only the decoder of the browser can decode: its packets out, its samples in.

use hovertone_media::{CodedPacket, CodedSound};
use wasm_bindgen::prelude::wasm_bindgen;

/// The packets of a file for the decoder of the browser.
#[wasm_bindgen]
pub struct Coded {
    sound: CodedSound,
}

impl From<CodedSound> for Coded {
    fn from(sound: CodedSound) -> Self {
        Self { sound }
    }
}

#[wasm_bindgen]
impl Coded {
    /// The codec by its name in RFC 6381.
    pub fn codec(&self) -> String {
        self.sound.format().codec.clone()
    }

    /// Configuration of the decoder.
    pub fn description(&self) -> Vec<u8> {
        self.sound.format().description.clone()
    }

    /// Samples per second, by the header.
    pub fn sample_rate_hz(&self) -> f64 {
        self.sound.format().sample_rate_hz
    }

    /// Number of channels, by the header.
    pub fn channel_count(&self) -> u32 {
        u32::try_from(self.sound.format().channel_count).unwrap_or(u32::MAX)
    }

    /// The next packet; `None` after the last one.
    ///
    /// # Errors
    /// The browser can no longer read the file.
    pub fn next_packet(&mut self) -> Result<Option<Packet>, String> {
        let packet = self.sound.next_packet().map_err(|error| error.to_string())?;
        Ok(packet.map(|CodedPacket { at_s, data }| Packet { at_s, data }))
    }
}

/// A packet of coded sound.
#[wasm_bindgen]
pub struct Packet {
    /// Time of its first sample on the clock of the track.
    pub at_s: f64,
    data: Box<[u8]>,
}

#[wasm_bindgen]
impl Packet {
    /// Its bytes, and an empty packet behind them.
    pub fn take(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.data).into_vec()
    }
}
