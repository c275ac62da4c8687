//! Events among the frames: only their lengths and few of their meanings matter here.

use super::encoding::Cursor;

/// Text of the event at the end of a log.
const END: &[u8] = b"End of log";
/// Where this stands behind it, INAV adds the reason of the disarming, up to a zero.
const END_BYTES_MAX: usize = 40;

/// An event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Event {
    /// Number of its bytes, without the letter of the frame.
    pub(super) size: usize,
    /// Whether the log ends here.
    pub(super) is_end: bool,
    /// Whether the log goes on after a pause.
    pub(super) is_resume: bool,
}

impl Event {
    /// The event here, if it is complete and of a known type.
    pub(super) fn at(bytes: &[u8]) -> Option<Self> {
        let mut cursor = Cursor::new(bytes);
        let kind = cursor.byte()?;
        match kind {
            // beep; disarming; failure of the sensors
            0 | 15 | 40 => drop(cursor.unsigned()?),
            // steps of the autotune of Cleanflight
            10 => cursor.skip(5)?,
            11 => cursor.skip(4)?,
            12 => cursor.skip(10)?,
            // a setting is changed in flight: to a number with a point, or to a whole number
            13 => match cursor.byte()? {
                setting if setting & 0x80 != 0 => cursor.skip(4)?,
                _ => drop(cursor.signed()?),
            },
            // the log goes on; the mode of flight changes
            14 | 30 => {
                cursor.unsigned()?;
                cursor.unsigned()?;
            }
            20 => {
                cursor.skip(1)?;
                cursor.signed()?;
                cursor.skip(2)?;
            }
            255 => {
                let text = bytes.get(1..)?.strip_prefix(END)?;
                let zero = text.iter().take(END_BYTES_MAX).position(|byte| *byte == 0)?;
                cursor.skip(END.len() + zero + 1)?;
            }
            _ => return None,
        }
        Some(Self { size: cursor.at(), is_end: kind == 255, is_resume: kind == 14 })
    }
}
