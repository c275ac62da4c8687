//! A recording as a row of `recordings.parquet`. Names are those of `hovertone speed --json`.

use crate::columns::{Columns, NO_UNIT, head, plain};
use arrow_array::RecordBatch;
use arrow_schema::ArrowError;
use hovertone_analysis::{Reading, RotorEstimate, RotorsHeard, UncertaintySource, UncertaintyTerm};
use hovertone_report::{RecordingFacts, SpeedRecord};
use hovertone_vehicle::RotorSpeed;

/// A recording, heard or not.
#[derive(Clone, Debug)]
pub struct ArchiveRow {
    /// The record, as `hovertone speed` has it.
    pub record: SpeedRecord,
    /// One word for the kind of error, where the recording could not be heard.
    pub error_class: Option<&'static str>,
}

const REV_S: &str = "rev/s";
const SECOND: &str = "s";
const HERTZ: &str = "Hz";

/// One row for each recording.
pub(crate) fn recordings_batch(rows: &[ArchiveRow]) -> Result<RecordBatch, ArrowError> {
    let columns = answer_columns(Columns::of(rows));
    let columns = speed_columns(columns);
    facts_columns(rotor_columns(columns)).batch()
}

fn answer_columns(columns: Columns<'_, ArchiveRow>) -> Columns<'_, ArchiveRow> {
    let error = |row: &ArchiveRow| row.error_class.filter(|_| row.record.has_failed()).map(str::to_owned);
    columns
        .text(plain("file", "name of the recording's file, as it was found"), |row| &row.record.file)
        .text(plain("status", "ok, ambiguous, no_rotor_tone or error"), |row| row.record.status())
        .text_or_none(plain("error_class", "kind of the error, where it could not be heard"), error)
        .text_or_none(plain("reason", "why there is no speed"), |row| row.record.reason())
        .text(plain("method", "how the speed is read from the sound"), |row| {
            row.record.speed().map_or(row.record.method, |speed| speed.method).name()
        })
        .text_or_none(plain("rotors_heard", "separated, group or one_tone"), |row| {
            row.record.rotors_heard().map(|heard| heard_name(heard).to_owned())
        })
        .texts(plain("warnings", "what weakens the answer, each with its hint"), |row| {
            row.record.notices.iter().map(ToString::to_string).collect()
        })
        .flag(plain("is_doubtful", "whether the speed must not be used: it contradicts the given facts"), |row| {
            Some(row.record.is_doubtful())
        })
}

fn heard_name(heard: RotorsHeard) -> &'static str {
    match heard {
        RotorsHeard::Separated => "separated",
        RotorsHeard::Group => "group",
        RotorsHeard::OneTone => "one_tone",
        _ => "other",
    }
}

