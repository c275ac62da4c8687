//! No block allocates memory, once the sound is followed.

use hovertone_live::{Listener, LiveConfig, LiveStatus};
use hovertone_rotor_speed::{Config, ToneConfig};
use hovertone_sim::prescribed::{Line, Noise, Recording, Rotor, Sampling, seeded};
use hovertone_vehicle::Order;
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

#[test]
fn a_block_allocates_nothing() {
    let lines = [2.0, 4.0, 6.0].map(|order| Line::new(order, 0.2 / order)).to_vec();
    // a step, so that the grid moves
    let rotor = Rotor::new(|time_s| if time_s < 3.0 { 100.0 } else { 118.0 }, lines);
    let mut recording = Recording::of_rotors(&[rotor], Sampling::new(48_000.0, 6.0));
    recording.add_noise(&Noise::white(0.02), &mut seeded(1));
    let samples = recording.samples_f32();
    let config = Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap()));
    let mut listener = Listener::new(48_000.0, LiveConfig::of_analysis(config, None)).unwrap();
    let (before, after) = samples.split_at(2 * 48_000 + 4800);
    // blocks that end where a live speed is due
    for block in before.chunks(480) {
        assert!(listener.push(block, &mut |_| {}).is_empty());
        if listener.wants_review() {
            listener.review().unwrap();
        }
    }
    let mut last = None;
    let used = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    for block in after.chunks(480) {
        listener.push(block, &mut |speed| last = Some(speed));
    }
    assert_eq!(MEMORY.peak_usage(), used);
    assert_eq!(MEMORY.current_usage(), used);
    let last = last.unwrap();
    assert!(last.status == LiveStatus::Ok && (last.speed_rev_s.unwrap() - 118.0).abs() < 0.5, "{last:?}");
}
