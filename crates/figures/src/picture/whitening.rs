//! A spectrogram with its noise floor flattened, so that weak lines are seen beside loud noise.

use super::Picture;

/// The floor of a cell is the median over this share of the rows around it.
const FLOOR_SHARE: f64 = 0.2;

/// Each level minus the floor around it in its column.
pub fn whitened(picture: &Picture) -> Picture {
    let rows = picture.row_count;
    let reach = ((rows as f64 * FLOOR_SHARE / 2.0) as usize).max(1);
    let mut level_db = Vec::with_capacity(picture.level_db.len());
    for column in 0..picture.column_count {
        let levels = picture.column(column);
        level_db.extend((0..rows).map(|row| {
            let around = &levels[row.saturating_sub(reach)..(row + reach + 1).min(rows)];
            levels[row] - median(around)
        }));
    }
    Picture { level_db, ..picture.clone() }
}

fn median(values: &[f32]) -> f32 {
    let mut values = values.to_vec();
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f32::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::whitened;
    use crate::picture::{Picture, PictureView};
    use hovertone_analysis::Span;

    #[test]
    fn a_slope_is_flat_and_a_line_stays() {
        let rows = 100;
        let mut level_db: Vec<f32> = (0..rows).map(|row| -(row as f32)).collect();
        level_db[50] += 20.0;
        let picture = Picture {
            view: PictureView { harmonic: None, hz_low: 0.0, hz_high: 1000.0, window_s: 0.1 },
            span: Span { from_s: 0.0, to_s: 1.0 },
            hz_low: 0.0,
            hz_high: 1000.0,
            column_count: 1,
            row_count: rows,
            level_db,
        };
        let white = whitened(&picture);
        assert!((white.level_db[50] - 20.0).abs() <= 1.0);
        assert!(white.level_db[20..45].iter().all(|level| level.abs() <= 1.0));
    }
}
