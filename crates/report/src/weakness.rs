//! Warnings about recordings, counted: a warning that holds for all recordings is one warning.

use crate::notice::Notice;
use crate::recording::SpeedRecord;

/// The notices that hold for all of three or more recordings.
pub fn notices_of_all<'a>(records: &[&'a SpeedRecord]) -> Vec<&'a Notice> {
    match records {
        [first, _, _, ..] => {
            let is_of_all = |notice: &&Notice| records.iter().all(|record| record.notices.contains(notice));
            first.notices.iter().filter(is_of_all).collect()
        }
        _ => Vec::new(),
    }
}

/// Such a notice, with the number of recordings.
pub fn notice_of_all(notice: &Notice, records: &[&SpeedRecord]) -> Notice {
    Notice::new(format!("{} (in all {} recordings)", notice.text, records.len()), notice.hint.as_str())
}

/// Number of warnings about recordings. A recording without a speed counts as one.
pub fn warning_count(records: &[&SpeedRecord]) -> usize {
    let of_all = notices_of_all(records);
    let of_one = |record: &&SpeedRecord| {
        let own = record.notices.iter().filter(|notice| !of_all.contains(notice)).count();
        if record.has_failed() { 1 } else { own + usize::from(record.speed().is_none()) }
    };
    of_all.len() + records.iter().map(of_one).sum::<usize>()
}
