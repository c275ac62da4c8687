//! Many independent trials on all cores, with the same outcome whatever their number.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The outcomes of `one` for 0 to `count`, in that order. `one` must depend on its number alone.
pub(crate) fn drawn<T: Send>(count: usize, one: impl Fn(usize) -> Result<T, String> + Sync) -> Result<Vec<T>, String> {
    let next = AtomicUsize::new(0);
    let outcomes = Mutex::new(Vec::with_capacity(count));
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= count {
                        break;
                    }
                    let outcome = one(number);
                    if let Ok(mut outcomes) = outcomes.lock() {
                        outcomes.push((number, outcome));
                    }
                }
            });
        }
    });
    let mut outcomes = outcomes.into_inner().map_err(|_| "a worker failed".to_owned())?;
    outcomes.sort_by_key(|(number, _)| *number);
    outcomes.into_iter().map(|(_, outcome)| outcome).collect()
}

#[cfg(test)]
mod tests {
    use super::drawn;

    #[test]
    fn outcomes_come_in_order_and_failures_come_through() {
        assert_eq!(drawn(100, |number| Ok(number * number)).unwrap(), (0..100).map(|n| n * n).collect::<Vec<_>>());
        assert_eq!(drawn(9, |number| if number == 7 { Err("seven".to_owned()) } else { Ok(()) }).unwrap_err(), "seven");
    }
}
