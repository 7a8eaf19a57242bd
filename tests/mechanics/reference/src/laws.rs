//! Elastic force, hysteresis damping and friction of one contact, each on a frozen branch.

use crate::mechanism::{Contact, DampingLaw, Elasticity, Friction, FrictionLaw, Guide, Revolute};
use crate::phase::Phase;
use std::f64::consts::PI;

/// The elastic force as a function of penetration.
enum Elastic {
    /// K·δ^p.
    Power { stiffness: f64, exponent: f64 },
    /// (π/2)·E*·L·δ·√(δ/(2(c + δ))).
    Conformal { modulus_width: f64, clearance: f64 },
    /// (π/8)·E*·L·√(2δ·(3c + 2δ)²/(c + δ)³)·δ.
    Hybrid { modulus_width: f64, clearance: f64 },
    /// A layer of springs on the bearing: k_w·R_b·L·((c + δ)·β − c·sin β), cos β = c/(c + δ).
    Layer { stiffness: f64, clearance: f64 },
}

/// The laws of one contact.
pub struct Laws {
    elastic: Elastic,
    /// χ.
    pub damping: f64,
    /// s_max; at or below 0 none.
    pub ratio_limit: f64,
    /// [m/s] v_floor.
    pub speed_floor: f64,
    /// Friction, as told.
    pub friction: Friction,
}

/// σ_b + σ_j with σ = (1 − ν²)/E.
pub fn compliance(contact: &Contact) -> f64 {
    let sigma = |poisson: f64, young: f64| (1.0 - poisson * poisson) / young;
    sigma(contact.poisson.bearing, contact.young.bearing) + sigma(contact.poisson.journal, contact.young.journal)
}

/// β − sin β.
fn segment(angle: f64) -> f64 {
    if angle > 0.6 {
        return angle - angle.sin();
    }
    let mut term = angle.powi(3) / 6.0;
    let mut sum = 0.0;
    for n in 2..12 {
        sum += term;
        term *= -angle * angle / f64::from(2 * n * (2 * n + 1));
    }
    sum
}

impl Laws {
    /// Hertz: K = 4/(3(σ_b + σ_j))·√(R_b·R_j/(R_b − R_j)).
    pub fn of_revolute(joint: &Revolute) -> Self {
        let journal_radius = joint.radius - joint.clearance;
        let hertz = 4.0 / (3.0 * compliance(&joint.contact)) * (joint.radius * journal_radius / joint.clearance).sqrt();
        let elastic = match joint.elasticity {
            Elasticity::Hertz => power(&joint.contact, hertz),
            Elasticity::Liu => Elastic::Conformal {
                modulus_width: joint.contact.width / compliance(&joint.contact),
                clearance: joint.clearance,
            },
            Elasticity::BaiZhao => Elastic::Hybrid {
                modulus_width: joint.contact.width / compliance(&joint.contact),
                clearance: joint.clearance,
            },
            Elasticity::Winkler => {
                let (young, poisson) = (joint.contact.young.bearing, joint.contact.poisson.bearing);
                // Plane strain without strain along the layer: λ + 2μ over the thickness.
                let shear = young / (2.0 * (1.0 + poisson));
                let lame = 2.0 * shear * poisson / (1.0 - 2.0 * poisson);
                let own = (lame + 2.0 * shear) / joint.layer.thickness;
                let springs = if joint.layer.stiffness > 0.0 { joint.layer.stiffness } else { own };
                Elastic::Layer { stiffness: springs * joint.radius * joint.contact.width, clearance: joint.clearance }
            }
        };
        Self::new(elastic, &joint.contact)
    }

    /// A sphere on a plane: K_T = 4/(3(σ_g + σ_s))·√R_c.
    pub fn of_corner(guide: &Guide) -> Self {
        let hertz = 4.0 / (3.0 * compliance(&guide.contact)) * guide.corner_radius.sqrt();
        Self::new(power(&guide.contact, hertz), &guide.contact)
    }

    /// A bed of springs under a face gives its elastic force itself.
    pub fn of_face(guide: &Guide) -> Self {
        Self::new(Elastic::Power { stiffness: 0.0, exponent: 1.0 }, &guide.contact)
    }

    fn new(elastic: Elastic, contact: &Contact) -> Self {
        Self {
            elastic,
            damping: damping_factor(contact.law, contact.restitution),
            ratio_limit: contact.ratio_limit,
            speed_floor: contact.speed_floor,
            friction: contact.friction,
        }
    }

    /// [N] F_elastic(δ), 0 at δ ≤ 0.
    pub fn elastic_force(&self, penetration: f64) -> f64 {
        let penetration = penetration.max(0.0);
        match self.elastic {
            Elastic::Power { stiffness, exponent } => stiffness * penetration.powf(exponent),
            Elastic::Conformal { modulus_width, clearance } => {
                PI / 2.0 * modulus_width * penetration * (penetration / (2.0 * (clearance + penetration))).sqrt()
            }
            Elastic::Hybrid { modulus_width, clearance } => {
                let reach = clearance + penetration;
                let steep = 2.0 * penetration * (2.0 * reach + clearance).powi(2) / reach.powi(3);
                PI / 8.0 * modulus_width * steep.sqrt() * penetration
            }
            Elastic::Layer { stiffness, clearance } => {
                let reach = clearance + penetration;
                // 1 − cos β = δ/(c + δ).
                let angle = 2.0 * (penetration / (2.0 * reach)).sqrt().asin();
                stiffness * (penetration * angle + clearance * segment(angle))
            }
        }
    }

