//! What is no rotor is not answered with a speed.
#![allow(missing_docs)]

mod testkit;

use hovertone::{Config, Outcome, ToneConfig};
use hovertone_vehicle::presets;
use testkit::not_rotors::KINDS;
use testkit::{analyse, config};

/// Every way in which a user can say which tone: blades, a gear, both, a vehicle.
fn asked() -> Vec<(String, Config)> {
    let mut asked: Vec<(String, Config)> =
        (1..=4).map(|blades| (format!("blades {blades}"), config(f64::from(blades)))).collect();
    asked.push(("gear 69".to_owned(), config(69.0)));
    let mut both = config(69.0);
    both.tone.blades = Some(2);
    asked.push(("gear 69, blades 2".to_owned(), both));
    for id in ["ardrone", "crazyflie"] {
        let Some(vehicle) = presets().iter().find(|vehicle| vehicle.id == id) else { continue };
        let order = vehicle.gear.map_or(2.0, |gear| f64::from(gear.value.wheel));
        let Some(known) = vehicle.shaft_speed else { continue };
        let mut config = config(order);
        config.tone = ToneConfig { blades: vehicle.blade_count.map(|it| it.value), ..config.tone }.within(&known.value);
        asked.push((id.to_owned(), config));
    }
    asked
}

#[test]
#[ignore]
fn shares() {
    let asked = asked();
    let seeds: u64 = std::env::var("SEEDS").ok().and_then(|s| s.parse().ok()).unwrap_or(10);
    let only = std::env::var("KIND").unwrap_or_default();
    for kind in KINDS.iter().filter(|kind| kind.name.contains(&only)) {
        let mut line = String::new();
        let mut total = 0;
        for (name, config) in &asked {
            let mut fooled = 0;
            for seed in 0..seeds {
                let analysis = analyse(kind.sound(seed, 8.0), config);
                if let Outcome::Ok(tone) = &analysis.outcome {
                    fooled += 1;
                    if std::env::var("SHOW").is_ok() {
                        let s = &tone.speeds[0];
                        eprintln!(
                            "{} seed {seed} {name}: {:.2} Hz spread {:.3} win {} lines {:?} hover {:.1} {:?}",
                            kind.name,
                            s.speed.rev_s() * config.tone.order.lines_per_turn(),
                            s.spread_rev_s.unwrap_or(0.0) / s.speed.rev_s(),
                            tone.window_s,
                            tone.ridges.iter().map(|r| (100.0 * r.line_share) as i32).collect::<Vec<_>>(),
                            analysis.hover.length_s(),
                            analysis.hover.segments.iter().map(|s| (s.from_s, s.to_s)).collect::<Vec<_>>()
                        );
                    }
                }
            }
            total += fooled;
            line += &format!(" {fooled}");
        }
        eprintln!("{:20} {total:4} of {} :{line}", kind.name, seeds as usize * asked.len());
    }
}
