//! The report: tables of quantiles and of outcomes, and the figure.

use super::super::judgement::Verdict;
use super::super::sentence;
use super::measured::{Heard, Measured, QUANTITIES, Quantity};
use crate::document::Document;
use hovertone_figures::{Distribution, Figure, distributions_figure};

/// The shares whose values are told.
const SHARES: [f64; 3] = [0.1, 0.5, 0.9];
const NAMES: [&str; 3] = ["simulated flights", "real flights", "one real rotor on a bench"];

/// The recordings that are compared.
pub(super) struct Sets {
    pub(super) simulated: Vec<Heard>,
    pub(super) flights: Vec<Heard>,
    pub(super) benches: Vec<Heard>,
}

impl Sets {
    fn all(&self) -> [&[Heard]; 3] {
        [&self.simulated, &self.flights, &self.benches]
    }
}

pub(super) fn figure(sets: &Sets) -> Result<Figure, String> {
    let quantities = QUANTITIES.map(|quantity| Distribution {
        title: quantity.title.to_owned(),
        values: sets.all().map(|heard| values_of(&quantity, heard)).to_vec(),
    });
    let title = "Levels and evidence of simulated and of real rotors";
    distributions_figure("levels", title, &NAMES, &quantities).map_err(|error| error.to_string())
}

pub(super) fn report(made_by: &str, sets: &Sets, has_ffmpeg: bool) -> String {
    let mut document = Document::default();
    document.paragraph("# Simulated sound beside real sound");
    document.paragraph(&format!("{}; not edited by hand.", sentence(made_by)));
    document.paragraph(PICTURE_HEAD);
    document.paragraph("![Spectrograms of a simulated AR.Drone and of a real multirotor](synthetic-and-real.png)");
    document.paragraph(PICTURE);
    document.heading("Levels and evidence");
    document.paragraph(LEVELS);
    if !has_ffmpeg {
        document.paragraph("ffmpeg was not there: no simulated flight went through a codec.");
    }
    document.table(&heads(sets), &QUANTITIES.map(|quantity| quantile_row(&quantity, sets)));
    document.paragraph(
        "![Shares of the recordings that have at most a value, for each quantity](synthetic-and-real-levels.png)",
    );
    document.heading("Answers");
    document.paragraph(ANSWERS);
    let heads: Vec<&str> = ["set", "recordings"].into_iter().chain(Verdict::ALL.map(Verdict::name)).collect();
    let rows: Vec<Vec<String>> =
        NAMES.into_iter().zip(sets.all()).map(|(name, heard)| count_row(name, heard)).collect();
    document.table(&heads, &rows);
    let not_right = sets.simulated.iter().filter(|heard| heard.verdict != Verdict::Right);
    let heads = [
        "not right",
        "answer",
        "told or first speed over the true one",
        "first line, dB",
        "votes, nats",
        "levels, nats",
    ];
    document.table(&heads, &not_right.map(cells_of).collect::<Vec<_>>());
    document.heading("Where simulated sound is easier, and where it is harder");
    document.markdown(EASIER);
    document.into_text()
}

fn heads(sets: &Sets) -> Vec<String> {
    let named = NAMES.into_iter().zip(sets.all()).map(|(name, heard)| format!("{name} ({})", heard.len()));
    ["quantity".to_owned()].into_iter().chain(named).collect()
}

fn values_of(quantity: &Quantity, heard: &[Heard]) -> Vec<f64> {
    heard.iter().filter_map(|heard| (quantity.of)(&heard.measured)).collect()
}

/// "1.2, 3.4, 5.6 (40)": the values of the shares, and how many recordings have one.
fn quantile_row(quantity: &Quantity, sets: &Sets) -> Vec<String> {
    let cells = sets.all().map(|heard| {
        let values = values_of(quantity, heard);
        let quantiles = SHARES.map(|share| quantile(&values, share).map_or("–".to_owned(), number));
        format!("{} ({})", quantiles.join(", "), values.len())
    });
    [quantity.title.to_owned()].into_iter().chain(cells).collect()
}

fn number(value: f64) -> String {
    let decimals = if value.abs() < 3.0 { 2 } else { 1 };
    let text = if value.is_infinite() { "∞".to_owned() } else { format!("{:.decimals$}", value.abs()) };
    let is_zero = text.chars().all(|letter| matches!(letter, '0' | '.'));
    if value < 0.0 && !is_zero { format!("−{text}") } else { text }
}

/// The value that this share of the values does not exceed, between two of them by a straight line.
fn quantile(values: &[f64], share: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = share * sorted.len().checked_sub(1)? as f64;
    let (before, after) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    Some(if before == after { before } else { before + place.fract() * (after - before) })
}

fn cells_of(heard: &Heard) -> Vec<String> {
    let Measured { first_db, votes_nats, levels_nats, .. } = heard.measured;
    let numbers = [heard.told_share, first_db, votes_nats, levels_nats];
    let texts = numbers.map(|value| value.map_or("–".to_owned(), number));
    [heard.name.clone(), heard.verdict.name().to_owned()].into_iter().chain(texts).collect()
}

