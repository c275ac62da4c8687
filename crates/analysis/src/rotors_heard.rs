//! How the rotors of a recording are heard: each by itself, as a group, or by one tone for all.

use crate::{Method, RotorTone, SpeedEstimate, TrackPoint};
use hovertone_vehicle::ROTOR_SPREAD_SHARE;
use serde::Serialize;
use std::borrow::Cow;

/// How a method hears the rotors of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum RotorsHeard {
    /// More than half of the rotors are separated; each of these has a speed of its own.
    Separated,
    /// At most half of the rotors can be separated: they have a common mean speed and a common mean square.
    Group,
    /// One tone is used for all rotors.
    OneTone,
}

impl RotorTone {
    /// How this method hears the rotors; `None` where it has no speed.
    pub fn rotors_heard(&self, method: Method) -> Option<RotorsHeard> {
        let speed = self.speed(method)?;
        Some(match speed.method {
            Method::Separated if self.rotors.is_empty() => RotorsHeard::Group,
            Method::Separated => RotorsHeard::Separated,
            _ => RotorsHeard::OneTone,
        })
    }

    /// The tracks that a log is compared with: those of the separated rotors, else that of the one tone. It may be the tone of any of several
    /// rotors, so each of its points has the spread of the rotors too. That of a group has the mean of the group, which is known better.
    pub fn tracks_beside_log(&self, method: Method) -> Vec<Cow<'_, [TrackPoint]>> {
        if !self.rotors.is_empty() {
            return self.rotors.iter().map(|rotor| Cow::Borrowed(rotor.track.as_slice())).collect();
        }
        let speed = self.speed(method);
        let of_speed = speed.map_or(0.0, SpeedEstimate::rotors_std_share);
        let (spread_share, factor) = match (self.rotors_heard(method), speed) {
            (Some(RotorsHeard::Group), Some(group)) => {
                (of_speed.max(ROTOR_SPREAD_SHARE), group.speed.rev_s() / self.mean_rev_s())
            }
            _ => (of_speed, 1.0),
        };
        let point = |point: &TrackPoint| TrackPoint {
            tone_hz: factor * point.tone_hz,
            speed_rev_s: factor * point.speed_rev_s,
            std_uncertainty_rev_s: point.std_uncertainty_rev_s.hypot(spread_share * point.speed_rev_s),
            ..*point
        };
        vec![self.track.iter().map(point).collect()]
    }

    /// Mean speed over the points of the track.
    fn mean_rev_s(&self) -> f64 {
        self.track.iter().map(|point| point.speed_rev_s).sum::<f64>() / self.track.len() as f64
    }
}

/// Number of recordings in which the rotors are heard in each way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RotorsHeardCounts {
    /// Recordings in which they are separated.
    pub separated: usize,
    /// Recordings in which they are heard as a group.
    pub group: usize,
    /// Recordings in which one tone is used for all.
    pub one_tone: usize,
}

impl FromIterator<RotorsHeard> for RotorsHeardCounts {
    fn from_iter<I: IntoIterator<Item = RotorsHeard>>(all: I) -> Self {
        let mut counts = Self::default();
        for heard in all {
            *match heard {
                RotorsHeard::Separated => &mut counts.separated,
                RotorsHeard::Group => &mut counts.group,
                RotorsHeard::OneTone => &mut counts.one_tone,
            } += 1;
        }
        counts
    }
}
