//! From the sound of a hovering multirotor to the speed of its rotors and its thrust constant.
//!
//! A recording to a speed:
//!
//! ```
//! use hovertone::speed::{Config, Outcome, ToneConfig, speed_from_source};
//! use hovertone::vehicle::Order;
//! # fn hover(rev_s: f64) -> hovertone::sound::Signal {
//! #     let (mut state, rate_hz) = (1_u32, 16_000.0);
//! #     let sample = |n: usize| {
//! #         state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
//! #         let noise = f64::from(state) / f64::from(u32::MAX) - 0.5;
//! #         let line = |k: f64| 0.1 / k * (std::f64::consts::TAU * 2.0 * k * rev_s * n as f64 / rate_hz).cos();
//! #         (0.03 * noise + (1..7).map(|k| line(f64::from(k))).sum::<f64>()) as f32
//! #     };
//! #     hovertone::sound::Signal::new((0..80_000).map(sample).collect(), rate_hz)
//! # }
//! let mut recording = hover(61.3); // or `hovertone_media::Recording::open(path)`: both are a `SignalSource`
//! let config = Config::for_tone(ToneConfig::of_order(Order::from_blades(2)?)); // the blade pass of two blades
//! match speed_from_source(&mut recording, &config, &mut |_progress| {})?.outcome {
//!     Outcome::Ok(tone) => {
//!         let speed = tone.speed(config.method).ok_or("no estimate by the configured method")?;
//!         println!("{:.3} rev/s ± {:?} (k = 1)", speed.speed.rev_s(), speed.combined_std_uncertainty_rev_s());
//! #         assert!((speed.speed.rev_s() - 61.3).abs() < 0.01);
//!     }
//!     Outcome::NoRotorTone { reason } => println!("no rotor tone: {reason}"),
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The modules follow the data: [`sound`] → [`speed`] (or [`tones`], where nobody knows the tone) → [`rotors`] → [`thrust`]. [`experiment`]
//! settles a whole campaign; [`calibration`] checks the recorder; [`vehicle`] knows multirotors and quantities.
//!
//! Pure: no files, clock, threads, environment or printing. Everything is SI, and units stand in the names.

pub mod calibration;
pub mod experiment;
pub mod motors;

/// Sound: a source of samples, and the passes over it.
///
/// Any type with four methods is a source:
///
/// ```
/// use hovertone::sound::{Passes, SignalSource, SourceError};
///
/// /// A siren of 5 s, made block by block.
/// struct Siren { block: Vec<f32>, blocks_left: u32 }
///
/// impl SignalSource for Siren {
///     fn sample_rate_hz(&self) -> f64 { 8_000.0 }
///     fn start_s(&self) -> f64 { 0.0 }
///     fn next_block(&mut self) -> Result<Option<&[f32]>, SourceError> {
///         if self.blocks_left == 0 {
///             return Ok(None);
///         }
///         self.blocks_left -= 1;
///         Ok(Some(&self.block))
///     }
///     fn rewind(&mut self) -> Result<(), SourceError> {
///         self.blocks_left = 5;
///         Ok(())
///     }
/// }
///
/// let mut siren = Siren { block: vec![0.1; 8_000], blocks_left: 5 };
/// let mut seen = Vec::new();
/// let mut on_progress = |progress: hovertone::sound::Progress| seen.push((progress.pass, progress.pass_count, progress.time_s));
/// let mut passes = Passes::planned(&mut siren, 1, &mut on_progress)?;
/// let end_s = passes.pieces(&[1.0..3.0], |_piece| {})?;
/// assert_eq!(end_s, 3.0);
/// assert_eq!(seen.last(), Some(&(1, 1, 3.0))); // pass 1 of 1; nothing after the span is read
/// # Ok::<(), hovertone::sound::SignalError>(())
/// ```
pub mod sound {
    pub use hovertone_signal::line_frequency::{HeardBand, LineFrequency, line_frequency};
    pub use hovertone_signal::passes::{Passes, Piece, Progress, StretchListener};
    pub use hovertone_signal::spectrogram::{Frame, Stft, Window};
    pub use hovertone_signal::{Signal, SignalError, SignalSource, SourceError};
}

