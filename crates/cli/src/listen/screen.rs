//! The screen of `listen`: draws a view, and reads the keys.

use super::level::level_in_words;
use super::view::{STRIP_S, View};
use crate::failure::Failure;
use hovertone::live::LiveStatus;
use hovertone_workflow::{live_status_in_words, live_words};
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEventKind, KeyModifiers};
use ratatui::layout::{Alignment, Constraint, Layout, Rect};
use ratatui::style::{Color, Style, Stylize};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Axis, Chart, Dataset, GraphType, Paragraph, Wrap};
use ratatui::{DefaultTerminal, Frame};
use std::io;
use std::time::Duration;

/// Level at the left end of the bar of the level, dB.
const LEVEL_DB_MIN: f64 = -80.0;
/// Levels above this are close to clipping, dB.
const LOUD_DB: f64 = -3.0;
/// Smallest part of the speed that the strip chart shows, so that a steady speed looks steady.
const STRIP_SHARE_MIN: f64 = 0.01;
/// Most decimals in large figures.
const DECIMALS_LARGE: usize = 2;
/// Width of the names before numbers.
const NAME_WIDTH: usize = 10;

/// A screen that leaves the terminal as it was.
pub(crate) struct Screen {
    terminal: DefaultTerminal,
}

/// What a person pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Key {
    Quit,
    Freeze,
    /// The choice of this number, counted from 0.
    Choose(usize),
}

impl Screen {
    pub(crate) fn open() -> Result<Self, Failure> {
        Ok(Self { terminal: ratatui::try_init().map_err(|error| no_screen(&error))? })
    }

    pub(crate) fn draw(&mut self, view: &View) -> Result<(), Failure> {
        self.terminal.draw(|frame| draw(frame, view)).map(|_| ()).map_err(|error| no_screen(&error))
    }

    /// Waits for a key, at most so long.
    pub(crate) fn key(&self, wait: Duration) -> Result<Option<Key>, Failure> {
        if !event::poll(wait).map_err(|error| no_screen(&error))? {
            return Ok(None);
        }
        let Event::Key(pressed) = event::read().map_err(|error| no_screen(&error))? else { return Ok(None) };
        if pressed.kind == KeyEventKind::Release {
            return Ok(None);
        }
        Ok(match pressed.code {
            KeyCode::Char('c') if pressed.modifiers.contains(KeyModifiers::CONTROL) => Some(Key::Quit),
            KeyCode::Char('q') | KeyCode::Esc => Some(Key::Quit),
            KeyCode::Char('f') => Some(Key::Freeze),
            KeyCode::Char(digit @ '1'..='9') => Some(Key::Choose(digit as usize - '1' as usize)),
            _ => None,
        })
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        ratatui::restore();
    }
}

fn no_screen(error: &io::Error) -> Failure {
    Failure::usage(format!("the screen cannot be drawn here: {error}"), "use --plain or --json")
}

/// Draws the whole screen.
fn draw(frame: &mut Frame<'_>, view: &View) {
    let has_rotors = !view.rotors_rev_s.is_empty();
    let heights = [
        Constraint::Length(2),
        Constraint::Length(5),
        Constraint::Length(2),
        Constraint::Length(if has_rotors { view.rotors_rev_s.len() as u16 + 1 } else { 0 }),
        Constraint::Length(if view.choices.is_empty() { 0 } else { view.choices.len().min(9) as u16 + 2 }),
        Constraint::Min(4),
        Constraint::Length(1),
    ];
    let [title, speed, level, rotors, choices, strip, keys] = Layout::vertical(heights).areas(frame.area());
    draw_title(frame, title, view);
    draw_speed(frame, speed, view);
    draw_level(frame, level, view);
    draw_rotors(frame, rotors, view);
    draw_choices(frame, choices, view);
    draw_strip(frame, strip, view);
    let choose = if view.choices.is_empty() { "" } else { "   1–9 choose" };
    frame.render_widget(Line::from(format!(" q quit   f {}{choose}", freeze_word(view))).dark_gray(), keys);
}

