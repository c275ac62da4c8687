//! From the sound of a hovering multirotor to the speed of its rotors and its thrust constant.
//!
//! Pure: no files, clock, threads, environment or printing. Sound comes in through [`sound::SignalSource`].

pub mod experiment;

/// Sound: a source of samples, and how far an analysis has come in it.
pub mod sound {
    pub use hovertone_signal::passes::{Passes, Progress};
    pub use hovertone_signal::spectrogram::{Frame, Stft, Window};
    pub use hovertone_signal::{Signal, SignalError, SignalSource, SourceError};
}

/// Rotor speeds: from a recording to a [`SpeedAnalysis`].
pub mod speed {
    pub use hovertone_analysis::{
        Band, Cut, CutReason, HarmonicSpeed, Hover, Method, NoTone, Outcome, Peak, Ridge, RidgeFrame, RotorEstimate,
        RotorTone, SampleSpeeds, Span, SpeedAnalysis, SpeedEstimate, TrackPoint, UncertaintySource, UncertaintyTerm,
        Warning,
    };
    pub use hovertone_rotor_speed::{
        BudgetConfig, Config, Error, HoverConfig, HoverPart, HoverRotors, RidgeConfig, RotorsConfig, SampleConfig,
        SpanConfig, SpectrogramConfig, Surveyed, ToneConfig, passes_of_speed, rotors_from_survey, speed_from_passes,
        speed_from_source, speed_from_survey, survey_from_passes,
    };
}

/// Tone families of a recording whose tone nobody has named, and the shaft speeds that each can mean.
pub mod tones {
    pub use hovertone_analysis::{Meaning, Reading, Remark, SeenHarmonic, ToneFamily};
    pub use hovertone_rotor_speed::{Discovery, DiscoveryConfig, FoundSpeed, tones_from_passes, tones_from_source};
    pub use hovertone_vehicle::KnownRotor;
}

/// Which track is which rotor, and the condition of each rotor.
pub mod rotors {
    pub use hovertone_analysis::{
        LABELLED_ROTORS_MAX, LabelSource, NotTold, RotorCondition, RotorLabel, RotorLabels, ShaftLine,
    };
    pub use hovertone_rotor_id::LabelsConfig;
    pub use hovertone_rotor_id::by_log::{FlightLog, LogError, LogSignals, MotorSignal, labels_from_log};
    pub use hovertone_rotor_id::by_microphones::{
        ArrayError, MicrophoneArray, MicrophoneLines, MicrophonesConfig, PlacedRotor, labels_from_microphones,
        microphone_lines_from_source,
    };
    pub use hovertone_rotor_id::by_spin_up::{
        RotorStart, SpinUp, labels_from_spin_up, passes_of_spin_up, speed_after_spin_up, spin_up_from_analysis,
    };
    pub use hovertone_rotor_id::condition::conditions_from_analysis;
}

/// The thrust constant: from rotor speeds and known forces to C_f in F = C_f ω², with its uncertainty.
pub mod thrust {
    pub use hovertone_thrust::*;
}

/// What a multirotor is: presets with sources, quantities, physical constants.
pub mod vehicle {
    pub use hovertone_vehicle::*;
}
