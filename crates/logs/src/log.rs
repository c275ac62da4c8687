//! The kind of a log, by its first bytes, and its reader.

use crate::byte_window::ByteWindow;
use crate::table::{Findings, RowSink};
use crate::table_text::ColumnNames;
use crate::{LogError, LogFormat, blackbox, dataflash, table_text, ulog};
use std::io::Read;

/// Bytes in which a binary log is looked for: the start of a file may be damaged.
const HEAD_BYTES: usize = 1 << 16;

/// Reads a log to its end and hands its rows to a sink.
pub(crate) fn read_log(
    source: impl Read,
    names: &ColumnNames,
    sink: &mut impl RowSink,
) -> Result<(LogFormat, Findings), LogError> {
    let mut bytes = ByteWindow::new(source);
    let head = bytes.ahead(HEAD_BYTES)?;
    let head = &head[..head.len().min(HEAD_BYTES)];
    let format = format_of(head)?;
    if let Some(format) = format.filter(|_| !names.is_empty()) {
        return Err(LogError::NoColumns { format });
    }
    let (format, mut findings) = match format {
        Some(LogFormat::Ulog) => (LogFormat::Ulog, ulog::read(&mut bytes, sink)?),
        Some(LogFormat::DataFlash) => (LogFormat::DataFlash, dataflash::read(&mut bytes, sink)?),
        Some(_) => (LogFormat::Blackbox, blackbox::read(&mut bytes, sink)?),
        None => table_text::read(&mut bytes, names, sink)?,
    };
    findings.loss.all_bytes = bytes.offset();
    Ok((format, findings))
}

/// The binary format of these first bytes; `None` for text.
fn format_of(head: &[u8]) -> Result<Option<LogFormat>, LogError> {
    let has = |wanted: &[u8]| head.windows(wanted.len()).any(|window| window == wanted);
    if ulog::is_ulog(head) {
        return Ok(Some(LogFormat::Ulog));
    }
    if has(blackbox::FIRST_LINE) {
        return Ok(Some(LogFormat::Blackbox));
    }
    let first_line = head.split(|byte| *byte == b'\n').next().unwrap_or_default();
    let is_of_text = |byte: &u8| !byte.is_ascii_control() || matches!(byte, b'\t' | b'\r');
    match !head.contains(&0) && first_line.iter().all(is_of_text) {
        true => Ok(None),
        false if has(&dataflash::FIRST_BYTES) => Ok(Some(LogFormat::DataFlash)),
        false => Err(LogError::UnknownFormat),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_are_no_text_are_no_table() {
        assert!(matches!(format_of(b"time_s,rotor1_rpm\r\n0,1000\r\n"), Ok(None)));
        assert!(matches!(format_of(b"d\x05a\x19V[8 }\x10 d8\n"), Err(LogError::UnknownFormat)));
    }
}
