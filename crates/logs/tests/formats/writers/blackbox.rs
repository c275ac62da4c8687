//! A blackbox log of Betaflight.

pub(crate) const FIRST_LINE: &str = "H Product:Blackbox flight data recorder by Nicholas Sherlock\n";
/// Name and sign of a value, and predictor and encoding in whole frames and in differences.
type Field = (&'static str, u32, [u32; 4]);

/// Values of a main frame: name, sign, and predictor and encoding in whole frames and in differences.
const FIELDS: [Field; 20] = [
    ("loopIteration", 0, [0, 1, 6, 9]),
    ("time", 0, [0, 1, 2, 0]),
    ("axisP[0]", 1, [0, 0, 1, 7]),
    ("axisP[1]", 1, [0, 0, 1, 7]),
    ("axisP[2]", 1, [0, 0, 1, 7]),
    ("rcCommand[0]", 1, [0, 0, 1, 8]),
    ("rcCommand[1]", 1, [0, 0, 1, 8]),
    ("rcCommand[2]", 1, [0, 0, 1, 8]),
    ("rcCommand[3]", 0, [4, 1, 1, 8]),
    ("vbatLatest", 0, [9, 3, 1, 6]),
    ("amperageLatest", 1, [0, 0, 1, 6]),
    ("gyroADC[0]", 1, [0, 0, 3, 0]),
    ("gyroADC[1]", 1, [0, 0, 3, 0]),
    ("gyroADC[2]", 1, [0, 0, 3, 0]),
    ("motor[0]", 0, [11, 1, 3, 0]),
    ("motor[1]", 0, [5, 0, 3, 0]),
    ("motor[2]", 0, [5, 0, 3, 0]),
    ("motor[3]", 0, [5, 0, 3, 0]),
    ("eRPM[0]", 0, [0, 1, 1, 0]),
    ("eRPM[1]", 0, [0, 1, 1, 0]),
];
const COUNT: usize = FIELDS.len();
const MIN_THROTTLE: i64 = 1070;
const BATTERY_REFERENCE: i64 = 1600;
const MIN_MOTOR: i64 = 158;
/// Every 32nd loop is written as a whole; of the others every second is written.
const WHOLE: u32 = 32;
const DENOMINATOR: u32 = 2;
pub(crate) const LOOP_US: u32 = 250;

fn header() -> String {
    let line = |name: &str, value: &dyn Fn(&Field) -> String| {
        format!("H Field {name}:{}\n", FIELDS.iter().map(value).collect::<Vec<_>>().join(","))
    };
    [
        FIRST_LINE.to_owned(),
        "H Data version:2\nH I interval:32\nH P interval:1/2\nH Firmware type:Cleanflight\n".to_owned(),
        "H Firmware revision:Betaflight 2025.12.1 (abc) STM32F7X2\n".to_owned(),
        line("I name", &|field| field.0.to_owned()),
        line("I signed", &|field| field.1.to_string()),
        line("I predictor", &|field| field.2[0].to_string()),
        line("I encoding", &|field| field.2[1].to_string()),
        line("P predictor", &|field| field.2[2].to_string()),
        line("P encoding", &|field| field.2[3].to_string()),
        "H Field S name:flightModeFlags,stateFlags,failsafePhase,rxSignalReceived,rxFlightChannelsValid\nH Field S signed:0,0,0,0,0\n".to_owned(),
        "H Field S predictor:0,0,0,0,0\nH Field S encoding:1,1,7,7,7\n".to_owned(),
        "H minthrottle:1070\nH vbatref:1600\nH motorOutput:158,2047\nH motor_poles:12\nH gyro_scale:0x3f800000\n"
            .to_owned(),
    ]
    .concat()
}

fn unsigned(into: &mut Vec<u8>, value: i64) {
    let mut value = value as u32;
    while value >= 0x80 {
        into.push(value as u8 | 0x80);
        value >>= 7;
    }
    into.push(value as u8);
}

fn signed(into: &mut Vec<u8>, value: i64) {
    let value = value as i32;
    unsigned(into, i64::from(((value << 1) ^ (value >> 31)).cast_unsigned()));
}

/// Three values in the shortest way.
fn three(into: &mut Vec<u8>, values: &[i64]) {
    let fits = |bits: u32| values.iter().all(|value| (-(1 << (bits - 1))..1 << (bits - 1)).contains(value));
    let [a, b, c] = [values[0], values[1], values[2]].map(|value| value as u8);
    if fits(2) {
        into.push((a & 3) << 4 | (b & 3) << 2 | c & 3);
    } else if fits(4) {
        into.extend([0x40 | a & 0xf, b << 4 | c & 0xf]);
    } else if fits(6) {
        into.extend([0x80 | a & 0x3f, b & 0x3f, c & 0x3f]);
    } else {
        into.push(0xc0 | 0b01_01_01);
        values.iter().for_each(|value| into.extend((*value as i16).to_le_bytes()));
    }
}

/// Four values in the shortest way, each of 0, 4, 8 or 16 bits.
fn four(into: &mut Vec<u8>, values: &[i64]) {
    let halves = |value: i64| match value {
        0 => 0,
        -8..=7 => 1,
        -128..=127 => 2,
        _ => 4,
    };
    let tag = |count: usize| [0, 1, 2, 0, 3][count];
    into.push(values.iter().rev().fold(0, |tags, value| tags << 2 | tag(halves(*value))));
    let mut all: Vec<u8> = Vec::new();
    for &value in values {
        (0..halves(value)).rev().for_each(|half| all.push((value >> (4 * half)) as u8 & 0xf));
    }
    all.chunks(2).for_each(|pair| into.push(pair[0] << 4 | pair.get(1).copied().unwrap_or(0)));
}

fn write(into: &mut Vec<u8>, encodings: impl Fn(usize) -> u32, values: &[i64; COUNT]) {
    let mut at = 0;
    while at < COUNT {
        let encoding = encodings(at);
        let same = (at..COUNT).take_while(|next| encodings(*next) == encoding).count();
        at += match encoding {
            0 => {
                signed(into, values[at]);
                1
            }
            1 => {
                unsigned(into, values[at]);
                1
            }
            3 => {
                unsigned(into, -values[at] & 0x3fff);
                1
            }
            6 => {
                let group = &values[at..at + same];
                into.push(group.iter().rev().fold(0, |bits, value| bits << 1 | u8::from(*value != 0)));
                group.iter().filter(|value| **value != 0).for_each(|value| signed(into, *value));
                same
            }
            7 => {
                three(into, &values[at..at + 3]);
                3
            }
            8 => {
                four(into, &values[at..at + 4]);
                4
            }
            _ => 1,
        };
    }
}

/// The true values of a loop.
pub(crate) fn truth(iteration: u32) -> [i64; COUNT] {
    let t = f64::from(iteration) * 1e-6 * f64::from(LOOP_US);
    let wave = |size: f64, rad_s: f64| (size * (rad_s * t).sin()).round() as i64;
    let loops = i64::from(iteration);
    let motor = |offset: f64| 800 + (offset + 200.0 * (9.0 * t).sin()) as i64;
    [
        loops,
        i64::from(LOOP_US) * loops + 7 + loops % 3,
        wave(3000.0, 40.0),
        wave(50.0, 30.0),
        wave(2.0, 20.0),
        wave(400.0, 3.0),
        wave(400.0, 4.0),
        0,
        1500 + wave(300.0, 2.0),
        1580 - loops / 4000,
        900 + wave(90.0, 7.0),
        wave(300.0, 60.0),
        wave(200.0, 50.0),
        -20,
        motor(0.0),
        motor(13.0),
        motor(-40.0),
        motor(7.0),
        1000 + wave(150.0, 9.0),
        1100 + wave(150.0, 8.0),
    ]
}

/// Whether a loop is written, and whether as a whole.
pub(crate) fn is_written(iteration: u32) -> Option<bool> {
    match iteration % WHOLE {
        0 => Some(true),
        index => (index % DENOMINATOR == 0).then_some(false),
    }
}

/// A log of these loops, from the first line to the event at its end.
pub(crate) fn flight(loops: u32) -> Vec<u8> {
    let mut bytes = header().into_bytes();
    let mut last: [[i64; COUNT]; 2] = [[0; COUNT]; 2];
    for iteration in 0..loops {
        let Some(is_whole) = is_written(iteration) else { continue };
        let now = truth(iteration);
        let mut values = [0; COUNT];
        for (at, (_, _, codes)) in FIELDS.iter().enumerate() {
            let predictor = codes[if is_whole { 0 } else { 2 }];
            values[at] = now[at]
                - match predictor {
                    1 => last[0][at],
                    2 => 2 * last[0][at] - last[1][at],
                    3 => (last[0][at] + last[1][at]) / 2,
                    4 => MIN_THROTTLE,
                    5 => now[14],
                    6 => now[at],
                    9 => BATTERY_REFERENCE,
                    11 => MIN_MOTOR,
                    _ => 0,
                };
        }
        bytes.push(if is_whole { b'I' } else { b'P' });
        write(&mut bytes, |at| FIELDS[at].2[if is_whole { 1 } else { 3 }], &values);
        if iteration % (40 * WHOLE) == 0 {
            // flags, three small values; then a change of the mode
            bytes.extend([b'S', 5, 0, 0x00, b'E', 30, 3, 1]);
        }
        last = if is_whole { [now, now] } else { [now, last[0]] };
    }
    bytes.extend(b"E\xffEnd of log\0");
    bytes
}