/// Rotor speeds: from a recording to a [`SpeedAnalysis`](speed::SpeedAnalysis).
///
/// ```
/// use hovertone::speed::{Config, Outcome, SpanConfig, ToneConfig, speed_from_source};
/// use hovertone::vehicle::Order;
/// # fn hover(rev_s: f64) -> hovertone::sound::Signal {
/// #     let (mut state, rate_hz) = (1_u32, 16_000.0);
/// #     let sample = |n: usize| {
/// #         state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
/// #         let noise = f64::from(state) / f64::from(u32::MAX) - 0.5;
/// #         let line = |k: f64| 0.1 / k * (std::f64::consts::TAU * 2.0 * k * rev_s * n as f64 / rate_hz).cos();
/// #         (0.03 * noise + (1..7).map(|k| line(f64::from(k))).sum::<f64>()) as f32
/// #     };
/// #     hovertone::sound::Signal::new((0..80_000).map(sample).collect(), rate_hz)
/// # }
/// let mut config = Config::for_tone(ToneConfig::of_order(Order::from_blades(2)?));
/// config.span = SpanConfig { from_s: Some(1.0), to_s: Some(4.0) }; // all between is used, nothing is cut away
/// let analysis = speed_from_source(&mut hover(61.3), &config, &mut |_progress| {})?;
/// assert_eq!(analysis.hover.length_s(), 3.0);
/// let Outcome::Ok(tone) = analysis.outcome else { panic!("no rotor tone") };
/// for point in &tone.track {
///     assert!((point.speed_rev_s - 61.3).abs() < 0.1, "{} s: {} rev/s", point.time_s, point.speed_rev_s);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// No rotor tone is an answer with its reason:
///
/// ```
/// use hovertone::sound::Signal;
/// use hovertone::speed::{Config, NoTone, Outcome, ToneConfig, speed_from_source};
/// use hovertone::vehicle::Order;
///
/// let mut silence = Signal::new(vec![0.0; 80_000], 16_000.0);
/// let config = Config::for_tone(ToneConfig::of_order(Order::from_blades(3)?));
/// let analysis = speed_from_source(&mut silence, &config, &mut |_progress| {})?;
/// assert!(matches!(analysis.outcome, Outcome::NoRotorTone { reason: NoTone::Silence }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub mod speed {
    pub use hovertone_analysis::{
        Band, Cut, CutReason, HarmonicSpeed, Hover, Method, NoTone, OtherRotor, Outcome, Peak, Ridge, RidgeFrame,
        RotorEstimate, RotorTone, RotorsHeard, RotorsHeardCounts, SampleSpeeds, Span, SpeedAnalysis, SpeedEstimate,
        TrackPoint, UncertaintySource, UncertaintyTerm, Warning,
    };
    pub use hovertone_rotor_speed::{
        BudgetConfig, ComparedSpeed, Config, Error, EvidenceNear, HoverConfig, HoverPart, HoverRotors, LinesNear,
        NoiseLevel, OrderLevel, RidgeConfig, RotorsConfig, SampleConfig, SpanConfig, SpectrogramConfig, Surveyed,
        ToneConfig, better_rotor_from_passes, evidence_near, passes_of_speed, rotors_from_survey, speed_from_passes,
        speed_from_source, speed_from_survey, survey_from_passes,
    };
}

/// Tone families of a recording whose tone nobody has named, and the shaft speeds that each can mean.
///
/// ```
/// use hovertone::speed::{Config, ToneConfig};
/// use hovertone::tones::{Discovery, KnownRotor, tones_from_source};
/// use hovertone::vehicle::Order;
/// # fn hover(rev_s: f64) -> hovertone::sound::Signal {
/// #     let (mut state, rate_hz) = (1_u32, 16_000.0);
/// #     let sample = |n: usize| {
/// #         state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
/// #         let noise = f64::from(state) / f64::from(u32::MAX) - 0.5;
/// #         let line = |k: f64| 0.1 / k * (std::f64::consts::TAU * 2.0 * k * rev_s * n as f64 / rate_hz).cos();
/// #         (0.03 * noise + (1..7).map(|k| line(f64::from(k))).sum::<f64>()) as f32
/// #     };
/// #     hovertone::sound::Signal::new((0..80_000).map(sample).collect(), rate_hz)
/// # }
/// let discovery = Discovery { known: KnownRotor { blade_count: Some(2), ..KnownRotor::default() }, ..Discovery::default() };
/// let config = Config::for_tone(ToneConfig::of_order(Order::new(1.0)?)); // the order is replaced by the one that is found
/// let found = tones_from_source(&mut hover(61.3), &config, &discovery, &mut |_progress| {})?;
/// let family = &found.families[found.rotor.ok_or("no family that a rotor can make")?];
/// assert!((family.fundamental_hz - 122.6).abs() < 0.5);
/// assert_eq!(found.reading().map(|reading| reading.order.lines_per_turn()), Some(2.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub mod tones {
    pub use hovertone_analysis::{Meaning, Reading, Remark, SeenHarmonic, ToneFamily};
    pub use hovertone_rotor_speed::{Discovery, DiscoveryConfig, FoundSpeed, tones_from_passes, tones_from_source};
    pub use hovertone_vehicle::KnownRotor;
}

