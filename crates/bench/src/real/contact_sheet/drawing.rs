//! The tiles as one sheet.

use super::tile::{HEIGHT, Tile, TrackPoint, WIDTH};
use crate::real::judgement::Verdict;
use hovertone_figures::Figure;
use std::fmt::Write as _;

const COLUMNS: usize = 9;
/// Size of a tile, and of the space around its picture.
const TILE_WIDTH: usize = 262;
const TILE_HEIGHT: usize = 168;
const PICTURE_LEFT: usize = 17;
const PICTURE_TOP: usize = 38;
/// Above the tiles.
const HEAD_HEIGHT: usize = 62;
const MARGIN: usize = 14;
/// Length of a tick beside a picture.
const TICK: usize = 8;
/// Points of a track that are further apart have a gap between them.
const GAP_S: f64 = 0.3;
/// Letters of a name that fit, and how many of them are its end, which says more than its beginning.
const NAME_LETTERS: usize = 23;
const END_LETTERS: usize = 17;

const INK: &str = "#1b1b1f";
const MUTED: &str = "#6b7078";
const TRACK: &str = "#e0218a";

/// Colours that people with any colour vision can distinguish (Okabe and Ito 2008).
fn colour(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Right => "#009e73",
        Verdict::Wrong => "#d55e00",
        Verdict::Octave => "#e69f00",
        Verdict::MeanOff => "#cc79a7",
        Verdict::First | Verdict::Listed | Verdict::Missing => "#0072b2",
        Verdict::Silent => "#6b7078",
    }
}

/// The sheet.
pub(super) fn sheet(tiles: &[Tile]) -> Figure {
    let rows = tiles.len().div_ceil(COLUMNS);
    let (width, height) = (2 * MARGIN + COLUMNS * TILE_WIDTH, HEAD_HEIGHT + rows * TILE_HEIGHT + MARGIN);
    let mut body = head(tiles);
    for (index, tile) in tiles.iter().enumerate() {
        let (left, top) = (MARGIN + index % COLUMNS * TILE_WIDTH, HEAD_HEIGHT + index / COLUMNS * TILE_HEIGHT);
        let _ = writeln!(body, "<g transform=\"translate({left} {top})\">\n{}</g>", drawn(tile));
    }
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{body}</svg>\n"
    );
    Figure {
        name: "real-sound".to_owned(),
        title: "Real recordings".to_owned(),
        description: "A spectrogram of each real recording with our tracks, the truth and the outcome.".to_owned(),
        svg,
    }
}

/// The key.
fn head(tiles: &[Tile]) -> String {
    let mut head = format!(
        "<text x=\"{MARGIN}\" y=\"26\" font-size=\"20\" fill=\"{INK}\">Real recordings, heard with the blades told</text>\n\
         <text x=\"{MARGIN}\" y=\"47\" font-size=\"13\" fill=\"{MUTED}\">Sound over its noise floor, 0 Hz to above the 8th harmonic of the blade \
         pass. Pink: our track and its harmonics; dashed: the first reading of an ambiguous answer. Right edge: true speeds (ticks) \
         or the accepted range (bar).</text>\n"
    );
    let mut right = 2 * MARGIN + COLUMNS * TILE_WIDTH - MARGIN;
    for verdict in Verdict::ALL.iter().rev() {
        let count = tiles.iter().filter(|tile| tile.verdict == *verdict).count();
        if count == 0 {
            continue;
        }
        let words = format!("{} {count}", verdict.name());
        right -= 34 + words.len() * 8;
        let _ = writeln!(
            head,
            "<rect x=\"{right}\" y=\"12\" width=\"16\" height=\"16\" rx=\"3\" fill=\"{}\"/>\
             <text x=\"{}\" y=\"25\" font-size=\"14\" fill=\"{INK}\">{words}</text>",
            colour(*verdict),
            right + 22
        );
    }
    head
}

fn drawn(tile: &Tile) -> String {
    let hue = colour(tile.verdict);
    let (left, top) = (PICTURE_LEFT, PICTURE_TOP);
    let right = left + WIDTH;
    let mut text = format!(
        "<text x=\"{left}\" y=\"15\" font-size=\"12.5\" fill=\"{INK}\">{}</text>\n\
         <rect x=\"{}\" y=\"3\" width=\"58\" height=\"16\" rx=\"3\" fill=\"{hue}\"/>\n\
         <text x=\"{}\" y=\"15\" font-size=\"11.5\" fill=\"#ffffff\" text-anchor=\"middle\">{}</text>\n\
         <text x=\"{left}\" y=\"31\" font-size=\"10.5\" fill=\"{MUTED}\">{}</text>\n",
        escaped(&shortened(&tile.name)),
        right - 58,
        right - 29,
        tile.verdict.name(),
        escaped(&format!("{} · {}", tile.class, tile.answer)),
    );
    let _ = writeln!(
        text,
        "<svg x=\"{left}\" y=\"{top}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {WIDTH} {HEIGHT}\">\n\
         <image width=\"{WIDTH}\" height=\"{HEIGHT}\" preserveAspectRatio=\"none\" href=\"{}\"/>\n{}</svg>",
        tile.picture,
        lines_over(tile)
    );
    text += &truth_beside(tile);
    let _ = writeln!(
        text,
        "<rect x=\"{left}\" y=\"{top}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"none\" stroke=\"{hue}\" stroke-width=\"2\"/>"
    );
    let top_khz = format!("{:.1} kHz", tile.hz_high / 1e3);
    let length = format!("{:.0} s", tile.shown.to_s - tile.shown.from_s);
    for (x, y, anchor, words) in [(left + 4, top + 11, "start", top_khz), (right - 4, top + HEIGHT - 4, "end", length)]
    {
        let _ = writeln!(
            text,
            "<text x=\"{x}\" y=\"{y}\" font-size=\"9.5\" text-anchor=\"{anchor}\" fill=\"{INK}\" stroke=\"#ffffff\" stroke-width=\"3\" \
             stroke-opacity=\"0.8\" paint-order=\"stroke\">{words}</text>"
        );
    }
    text
}

