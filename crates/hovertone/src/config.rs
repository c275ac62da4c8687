//! Settings: every default stands here once, with its unit and its reason.

use crate::budget_config::BudgetConfig;
use crate::error::ConfigError;
use crate::method::Method;
use crate::rotors_config::RotorsConfig;
use crate::spectrogram::Window;
use hovertone_vehicle::{Order, RotorSpeed, ShaftSpeedRange};
use serde::{Deserialize, Serialize};

/// All settings of an analysis. `Default` holds the recommended values; the tone's order has none and must be said.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Config {
    /// Which tone of the rotor is followed.
    pub tone: ToneConfig,
    /// How many rotors sound, and where they are looked for.
    pub rotors: RotorsConfig,
    /// Which part of the recording is used.
    pub span: SpanConfig,
    /// How hovering is told from the rest.
    pub hover: HoverConfig,
    /// How a hover is cut into samples.
    pub samples: SampleConfig,
    /// Frames and their spectra.
    pub spectrogram: SpectrogramConfig,
    /// How a ridge is drawn and when it counts as a tone.
    pub ridge: RidgeConfig,
    /// What else makes the speed uncertain.
    pub budget: BudgetConfig,
    /// Which of the estimators gives the speed.
    pub method: Method,
    /// Whether the others are wanted too, for comparison. The paper's two cost more time than the harmonic likelihood.
    pub wants_all_methods: bool,
}

impl Config {
    /// The recommended settings for a tone.
    pub fn for_tone(tone: ToneConfig) -> Self {
        Self {
            tone,
            rotors: RotorsConfig::default(),
            span: SpanConfig::default(),
            hover: HoverConfig::default(),
            samples: SampleConfig::default(),
            spectrogram: SpectrogramConfig::default(),
            ridge: RidgeConfig::default(),
            budget: BudgetConfig::default(),
            method: Method::default(),
            wants_all_methods: false,
        }
    }

    /// The estimators that are wanted.
    pub(crate) fn methods(&self) -> impl Iterator<Item = Method> {
        let is_there = |method: &Method| *method != Method::Separated || self.rotors.are_several();
        let is_wanted = |method: &Method| {
            // where there is nothing to tell apart, one rotor is heard alone
            let is_instead = self.method == Method::Separated && *method == Method::Harmonic;
            self.wants_all_methods || *method == self.method || is_instead
        };
        Method::ALL.into_iter().filter(is_there).filter(is_wanted)
    }

    /// Whether a method is wanted that reads ridges.
    pub(crate) fn wants_ridges(&self) -> bool {
        self.methods().any(Method::reads_ridges)
    }

    /// Refuses settings that mean nothing, by name, value and limit.
    pub fn check(&self) -> Result<(), ConfigError> {
        self.tone.check()?;
        self.rotors.check()?;
        self.span.check()?;
        self.hover.check()?;
        self.samples.check()?;
        self.spectrogram.check()?;
        self.budget.check()?;
        self.ridge.check()
    }
}

pub(crate) fn check_range(name: &'static str, value: f64, min: f64, max: f64) -> Result<(), ConfigError> {
    if (min..=max).contains(&value) { Ok(()) } else { Err(ConfigError::OutOfRange { name, value, min, max }) }
}

/// Which tone of the rotor is followed, and where it is looked for.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ToneConfig {
    /// Order of the tone: lines per turn of the shaft.
    pub order: Order,
    /// How many harmonics have a ridge, the tone itself counted as the first. The paper follows three.
    pub harmonics: u32,
    /// How many lines of the blade pass the harmonic likelihood hears: those of small multirotors stand out of the noise up
    /// to the twelfth, and weak ones do no harm.
    pub blade_pass_lines: u32,
    /// How many lines of the gear mesh it hears: the AR.Drone's fourth is above what most recorders keep.
    pub gear_mesh_lines: u32,
    /// Blades of the rotor, where they are known beside a gear: their lines help to find the shaft speed.
    pub blades: Option<u32>,
    /// Band of the first harmonic, in Hz; found from the recording where absent.
    pub band_hz: Option<(f64, f64)>,
    /// Half width of a found band as a share of its middle. Holds ±4 standard deviations of the paper's 1.2 % wander and
    /// rotors a few per cent apart, and keeps the bands of three harmonics from overlapping.
    pub band_half_width_share: f64,
    /// Slowest shaft that is looked for, rad/s.
    #[serde(rename = "speed_rad_s_min")]
    pub speed_min: RotorSpeed,
    /// Fastest shaft that is looked for, rad/s.
    #[serde(rename = "speed_rad_s_max")]
    pub speed_max: RotorSpeed,
}

