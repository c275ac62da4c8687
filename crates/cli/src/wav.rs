//! Simulated sound into WAV files, channel by channel.

use crate::failure::Failure;
use crate::output_file::OutputFile;
use hound::{SampleFormat as Stored, WavSpec, WavWriter};
use hovertone_sim::scenario::SampleFormat;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// A WAV file that is written in pieces.
pub(crate) struct WavFile {
    writer: WavWriter<BufWriter<File>>,
    format: SampleFormat,
    output: OutputFile,
}

impl WavFile {
    /// Begins a file with the given number of channels.
    pub(crate) fn create(
        output: OutputFile,
        channels: usize,
        sample_rate: u32,
        format: SampleFormat,
    ) -> Result<Self, Failure> {
        let (bits_per_sample, sample_format) = match format.integer_bits() {
            Some(bits) => (bits as u16, Stored::Int),
            None => (32, Stored::Float),
        };
        let channels = u16::try_from(channels)
            .map_err(|_| Failure::usage("too many microphones for a WAV file", "use 65535 microphones or fewer"))?;
        let spec = WavSpec { channels, sample_rate, bits_per_sample, sample_format };
        let file = BufWriter::new(output.handle()?);
        let writer = WavWriter::new(file, spec).map_err(|error| cannot_write(error, output.place()))?;
        Ok(Self { writer, format, output })
    }

    /// Writes and empties the channels, which have equal lengths.
    pub(crate) fn drain(&mut self, channels: &mut [Vec<f32>]) -> Result<(), Failure> {
        for index in 0..channels.first().map_or(0, Vec::len) {
            for channel in channels.iter() {
                let written = match self.format.integer_bits() {
                    Some(bits) => self.writer.write_sample(SampleFormat::whole_number(bits, channel[index])),
                    None => self.writer.write_sample(channel[index]),
                };
                written.map_err(|error| cannot_write(error, self.output.place()))?;
            }
        }
        channels.iter_mut().for_each(Vec::clear);
        Ok(())
    }

    /// Finishes the file and puts it into its place.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let output = self.output;
        self.writer.finalize().map_err(|error| cannot_write(error, output.place()))?;
        output.keep()
    }
}

fn cannot_write(error: hound::Error, path: &Path) -> Failure {
    match error {
        hound::Error::IoError(error) => Failure::cannot_write(&error, path),
        error => Failure::internal(error),
    }
}
