//! The fixed-step integrator of the flight.

/// One step of the classical fourth-order Runge-Kutta method over `step_s`; its error over a fixed time is proportional to
/// the fourth power of the step. `rate(state)` is the time derivative; inputs that depend on time are constant in the step.
pub fn rk4<const N: usize>(state: &[f64; N], step_s: f64, rate: impl Fn(&[f64; N]) -> [f64; N]) -> [f64; N] {
    let moved = |rate: &[f64; N], by_s: f64| -> [f64; N] { std::array::from_fn(|k| state[k] + by_s * rate[k]) };
    let first = rate(state);
    let second = rate(&moved(&first, 0.5 * step_s));
    let third = rate(&moved(&second, 0.5 * step_s));
    let fourth = rate(&moved(&third, step_s));
    std::array::from_fn(|k| state[k] + step_s / 6.0 * (first[k] + 2.0 * (second[k] + third[k]) + fourth[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_the_fourth_degree_in_time_is_exact() {
        // y' = 4 t³ with the time as a second variable.
        let state = rk4(&[0.0, 0.0], 2.0, |&[_, time]| [4.0 * time.powi(3), 1.0]);
        assert!((state[0] - 16.0).abs() < 1e-12 && state[1] == 2.0);
    }

    #[test]
    fn halving_the_step_takes_the_error_to_a_sixteenth() {
        let error_at = |count: u32| {
            let mut state = [1.0];
            for _ in 0..count {
                state = rk4(&state, 1.0 / f64::from(count), |&[y]| [-y]);
            }
            (state[0] - (-1.0_f64).exp()).abs()
        };
        let order = (error_at(16) / error_at(32)).log2();
        assert!((order - 4.0).abs() < 0.1, "order {order}");
    }
}
