//! Sine and cosine together, without a branch and without a call: two angles of one mechanism are
//! computed side by side.

#![expect(clippy::excessive_precision, reason = "coefficients stand as printed")]

/// Greatest angle that the reduction below takes: its multiple of π/2 has 20 bits.
const GREATEST: f64 = 1.6e6;

/// Adding and subtracting it rounds to an integer: 1.5·2⁵².
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// π/2 as a sum: two numbers of 33 bits, whose products with an integer of 20 bits are exact, and the
/// rest (W. J. Cody, W. Waite, Software Manual for the Elementary Functions, 1980).
const HALF_PI: [f64; 3] = [
    f64::from_bits(0x3FF9_21FB_5440_0000),
    f64::from_bits(0x3DD0_B461_1A60_0000),
    f64::from_bits(0x3BA3_198A_2E03_7073),
];

/// Minimax coefficients of (sin r − r)/r³ on |r| ≤ π/4, by powers of r² (Sun Microsystems, fdlibm 5.3).
const SIN: [f64; 6] = [
    -1.666_666_666_666_663_243_48e-1,
    8.333_333_333_322_489_461_24e-3,
    -1.984_126_982_985_794_931_34e-4,
    2.755_731_370_707_006_767_89e-6,
    -2.505_076_025_340_686_341_95e-8,
    1.589_690_995_211_550_102_21e-10,
];

/// Minimax coefficients of (cos r − 1 + r²/2)/r⁴, likewise.
const COS: [f64; 6] = [
    4.166_666_666_666_660_190_37e-2,
    -1.388_888_888_887_410_957_49e-3,
    2.480_158_728_947_672_941_78e-5,
    -2.755_731_435_139_066_330_35e-7,
    2.087_572_321_298_174_827_90e-9,
    -1.135_964_755_778_819_482_65e-11,
];

/// (sin x, cos x), within about a rounding of the exact ones.
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    if x.abs() < GREATEST { reduced(x) } else { libm::sincos(x) }
}

#[inline(always)]
fn reduced(x: f64) -> (f64, f64) {
    // x = k·π/2 + r + tail.
    let shifted = x * std::f64::consts::FRAC_2_PI + ROUNDER;
    let k = shifted - ROUNDER;
    let quadrant = shifted.to_bits();
    let left = x - k * HALF_PI[0];
    let product = k * HALF_PI[1];
    let near = left - product;
    let small = k * HALF_PI[2] - ((left - near) - product);
    let r = near - small;
    let tail = (near - r) - small;

    let z = r * r;
    let zz = z * z;
    let cube = z * r;
    let s = SIN[1] + z * (SIN[2] + z * SIN[3]) + z * zz * (SIN[4] + z * SIN[5]);
    let sin = r - ((z * (0.5 * tail - cube * s) - tail) - cube * SIN[0]);
    let c = z * (COS[0] + z * (COS[1] + z * COS[2])) + zz * zz * (COS[3] + z * (COS[4] + z * COS[5]));
    let half = 0.5 * z;
    let one = 1.0 - half;
    let cos = one + (((1.0 - one) - half) + (z * c - r * tail));

    let (sin, cos) = if quadrant & 1 == 0 { (sin, cos) } else { (cos, sin) };
    let sign = |bit: u64| (bit & 2) << 62;
    (f64::from_bits(sin.to_bits() ^ sign(quadrant)), f64::from_bits(cos.to_bits() ^ sign(quadrant.wrapping_add(1))))
}