fn freeze_word(view: &View) -> &'static str {
    if view.is_frozen { "go on" } else { "freeze" }
}

fn draw_title(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let heard_s = view.now.map_or(0.0, |now| now.time_s);
    let clock = format!("{}:{:04.1} ", (heard_s / 60.0) as u64, heard_s % 60.0);
    let frozen = if view.is_frozen { "  FROZEN" } else { "" };
    let [name, time] = Layout::horizontal([Constraint::Min(10), Constraint::Length(clock.len() as u16)]).areas(area);
    let title = Line::from(vec![" hovertone ".bold(), view.source.as_str().into(), frozen.yellow().bold()]);
    frame.render_widget(title, name);
    frame.render_widget(Line::from(clock).alignment(Alignment::Right), time);
}

/// The speed in large figures, and its uncertainty and other units beside; or why there is none, or not one.
fn draw_speed(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let Some(now) = view.now else {
        frame.render_widget(Paragraph::new(" the first answer comes after two seconds of sound"), area);
        return;
    };
    let status = live_status_in_words(now.status, &view.remark);
    let one_speed = live_words(&now).filter(|_| now.status == LiveStatus::Ok);
    let Some((speed_rev_s, words)) = now.speed_rev_s.zip(one_speed) else {
        let text = Paragraph::new(format!(" {status}")).wrap(Wrap { trim: false });
        frame.render_widget(text.yellow(), area);
        return;
    };
    let decimals = words.speed_rev_s.split_once('.').map_or(0, |(_, decimals)| decimals.len().min(DECIMALS_LARGE));
    let figures = large_figures(&format!("{speed_rev_s:.decimals$}"));
    let width = figures[0].chars().count() as u16 + 3;
    let [large, beside] = Layout::horizontal([Constraint::Length(width), Constraint::Min(20)]).areas(area);
    let rows: Vec<Line<'_>> = figures.into_iter().map(|row| Line::from(format!(" {row}"))).collect();
    frame.render_widget(Paragraph::new(rows).style(Style::new().fg(Color::Green)), large);
    let lines = vec![
        Line::from("rev/s"),
        Line::from(format!("± {} (k = 2)", words.plus_minus_rev_s)),
        Line::from(format!("{} rpm", words.speed_rpm)),
        Line::from(format!("{} rad/s", words.speed_rad_s)),
        Line::from(status).yellow(),
    ];
    frame.render_widget(Paragraph::new(lines), beside);
}

fn draw_level(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let Some(now) = view.now else { return };
    let after = format!(" {}  ", level_in_words(now.level_db, 0));
    let clipping = if now.clipped_share > 0.0 { "too loud (clipped): move the microphone away" } else { "" };
    let width = usize::from(area.width).saturating_sub(NAME_WIDTH + after.chars().count() + clipping.len() + 2);
    let share = ((now.level_db - LEVEL_DB_MIN) / -LEVEL_DB_MIN).clamp(0.0, 1.0);
    let colour = if now.level_db > LOUD_DB || now.clipped_share > 0.0 { Color::Red } else { Color::Green };
    let line =
        vec![name("level"), Span::styled(bar(share, width), Style::new().fg(colour)), after.into(), clipping.red()];
    frame.render_widget(Line::from(line), area);
}

fn draw_rotors(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let fastest = view.rotors_rev_s.iter().copied().fold(f64::MIN, f64::max);
    let slowest = view.rotors_rev_s.iter().copied().fold(f64::MAX, f64::min);
    let width = usize::from(area.width).saturating_sub(NAME_WIDTH + 24);
    // the slowest has a quarter of the bar of the fastest, so that differences show
    let share =
        |speed: f64| if fastest > slowest { 0.25 + 0.75 * (speed - slowest) / (fastest - slowest) } else { 1.0 };
    let line = |(index, &speed_rev_s): (usize, &f64)| {
        let number = format!("rotor {}", index + 1);
        let words = format!("{} {speed_rev_s:.2} rev/s", bar(share(speed_rev_s), width));
        Line::from(vec![name(&number), words.cyan()])
    };
    let lines: Vec<Line<'_>> = view.rotors_rev_s.iter().enumerate().map(line).collect();
    frame.render_widget(Paragraph::new(lines), area);
}

