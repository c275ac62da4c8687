//! One of several jobs that hear an archive together.

use std::fmt;
use std::str::FromStr;

/// Most jobs of one archive.
const COUNT_MAX: usize = 100_000;

/// The job `number` of `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: usize,
    count: usize,
}

impl Shard {
    /// All of it by one job.
    pub const WHOLE: Self = Self { number: 1, count: 1 };

    /// Whether this job hears the recording at a place of the plan. Neighbours go to different jobs, so that all jobs last equally long.
    pub fn has(self, index: usize) -> bool {
        index % self.count == self.number - 1
    }

    /// Whether it is the only job.
    pub fn is_whole(self) -> bool {
        self.count == 1
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(typed: &str) -> Result<Self, String> {
        let parts = typed.split_once('/').and_then(|(number, count)| Some((number.parse().ok()?, count.parse().ok()?)));
        match parts {
            Some((number, count)) if (1..=count).contains(&number) && count <= COUNT_MAX => Ok(Self { number, count }),
            Some((_, count @ 1..=COUNT_MAX)) => {
                let last = match count {
                    1 => String::new(),
                    2 => " or 2/2".to_owned(),
                    _ => format!(" to {count}/{count}"),
                };
                let jobs = if count > 1 { format!("there are {count} jobs") } else { "there is 1 job".to_owned() };
                Err(format!("{jobs}, so write 1/{count}{last}"))
            }
            _ => Err(format!(
                "write the number of this job and the number of all jobs, such as 1/8 for the first of eight jobs; at \
                most {COUNT_MAX} jobs"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Shard;

    #[test]
    fn each_recording_belongs_to_one_job() {
        assert_eq!("3/2".parse::<Shard>().unwrap_err(), "there are 2 jobs, so write 1/2 or 2/2");
        let shards: Vec<Shard> = ["1/3", "2/3", "3/3"].map(|typed| typed.parse().unwrap()).to_vec();
        for index in 0..10 {
            assert_eq!(shards.iter().filter(|shard| shard.has(index)).count(), 1);
        }
        assert!((0..10).all(|index| Shard::WHOLE.has(index)) && Shard::WHOLE.is_whole());
    }

    #[test]
    fn a_job_beyond_their_number_is_refused() {
        for typed in ["0/3", "4/3", "1", "1/0", "a/b", "-1/3", "1/3/3", "", "1/100001"] {
            assert!(typed.parse::<Shard>().is_err(), "{typed}");
        }
    }
}