fn count_row(name: &str, heard: &[Heard]) -> Vec<String> {
    let count = |verdict: Verdict| heard.iter().filter(|heard| heard.verdict == verdict).count().to_string();
    [name.to_owned(), heard.len().to_string()].into_iter().chain(Verdict::ALL.map(count)).collect()
}

const PICTURE_HEAD: &str = "`hovertone simulate examples/ardrone-doublets.toml -o flight` flies a scenario through the flight model of the \
    paper. It writes the sound at each microphone (`sound.wav`) and the truth at every instant (`truth.csv`, `truth.json`). \
    [formats.md](formats.md#the-scenario-file-of-simulate) lists everything that a scenario can have.";
const PICTURE: &str = "Left: `hovertone simulate validation/spectrogram/ardrone.toml`, an AR.Drone with rotors up to 5 % apart in the laboratory of \
    the paper's figure 1, with the assumed levels. Right: DRONE_001 of the DroneDetectionThesis recordings (CC0), another drone without a gear. Above: \
    up to 9 kHz, in frames of 43 ms. Below: up to 1 kHz, in frames of 0.34 s. `validation/spectrogram/draw.py` draws the figure. In both, the blade \
    pass lines are bundles that become wider with the order, all lines move together, the floor falls with frequency, and levels rise and fall as \
    rotors beat and reflections add and cancel. The simulated drone also has its gear mesh at 4.15 and 8.3 kHz, with sidebands. The real recording has \
    more noise below 150 Hz, a wider bundle (single rotors at 166 to 201 Hz), and a codec that cuts above 4.5 kHz at times.";
const LEVELS: &str = "Each simulated flight is a hover with levels drawn from the [levels of real rotors](measurements.md#levels-of-real-rotors) \
    (`line_levels = \"drawn\"`), of a vehicle, place, wind, voices and recorder that are drawn as well, through AAC or Opus in four of five cases \
    (`crates/bench/src/real/levels/simulated.rs`). The real recordings are the trusted ones with known blades. The same code measures all: along the \
    best path within 10 % of the true speed, in frames of 0.1 s. A line is audible if it is 2.5 standard deviations above the level between the \
    orders. The power of a line is its level over the local floor, plus the local floor against the mean floor of the recording. Fall and scatter \
    come from a straight line in log order through the powers of the audible lines of the blade pass, up to the 12th harmonic; shaft \
    lines above the blade pass are measured against it, lines below the blade pass against its first line, where that is at least 15 dB. Each cell has \
    the 10, 50 and 90 % quantiles and the number of recordings with a value. The evidence of the levels is the sum of frames of 0.1 and 0.4 s. The last \
    quantity is the logarithm of the odds of the true octave against its best rival, where a rotor is heard; it is −∞ where the truth is not among \
    the compared speeds, and ∞ where nothing else is.";
const ANSWERS: &str = "Answers to the whole sound with the blades given and nothing else, judged as in [real-sound.md](real-sound.md). A simulated \
    answer is right between the slowest and the fastest instant of any rotor.";
const EASIER: &str = "\
- **More evidence at the same loudness.** The first line of the blade pass has nearly the same median level as in real flights, but the medians of
  votes and of the evidence of the levels are higher in simulated flights.
- **More and louder shaft lines** than in real flights, and louder lines below the blade pass than on real benches. They tell the octave. The table
  has one distribution for flights and benches, and lines of the motor, whose levels are assumed, are at orders 7 and 21, which are no blade pass.
- **Steadier speeds.** The gain of each motor wanders by 0.2 to 0.4 % here; rotors of real flights wander by 1 to 3 %. With gains that wander by 2 %,
  the simulated vehicles lean and sink to the ground.

The first line of the blade pass, the audible share of blade pass lines and the odds of the octave are distributed much as in real flights.

Where it is harder:

- Lines of the blade pass scatter more than in real flights, and less than on real benches: the table has one distribution for both.
- The loudness has a wider range. The silent simulated flights have a first line within 3 dB of the floor and votes below 0: they are not
  audible. Nine of ten real flights have votes of 3 nats and more.
- More places between the orders hold lines of something else, probably of voices and of rotors that are further apart.

One real rotor on a bench is louder, falls more steeply and shows most of its shaft lines. No simulated set stands for it.

Findings for the estimator: flight 35 is answered with twice its speed, flights 5 and 49 with half, and in flight 7 twice the speed comes first. The
first line of the blade pass is hidden by noise in flights 7 and 35, and the harmonics are not. Flight 11 is answered with a speed below its slowest
rotor.
";

#[cfg(test)]
mod tests {
    use super::{number, quantile};

    #[test]
    fn quantiles_lie_between_the_values() {
        let values = [4.0, 1.0, 3.0, 2.0, f64::INFINITY];
        assert_eq!(
            [0.0, 0.5, 0.625, 1.0].map(|share| quantile(&values, share).unwrap()),
            [1.0, 3.0, 3.5, f64::INFINITY]
        );
        assert_eq!(quantile(&[], 0.5), None);
        assert_eq!(quantile(&[f64::INFINITY; 2], 0.9), Some(f64::INFINITY));
    }

    #[test]
    fn numbers_have_the_minus_of_print() {
        assert_eq!([-14.21, 0.5, -0.001, f64::NEG_INFINITY].map(number), ["−14.2", "0.50", "0.00", "−∞"]);
    }
}
