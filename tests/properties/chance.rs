//! Pseudo-random numbers, the same on every run: xorshift64*, G. Marsaglia 2003, S. Vigna 2016.

pub struct Chance(pub u64);

impl Chance {
    /// In low .. high.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let share = (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * share
    }

    /// −1 or 1.
    pub fn sign(&mut self) -> f64 {
        if self.between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 }
    }
}