/// Sound as it arrives: the speed of the rotors now.
///
/// ```
/// use hovertone::live::{Listener, LiveConfig, LiveStatus};
/// use hovertone::speed::{Config, ToneConfig};
/// use hovertone::vehicle::Order;
/// # fn hover(rev_s: f64) -> Vec<f32> {
/// #     let (mut state, rate_hz) = (1_u32, 16_000.0);
/// #     let sample = |n: usize| {
/// #         state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
/// #         let noise = f64::from(state) / f64::from(u32::MAX) - 0.5;
/// #         let line = |order: u32| {
/// #             let level = if order.is_multiple_of(2) { 0.2 } else { 0.04 } / f64::from(order);
/// #             level * (std::f64::consts::TAU * f64::from(order) * rev_s * n as f64 / rate_hz).cos()
/// #         };
/// #         (0.03 * noise + (1..13).map(line).sum::<f64>()) as f32
/// #     };
/// #     (0..80_000).map(sample).collect()
/// # }
/// let config = Config::for_tone(ToneConfig::of_order(Order::from_blades(2)?));
/// let mut listener = Listener::new(16_000.0, LiveConfig::of_analysis(config, None))?;
/// let mut last = None;
/// for mut block in hover(61.3).chunks(1_000) {
///     while !block.is_empty() {
///         block = listener.push(block, &mut |speed| last = Some(speed)); // allocates nothing
///         if listener.wants_review() {
///             listener.review()?; // the analysis of the last seconds
///         }
///     }
/// }
/// let now = last.expect("a live speed every tenth of a second");
/// assert_eq!(now.status, LiveStatus::Ok);
/// assert!((now.speed_rev_s.expect("a speed") - 61.3).abs() < 0.1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub mod live {
    pub use hovertone_live::{Listener, LiveConfig, LiveSpeed, LiveStatus, PossibleSpeed};
}

/// Which track is which rotor, and the condition of each rotor.
///
/// Two tracks, and a log of the same flight on a clock of its own, 3.2 s behind:
///
/// ```
/// use hovertone::rotors::{FlightLog, LabelsConfig, LogSignals, MotorSignal, labels_from_log};
/// use hovertone::speed::TrackPoint;
///
/// // each motor's speed wanders in its own way
/// let left_rev_s = |t: f64| 60.0 + 0.8 * (1.1 * t).sin() + 0.5 * (2.9 * t).cos();
/// let right_rev_s = |t: f64| 60.6 + 0.7 * (1.7 * t + 1.0).sin() + 0.6 * (3.7 * t).cos();
/// let track = |speed_rev_s: &dyn Fn(f64) -> f64| -> Vec<TrackPoint> {
///     let point = |k: u32| (0.04 * f64::from(k), speed_rev_s(0.04 * f64::from(k)));
///     (0..250)
///         .map(point)
///         .map(|(time_s, speed_rev_s)| TrackPoint {
///             time_s,
///             tone_hz: 2.0 * speed_rev_s,
///             speed_rev_s,
///             std_uncertainty_rev_s: 0.02,
///             level_db: -40.0,
///         })
///         .collect()
/// };
/// let (heard_first, heard_second) = (track(&right_rev_s), track(&left_rev_s));
/// let log_time_s: Vec<f64> = (0..200).map(|k| 0.05 * f64::from(k) - 3.2).collect();
/// let logged = |speed_rev_s: &dyn Fn(f64) -> f64| -> Vec<f64> {
///     log_time_s.iter().map(|t| std::f64::consts::TAU * speed_rev_s(t + 3.2)).collect()
/// };
/// let values = vec![logged(&left_rev_s), logged(&right_rev_s)];
/// let names = vec!["left".to_owned(), "right".to_owned()];
/// let log = FlightLog::new(log_time_s, LogSignals::Motors { signal: MotorSignal::Speed, names, values })?;
///
/// let labels = labels_from_log(&[&heard_first, &heard_second], 2, &log, &LabelsConfig::default());
/// let names: Vec<&str> = labels.rotors.iter().flatten().map(|label| label.name.as_str()).collect();
/// assert_eq!(names, ["right", "left"]);
/// assert!(labels.offset_s.is_some_and(|offset_s| (offset_s - 3.2).abs() < 0.05));
/// # Ok::<(), hovertone::rotors::LogError>(())
/// ```
pub mod rotors {
    pub use hovertone_analysis::{Agreement, ComparedPoint, Verification, VerifiedRotor};
    pub use hovertone_analysis::{
        LABELLED_ROTORS_MAX, LabelSource, NotTold, RotorCondition, RotorLabel, RotorLabels, ShaftLine,
    };
    pub use hovertone_rotor_id::LabelsConfig;
    pub use hovertone_rotor_id::by_log::{
        FlightLog, LogError, LogSignals, LoggedSpeeds, MotorSignal, NotVerified, labels_from_log, verification_of_heard,
    };
    pub use hovertone_rotor_id::by_microphones::{
        ArrayError, MicrophoneArray, MicrophoneLines, MicrophonesConfig, PlacedRotor, labels_from_microphones,
        microphone_lines_from_source,
    };
    pub use hovertone_rotor_id::by_spin_up::{
        RotorStart, SpinUp, labels_from_spin_up, passes_of_spin_up, speed_after_spin_up, spin_up_from_analysis,
    };
    pub use hovertone_rotor_id::condition::{condition_of_one_rotor, conditions_from_analysis};
}

