//! The microphone of this computer.

use crate::failure::Failure;
use cpal::traits::{DeviceTrait, HostTrait, StreamTrait};
use cpal::{Device, FromSample, Sample, SampleFormat, SizedSample, Stream, SupportedStreamConfig};
use hovertone_report::counted;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::Duration;

/// Blocks that wait while a review is made: at 10 ms each, ten seconds.
const BLOCKS_WAITING: usize = 1000;
/// A device that sends nothing for so long was removed.
const SILENT_DEVICE: Duration = Duration::from_secs(5);
const CHECK_DEVICE: &str = "check that the microphone is plugged in and that hovertone may use it, or give a \
                            recording with --from-file FILE";

/// An open microphone.
pub(crate) struct Microphone {
    name: String,
    sample_rate_hz: f64,
    blocks: Receiver<Vec<f32>>,
    block: Vec<f32>,
    /// The device records as long as it lives.
    _stream: Stream,
}

impl Microphone {
    /// Opens the device that the system names as its microphone. `channel`: number of the channel, counted from 1; the mean of all where absent.
    pub(crate) fn open(channel: Option<usize>) -> Result<Self, Failure> {
        let device = cpal::default_host().default_input_device().ok_or_else(|| {
            Failure::usage(
                "no microphone was found on this computer",
                "plug one in, or give a recording with --from-file FILE",
            )
        })?;
        let config = device.default_input_config().map_err(|error| failed(&error))?;
        let count = usize::from(config.channels());
        if let Some(asked) = channel.filter(|asked| !(1..=count).contains(asked)) {
            let what = format!(
                "channel {asked} does not exist: the microphone has {}, counted from 1",
                counted(count, "channel")
            );
            return Err(Failure::usage(
                what,
                "give another number, or leave --channel out to hear the mean of all channels",
            ));
        }
        let (sender, blocks) = sync_channel(BLOCKS_WAITING);
        let mix = Mix { count, channel: channel.map(|channel| channel - 1), sender };
        let stream = match config.sample_format() {
            SampleFormat::F32 => stream_of::<f32>(&device, &config, mix),
            SampleFormat::I16 => stream_of::<i16>(&device, &config, mix),
            SampleFormat::I32 => stream_of::<i32>(&device, &config, mix),
            SampleFormat::U16 => stream_of::<u16>(&device, &config, mix),
            other => {
                return Err(Failure::usage(
                    format!("the microphone sends samples in the format {other}, which hovertone cannot read"),
                    "choose another microphone in the settings of the system, or give a recording with --from-file FILE",
                ));
            }
        }?;
        stream.play().map_err(|error| failed(&error))?;
        Ok(Self {
            name: device.to_string(),
            sample_rate_hz: f64::from(config.sample_rate()),
            blocks,
            block: Vec::new(),
            _stream: stream,
        })
    }

    pub(crate) fn name(&self) -> String {
        self.name.clone()
    }

    pub(crate) fn sample_rate_hz(&self) -> f64 {
        self.sample_rate_hz
    }

    /// The next samples, as soon as they are there.
    pub(crate) fn next_block(&mut self) -> Result<Option<&[f32]>, Failure> {
        self.block = self.blocks.recv_timeout(SILENT_DEVICE).map_err(|_| failed(&"it sends no more sound"))?;
        Ok(Some(&self.block))
    }
}

/// Interleaved samples → one channel, and away from the thread of the device.
struct Mix {
    count: usize,
    channel: Option<usize>,
    sender: SyncSender<Vec<f32>>,
}

impl Mix {
    fn send<T: Sample>(&self, interleaved: &[T])
    where
        f32: FromSample<T>,
    {
        let mono = |frame: &[T]| match self.channel {
            Some(channel) => frame[channel].to_sample::<f32>(),
            None => frame.iter().map(|sample| sample.to_sample::<f32>()).sum::<f32>() / self.count as f32,
        };
        // where the listener is far behind, sound is lost rather than the device stopped
        match self.sender.try_send(interleaved.chunks_exact(self.count).map(mono).collect()) {
            Ok(()) | Err(TrySendError::Full(_) | TrySendError::Disconnected(_)) => {}
        }
    }
}

fn stream_of<T: SizedSample>(device: &Device, config: &SupportedStreamConfig, mix: Mix) -> Result<Stream, Failure>
where
    f32: FromSample<T>,
{
    // a device that fails sends nothing more, which the listener notices
    device
        .build_input_stream(config.clone().into(), move |data: &[T], _: &_| mix.send(data), |_| {}, None)
        .map_err(|error| failed(&error))
}

fn failed(error: &dyn std::fmt::Display) -> Failure {
    Failure::usage(format!("the microphone cannot be heard: {error}"), CHECK_DEVICE)
}
