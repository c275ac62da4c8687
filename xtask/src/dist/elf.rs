//! Whether a program of Linux is static: whether it names no loader.

/// Segment of the name of the loader (PT_INTERP).
const INTERPRETER: u32 = 3;
/// Places of the header of a 64-bit file, little-endian.
const SEGMENTS_AT: usize = 32;
const SEGMENT_SIZE_AT: usize = 54;
const SEGMENT_COUNT_AT: usize = 56;

/// `None` for other files than 64-bit little-endian ELF.
pub(super) fn is_static(bytes: &[u8]) -> Option<bool> {
    // magic number, 64 bits, little-endian
    if !bytes.starts_with(b"\x7fELF\x02\x01") {
        return None;
    }
    let start = usize::try_from(u64::from_le_bytes(bytes.get(SEGMENTS_AT..SEGMENTS_AT + 8)?.try_into().ok()?)).ok()?;
    let size = usize::from(half(bytes, SEGMENT_SIZE_AT)?);
    let count = usize::from(half(bytes, SEGMENT_COUNT_AT)?);
    for index in 0..count {
        let place = start.checked_add(index.checked_mul(size)?)?;
        let kind = u32::from_le_bytes(bytes.get(place..place.checked_add(4)?)?.try_into().ok()?);
        if kind == INTERPRETER {
            return Some(false);
        }
    }
    Some(true)
}

fn half(bytes: &[u8], place: usize) -> Option<u16> {
    Some(u16::from_le_bytes(bytes.get(place..place + 2)?.try_into().ok()?))
}

#[cfg(test)]
mod tests {
    use super::is_static;

    fn file(kinds: &[u32]) -> Vec<u8> {
        let mut bytes = vec![0; 64];
        bytes[..6].copy_from_slice(b"\x7fELF\x02\x01");
        bytes[32..40].copy_from_slice(&64u64.to_le_bytes());
        bytes[54..56].copy_from_slice(&56u16.to_le_bytes());
        bytes[56..58].copy_from_slice(&u16::try_from(kinds.len()).unwrap().to_le_bytes());
        for kind in kinds {
            bytes.extend(kind.to_le_bytes());
            bytes.extend([0; 52]);
        }
        bytes
    }

    #[test]
    fn a_program_with_a_loader_is_not_static() {
        assert_eq!(is_static(&file(&[1, 2])), Some(true));
        assert_eq!(is_static(&file(&[1, 3, 2])), Some(false));
        assert_eq!(is_static(b"MZ"), None);
        assert_eq!(is_static(&file(&[1, 2])[..100]), None, "cut off");
    }
}
