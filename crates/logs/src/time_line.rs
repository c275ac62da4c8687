//! The times of a table, row by row: first, last and mean step, without the times that damage changed.

/// The times so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct TimeLine {
    /// Number of rows.
    pub(crate) row_count: u64,
    first_s: Option<f64>,
    last_s: Option<f64>,
    lowest_s: f64,
    highest_s: f64,
    /// A time that is not yet known to lie between its neighbours.
    pending_s: Option<f64>,
    step_count: u64,
    step_sum_s: f64,
}

impl TimeLine {
    /// A row at this time. A time that is not between its neighbours, while those are in sequence, is damaged; a time before all others
    /// is a clock that was started again.
    pub(crate) fn take(&mut self, time_s: f64) {
        self.row_count += 1;
        if let Some(pending_s) = self.pending_s.replace(time_s) {
            let before_s = self.last_s.unwrap_or(f64::NEG_INFINITY);
            let is_between = before_s <= pending_s && pending_s <= time_s;
            if is_between || time_s < before_s {
                self.accept(pending_s);
            }
        }
    }

    fn accept(&mut self, time_s: f64) {
        if !time_s.is_finite() {
            return;
        }
        if self.first_s.is_none() {
            (self.first_s, self.lowest_s, self.highest_s) = (Some(time_s), time_s, time_s);
        }
        if let Some(step_s) = self.last_s.map(|last_s| time_s - last_s).filter(|step_s| *step_s >= 0.0) {
            self.step_count += 1;
            self.step_sum_s += step_s;
        }
        self.last_s = Some(time_s);
        self.lowest_s = self.lowest_s.min(time_s);
        self.highest_s = self.highest_s.max(time_s);
    }

    /// The times with the last one.
    pub(crate) fn finished(mut self) -> Self {
        if let Some(pending_s) = self.pending_s.take() {
            self.accept(pending_s);
        }
        self
    }

    /// Lowest and highest time.
    pub(crate) fn span_s(&self) -> Option<[f64; 2]> {
        self.first_s.map(|_| [self.lowest_s, self.highest_s])
    }

    /// Rows per second: 1 over the mean step. Rows with the time of the row before count too.
    pub(crate) fn rate_hz(&self) -> Option<f64> {
        (self.step_sum_s > 0.0).then(|| self.step_count as f64 / self.step_sum_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(times_s: &[f64]) -> TimeLine {
        let mut line = TimeLine::default();
        times_s.iter().for_each(|time_s| line.take(*time_s));
        line.finished()
    }

    #[test]
    fn a_damaged_time_neither_widens_the_span_nor_changes_the_rate() {
        for damaged in [[0.0, 0.1, 9e9, 0.3, 0.4], [0.0, 0.1, -9e9, 0.3, 0.4], [-9e9, 0.1, 0.2, 0.3, 0.4]] {
            let line = line(&damaged);
            assert_eq!(line.row_count, 5);
            let [from_s, to_s] = line.span_s().unwrap();
            assert!(to_s == 0.4 && (from_s >= 0.0 || damaged[0] < 0.0), "{damaged:?}");
        }
        let line = line(&[0.0, 0.1, f64::NAN, 0.3, 0.4]);
        assert_eq!(line.span_s(), Some([0.0, 0.4]));
    }

    #[test]
    fn a_clock_that_starts_again_keeps_its_rate() {
        let line = line(&[5.0, 5.1, 5.2, 0.0, 0.1, 0.2, 0.3]);
        assert!((line.rate_hz().unwrap() - 10.0).abs() < 1e-9);
        assert_eq!((line.row_count, line.span_s()), (7, Some([0.0, 5.2])));
        assert_eq!((TimeLine::default().span_s(), TimeLine::default().rate_hz()), (None, None));
        let one = self::line(&[2.0]);
        assert_eq!((one.span_s(), one.rate_hz()), (Some([2.0, 2.0]), None));
        let repeated = self::line(&[0.0, 0.0, 0.1, 0.1, 0.2, 0.2, 0.3]);
        assert!((repeated.rate_hz().unwrap() - 20.0).abs() < 1e-9);
        assert_eq!(self::line(&[1.0, 1.0, 1.0]).rate_hz(), None);
    }
}
