//! Random flights with known phases: how much of the hover is used, and how much of what is used is hover.
use crate::testkit::not_rotors::Dice;
use crate::testkit::{analyse, config, rotor, sound};
use hovertone::speed::{CutReason, Outcome};

/// Silence, run-up, hover with doublets in between, run-down, silence.
struct Flight {
    hover_rev_s: f64,
    wander: (f64, f64),
    run_up_s: (f64, f64),
    run_down_s: (f64, f64),
    /// Start, length and share of each manoeuvre: so much faster for its first half, so much slower for its second.
    doublets: Vec<(f64, f64, f64)>,
    length_s: f64,
}

impl Flight {
    fn random(seed: u64) -> Self {
        let mut dice = Dice::new(seed);
        let from_s = dice.between(1.0, 2.5);
        let run_up_s = (from_s, from_s + dice.between(1.0, 2.5));
        let mut doublets = Vec::new();
        let mut time_s = run_up_s.1 + dice.between(3.5, 6.0);
        for _ in 0..dice.pick(&[0, 1, 2]) {
            let lasts_s = dice.between(1.6, 3.0);
            doublets.push((time_s, lasts_s, dice.between(0.04, 0.2)));
            time_s += lasts_s + dice.between(3.5, 6.0);
        }
        let run_down_s = (time_s, time_s + dice.between(1.0, 2.5));
        let length_s = run_down_s.1 + dice.between(1.0, 2.5);
        let wander = (dice.between(0.001, 0.005), dice.between(1.0, 5.0));
        Self { hover_rev_s: dice.between(50.0, 220.0), wander, run_up_s, run_down_s, doublets, length_s }
    }

    fn is_hover(&self, time_s: f64) -> bool {
        let is_flown = self.doublets.iter().any(|(from_s, lasts_s, _)| (*from_s..from_s + lasts_s).contains(&time_s));
        (self.run_up_s.1..self.run_down_s.0).contains(&time_s) && !is_flown
    }

    fn speed_rev_s(&self, time_s: f64) -> f64 {
        let ramp = |(from_s, to_s): (f64, f64)| ((time_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0);
        let flown: f64 = self
            .doublets
            .iter()
            .filter(|(from_s, lasts_s, _)| (*from_s..from_s + lasts_s).contains(&time_s))
            .map(|(from_s, lasts_s, share)| if time_s < from_s + lasts_s / 2.0 { *share } else { -share })
            .sum();
        let wander = self.wander.0 * 1.4 * (self.wander.1 * time_s).sin();
        self.hover_rev_s * ramp(self.run_up_s) * (1.0 - ramp(self.run_down_s)) * (1.0 + flown + wander)
    }

    fn sound(&self, seed: u64) -> Vec<f32> {
        let speed = |time_s: f64| self.speed_rev_s(time_s);
        let lines = [(1.0, 0.01), (2.0, 0.1), (4.0, 0.06), (6.0, 0.04), (8.0, 0.02)];
        let rotor = rotor(speed, &lines).with_level(|time_s| (speed(time_s) / self.hover_rev_s).powi(2));
        sound(&[rotor], self.length_s, 0.003, seed + 1)
    }
}

#[test]
fn the_hover_of_random_flights_is_found_and_named() {
    let (mut precisions, mut recalls, mut errors) = (Vec::new(), Vec::new(), Vec::new());
    let (mut take_offs, mut landings, mut manoeuvres, mut doublets, mut unheard) = (0, 0, 0, 0, 0);
    let flights = 24u64;
    for seed in 0..flights {
        let flight = Flight::random(seed);
        let analysis = analyse(flight.sound(seed), &config(2.0));
        let Outcome::Ok(tone) = &analysis.outcome else {
            println!("seed {seed}: {:?}", analysis.outcome);
            unheard += 1;
            continue;
        };
        let hover = &analysis.hover;
        let (mut both, mut used, mut truth, mut sum) = (0.0, 0.0, 0.0, 0.0);
        for step in 0..(100.0 * flight.length_s) as u32 {
            let time_s = f64::from(step) / 100.0;
            let is_used = hover.segments.iter().any(|segment| segment.contains(time_s));
            let is_hover = flight.is_hover(time_s);
            used += f64::from(u8::from(is_used));
            truth += f64::from(u8::from(is_hover));
            both += f64::from(u8::from(is_used && is_hover));
            sum += if is_hover { flight.speed_rev_s(time_s) } else { 0.0 };
        }
        precisions.push(both / used);
        recalls.push(both / truth);
        errors.push((tone.speeds[0].speed.rev_s() / (sum / truth) - 1.0).abs());
        let says = |at_s: f64, reason: CutReason| {
            hover.cuts.iter().any(|cut| cut.reason == reason && cut.span.from_s <= at_s && at_s <= cut.span.to_s)
        };
        let names = |span: (f64, f64), reason: CutReason| {
            hover.cuts.iter().any(|cut| cut.reason == reason && cut.span.from_s <= span.1 && span.0 <= cut.span.to_s)
        };
        take_offs += usize::from(names(flight.run_up_s, CutReason::TakeOff));
        landings += usize::from(names(flight.run_down_s, CutReason::Landing));
        doublets += flight.doublets.len();
        manoeuvres += flight
            .doublets
            .iter()
            .filter(|(from_s, lasts_s, _)| says(from_s + lasts_s / 2.0, CutReason::Manoeuvre))
            .count();
    }
    let sorted = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values
    };
    let (precisions, recalls, errors) = (sorted(precisions), sorted(recalls), sorted(errors));
    let at = |values: &[f64], share: f64| values[((values.len() - 1) as f64 * share) as usize];
    println!(
        "precision {:.3} (worst {:.3}), recall {:.3} (worst {:.3}), speed off by {:.5} (worst {:.5}), unheard {unheard}; take-offs \
         {take_offs}, landings {landings} of {flights}, manoeuvres {manoeuvres} of {doublets}",
        at(&precisions, 0.5),
        at(&precisions, 0.0),
        at(&recalls, 0.5),
        at(&recalls, 0.0),
        at(&errors, 0.5),
        at(&errors, 1.0)
    );
    assert!(at(&precisions, 0.5) > 0.97 && at(&precisions, 0.0) > 0.9, "{precisions:?}");
    assert!(at(&recalls, 0.5) > 0.75 && at(&recalls, 0.0) > 0.3, "{recalls:?}");
    assert!(at(&errors, 0.5) < 0.001 && at(&errors, 1.0) < 0.01, "{errors:?}");
    assert_eq!(unheard, 0);
    let most = |count: usize, of: usize| 10 * count >= 7 * of;
    assert!(doublets > 10 && most(manoeuvres, doublets), "{manoeuvres} of {doublets}");
    assert!(most(take_offs, flights as usize) && most(landings, flights as usize), "{take_offs}, {landings}");
}
