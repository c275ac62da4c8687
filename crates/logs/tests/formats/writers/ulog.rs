//! A ULog of PX4.

/// A log in the format of PX4.
pub(crate) struct Writer {
    pub(crate) bytes: Vec<u8>,
    topics: u16,
}

impl Writer {
    pub(crate) fn new() -> Self {
        let mut bytes = vec![0x55, 0x4c, 0x6f, 0x67, 0x01, 0x12, 0x35, 1];
        bytes.extend(5_000_000_u64.to_le_bytes());
        let mut writer = Self { bytes, topics: 0 };
        writer.message(b'B', &[0; 40]);
        writer.message(b'I', b"\x10char[3] sys_nameabc");
        writer.message(b'P', b"\x16int32_t SENS_BOARD_ROT\0\0\0\0");
        for format in [
            "esc_report:uint64_t timestamp;uint32_t esc_errorcount;int32_t esc_rpm;uint8_t actuator_function;uint8_t[7] _padding0;",
            "esc_status:uint64_t timestamp;uint16_t counter;uint8_t[6] _padding0;esc_report[8] esc;",
            "actuator_motors:uint64_t timestamp;uint64_t timestamp_sample;uint16_t reversible_flags;float[12] control;uint8_t[6] _padding0;",
            "actuator_outputs:uint64_t timestamp;uint32_t noutputs;float[16] output;uint8_t[4] _padding0;",
            "vehicle_angular_velocity:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;uint8_t[4] _padding0;",
            "cpuload:uint64_t timestamp;float load;",
            "manual_control_setpoint:uint64_t timestamp;float x;float y;float z;float r;",
            "vehicle_attitude:uint64_t timestamp;float[4] q;",
            "vehicle_local_position:uint64_t timestamp;float vx;float vy;float vz;uint8_t[4] _padding0;",
            "vehicle_status:uint64_t timestamp;uint8_t nav_state;uint8_t[7] _padding0;",
        ] {
            writer.message(b'F', format.as_bytes());
        }
        writer
    }

    fn message(&mut self, kind: u8, content: &[u8]) {
        self.bytes.extend((content.len() as u16).to_le_bytes());
        self.bytes.push(kind);
        self.bytes.extend(content);
    }

    pub(crate) fn topic(&mut self, name: &str, instance: u8) -> u16 {
        let number = self.topics;
        self.topics += 1;
        let [low, high] = number.to_le_bytes();
        self.message(b'A', &[&[instance, low, high], name.as_bytes()].concat());
        number
    }

    pub(crate) fn data(&mut self, topic: u16, parts: &[&[u8]]) {
        self.message(b'D', &[&topic.to_le_bytes(), parts.concat().as_slice()].concat());
    }
}

pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// `functions[esc]`, or 0 where it is missing.
pub(crate) fn escs(reported_us: u64, rpm: &[i32], functions: &[u8]) -> Vec<u8> {
    let esc = |esc: usize| {
        let rpm = rpm.get(esc).copied().unwrap_or(0);
        let time = if esc < functions.len() { reported_us } else { 0 };
        let function = functions.get(esc).copied().unwrap_or(0);
        [&time.to_le_bytes()[..], &[0; 4], &rpm.to_le_bytes(), &[function], &[0; 7]].concat()
    };
    (0..8).flat_map(esc).collect()
}

/// One second of data: rates at 100 Hz, motors at 50 Hz, outputs at 20 Hz, ESCs at 10 Hz.
pub(crate) fn flight() -> Vec<u8> {
    let mut log = Writer::new();
    let [rates, motors, servos, outputs, cpu, status] = [
        ("vehicle_angular_velocity", 0),
        ("actuator_motors", 0),
        ("actuator_outputs", 0),
        ("actuator_outputs", 1),
        ("cpuload", 0),
        ("esc_status", 0),
    ]
    .map(|(name, instance)| log.topic(name, instance));
    for step in 0..100_u64 {
        let now_us = 10_000_000 + 10_000 * step;
        let (now, sampled) = (now_us.to_le_bytes(), (now_us - 1000).to_le_bytes());
        let wave = step as f32 / 100.0;
        log.data(rates, &[&now, &sampled, &floats(&[wave, -wave, 0.5])]);
        if step % 2 == 0 {
            let nan = f32::NAN;
            let control = [0.5 + wave, 0.5 - 0.1 * wave, 0.5, 0.6 + wave, nan, nan, nan, nan, nan, nan, nan, nan];
            log.data(motors, &[&now, &sampled, &[0; 2], &floats(&control)]);
            log.data(cpu, &[&now, &floats(&[0.5])]);
        }
        if step % 5 == 0 {
            let mut output = [0.0; 16];
            output[..6].copy_from_slice(&[1500.0 + wave, 1500.0, 1000.0, 0.0, 0.0, 0.0]);
            log.data(servos, &[&now, &[8, 0, 0, 0], &floats(&output)]);
            output[..6].copy_from_slice(&[
                1500.0 + 100.0 * wave,
                1400.0 - 50.0 * wave,
                1300.0 + 50.0 * wave,
                1600.0 - 100.0 * wave,
                900.0,
                900.0,
            ]);
            log.data(outputs, &[&now, &[8, 0, 0, 0], &floats(&output)]);
        }
        if step % 10 == 0 {
            // the fourth row repeats the third, and in the sixth row one ESC does not answer
            let counted = if step == 30 { 20 } else { step as u16 };
            let rpm = [3000 + step as i32, -3100, if step == 50 { 0 } else { 3200 }, 3300];
            log.data(status, &[&now, &counted.to_le_bytes(), &[0; 6], &escs(now_us, &rpm, &[])]);
        }
    }
    log.bytes
}

/// Place of the first data message.
pub(crate) fn data_begin(log: &[u8]) -> usize {
    let mut at = 16;
    while log[at + 2] != b'D' {
        at += 3 + usize::from(u16::from_le_bytes([log[at], log[at + 1]]));
    }
    at
}