/// A shaft may turn this much slower or faster than the vehicle's known range before it is not looked for.
const KNOWN_RANGE_MARGIN: f64 = 1.5;

impl ToneConfig {
    /// The recommended settings for a tone of that order.
    pub fn of_order(order: Order) -> Self {
        Self {
            order,
            harmonics: 3,
            blade_pass_lines: 20,
            gear_mesh_lines: 3,
            blades: None,
            band_hz: None,
            band_half_width_share: 0.08,
            speed_min: RotorSpeed::from_rev_s(15.0), // below the 30 rev/s of the largest multirotors' propellers
            speed_max: RotorSpeed::from_rev_s(800.0), // above the 670 rev/s of the smallest racers' propellers
        }
    }

    /// The same tone, looked for only where the vehicle's rotors are known to turn (and half as far again beyond).
    #[must_use]
    pub fn within(self, known: &ShaftSpeedRange) -> Self {
        Self {
            speed_min: RotorSpeed::from_rev_s(known.rev_s_low / KNOWN_RANGE_MARGIN),
            speed_max: RotorSpeed::from_rev_s(known.rev_s_high * KNOWN_RANGE_MARGIN),
            ..self
        }
    }

    fn check(&self) -> Result<(), ConfigError> {
        check_range("order", self.order.lines_per_turn(), 0.1, 1e4)?;
        check_range("harmonics", f64::from(self.harmonics), 1.0, 20.0)?;
        check_range("blade_pass_lines", f64::from(self.blade_pass_lines), 1.0, 40.0)?;
        check_range("gear_mesh_lines", f64::from(self.gear_mesh_lines), 1.0, 40.0)?;
        check_range("blades", f64::from(self.blades.unwrap_or(1)), 1.0, 20.0)?;
        check_range("band_half_width_share", self.band_half_width_share, 0.005, 0.3)?;
        check_range("speed_rad_s_min", self.speed_min.rad_s(), 1.0, 1e5)?;
        check_range("speed_rad_s_max", self.speed_max.rad_s(), self.speed_min.rad_s(), 1e5)?;
        if let Some((low_hz, high_hz)) = self.band_hz {
            check_range("band_hz_low", low_hz, 1.0, 1e6)?;
            if high_hz.is_nan() || high_hz <= low_hz {
                return Err(ConfigError::EmptyBand { low_hz, high_hz });
            }
        }
        Ok(())
    }
}

/// Which part of the recording is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SpanConfig {
    /// Start of the part to use, on the recording's clock. Where a start or end is given, all between is used and
    /// nothing is cut away as not hovering.
    pub from_s: Option<f64>,
    /// End of the part to use.
    pub to_s: Option<f64>,
}

impl SpanConfig {
    /// Whether the user says what to use.
    pub fn is_given(&self) -> bool {
        self.from_s.is_some() || self.to_s.is_some()
    }

    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        let (from_s, to_s) = (self.from_s.unwrap_or(0.0), self.to_s.unwrap_or(f64::INFINITY));
        if from_s < to_s { Ok(()) } else { Err(ConfigError::EmptySpan { from_s, to_s }) }
    }
}

/// How hovering is told from silence, handling noise, take-off and landing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HoverConfig {
    /// Frame of the survey: resolves 5 Hz, enough to find lines, short enough for their wander.
    pub survey_window_s: f64,
    /// Time step of the survey: cuts are made to this.
    pub survey_row_s: f64,
    /// Rows kept at most; a longer recording gets longer rows, so that memory does not grow with its length.
    pub survey_rows_max: usize,
    /// Frame of the survey's low frequencies: resolves 1 Hz, so that mains hum is told from a rotor that wanders by 0.1 % and
    /// more, and a helicopter's lines, 10 Hz and more apart, from each other.
    pub fine_window_s: f64,
    /// Highest frequency of those: mains hum has been heard to its fiftieth multiple, and that must not pass for a gear mesh.
    pub fine_hz_max: f64,
    /// Rows this much quieter than the typical row of the hover are not hover.
    pub quieter_db: f64,
    /// Rows this much louder are handling noise.
    pub louder_db: f64,
    /// A row's comb must reach this share of the hover's typical comb to count as hover.
    pub comb_share_min: f64,
    /// Rows whose speed differs from the hover's around them by so many of the hover's own wanders (standard deviations) are a
    /// manoeuvre. Wander alone reaches it in one row of 16 000.
    pub manoeuvre_wanders: f64,
    /// A difference below this share is no manoeuvre, however steady the hover: twice the spread of the paper's hovers.
    pub manoeuvre_share_min: f64,
    /// The hover around a row reaches this far: long against a doublet, short against a battery.
    pub manoeuvre_reach_s: f64,
    /// A tone that is never held for so long, while others sound for longer than it, is no rotor's: music does that. The
    /// shortest hover between manoeuvres that is worth a sample of the paper's is longer.
    pub held_s_min: f64,
    /// Shorter hovers are not used: they hold too few frames to tell a tone from noise.
    pub length_s_min: f64,
}