fn speed_columns(columns: Columns<'_, ArchiveRow>) -> Columns<'_, ArchiveRow> {
    let shaft = |row: &ArchiveRow| row.record.speed().map(|speed| speed.speed);
    let order = |row: &ArchiveRow| {
        let record = &row.record;
        (record.found.is_none() || record.speed().is_some()).then(|| record.order.lines_per_turn())
    };
    columns
        .number(head("order", NO_UNIT, "lines of the tone per turn of the shaft"), order)
        .number(head("tone_hz", HERTZ, "mean frequency of the tone"), |row| row.record.tone_hz())
        .number(head("speed_rev_s", REV_S, "mean shaft speed"), |row| shaft(row).map(RotorSpeed::rev_s))
        .number(head("speed_rpm", "rpm", "mean shaft speed"), |row| shaft(row).map(RotorSpeed::rpm))
        .number(head("speed_rad_s", "rad/s", "mean shaft speed"), |row| shaft(row).map(RotorSpeed::rad_s))
        .number(head("std_uncertainty_rev_s", REV_S, "standard uncertainty from the sound alone"), |row| {
            row.record.speed()?.std_uncertainty_rev_s
        })
        .number(head("combined_std_uncertainty_rev_s", REV_S, "standard uncertainty of all terms"), |row| {
            row.record.speed()?.combined_std_uncertainty_rev_s()
        })
        .list(
            plain("uncertainty_budget", "terms of the combined uncertainty"),
            |row| row.record.speed().map_or(Vec::new(), |speed| speed.budget.clone()),
            budget_columns,
        )
        .number(head("spread_rev_s", REV_S, "standard deviation of the speed over the frames"), |row| {
            row.record.speed()?.spread_rev_s
        })
        .number(head("mean_square_rad2_s2", "rad2/s2", "mean square of the angular speed"), |row| {
            row.record.speed()?.mean_square_rad2_s2
        })
        .number(head("from_s", SECOND, "start of the used hover"), |row| row.record.used().map(|used| used.from_s))
        .number(head("to_s", SECOND, "end of the used hover"), |row| row.record.used().map(|used| used.to_s))
        .whole(head("frame_count", NO_UNIT, "frames with a point"), |row| {
            row.record.speed().map(|speed| speed.frame_count as i64)
        })
        .number(head("window_s", SECOND, "length of a frame"), |row| row.record.tone().map(|tone| tone.window_s))
}

fn budget_columns(columns: Columns<'_, UncertaintyTerm>) -> Columns<'_, UncertaintyTerm> {
    columns
        .text(plain("source", "source of the uncertainty"), |term| source_name(term.source))
        .number(head("std_uncertainty_rev_s", REV_S, "standard uncertainty"), |term| Some(term.std_uncertainty_rev_s))
}

fn source_name(source: UncertaintySource) -> &'static str {
    match source {
        UncertaintySource::Sound => "sound",
        UncertaintySource::Clock => "clock",
        UncertaintySource::Doppler => "doppler",
        UncertaintySource::Drift => "drift",
        UncertaintySource::Rotors => "rotors",
        _ => "other",
    }
}

fn rotor_columns(columns: Columns<'_, ArchiveRow>) -> Columns<'_, ArchiveRow> {
    columns
        .list(
            plain("rotors", "separated rotors, fastest first"),
            |row| row.record.rotors().to_vec(),
            |columns| {
                columns
                    .number(head("speed_rev_s", REV_S, "mean shaft speed"), |rotor: &RotorEstimate| {
                        Some(rotor.speed.speed.rev_s())
                    })
                    .number(
                        head("std_uncertainty_rev_s", REV_S, "standard uncertainty from the sound alone"),
                        |rotor| rotor.speed.std_uncertainty_rev_s,
                    )
                    .number(
                        head("combined_std_uncertainty_rev_s", REV_S, "standard uncertainty of all terms"),
                        |rotor| rotor.speed.combined_std_uncertainty_rev_s(),
                    )
                    .number(head("spread_rev_s", REV_S, "standard deviation over the frames"), |rotor| {
                        rotor.speed.spread_rev_s
                    })
                    .number(head("mean_square_rad2_s2", "rad2/s2", "mean square of the angular speed"), |rotor| {
                        rotor.speed.mean_square_rad2_s2
                    })
                    .number(
                        head(
                            "shaft_over_blade_pass_db",
                            "dB",
                            "shaft line over blade pass, where --condition asks for it",
                        ),
                        |rotor| rotor.condition.as_ref()?.shaft_over_blade_pass_db(),
                    )
            },
        )
        .list(
            plain("alternatives", "speeds that stay plausible, most plausible first; empty where one is settled"),
            |row| row.record.alternatives().to_vec(),
            reading_columns,
        )
}

fn reading_columns(columns: Columns<'_, Reading>) -> Columns<'_, Reading> {
    columns
        .number(head("order", NO_UNIT, "lines of the tone per turn"), |reading| Some(reading.order.lines_per_turn()))
        .number(head("speed_rev_s", REV_S, "shaft speed of this reading"), |reading| Some(reading.speed.rev_s()))
        .number(head("plausibility", NO_UNIT, "from 0 to 1"), |reading| Some(reading.plausibility))
}

fn facts_columns(columns: Columns<'_, ArchiveRow>) -> Columns<'_, ArchiveRow> {
    type Facts<'a> = Option<&'a RecordingFacts>;
    columns.group(
        plain("recording", "facts about the file; absent where it could not be opened"),
        |row| row.record.recording.as_ref(),
        |columns| {
            columns
                .text_or_none(plain("sha256", "hash of the bytes"), |facts: &Facts<'_>| facts.as_ref()?.sha256.clone())
                .text_or_none(plain("container", "kind of the file"), |facts| Some(facts.as_ref()?.container.clone()))
                .text_or_none(plain("codec", "kind of the sound"), |facts| Some(facts.as_ref()?.codec.clone()))
                .text_or_none(plain("decoder", "hovertone or ffmpeg"), |facts| Some(facts.as_ref()?.decoder.clone()))
                .number(head("sample_rate_hz", HERTZ, "samples per second"), |facts| {
                    Some(facts.as_ref()?.sample_rate_hz)
                })
                .whole(head("channel_count", NO_UNIT, "channels of the track"), |facts| {
                    Some(facts.as_ref()?.channel_count as i64)
                })
                .whole(head("channel", NO_UNIT, "heard channel, from 1; absent for the mean of all"), |facts| {
                    Some(facts.as_ref()?.channel? as i64)
                })
                .whole(head("audio_track", NO_UNIT, "heard track, from 1"), |facts| {
                    Some(facts.as_ref()?.audio_track as i64)
                })
                .whole(head("audio_track_count", NO_UNIT, "audio tracks of the file"), |facts| {
                    Some(facts.as_ref()?.audio_track_count as i64)
                })
                .flag(plain("is_prefix", "whether the file ends before its sound does"), |facts| {
                    Some(facts.as_ref()?.is_prefix)
                })
        },
    )
}
