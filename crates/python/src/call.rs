//! Calls of commands: words and arrays in, results out. The GIL is released while a command runs.

use crate::failure::raised;
use crate::heard::Heard;
use crate::identified::Identified;
use hovertone_cli::calls::{Call, LoadedSound};
use hovertone_cli::{Ending, Failure};
use hovertone_media::Samples;
use numpy::{Element, IntoPyArray, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::ffi::OsString;
use std::panic::resume_unwind;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::Duration;

/// Hears the recordings of `speed` or `tones`; the first may be an array.
#[pyfunction]
#[pyo3(signature = (words, samples=None, rate_hz=0.0, on_progress=None))]
pub(crate) fn heard(
    py: Python<'_>,
    words: Vec<OsString>,
    samples: Option<&Bound<'_, PyAny>>,
    rate_hz: f64,
    on_progress: Option<Py<PyAny>>,
) -> PyResult<Vec<Heard>> {
    let samples = samples.map(|array| samples_of(array, rate_hz)).transpose()?;
    let found = run(py, words, on_progress, |call| call.heard(samples))?;
    Ok(found.into_iter().map(Heard::from).collect())
}

/// Identifies the experiment of `identify`.
#[pyfunction]
#[pyo3(signature = (words, on_progress=None))]
pub(crate) fn identified(py: Python<'_>, words: Vec<OsString>, on_progress: Option<Py<PyAny>>) -> PyResult<Identified> {
    run(py, words, on_progress, Call::identified).map(Identified::from)
}

/// Runs any command: what it prints to stdout and to stderr, and whether something is missing.
#[pyfunction]
#[pyo3(signature = (words, on_progress=None))]
pub(crate) fn printed(
    py: Python<'_>,
    words: Vec<OsString>,
    on_progress: Option<Py<PyAny>>,
) -> PyResult<(String, String, bool)> {
    let printed = run(py, words, on_progress, Call::printed)?;
    Ok((printed.data, printed.messages, printed.ending != Ending::Done))
}

/// Decodes the recording of `tones`: samples, rate, time of the first sample, facts as JSON, warnings.
#[pyfunction]
pub(crate) fn loaded(py: Python<'_>, words: Vec<OsString>) -> PyResult<LoadedParts<'_>> {
    let LoadedSound { samples, start_s, facts, notices } = run(py, words, None, Call::loaded)?;
    let rate_hz = facts.sample_rate_hz;
    let facts = serde_json::to_string(&facts).map_err(|error| raised(py, &Failure::internal(error)))?;
    let warnings = notices.iter().map(ToString::to_string).collect();
    Ok((samples.into_pyarray(py), rate_hz, start_s, facts, warnings))
}

type LoadedParts<'py> = (Bound<'py, numpy::PyArray1<f32>>, f64, f64, String, Vec<String>);

/// The recordings of an archive, in the order of its tables, from the words of `batch`.
#[pyfunction]
pub(crate) fn archive_names(py: Python<'_>, words: Vec<OsString>) -> PyResult<Vec<String>> {
    run(py, words, None, Call::archive_names)
}

/// The row of the first recording of `batch`, as a stream of Arrow IPC.
#[pyfunction]
pub(crate) fn archive_row(py: Python<'_>, words: Vec<OsString>) -> PyResult<Bound<'_, PyBytes>> {
    run(py, words, None, Call::archive_row).map(|row| PyBytes::new(py, &row))
}

/// Runs a command on a thread of its own, while this one looks for interrupts: Python tells them to its main thread only.
fn run<T: Send>(
    py: Python<'_>,
    words: Vec<OsString>,
    on_progress: Option<Py<PyAny>>,
    command: impl FnOnce(Call) -> Result<T, Failure> + Send,
) -> PyResult<T> {
    let listener = Arc::new(Listener { callable: on_progress, raised: OnceLock::new() });
    let told = Arc::clone(&listener);
    let call = Call::new(words, Some(Arc::new(move |share| told.tell(share))));
    let ended = py.detach(|| {
        thread::scope(|scope| {
            let (sender, receiver) = mpsc::channel();
            let running = scope.spawn(move || {
                let ended = command(call);
                // the receiver waits for the end of this thread in any case
                let _ = sender.send(());
                ended
            });
            while receiver.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                listener.keep(Python::attach(|py| py.check_signals()));
            }
            running.join()
        })
    });
    match (listener.raised.get(), ended) {
        (Some(error), _) => Err(error.clone_ref(py)),
        (None, Ok(ended)) => ended.map_err(|failure| raised(py, &failure)),
        (None, Err(panic)) => resume_unwind(panic),
    }
}

/// Time between two looks for an interrupt.
const LOOK: Duration = Duration::from_millis(50);

/// Who is told the progress of a call, and what ends it.
struct Listener {
    callable: Option<Py<PyAny>>,
    /// What the callable or an interrupt has raised first.
    raised: OnceLock<PyErr>,
}

impl Listener {
    /// Tells the finished share. Where something was raised, the threads of the command are unwound to the thread of the call.
    fn tell(&self, share: f64) {
        if let Some(callable) = self.callable.as_ref().filter(|_| self.raised.get().is_none()) {
            self.keep(Python::attach(|py| callable.call1(py, (share,)).map(drop)));
        }
        // what is dropped on the way tells its end, too
        if self.raised.get().is_some() && !thread::panicking() {
            resume_unwind(Box::new("the call has ended"));
        }
    }

    fn keep(&self, told: PyResult<()>) {
        if let Err(error) = told {
            // the first one stays
            let _ = self.raised.set(error);
        }
    }
}

/// The samples of an array of frames, or of frames and channels, with the full scale of its type.
fn samples_of(array: &Bound<'_, PyAny>, rate_hz: f64) -> PyResult<Samples> {
    if let Some((samples, channel_count)) = interleaved::<f32>(array)? {
        return Ok(Samples::new(samples.as_slice()?.into(), channel_count, rate_hz));
    }
    if let Some((samples, channel_count)) = interleaved::<f64>(array)? {
        return Ok(Samples::from_doubles(samples.as_slice()?, channel_count, rate_hz));
    }
    if let Some((samples, channel_count)) = interleaved::<i16>(array)? {
        return Ok(Samples::from_16_bits(samples.as_slice()?, channel_count, rate_hz));
    }
    if let Some((samples, channel_count)) = interleaved::<i32>(array)? {
        return Ok(Samples::from_32_bits(samples.as_slice()?, channel_count, rate_hz));
    }
    Err(PyTypeError::new_err("samples are an array of float32, float64, int16 or int32"))
}

/// The array, where its numbers are of this type, and the number of its channels.
fn interleaved<'py, T: Element>(array: &Bound<'py, PyAny>) -> PyResult<Option<(PyReadonlyArrayDyn<'py, T>, usize)>> {
    let Ok(array) = array.cast::<PyArrayDyn<T>>() else { return Ok(None) };
    let array = array.try_readonly()?;
    let channel_count = array.shape().get(1).copied().unwrap_or(1);
    Ok(Some((array, channel_count)))
}
