//! A DataFlash log of ArduPilot.

/// Time of the messages about the log.
const TIME_US: u64 = 900_000;

/// Type of a message, its name, the types and labels of its values, the letters of their units and factors.
pub(crate) struct Kind {
    pub(crate) number: u8,
    pub(crate) name: &'static str,
    pub(crate) types: &'static str,
    pub(crate) labels: &'static str,
    pub(crate) units: &'static str,
    pub(crate) factors: &'static str,
}

pub(crate) const ESC: Kind = Kind {
    number: 10,
    name: "ESC",
    types: "QBffhc",
    labels: "TimeUS,Instance,RPM,Volt,Temp,Curr",
    units: "s#qvOA",
    factors: "F-00BB",
};
pub(crate) const RCOU: Kind = Kind {
    number: 11,
    name: "RCOU",
    types: "QHHHHHH",
    labels: "TimeUS,C1,C2,C3,C4,C5,C6",
    units: "sYYYYYY",
    factors: "F------",
};
pub(crate) const IMU: Kind = Kind {
    number: 12,
    name: "IMU",
    types: "QBffffff",
    labels: "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ",
    units: "s#EEEooo",
    factors: "F-000000",
};
pub(crate) const RCIN: Kind =
    Kind { number: 13, name: "RCIN", types: "QHHHH", labels: "TimeUS,C1,C2,C3,C4", units: "sYYYY", factors: "F----" };
pub(crate) const ATT: Kind = Kind {
    number: 14,
    name: "ATT",
    types: "Qffff",
    labels: "TimeUS,DesRoll,Roll,DesPitch,Pitch",
    units: "sdddd",
    factors: "F0000",
};
pub(crate) const XKF1: Kind =
    Kind { number: 15, name: "XKF1", types: "QBfff", labels: "TimeUS,C,VN,VE,VD", units: "s#nnn", factors: "F-000" };
pub(crate) const MODE: Kind =
    Kind { number: 16, name: "MODE", types: "QBB", labels: "TimeUS,ModeNum,Rsn", units: "s--", factors: "F--" };
const FMT: Kind = Kind {
    number: 128,
    name: "FMT",
    types: "BBnNZ",
    labels: "Type,Length,Name,Format,Columns",
    units: "",
    factors: "",
};
const UNIT: Kind = Kind { number: 1, name: "UNIT", types: "QbZ", labels: "TimeUS,Id,Label", units: "", factors: "" };
const MULT: Kind = Kind { number: 2, name: "MULT", types: "Qbd", labels: "TimeUS,Id,Mult", units: "", factors: "" };
const FMTU: Kind =
    Kind { number: 3, name: "FMTU", types: "QBNN", labels: "TimeUS,FmtType,UnitIds,MultIds", units: "", factors: "" };
const PARM: Kind = Kind { number: 4, name: "PARM", types: "QNf", labels: "TimeUS,Name,Value", units: "", factors: "" };

pub(crate) fn text(text: &str, length: usize) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize(length, 0);
    bytes
}

fn size(kind: &Kind) -> u8 {
    let size = |letter: u8| match letter {
        b'b' | b'B' => 1,
        b'h' | b'H' | b'c' => 2,
        b'f' | b'n' => 4,
        b'Q' | b'd' => 8,
        b'N' => 16,
        _ => 64,
    };
    3 + kind.types.bytes().map(size).sum::<u8>()
}

#[derive(Default)]
pub(crate) struct Writer {
    pub(crate) bytes: Vec<u8>,
}

