use super::*;

fn lopsided(gravity_m_s2: f64) -> RigidBody {
    let inertia = Matrix3::new(2.2e-3, 1e-4, -2e-4, 1e-4, 3.0e-3, 3e-4, -2e-4, 3e-4, 4.8e-3);
    RigidBody::new(0.413, inertia, gravity_m_s2).unwrap()
}

fn tumbling() -> BodyState {
    let mut state = BodyState::at_rest([0.0, 0.0, 100.0]);
    state.velocity_m_s = Vector3::new(1.0, -2.0, 3.0);
    state.rates_rad_s = Vector3::new(4.0, -7.0, 2.0);
    state
}

const NOTHING: Wrench = Wrench { force_n: Vector3::new(0.0, 0.0, 0.0), torque_n_m: Vector3::new(0.0, 0.0, 0.0) };

/// A body of three different moments and products of inertia, in ten seconds and some 13 turns, keeps the three
/// components of its angular momentum in the world, its kinetic energy, and the length of its quaternion.
#[test]
fn a_free_tumble_keeps_momentum_and_energy() {
    let (body, start) = (lopsided(0.0), tumbling());
    let (momentum, energy_j) = (body.angular_momentum(&start), body.kinetic_energy_j(&start));
    let (mut state, mut worst_momentum, mut worst_energy, mut turned) = (start, 0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..10_000 {
        state = body.step(&state, 0.001, |_| NOTHING);
        worst_momentum = worst_momentum.max((body.angular_momentum(&state) - momentum).norm() / momentum.norm());
        worst_energy = worst_energy.max((body.kinetic_energy_j(&state) / energy_j - 1.0).abs());
        turned = turned.max((state.rates_rad_s - start.rates_rad_s).norm());
        let length = state.attitude.iter().map(|part| part * part).sum::<f64>().sqrt();
        assert!((length - 1.0).abs() < 1e-15);
    }
    println!("free tumble: momentum within {worst_momentum:.1e}, energy within {worst_energy:.1e}");
    assert!(turned > 5.0, "the tumble must be one, rates changed by {turned} rad/s");
    assert!(worst_momentum < 1e-8, "{worst_momentum}");
    assert!(worst_energy < 1e-8, "{worst_energy}");
    let flown = start.position_m + 10.0 * start.velocity_m_s;
    assert!((state.position_m - flown).norm() < 1e-9);
}

#[test]
fn the_tumbles_error_goes_with_the_fourth_power_of_the_step() {
    let end = |step_s: f64| {
        let (body, mut state) = (lopsided(9.8), tumbling());
        for _ in 0..(2.0 / step_s).round() as u32 {
            state = body.step(&state, step_s, |_| NOTHING);
        }
        state
    };
    let reference = end(0.001 / 4.0);
    let error = |step_s: f64| -> f64 {
        let state = end(step_s);
        (0..4).map(|k| (state.attitude[k] - reference.attitude[k]).powi(2)).sum::<f64>().sqrt()
    };
    let order = (error(0.016) / error(0.008)).log2();
    println!("rigid body: order {order:.3}");
    assert!((order - 4.0).abs() < 0.15, "order {order}");
}

/// Without drag, height turns into speed exactly. With drag, the difference is the work of the drag, and the speed of the fall is
/// m g/k (1 - exp(-k t/m)).
#[test]
fn falling_gives_height_for_speed_and_drag_takes_its_share() {
    let body = lopsided(9.8);
    let total = |state: &BodyState| body.kinetic_energy_j(state) + body.potential_energy_j(state);
    let mut free = tumbling();
    let start_j = total(&free);
    for _ in 0..2_000 {
        free = body.step(&free, 0.001, |_| NOTHING);
    }
    assert!((total(&free) / start_j - 1.0).abs() < 1e-9);

    let drag = 0.2;
    let (mut state, mut work_j) = (BodyState::at_rest([0.0, 0.0, 100.0]), 0.0);
    let start_j = total(&state);
    for step in 1..=5_000 {
        let before = state;
        let wrench =
            |s: &BodyState| Wrench { force_n: rotation(&s.attitude).transpose() * (-drag * s.velocity_m_s), ..NOTHING };
        state = body.step(&state, 0.001, wrench);
        // Simpson over the step, with the exact middle of v = u (1 - exp(-t/T)).
        let (time_s, final_m_s, constant_s) = (0.001 * f64::from(step), body.weight_n() / drag, body.mass_kg() / drag);
        let middle = -final_m_s * -(-(time_s - 0.0005) / constant_s).exp_m1();
        let exact = -final_m_s * -(-time_s / constant_s).exp_m1();
        assert!((state.velocity_m_s.z - exact).abs() < 1e-10, "{time_s}: {} {exact}", state.velocity_m_s.z);
        let power = |speed: f64| drag * speed * speed;
        work_j += 0.001 / 6.0 * (power(before.velocity_m_s.z) + 4.0 * power(middle) + power(state.velocity_m_s.z));
    }
    assert!((total(&state) + work_j - start_j).abs() / work_j < 1e-9, "{} J missing", start_j - total(&state) - work_j);
}

#[test]
fn a_body_without_mass_or_inertia_is_refused() {
    assert!(RigidBody::new(0.0, Matrix3::identity(), 9.8).is_none());
    assert!(RigidBody::new(1.0, Matrix3::zeros(), 9.8).is_none());
}
