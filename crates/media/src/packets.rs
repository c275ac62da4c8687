//! The packets of one track, from any demuxer.

use std::io;

use symphonia::core::errors::Error as SymphoniaError;
use symphonia::core::formats::FormatReader;
use symphonia::core::packet::Packet;

use crate::frames::Incidents;
use crate::guard::{PANICKED, guarded};
use crate::iso::TablePackets;
use crate::wave::WaveBlocks;

/// Largest number of consecutive errors. A demuxer resynchronises after an error; after this many it has no more data.
const DEMUXER_ERRORS_IN_A_ROW_MAX: u32 = 64;

/// Where the packets of a track come from.
pub(crate) enum PacketSource {
    Demuxer { reader: Box<dyn FormatReader>, track_id: u32, errors_in_a_row: u32 },
    Wave(WaveBlocks),
    IsoTable(TablePackets),
}

impl PacketSource {
    pub(crate) fn of_demuxer(reader: Box<dyn FormatReader>, track_id: u32) -> Self {
        Self::Demuxer { reader, track_id, errors_in_a_row: 0 }
    }

    /// The next packet of the track; `None` after the last one.
    pub(crate) fn next_packet(&mut self, incidents: &mut Incidents) -> io::Result<Option<Packet>> {
        let (reader, track_id, errors_in_a_row) = match self {
            Self::Wave(packets) => return packets.next_packet(),
            Self::IsoTable(packets) => return packets.next_packet(),
            Self::Demuxer { reader, track_id, errors_in_a_row } => (reader, *track_id, errors_in_a_row),
        };
        loop {
            match guarded(|| reader.next_packet()) {
                Ok(Some(packet)) => {
                    *errors_in_a_row = 0;
                    if packet.track_id == track_id {
                        return Ok(Some(packet));
                    }
                }
                Ok(None) => return Ok(None),
                Err(SymphoniaError::IoError(error)) if error.kind() == io::ErrorKind::UnexpectedEof => {
                    incidents.is_cut_off = true;
                    return Ok(None);
                }
                Err(SymphoniaError::IoError(error)) if !is_about_content(&error) => return Err(error),
                Err(SymphoniaError::ResetRequired) => {
                    incidents.format_changed = true;
                    return Ok(None);
                }
                Err(error) => {
                    *errors_in_a_row += 1;
                    let has_panicked = matches!(error, SymphoniaError::DecodeError(PANICKED));
                    if has_panicked || *errors_in_a_row > DEMUXER_ERRORS_IN_A_ROW_MAX {
                        incidents.is_cut_off = true;
                        return Ok(None);
                    }
                }
            }
        }
    }
}

/// Kinds of I/O errors that Symphonia uses for some damage; other kinds come from the disk.
fn is_about_content(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::Other | io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput)
        && error.raw_os_error().is_none()
}
