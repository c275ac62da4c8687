//! The command line as it was typed. The `resolve` function of each command finds its meaning.

#[cfg(feature = "archive")]
mod batch;
mod calibrate;
mod draft;
mod greybox;
mod groups;
mod init;
mod labels;
mod listen;
mod log;
mod motor;
mod serve;
mod shell;
mod simulation;
mod spectrogram;
mod speed;
mod thrust;
mod tones;
mod units;
mod vehicles;
mod verify;

#[cfg(feature = "archive")]
pub(crate) use batch::{BatchArguments, BatchCompareArguments};
pub(crate) use calibrate::CalibrateArguments;
pub(crate) use draft::DraftArguments;
pub(crate) use greybox::GreyBoxArguments;
pub(crate) use groups::{AnalysisArguments, HearingArguments, KnownArguments, ToneArguments, gear};
pub(crate) use init::InitArguments;
pub(crate) use labels::{BodyAxes, FrameLayout, LabelArguments};
pub(crate) use listen::ListenArguments;
pub(crate) use log::{ColumnName, LogArguments};
pub(crate) use motor::MotorArguments;
pub(crate) use serve::ServeArguments;
pub(crate) use shell::{CompletionsArguments, ManArguments};
pub(crate) use simulation::{DemoArguments, SimulateArguments};
pub(crate) use spectrogram::SpectrogramArguments;
pub(crate) use speed::SpeedArguments;
pub(crate) use thrust::{
    AirArguments, CompareArguments, ExportArguments, FitArguments, IdentifyArguments, PlaceArguments, WeighArguments,
};
pub(crate) use tones::TonesArguments;
pub(crate) use units::{Typed, length_m, rounded, typed_mass_kg};
pub(crate) use vehicles::VehiclesArguments;
pub(crate) use verify::VerifyArguments;

use clap::{Parser, Subcommand};

const EXAMPLES: &str = "\
Examples:
  hovertone demo                              the paper's experiment, in simulated flight
  hovertone speed --blades 2 hover.mp4        rotor speed of a recording
  hovertone speed --vehicle ardrone *.wav     of several recordings of a known vehicle
  hovertone listen --blades 2 --from-file hover.mp4        as it is played, or from a pipe
  hovertone batch archive -o speeds --blades 2     of a whole archive, as Parquet
  hovertone batch-compare january february    which rotors have changed between two archives
  hovertone tones hover.mp4                   its tones, and what each can mean
  hovertone spectrogram hover.mp4 -o x.png    its spectrogram, with the tracks of the rotors
  hovertone init                              an experiment file, by a few questions
  hovertone identify experiment.toml -o out   the thrust constant from hovers with known masses
  hovertone calibrate --true-hz 440 tone.wav  the recorder's clock, against a known tone
  hovertone fit stand.csv                     the same fit on a thrust stand's table
  hovertone fit --plan --mass-kg 0.413        how many flights a wanted uncertainty needs
  hovertone weigh loaded.mov --constant out/results.json   the mass of a payload, by the sound
  hovertone export out/results.json --to gazebo            lines for a simulator
  hovertone compare out/results.json iris.sdf              a simulator's model beside the constant
  hovertone log flight.ulg                    what a log of a flight holds
  hovertone motor steps.csv                   time constants of a motor, from steps in a log
  hovertone greybox doublets.csv --vehicle ardrone  gains and motors from doublets
  hovertone simulate scenario.toml -o flight  a flight, its sound, and the truth about both
  hovertone vehicles                          the vehicles it knows, with sources
  hovertone serve                             the same in a browser: drop, look, weigh

Exit codes:
  0  done
  1  a file or folder is not there, is of another kind, or cannot be read or written
  2  wrong use: a flag or a number has no meaning, or a file that exists would be replaced
  3  done, but something is missing: no rotor tone, a tone whose order is not known, a file that
     ends early, a calibration that does not pass, loads or table rows of which none fits the
     others, a vehicle that the sound contradicts
  130  interrupted with Ctrl-C: unfinished files are removed

Results go to stdout and to files, all messages to stderr.

± is the expanded uncertainty with the coverage factor k = 2: about 95 of 100 true values lie within it.";

/// hovertone hears a multirotor hover and tells its rotor speeds and its thrust constant
#[derive(Debug, Parser)]
#[command(name = "hovertone", version, after_help = EXAMPLES, max_term_width = 100)]
#[command(long_about = "hovertone hears a multirotor hover and tells its rotor speeds and its thrust constant.

It needs ordinary video or audio of hovering flights with known masses. It finds the tones of the rotors, and from them the rotor speeds. \
From speeds and masses follows C_f, the thrust constant in F = C_f ω², with its uncertainty.")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Init(Box<InitArguments>),
    Speed(Box<SpeedArguments>),
    Listen(Box<ListenArguments>),
    #[cfg(feature = "archive")]
    Batch(Box<BatchArguments>),
    #[cfg(feature = "archive")]
    BatchCompare(BatchCompareArguments),
    Tones(Box<TonesArguments>),
    Spectrogram(Box<SpectrogramArguments>),
    Identify(Box<IdentifyArguments>),
    Calibrate(Box<CalibrateArguments>),
    Fit(Box<FitArguments>),
    Weigh(Box<WeighArguments>),
    Export(ExportArguments),
    Compare(CompareArguments),
    Log(LogArguments),
    Motor(Box<MotorArguments>),
    Verify(Box<VerifyArguments>),
    #[command(name = "greybox")]
    GreyBox(Box<GreyBoxArguments>),
    Demo(DemoArguments),
    Simulate(SimulateArguments),
    Vehicles(VehiclesArguments),
    Serve(ServeArguments),
    Completions(CompletionsArguments),
    Man(ManArguments),
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }
}