fn draw_choices(frame: &mut Frame<'_>, area: Rect, view: &View) {
    if view.choices.is_empty() {
        return;
    }
    let first = Line::from(format!(
        " Which speed is right? Press its number. Or quit, start again, and {}.",
        view.advice.which_is_right()
    ));
    let line = |(index, choice): (usize, &String)| Line::from(format!("   {}  {choice}", index + 1));
    let lines = std::iter::once(first).chain(view.choices.iter().take(9).enumerate().map(line));
    frame.render_widget(Paragraph::new(lines.collect::<Vec<_>>()).yellow(), area);
}

/// The speed in the last minute.
fn draw_strip(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let points: Vec<(f64, f64)> = view.strip.iter().copied().collect();
    let Some(&(newest_s, _)) = points.last() else { return };
    let lowest = points.iter().map(|point| point.1).fold(f64::MAX, f64::min);
    let highest = points.iter().map(|point| point.1).fold(f64::MIN, f64::max);
    let (middle, half) = ((lowest + highest) / 2.0, (highest - lowest) / 2.0);
    let half = (1.1 * half).max(STRIP_SHARE_MIN * middle / 2.0);
    let time = Axis::default().bounds([newest_s - STRIP_S, newest_s]).labels(["−60 s", "−30 s", "now"]);
    let label = |at: f64| format!("{at:.1}");
    let speeds = Axis::default().bounds([middle - half, middle + half]).labels([
        label(middle - half),
        label(middle),
        label(middle + half),
    ]);
    let series = Dataset::default()
        .marker(Marker::Braille)
        .graph_type(GraphType::Scatter)
        .style(Style::new().fg(Color::Green))
        .data(&points);
    let chart = Chart::new(vec![series])
        .x_axis(time.style(Style::new().fg(Color::DarkGray)))
        .y_axis(speeds.title("rev/s").style(Style::new().fg(Color::DarkGray)));
    frame.render_widget(chart, area);
}

/// A name before numbers.
fn name(words: &str) -> Span<'static> {
    Span::from(format!(" {words:<width$}", width = NAME_WIDTH - 1))
}

/// A bar of a width in columns, filled by a share, in eighths of a column.
fn bar(share: f64, width: usize) -> String {
    const PARTS: [&str; 8] = ["", "▏", "▎", "▍", "▌", "▋", "▊", "▉"];
    let eighths = (share * (8 * width) as f64).round() as usize;
    let filled = format!("{}{}", "█".repeat(eighths / 8), PARTS[eighths % 8]);
    let empty = width.saturating_sub(filled.chars().count());
    filled + &" ".repeat(empty)
}

