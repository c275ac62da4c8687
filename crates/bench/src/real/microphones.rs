//! Several microphones hear one rotor at the same moment: do their speeds differ as their uncertainties say?

use super::answer::{Answer, Status};
use super::hearing::duration_s;
use super::program::Program;
use super::progress::Progress;
use crate::accuracy::drawn;
use crate::document::Document;
use std::path::Path;

/// Recordings of one propeller by four microphones at once, beside the truth.
const FILES: [&str; 2] = ["cf_m1.wav", "cf_m3.wav"];
const CHANNELS: usize = 4;
const WINDOW_S: f64 = 1.0;

/// One window of one channel.
struct Listening {
    file: &'static str,
    /// Number of the window.
    window: usize,
    /// Counted from 1, as `--channel` does.
    channel: usize,
}

impl Listening {
    fn flags(&self) -> Vec<String> {
        let at_s = |window: usize| (window as f64 * WINDOW_S).to_string();
        let words = ["--blades", "2", "--channel", &self.channel.to_string()].map(str::to_owned);
        let span = ["--from".to_owned(), at_s(self.window), "--to".to_owned(), at_s(self.window + 1)];
        words.into_iter().chain(span).collect()
    }
}

/// A speed and one of its uncertainties.
#[derive(Clone, Copy, Debug)]
struct Told {
    speed_rev_s: f64,
    std_rev_s: f64,
}

/// Differences of all pairs of channels over their combined uncertainty.
#[derive(Default)]
struct Differences {
    ratios: Vec<f64>,
}

impl Differences {
    fn add_window(&mut self, told: &[Told]) {
        for (index, a) in told.iter().enumerate() {
            for b in &told[index + 1..] {
                self.ratios.push((a.speed_rev_s - b.speed_rev_s).abs() / a.std_rev_s.hypot(b.std_rev_s));
            }
        }
    }

    fn cells(&self) -> [String; 3] {
        let rms = (self.ratios.iter().map(|ratio| ratio * ratio).sum::<f64>() / self.ratios.len() as f64).sqrt();
        let mut sorted = self.ratios.clone();
        sorted.sort_by(f64::total_cmp);
        let shown = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.2}"));
        let has_any = Some(rms).filter(|_| !sorted.is_empty());
        [shown(has_any), shown(sorted.get(sorted.len() / 2).copied()), shown(sorted.last().copied())]
    }
}

/// The section of the report.
pub(super) fn add_microphones(document: &mut Document, folder: &Path, program: &Program) -> Result<(), String> {
    let mut all = Vec::new();
    for file in FILES {
        let windows = duration_s(&folder.join(file)).map_or(0, |duration_s| (duration_s / WINDOW_S).floor() as usize);
        let channels = |window: usize| (1..=CHANNELS).map(move |channel| Listening { file, window, channel });
        all.extend((0..windows).flat_map(channels));
    }
    let progress = Progress::new("windows of four microphones", all.len());
    let answers = drawn(all.len(), |number| {
        let answer = program.speed(&all[number].flags(), &folder.join(all[number].file))?;
        progress.step();
        Ok(answer)
    })?;
    document.heading("Four microphones at once");
    document.paragraph(
        "`cf_m1.wav` and `cf_m3.wav`: one propeller, heard by four microphones at the same moment, in windows of 1 s by `speed --blades 2 \
         --channel N --from S --to S`. Over all windows and pairs of channels: the difference of the two means over their combined standard \
         uncertainty, with the ± of the sound alone and with the whole ± (clock and motion too, which the channels share). If the ± of the sound \
         is true and the noise of the microphones independent, its rms is 1.",
    );
    let heads = ["file", "±", "answers", "pairs", "rms", "median", "worst"];
    let mut lines = Vec::new();
    for file in FILES.iter().map(|file| Some(*file)).chain([None]) {
        for (name, std) in [("sound", sound_std as fn(&Answer) -> Option<f64>), ("whole", whole_std)] {
            let differences = differences_of(&all, &answers, file, std);
            let of_file =
                all.iter().zip(&answers).filter(|(listening, _)| file.is_none_or(|file| file == listening.file));
            let (count, told) = of_file.fold((0, 0), |(count, told), (_, answer)| {
                (count + 1, told + usize::from(answer.status == Status::Ok))
            });
            let mut line = vec![file.unwrap_or("both").to_owned(), name.to_owned(), format!("{told} of {count}")];
            line.push(differences.ratios.len().to_string());
            line.extend(differences.cells());
            lines.push(line);
        }
    }
    document.table(&heads, &lines);
    Ok(())
}

fn sound_std(answer: &Answer) -> Option<f64> {
    answer.std_uncertainty_rev_s
}

fn whole_std(answer: &Answer) -> Option<f64> {
    answer.combined_std_uncertainty_rev_s
}

fn differences_of(
    all: &[Listening],
    answers: &[Answer],
    file: Option<&str>,
    std: fn(&Answer) -> Option<f64>,
) -> Differences {
    let mut differences = Differences::default();
    let is_same_window =
        |a: &(&Listening, &Answer), b: &(&Listening, &Answer)| a.0.file == b.0.file && a.0.window == b.0.window;
    let heard: Vec<(&Listening, &Answer)> = all.iter().zip(answers).collect();
    for window in heard.chunk_by(is_same_window) {
        let is_of_file = file.is_none_or(|file| window[0].0.file == file);
        let told = window.iter().filter(|(_, answer)| is_of_file && answer.status == Status::Ok);
        let told =
            told.filter_map(|(_, answer)| Some(Told { speed_rev_s: answer.speed_rev_s?, std_rev_s: std(answer)? }));
        differences.add_window(&told.collect::<Vec<_>>());
    }
    differences
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_of_a_window_is_compared_and_no_other() {
        let listening = |window, channel| Listening { file: FILES[0], window, channel };
        let all = [listening(0, 1), listening(0, 2), listening(0, 3), listening(1, 1), listening(1, 2)];
        let answer = |speed_rev_s, std| Answer {
            status: Status::Ok,
            speed_rev_s: Some(speed_rev_s),
            std_uncertainty_rev_s: Some(std),
            ..Answer::default()
        };
        let answers = [answer(100.0, 0.3), answer(100.5, 0.4), Answer::default(), answer(90.0, 0.3), answer(91.0, 0.4)];
        let differences = differences_of(&all, &answers, None, sound_std);
        assert_eq!(differences.ratios.len(), 2);
        // 0.5 and 1 over the root of 0.3² + 0.4²
        assert_eq!(differences.cells(), ["1.58", "2.00", "2.00"]);
        assert_eq!(differences_of(&all, &answers, Some(FILES[1]), sound_std).cells(), ["–", "–", "–"]);
        assert_eq!(all[4].flags().join(" "), "--blades 2 --channel 2 --from 1 --to 2");
    }
}