    /// [J] ∫F_elastic dδ, by Simpson's rule in √δ, in which the force is smooth.
    pub fn elastic_energy(&self, penetration: f64) -> f64 {
        const PANELS: u32 = 2000;
        let end = penetration.max(0.0).sqrt();
        let integrand = |root: f64| self.elastic_force(root * root) * 2.0 * root;
        let weighted = (0..=PANELS).map(|k| {
            let weight = if k == 0 || k == PANELS { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
            weight * integrand(end * f64::from(k) / f64::from(PANELS))
        });
        weighted.sum::<f64>() * end / f64::from(3 * PANELS)
    }

    /// 1 + χ·s on the branch of `phase`: s = δ̇/δ̇⁻, or s_max where the limit holds.
    pub fn damping_multiplier(&self, phase: &Phase, rate: f64) -> f64 {
        let ratio = if phase.limited { self.ratio_limit } else { rate / phase.onset_rate };
        1.0 + self.damping * ratio
    }

    /// [N] f_n on the branch of `phase`.
    pub fn normal_force(&self, phase: &Phase, elastic_force: f64, rate: f64) -> f64 {
        if !phase.closed() || phase.clipped {
            return 0.0;
        }
        elastic_force * self.damping_multiplier(phase, rate)
    }

    /// [N] f_t on the branch of `phase`.
    pub fn friction_force(&self, phase: &Phase, normal_force: f64, sliding: f64, bristle: f64) -> f64 {
        let f = &self.friction;
        let coefficient = match f.law {
            FrictionLaw::None => 0.0,
            FrictionLaw::Lugre => {
                let damping = f.sigma1 * self.fading(sliding) * self.bristle_rate(phase, sliding, bristle);
                f.sigma0 * bristle + damping + f.sigma2 * sliding
            }
            FrictionLaw::Ambrosio => {
                let share = match phase.zone.abs() {
                    0 => 0.0,
                    1 => (sliding.abs() - f.v0) / (f.v1 - f.v0),
                    _ => 1.0,
                };
                f.coefficient * f64::from(phase.zone.signum()) * share
            }
            FrictionLaw::Tanh => f.coefficient * (sliding / f.v1).tanh(),
            FrictionLaw::Stribeck => self.falling(sliding) * (sliding / f.v1).tanh(),
        };
        coefficient * normal_force
    }

    /// exp(−(v/v_s)²).
    fn fading(&self, sliding: f64) -> f64 {
        (-(sliding / self.friction.v_stribeck).powi(2)).exp()
    }

    /// μ_k + (μ_s − μ_k)·exp(−(v/v_s)²).
    fn falling(&self, sliding: f64) -> f64 {
        let f = &self.friction;
        f.coefficient + (f.static_coefficient - f.coefficient) * self.fading(sliding)
    }

    /// [m/s] ż = v − σ0·|v|·z/g(v) of lugre, the sign of v being that of `phase`.
    pub fn bristle_rate(&self, phase: &Phase, sliding: f64, bristle: f64) -> f64 {
        if !phase.closed() || self.friction.law != FrictionLaw::Lugre {
            return 0.0;
        }
        let speed = f64::from(phase.zone) * sliding;
        sliding - self.friction.sigma0 * speed * bristle / self.falling(sliding)
    }
}

/// A power law with the stiffness given, or Hertz's.
fn power(contact: &Contact, hertz: f64) -> Elastic {
    let stiffness = if contact.stiffness > 0.0 { contact.stiffness } else { hertz };
    Elastic::Power { stiffness, exponent: contact.exponent }
}

/// χ as a function of the restitution.
fn damping_factor(law: DampingLaw, restitution: f64) -> f64 {
    let e = restitution;
    match law {
        DampingLaw::Hertz => 0.0,
        DampingLaw::HuntCrossley => 3.0 * (1.0 - e) / 2.0,
        DampingLaw::HerbertMcwhannell => 6.0 * (1.0 - e) / ((2.0 * e - 1.0).powi(2) + 3.0),
        DampingLaw::LeeWang => 3.0 * (1.0 - e) / 4.0,
        DampingLaw::LankaraniNikravesh => 3.0 * (1.0 - e * e) / 4.0,
        DampingLaw::Gonthier => (1.0 - e * e) / e,
        DampingLaw::ZhangSharf => exact_factor(e),
        DampingLaw::Flores => 8.0 * (1.0 - e) / (5.0 * e),
        DampingLaw::HuGuo => 3.0 * (1.0 - e) / (2.0 * e),
        DampingLaw::ZhiyingQishao => 0.75 * (1.0 - e * e) * (2.0 * (1.0 - e)).exp(),
        DampingLaw::CarvalhoMartins => 3.0 * (1.0 - e) * (11.0 - e) / (2.0 * (1.0 + 9.0 * e)),
    }
}

/// The positive root of χ(1 + e) = ln[(1 + χ)/(1 − χ·e)], by halving (0, 1/e).
fn exact_factor(e: f64) -> f64 {
    if e >= 1.0 {
        return 0.0;
    }
    // Below the root the left side is greater; both vanish at χ = 0, so start above it.
    let excess = |x: f64| x * (1.0 + e) - x.ln_1p() + (-x * e).ln_1p();
    let (mut low, mut high) = (1e-9, 1.0 / e);
    for _ in 0..200 {
        let middle = (low + high) / 2.0;
        if excess(middle) > 0.0 { low = middle } else { high = middle }
    }
    (low + high) / 2.0
}