/// Figures of three rows of half blocks: 3 by 5 points.
fn large_figures(text: &str) -> [String; 3] {
    const POINTS: [(char, [u8; 5]); 11] = [
        ('0', [0b111, 0b101, 0b101, 0b101, 0b111]),
        ('1', [0b010, 0b110, 0b010, 0b010, 0b111]),
        ('2', [0b111, 0b001, 0b111, 0b100, 0b111]),
        ('3', [0b111, 0b001, 0b011, 0b001, 0b111]),
        ('4', [0b101, 0b101, 0b111, 0b001, 0b001]),
        ('5', [0b111, 0b100, 0b111, 0b001, 0b111]),
        ('6', [0b111, 0b100, 0b111, 0b101, 0b111]),
        ('7', [0b111, 0b001, 0b010, 0b010, 0b010]),
        ('8', [0b111, 0b101, 0b111, 0b101, 0b111]),
        ('9', [0b111, 0b101, 0b111, 0b001, 0b111]),
        ('.', [0b000, 0b000, 0b000, 0b000, 0b010]),
    ];
    let mut rows = [const { String::new() }; 3];
    for figure in text.chars() {
        let points = POINTS.iter().find(|(name, _)| *name == figure).map_or([0; 5], |(_, points)| *points);
        for (row, into) in rows.iter_mut().enumerate() {
            let (upper, lower) = (points[2 * row], points.get(2 * row + 1).copied().unwrap_or(0));
            for column in (0..3).rev() {
                let (up, down) = (upper >> column & 1 == 1, lower >> column & 1 == 1);
                // twice as wide as high points, as terminals' columns are half as wide as rows
                let block = match (up, down) {
                    (true, true) => '█',
                    (true, false) => '▀',
                    (false, true) => '▄',
                    (false, false) => ' ',
                };
                into.push(block);
                into.push(block);
            }
            into.push_str("  ");
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::listen::advice::Advice;
    use hovertone::live::LiveSpeed;
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;

    fn text_of(view: &View, width: u16, height: u16) -> String {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| draw(frame, view)).unwrap();
        let buffer = terminal.backend().buffer();
        let row = |y: u16| (0..width).map(|x| buffer[(x, y)].symbol().to_owned()).collect::<String>();
        (0..height).map(row).collect::<Vec<_>>().join("\n")
    }

    fn view_of(speed_rev_s: Option<f64>) -> View {
        let mut view = View::new("hover.wav".to_owned(), Advice::default());
        for n in 0..300 {
            view.take(LiveSpeed {
                time_s: 0.1 * f64::from(n),
                status: if speed_rev_s.is_some() { LiveStatus::Ok } else { LiveStatus::NoRotorTone },
                speed_rev_s: speed_rev_s.map(|speed| speed + 0.02 * f64::from(n % 7)),
                std_uncertainty_rev_s: speed_rev_s.map(|_| 0.07),
                level_db: -18.0,
                clipped_share: 0.0,
            });
        }
        view
    }

    #[test]
    fn a_speed_fits_on_small_and_large_screens() {
        let mut view = view_of(Some(318.6));
        view.rotors_rev_s = vec![325.36, 320.29, 318.47, 314.74];
        for (width, height) in [(80, 24), (200, 60), (40, 12), (20, 5), (1, 1)] {
            let text = text_of(&view, width, height);
            if width >= 80 {
                for words in [
                    "hover.wav",
                    "0:29.9",
                    "± 0.14 (k = 2)",
                    "rpm",
                    "−18 dB",
                    "rotor 4",
                    "314.74 rev/s",
                    "now",
                    "q quit",
                ] {
                    assert!(text.contains(words), "{words} at {width}:\n{text}");
                }
            }
        }
    }

    #[test]
    fn no_rotor_and_choices_are_said() {
        let mut view = view_of(None);
        view.remark = "no series of lines that a rotor can make stands out of the noise".to_owned();
        assert!(text_of(&view, 80, 24).contains("no rotor tone: no series of lines"));
        let mut view = view_of(Some(120.0));
        view.take(LiveSpeed { status: LiveStatus::Ambiguous, ..view.now.unwrap() });
        view.choices = vec!["120.0 rev/s, 2 blades".to_owned(), "60.0 rev/s, 4 blades".to_owned()];
        let text = text_of(&view, 80, 24);
        assert!(text.contains("2  60.0 rev/s, 4 blades") && text.contains("1–9 choose"), "{text}");
        // a ± is that of one speed
        assert!(text.contains("several speeds are possible") && !text.contains('±'), "{text}");
    }

    #[test]
    fn figures_are_drawn_by_half_blocks() {
        let rows = large_figures("1.");
        assert_eq!(rows, ["▄▄██            ", "  ██            ", "▀▀▀▀▀▀    ▀▀    "]);
    }
}