/// The thrust constant: from rotor speeds and known forces to C_f in F = C_f ω², with its uncertainty.
///
/// Three loads of a vehicle with four rotors, three trials each:
///
/// ```
/// use hovertone::speed::{Method, Span};
/// use hovertone::thrust::{Force, LoadSpeeds, SampleSpeed, ThrustSettings, TrialSpeeds, thrust_from_loads};
/// use hovertone::vehicle::RotorSpeed;
///
/// let constant_total_n_s2 = 2.83e-5;
/// let load = |added_mass_kg: f64| {
///     let weight_n = (0.413 + added_mass_kg) * 9.80665;
///     let trial = |number: u32| {
///         let error = 1.0 + 3e-4 * (f64::from(number) - 2.0);
///         let speed = RotorSpeed::from_rad_s((weight_n / constant_total_n_s2).sqrt() * error);
///         let span = Span { from_s: 0.0, to_s: 10.0 };
///         let hover =
///             SampleSpeed { span, speed, std_uncertainty_rev_s: Some(0.01), spread_rev_s: Some(0.5), frame_count: 250 };
///         TrialSpeeds {
///             recording: format!("{added_mass_kg} kg, trial {number}"),
///             hover_s: 10.0,
///             hover: Some(hover),
///             samples: vec![],
///             rotors_heard: None,
///         }
///     };
///     LoadSpeeds {
///         name: format!("{added_mass_kg} kg"),
///         force: Force::Weight {
///             vehicle_mass_kg: 0.413,
///             added_mass_kg,
///             mass_std_kg: 0.0005,
///             gravity_m_s2: 9.80665,
///             gravity_std_m_s2: 0.001,
///         },
///         rotors_running: 4,
///         power_w: None,
///         trials: (1..=3).map(trial).collect(),
///     }
/// };
/// let loads = [load(0.0), load(0.1), load(0.2)];
/// let table = thrust_from_loads(&loads, Method::Separated, &ThrustSettings::for_rotors(4));
/// let constant = table.thrust_constant_total_n_s2.ok_or("no constant")?;
/// assert!((constant.value / constant_total_n_s2 - 1.0).abs() < 1e-3);
/// let budget = table.budget.ok_or("no budget")?;
/// println!("C_f = {:.3e} N s² ± {:.1} % (k = 2)", constant.value, 100.0 * budget.expanded_share);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// A straight line through points that are uncertain in both coordinates:
///
/// ```
/// use hovertone::thrust::regression::{FitPoint, line_fit};
///
/// let point = |x: f64, error: f64| FitPoint { x, x_std: 0.1, y: 1.0 + 2.0 * x + error, y_std: 0.2 };
/// let fit = line_fit(&[point(0.0, 0.1), point(1.0, -0.1), point(2.0, -0.1), point(3.0, 0.1)])?;
/// assert!((fit.slope - 2.0).abs() < 0.05 && (fit.intercept - 1.0).abs() < 0.05);
/// # Ok::<(), hovertone::thrust::regression::FitError>(())
/// ```
pub mod thrust {
    pub use hovertone_thrust::*;
}

/// Multirotors: presets with sources, quantities, physical constants.
///
/// ```
/// use hovertone::vehicle::{Gear, RotorSpeed, find_preset};
///
/// let ardrone = find_preset("ardrone").ok_or("no such preset")?;
/// let gear: Gear = ardrone.gear.ok_or("no gear")?.value;
/// let mesh = gear.mesh_order()?; // 69 lines per turn: the teeth of the wheel
/// let speed = RotorSpeed::from_tone_hz(4151.895, mesh);
/// assert!((speed.rpm() - 3610.3).abs() < 0.1); // eq 6 of the paper
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub mod vehicle {
    pub use hovertone_vehicle::*;
}
