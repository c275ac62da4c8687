//! Levels over the floor, one byte each, and the level of a power without a logarithm.

/// A level in steps of 0.36 dB above [`LEVEL_DB_MIN`]: the level of noise scatters by 5.6 dB from bin to bin.
pub(super) type Level = u8;
/// Lowest level that is told, dB. *Numeric.*
pub(super) const LEVEL_DB_MIN: f64 = -30.0;
/// Steps of levels to a dB. *Numeric.*
pub(super) const LEVELS_PER_DB: f64 = 2.8;
/// Number of levels: from −30 to 60 dB. *Numeric.*
pub(super) const LEVELS: usize = 253;
/// In place of a level: lines are left out of the sound there, so that nothing is known.
pub(super) const UNKNOWN: Level = Level::MAX;

/// The level of a power over the floor.
pub(super) fn level_of(excess: f64) -> Level {
    let db = 10.0 * excess.max(f64::MIN_POSITIVE).log10();
    ((db - LEVEL_DB_MIN) * LEVELS_PER_DB).round().clamp(0.0, (LEVELS - 1) as f64) as Level
}

/// A level in dB; also that of a mean of levels.
pub(super) fn level_db(level: f64) -> f64 {
    LEVEL_DB_MIN + level / LEVELS_PER_DB
}

/// Bits of the fraction of a number that choose its level: powers within 1/256, or 0.02 dB, have one level. *Numeric.*
const FRACTION_BITS: u32 = 8;
/// Bits of the fraction that are left out. *Numeric.*
const LEFT_OUT_BITS: u32 = f32::MANTISSA_DIGITS - 1 - FRACTION_BITS;
/// Lowest power in the table: below −30 dB, as a power of 2 whose number begins the table. *Numeric.*
const POWER_MIN: f32 = 0.000_976_562_5;
/// Factors of two in the table: to above 60 dB. *Numeric.*
const DOUBLINGS: u32 = 31;

/// The level of each number, by its exponent and the first bits of its fraction.
pub(super) struct LevelTable {
    levels: Vec<Level>,
}

impl LevelTable {
    pub(super) fn new() -> Self {
        let first = POWER_MIN.to_bits() >> LEFT_OUT_BITS;
        let middle = |cell: u32| f32::from_bits(((first + cell) << LEFT_OUT_BITS) | (1 << (LEFT_OUT_BITS - 1)));
        let cells = 0..DOUBLINGS << FRACTION_BITS;
        Self { levels: cells.map(|cell| level_of(f64::from(middle(cell)))).collect() }
    }

    /// The level of a power over the floor.
    pub(super) fn of(&self, excess: f64) -> Level {
        let cell = ((excess as f32).to_bits() >> LEFT_OUT_BITS).saturating_sub(POWER_MIN.to_bits() >> LEFT_OUT_BITS);
        self.levels[(cell as usize).min(self.levels.len() - 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_tells_the_level_of_any_power() {
        let table = LevelTable::new();
        for step in 0..200_000 {
            let db = -50.0 + 130.0 * f64::from(step) / 200_000.0;
            let excess = 10f64.powf(db / 10.0);
            let exact = ((db - LEVEL_DB_MIN) * LEVELS_PER_DB).clamp(0.0, (LEVELS - 1) as f64);
            // half a step by rounding, and 0.01 dB, or 0.03 steps, by the cell
            assert!((f64::from(table.of(excess)) - exact).abs() < 0.5 + 0.03, "{db} dB: {} {exact}", table.of(excess));
        }
        assert_eq!((table.of(0.0), table.of(f64::INFINITY)), (0, LEVELS as Level - 1));
    }
}