impl Default for HoverConfig {
    fn default() -> Self {
        Self {
            survey_window_s: 0.2,
            survey_row_s: 0.5,
            survey_rows_max: 256,
            fine_window_s: 1.0,
            fine_hz_max: 3000.0,
            quieter_db: 12.0,
            louder_db: 12.0,
            comb_share_min: 0.35,
            manoeuvre_wanders: 4.0,
            manoeuvre_share_min: 0.025,
            manoeuvre_reach_s: 15.0,
            held_s_min: 3.0,
            length_s_min: 1.0,
        }
    }
}

impl HoverConfig {
    fn check(&self) -> Result<(), ConfigError> {
        check_range("survey_window_s", self.survey_window_s, 0.02, 1.0)?;
        check_range("survey_row_s", self.survey_row_s, self.survey_window_s, 60.0)?;
        check_range("survey_rows_max", self.survey_rows_max as f64, 8.0, 4096.0)?;
        check_range("fine_window_s", self.fine_window_s, 0.2, 10.0)?;
        check_range("fine_hz_max", self.fine_hz_max, 200.0, 20_000.0)?;
        check_range("quieter_db", self.quieter_db, 1.0, 100.0)?;
        check_range("louder_db", self.louder_db, 1.0, 100.0)?;
        check_range("comb_share_min", self.comb_share_min, 0.0, 1.0)?;
        check_range("manoeuvre_wanders", self.manoeuvre_wanders, 1.0, 1e6)?;
        check_range("manoeuvre_share_min", self.manoeuvre_share_min, 0.001, 1.0)?;
        check_range("manoeuvre_reach_s", self.manoeuvre_reach_s, 1.0, 1e4)?;
        check_range("held_s_min", self.held_s_min, 0.0, 60.0)?;
        check_range("length_s_min", self.length_s_min, 0.1, 1e4)
    }
}

/// How a hover is cut into samples, the paper's database (figure 5).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SampleConfig {
    /// Length of a sample. The paper says "approximately 5 s".
    pub length_s: f64,
    /// Share of a sample that the next one repeats. 40 % gives two samples of 5 s in a trial of 10 s.
    pub overlap: f64,
}

impl Default for SampleConfig {
    fn default() -> Self {
        Self { length_s: 5.0, overlap: 0.4 }
    }
}

impl SampleConfig {
    fn check(&self) -> Result<(), ConfigError> {
        check_range("length_s", self.length_s, 0.5, 1e4)?;
        check_range("overlap", self.overlap, 0.0, 0.95)
    }
}

/// Frames and their spectra (paper, eq 5).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SpectrogramConfig {
    /// Length of a frame. Where absent, the clearest of 0.0125 to 0.4 s is taken: a wandering high order wants short
    /// frames, a steady low one long frames.
    pub window_s: Option<f64>,
    /// Step between frames as a share of their length. At one half, Hann frames use every sample of the sound equally.
    pub hop_share: f64,
    /// Frames of a ridge at most. On a hover so long that the step above would give more, the step grows, so that memory
    /// does not grow with the length of a recording. 12 000 frames cover 75 s in the shortest frames without a gap.
    pub frames_max: u32,
    /// Frames of each length at most where only the question is asked whether there are lines at all: a share of 256 is known to
    /// 3 %.
    pub verdict_frames_max: u32,
    /// Shape of the window.
    pub window: Window,
    /// Length of the transform in windows: 2 brings the bias of the interpolated peak to 0.0017 of a window's bin.
    pub zero_pad_factor: u32,
}

/// Frame lengths that are tried where none is given.
const WINDOW_LADDER_S: [f64; 6] = [0.0125, 0.025, 0.05, 0.1, 0.2, 0.4];

