//! Hysteresis damping: the factor χ of each law as a function of the restitution.

use crate::math;
use crate::scene::DampingLaw;

/// Damping factor χ of `law` at the restitution `e` (0 < e ≤ 1).
///
/// A free impact under f_n = F(δ)·(1 + χ·δ̇/δ̇⁻) has the restitution e that solves χ(1 + e) = ln((1 + χ)/(1 − χ·e)),
/// for any elastic law F. `ZhangSharf` solves this equation; the other laws approximate it, the older ones near e = 1.
pub fn factor(law: DampingLaw, e: f64) -> f64 {
    match law {
        DampingLaw::Hertz => 0.0,
        // K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440
        DampingLaw::HuntCrossley => 1.5 * (1.0 - e),
        // R. G. Herbert, D. C. McWhannell, J. Eng. Ind. 99 (1977) 513
        DampingLaw::HerbertMcwhannell => 6.0 * (1.0 - e) / ((2.0 * e - 1.0).powi(2) + 3.0),
        // T. W. Lee, A. C. Wang, J. Mech. Transm. Autom. Des. 105 (1983) 534
        DampingLaw::LeeWang => 0.75 * (1.0 - e),
        // H. M. Lankarani, P. E. Nikravesh, J. Mech. Des. 112 (1990) 369
        DampingLaw::LankaraniNikravesh => 0.75 * (1.0 - e * e),
        // Y. Gonthier et al., Multibody Syst. Dyn. 11 (2004) 209, approximate form
        DampingLaw::Gonthier => (1.0 - e * e) / e,
        // Y. Zhang, I. Sharf, J. Appl. Mech. 76 (2009) 041002
        DampingLaw::ZhangSharf => exact(e),
        // P. Flores et al., Multibody Syst. Dyn. 25 (2011) 357
        DampingLaw::Flores => 8.0 * (1.0 - e) / (5.0 * e),
        // S. Hu, X. Guo, Int. J. Impact Eng. (2015)
        DampingLaw::HuGuo => 1.5 * (1.0 - e) / e,
        // Q. Zhiying, L. Qishao, J. Mech. Strength 28 (2006)
        DampingLaw::ZhiyingQishao => 0.75 * (1.0 - e * e) * math::exp(2.0 * (1.0 - e)),
        // A. S. Carvalho, J. M. Martins, Mech. Mach. Theory 139 (2019) 174
        DampingLaw::CarvalhoMartins => 1.5 * (1.0 - e) * (11.0 - e) / (1.0 + 9.0 * e),
    }
}

/// The root χ in (0, 1/e) of χ(1 + e) = ln((1 + χ)/(1 − χ·e)), by bisection to the last bit.
///
/// The right side less the left is negative below the root and positive above it.
fn exact(e: f64) -> f64 {
    if e >= 1.0 {
        return 0.0;
    }
    let excess = |chi: f64| math::ln_1p(chi) - math::ln_1p(-chi * e) - chi * (1.0 + e);
    // Series about χ = 0: the root is 3(1 − e²)/(2(1 + e³)) to first order in 1 − e.
    let series = 1.5 * (1.0 - e * e) / (1.0 + e * e * e);
    if series < 1e-5 {
        // The difference is of third order in χ: below this χ its rounding error exceeds it.
        return series;
    }
    let (mut low, mut high) = (0.1 * series, 1.0 / e);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if excess(middle) > 0.0 { high = middle } else { low = middle }
    }
    low
}
