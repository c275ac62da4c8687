//! From the sound of a hovering multirotor to the speed of its rotors and its thrust constant.
//!
//! Pure: no files, clock, threads, environment or printing. Sound comes in through [`SignalSource`].

mod budget_config;
mod channel;
mod condition;
mod config;
mod discovery;
mod discovery_config;
mod error;
mod experiment;
mod harmonic;
mod hover;
mod labels;
mod labels_config;
mod listening;
mod matrix;
mod method;
mod microphones_config;
mod picture;
mod picture_config;
mod pipeline;
mod regression;
mod ridge;
mod rotor_readings;
mod rotors_config;
mod sample;
mod signal;
mod span;
mod spectrogram;
mod speed;
mod statistics;
mod stream;
mod thrust;
mod tone;
mod verdict;
mod warning;

pub use budget_config::BudgetConfig;
pub use condition::{RotorCondition, ShaftLine};
pub use config::{Config, HoverConfig, RidgeConfig, SampleConfig, SpanConfig, SpectrogramConfig, ToneConfig};
pub use discovery::{Discovery, FoundSpeed, tones_from_source};
pub use discovery_config::{DiscoveryConfig, KnownRotor};
pub use error::{ConfigError, Error};
pub use experiment::{
    Experiment, ExperimentError, ExperimentFile, ExperimentLoad, LoadSection, ModelAgainstHeard, OrderSetting,
    ToneSection, VehicleModel, VehicleSection,
};
pub use hover::{Cut, CutReason, Hover};
pub use labels::{
    ArrayError, FlightLog, LABELLED_ROTORS_MAX, LabelSource, LogError, LogSignals, MicrophoneArray, MicrophoneLines,
    MotorSignal, NotTold, PlacedRotor, RotorBegin, RotorLabel, RotorLabels, SpinUp, labels_from_log,
    labels_from_microphones, labels_from_spin_up, microphone_lines_from_source,
};
pub use labels_config::LabelsConfig;
pub use method::Method;
pub use microphones_config::MicrophonesConfig;
pub use picture::{MeanSpectrum, Picture, PictureView, Pictures, pictures_from_source, views_of_recording};
pub use picture_config::PictureConfig;
pub use pipeline::{Outcome, RotorTone, SampleSpeeds, SpeedAnalysis, speed_from_source};
pub use regression::{
    Agreement, FitError, FitPoint, LineFit, ParameterPrior, ProportionalFit, line_fit, log_evidence_ratio,
    proportional_fit,
};
pub use ridge::{Peak, Ridge, RidgeFrame, peak_offset_bins};
pub use rotors_config::RotorsConfig;
pub use signal::{Signal, SignalSource, SourceError};
pub use span::Span;
pub use spectrogram::{Frame, Stft, Window};
pub use speed::{HarmonicSpeed, RotorEstimate, SpeedEstimate, TrackPoint, UncertaintySource, UncertaintyTerm};
pub use stream::Progress;
pub use thrust::{
    AcousticScale, Air, BudgetInput, BudgetLine, COVERAGE_FACTOR, Drift, DriftKind, FlightPlan, Force, ForceLaw,
    ForcePoint, GRAVITY_STANDARD_M_S2, Gravity, HeardHover, InterceptLaw, LawAgreement, LawProbability, LoadRange,
    LoadSpeeds, LoadThrust, PROPELLER_DIAMETER_M, PlanError, PlanWish, PointNoise, PointVerdict, PowerLaw, SampleSpeed,
    SampleThrust, SquareLawFit, ThrustCoefficients, ThrustSettings, ThrustTable, TrialBootstrap, TrialSpeeds,
    TrialThrust, UncertaintyBudget, UncertaintyInputs, WeighedHover, figure_of_merit, flight_plan, gravity_m_s2,
    is_plausible_merit, row_drifts, square_law_fit, thrust_constant_n_s2, thrust_from_loads, torque_constant_n_m_s2,
    warnings_of_points,
};
pub use tone::{Band, Meaning, Reading, Remark, SeenHarmonic, ToneFamily};
pub use verdict::NoTone;
pub use warning::Warning;