impl Default for SpectrogramConfig {
    fn default() -> Self {
        Self {
            window_s: None,
            hop_share: 0.5,
            frames_max: 12_000,
            verdict_frames_max: 256,
            window: Window::Hann,
            zero_pad_factor: 2,
        }
    }
}

impl SpectrogramConfig {
    fn check(&self) -> Result<(), ConfigError> {
        if let Some(window_s) = self.window_s {
            check_range("window_s", window_s, 0.005, 2.0)?;
        }
        check_range("hop_share", self.hop_share, 0.02, 1.0)?;
        check_range("frames_max", f64::from(self.frames_max), 100.0, 1e5)?;
        check_range("verdict_frames_max", f64::from(self.verdict_frames_max), 20.0, 1e5)?;
        check_range("zero_pad_factor", f64::from(self.zero_pad_factor), 1.0, 8.0)
    }

    /// Step between frames of a length in a hover of a length.
    pub(crate) fn hop_s(&self, window_s: f64, hover_s: f64, frames_max: u32) -> f64 {
        (self.hop_share * window_s).max(hover_s / f64::from(frames_max))
    }

    /// The frame lengths in which to look for lines of a tone whose first band is this wide. The main lobe must fit in the
    /// band on either side of the tone: in a shorter frame noise of the band's width would look like a line.
    pub(crate) fn ladder_s(&self, band_width_hz: f64) -> Vec<f64> {
        let window_s_min = self.window.main_lobe_half_bins() / (band_width_hz / 2.0);
        let longest_s = WINDOW_LADDER_S[WINDOW_LADDER_S.len() - 1];
        WINDOW_LADDER_S.into_iter().filter(|&s| s >= window_s_min || s == longest_s).collect()
    }
}

/// How a ridge is drawn and when it counts as a tone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RidgeConfig {
    /// Share of a frame's peak that takes part in the Gaussian (paper: 0.8, remark 5: 0.5 to 0.9 change little).
    pub gaussian_threshold_share: f64,
    /// Chance that noise alone puts a point on the ridge of a frame. A frame with the tone has its point there; among the
    /// frames without, one in fifty then has one somewhere in the band.
    pub false_point_chance: f64,
    /// A peak is a line when it stands this far above the median of its surroundings. Noise reaches it in one frame of
    /// a hundred; the lines of real hovers in 60 to 100 % of frames.
    pub line_over_sides_db: f64,
    /// Share of frames in which the clearest harmonic must be a line. Rotors recorded in flight give 0.64 to 1.00,
    /// machinery and traffic that only resembles a rotor up to 0.45.
    pub line_share_min: f64,
    /// Share of frames in which a second harmonic must be a line too …
    pub company_share_min: f64,
    /// … unless the clearest is one in this share of frames.
    pub lonely_line_share_min: f64,
    /// … or lines keep their phase, in blocks of a second and more, over this share of the hover: a tone so steady is a tone
    /// however weak it is. No rotor in flight is; one on a bench, or a simulated one, can be.
    pub steady_share_min: f64,
    /// Share of frames with a point below which a ridge is not used.
    pub point_share_min: f64,
    /// Harmonics whose mean differs from the clearest one's by more than this share are left out.
    pub harmonic_disagreement_share_max: f64,
}

impl Default for RidgeConfig {
    fn default() -> Self {
        Self {
            gaussian_threshold_share: 0.8,
            false_point_chance: 0.02,
            line_over_sides_db: 16.0,
            line_share_min: 0.5,
            company_share_min: 0.1,
            lonely_line_share_min: 0.85,
            steady_share_min: 0.8,
            point_share_min: 0.3,
            harmonic_disagreement_share_max: 0.01,
        }
    }
}

impl RidgeConfig {
    fn check(&self) -> Result<(), ConfigError> {
        check_range("gaussian_threshold_share", self.gaussian_threshold_share, 0.3, 0.95)?;
        check_range("false_point_chance", self.false_point_chance, 1e-9, 0.5)?;
        check_range("line_over_sides_db", self.line_over_sides_db, 3.0, 60.0)?;
        check_range("line_share_min", self.line_share_min, 0.0, 1.0)?;
        check_range("company_share_min", self.company_share_min, 0.0, 1.0)?;
        check_range("lonely_line_share_min", self.lonely_line_share_min, 0.0, 1.0)?;
        check_range("steady_share_min", self.steady_share_min, 0.0, 1.0)?;
        check_range("point_share_min", self.point_share_min, 0.0, 1.0)?;
        check_range("harmonic_disagreement_share_max", self.harmonic_disagreement_share_max, 0.0, 0.2)
    }
}