impl Writer {
    /// A log with the descriptions of all messages, their units, and the motors of the outputs.
    pub(crate) fn new(motors: &[(&str, f32)]) -> Self {
        let mut writer = Self::default();
        for kind in [&FMT, &UNIT, &MULT, &FMTU, &PARM, &ESC, &RCOU, &IMU, &RCIN, &ATT, &XKF1, &MODE] {
            writer.describe(kind);
        }
        for (letter, label) in [
            ("s", "s"),
            ("q", "rpm"),
            ("v", "V"),
            ("A", "A"),
            ("E", "rad/s"),
            ("Y", "us"),
            ("o", "m/s/s"),
            ("d", "deg"),
            ("n", "m/s"),
        ] {
            writer.message(&UNIT, &[&TIME_US.to_le_bytes(), letter.as_bytes(), &text(label, 64)]);
        }
        for (letter, factor) in [("-", 0.0_f64), ("0", 1.0), ("F", 1e-6), ("B", 1e-2)] {
            writer.message(&MULT, &[&TIME_US.to_le_bytes(), letter.as_bytes(), &factor.to_le_bytes()]);
        }
        for kind in [&ESC, &RCOU, &IMU, &RCIN, &ATT, &XKF1, &MODE] {
            let (units, factors) = (text(kind.units, 16), text(kind.factors, 16));
            writer.message(&FMTU, &[&TIME_US.to_le_bytes(), &[kind.number], &units, &factors]);
        }
        for (name, value) in motors {
            writer.message(&PARM, &[&TIME_US.to_le_bytes(), &text(name, 16), &value.to_le_bytes()]);
        }
        writer
    }

    fn describe(&mut self, kind: &Kind) {
        let about = [kind.number, size(kind)];
        let texts = [text(kind.name, 4), text(kind.types, 16), text(kind.labels, 64)].concat();
        self.message(&FMT, &[&about, &texts]);
    }

    pub(crate) fn message(&mut self, kind: &Kind, parts: &[&[u8]]) {
        self.bytes.extend([0xa3, 0x95, kind.number]);
        self.bytes.extend(parts.concat());
    }

    pub(crate) fn esc(&mut self, time_us: u64, instance: u8, rpm: f32) {
        let rest = [16.5_f32.to_le_bytes().to_vec(), 45_i16.to_le_bytes().to_vec(), 1234_i16.to_le_bytes().to_vec()];
        self.message(&ESC, &[&time_us.to_le_bytes(), &[instance], &rpm.to_le_bytes(), &rest.concat()]);
    }

    pub(crate) fn outputs(&mut self, time_us: u64, outputs: [u16; 6]) {
        let outputs: Vec<u8> = outputs.iter().flat_map(|output| output.to_le_bytes()).collect();
        self.message(&RCOU, &[&time_us.to_le_bytes(), &outputs]);
    }

    pub(crate) fn imu(&mut self, time_us: u64, instance: u8, values: [f32; 6]) {
        let values: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.message(&IMU, &[&time_us.to_le_bytes(), &[instance], &values]);
    }
}

/// Speed of an ESC, in rpm.
pub(crate) fn rpm(esc: u8, time_s: f64) -> f32 {
    (3000.0 + 300.0 * f64::from(esc) + 200.0 * (5.0 * time_s).sin()) as f32
}

/// Two sensors at 100 Hz, outputs at 50 Hz, ESCs at 10 Hz, each a little later than the one before. Outputs 1 to 4 drive the motors 4, 2, 1, 3.
pub(crate) fn flight(seconds: u64) -> Vec<u8> {
    let mut log = Writer::new(&[
        ("SERVO1_FUNCTION", 36.0),
        ("SERVO2_FUNCTION", 34.0),
        ("SERVO3_FUNCTION", 33.0),
        ("SERVO4_FUNCTION", 35.0),
        ("SERVO5_FUNCTION", 0.0),
    ]);
    for step in 0..100 * seconds {
        let time_us = 1_000_000 + 10_000 * step;
        let wave = (step as f64 / 20.0).sin() as f32;
        log.imu(time_us, 0, [0.1 * wave, -0.2 * wave, 0.3, 0.0, 0.0, -9.8]);
        log.imu(time_us + 100, 1, [0.0; 6]);
        if step % 2 == 0 {
            let up = (100.0 * wave) as i16;
            let output = |base: i16| (base + up) as u16;
            log.outputs(time_us, [output(1500), output(1510), output(1520), output(1530), 1000, 1000]);
        }
        if step % 10 == 0 {
            for esc in 0..4 {
                let esc_us = time_us + 500 * u64::from(esc);
                log.esc(esc_us, esc, rpm(esc, esc_us as f64 * 1e-6));
            }
        }
    }
    log.bytes
}
