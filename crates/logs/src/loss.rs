//! What of a log could not be read.

use std::fmt;

/// Number of places that are listed.
const PLACES_MAX: usize = 8;

/// A place without meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LostPlace {
    /// First of the lost bytes, counted from 0.
    pub from_byte: u64,
    /// Their number.
    pub bytes: u64,
    /// Time of the last row before them.
    pub after_s: Option<f64>,
}

/// What of a log could not be read, and where.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loss {
    /// All bytes of the log.
    pub all_bytes: u64,
    /// Bytes without meaning.
    pub lost_bytes: u64,
    /// Number of places where they stand.
    pub place_count: u64,
    /// The first of these places.
    pub places: Vec<LostPlace>,
}

impl Loss {
    pub(crate) fn add(&mut self, place: LostPlace) {
        self.lost_bytes += place.bytes;
        self.place_count += 1;
        if self.places.len() < PLACES_MAX {
            self.places.push(place);
        }
    }

    /// Whether something is missing.
    pub fn is_some(&self) -> bool {
        self.lost_bytes > 0
    }

    /// What is missing and where, as a sentence; `None` where nothing is.
    pub fn in_words(&self) -> Option<String> {
        self.is_some().then(|| self.to_string())
    }
}

impl fmt::Display for Loss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(first) = self.places.first() else { return f.write_str("nothing is lost") };
        let is_end = self.place_count == 1 && first.from_byte + first.bytes == self.all_bytes;
        let (lost, all) = (self.lost_bytes, self.all_bytes);
        if is_end {
            write!(f, "the log breaks off: its last {lost} of {all} bytes cannot be read")?;
        } else {
            let places = if self.place_count == 1 { "place" } else { "places" };
            write!(
                f,
                "the log is damaged: {lost} of its {all} bytes cannot be read, in {} {places}",
                self.place_count
            )?;
        }
        let from = if self.place_count == 1 { "from" } else { "first from" };
        write!(f, ", {from} byte {}", first.from_byte)?;
        match first.after_s {
            Some(after_s) => write!(f, ", at {after_s:.3} s on the clock of the log"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_says_how_much_and_where() {
        let mut loss = Loss { all_bytes: 1000, ..Loss::default() };
        assert_eq!(loss.in_words(), None);
        loss.add(LostPlace { from_byte: 990, bytes: 10, after_s: Some(1.25) });
        let words = loss.in_words().unwrap();
        assert_eq!(
            words,
            "the log breaks off: its last 10 of 1000 bytes cannot be read, from byte 990, at 1.250 s on the clock of the log"
        );
        let mut loss = Loss { all_bytes: 1000, ..Loss::default() };
        loss.add(LostPlace { from_byte: 20, bytes: 10, after_s: None });
        let words = loss.in_words().unwrap();
        assert_eq!(words, "the log is damaged: 10 of its 1000 bytes cannot be read, in 1 place, from byte 20");
        (0..20).for_each(|_| loss.add(LostPlace { from_byte: 500, bytes: 1, after_s: None }));
        assert!(
            loss.in_words().unwrap().contains("30 of its 1000 bytes cannot be read, in 21 places, first from byte 20")
        );
        assert_eq!(loss.places.len(), PLACES_MAX);
    }
}