/// Our tracks, in the coordinates of the picture.
fn lines_over(tile: &Tile) -> String {
    let mut lines = String::new();
    let orders = || (1..=tile.order_count).map(|order| tile.lines_per_turn * f64::from(order));
    let x = |time_s: f64| WIDTH as f64 * (time_s - tile.shown.from_s) / (tile.shown.to_s - tile.shown.from_s);
    for stretch in tile.tracks.iter().flat_map(|track| track.chunk_by(|a, b| b.time_s - a.time_s < GAP_S)) {
        for order in orders() {
            let point =
                |point: &TrackPoint| format!("{:.1},{:.1}", x(point.time_s), y_of(tile, order * point.speed_rev_s));
            let points: Vec<String> = stretch.iter().map(point).collect();
            let _ = writeln!(
                lines,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{TRACK}\" stroke-width=\"1.1\" stroke-opacity=\"0.75\"/>",
                points.join(" ")
            );
        }
    }
    for y in tile.reading_rev_s.iter().flat_map(|speed| orders().map(move |order| y_of(tile, order * speed))) {
        let _ = writeln!(
            lines,
            "<line x1=\"0\" x2=\"{WIDTH}\" y1=\"{y:.1}\" y2=\"{y:.1}\" stroke=\"{TRACK}\" stroke-width=\"1\" \
             stroke-dasharray=\"6 5\" stroke-opacity=\"0.7\"/>"
        );
    }
    lines
}

fn y_of(tile: &Tile, hz: f64) -> f64 {
    HEIGHT as f64 * (1.0 - hz / tile.hz_high)
}

/// Ticks at the true speeds of every order; of the first two orders a bar over the accepted range.
fn truth_beside(tile: &Tile) -> String {
    let mut beside = String::new();
    let left = PICTURE_LEFT + WIDTH + 2;
    let y = |order: u32, speed_rev_s: f64| {
        PICTURE_TOP as f64 + y_of(tile, tile.lines_per_turn * f64::from(order) * speed_rev_s)
    };
    if let Some(range) = tile.accepted {
        for order in 1..=2 {
            let (top, bottom) = (y(order, range.high), y(order, range.low));
            let _ = writeln!(
                beside,
                "<rect x=\"{left}\" y=\"{:.1}\" width=\"{TICK}\" height=\"{:.1}\" fill=\"#009e73\" fill-opacity=\"0.35\"/>",
                top - 0.5,
                bottom - top + 1.0
            );
        }
    }
    for order in 1..=tile.order_count {
        for speed_rev_s in &tile.truths_rev_s {
            let y = y(order, *speed_rev_s);
            if y > PICTURE_TOP as f64 {
                let _ = writeln!(
                    beside,
                    "<line x1=\"{left}\" x2=\"{}\" y1=\"{y:.1}\" y2=\"{y:.1}\" stroke=\"{INK}\" stroke-width=\"1\"/>",
                    left + TICK
                );
            }
        }
    }
    beside
}

/// The name without its ending, with a gap where it is too long.
fn shortened(name: &str) -> String {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let count = stem.chars().count();
    if count <= NAME_LETTERS {
        return stem.to_owned();
    }
    let head = stem.chars().take(NAME_LETTERS - END_LETTERS - 1);
    head.chain(['…']).chain(stem.chars().skip(count - END_LETTERS)).collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone::speed::Span;

    #[test]
    fn tracks_and_truth_lie_at_their_frequencies() {
        let point = |time_s| TrackPoint { time_s, speed_rev_s: 50.0 };
        let tile = Tile {
            name: "a<b.wav".to_owned(),
            class: "c".to_owned(),
            verdict: Verdict::Octave,
            answer: "50 ± 1".to_owned(),
            picture: String::new(),
            shown: Span { from_s: 1.0, to_s: 3.0 },
            hz_high: 1000.0,
            lines_per_turn: 2.0,
            order_count: 8,
            tracks: vec![vec![point(1.0), point(1.1), point(2.9), point(3.0)]],
            reading_rev_s: None,
            truths_rev_s: vec![100.0],
            accepted: None,
        };
        assert_eq!(shortened("motor_m1_no_prop_30pct_000.flac"), "motor…no_prop_30pct_000");
        let lines = lines_over(&tile);
        assert_eq!(lines.matches("<polyline").count(), 16, "two stretches of eight orders");
        // 100 Hz of 1000 Hz is a tenth of the height
        assert!(lines.contains(&format!("0.0,{:.1}", 0.9 * HEIGHT as f64)), "{lines}");
        assert_eq!(
            truth_beside(&tile).matches("<line").count(),
            4,
            "200 to 800 Hz; that at 1000 Hz would lie on the edge"
        );
        let svg = sheet(&[tile]).svg;
        assert!(svg.contains("a&lt;b</text>") && svg.contains("octave 1"));
    }
}
