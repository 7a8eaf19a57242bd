//! What a free impact returns under each damping law, against the restitution it was asked for.

/// Restitutions asked for.
pub const ASKED: [f64; 11] = [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95];

/// Name of the law and the restitutions delivered, for exponent 3/2 and no limit of the ratio: the
/// root e of χ·(1 + e) = ln[(1 + χ)/(1 − χ·e)] for the law's χ.
pub const DELIVERED: [(&str, [f64; 11]); 10] = [
    ("hunt_crossley", [0.5014, 0.5158, 0.5469, 0.5813, 0.6197, 0.6630, 0.7120, 0.7680, 0.8329, 0.9090, 0.9524]),
    ("herbert_mcwhannell", [0.4884, 0.4907, 0.5008, 0.5200, 0.5503, 0.5936, 0.6511, 0.7227, 0.8070, 0.9009, 0.9501]),
    ("lee_wang", [0.6746, 0.6867, 0.7120, 0.7390, 0.7680, 0.7992, 0.8329, 0.8693, 0.9090, 0.9524, 0.9756]),
    ("lankarani_nikravesh", [0.6635, 0.6653, 0.6723, 0.6842, 0.7016, 0.7252, 0.7561, 0.7960, 0.8471, 0.9132, 0.9535]),
    ("gonthier", [0.0501, 0.1010, 0.2046, 0.3042, 0.3978, 0.4877, 0.5773, 0.6696, 0.7680, 0.8764, 0.9359]),
    ("zhang_sharf", ASKED),
    ("flores", [0.0329, 0.0694, 0.1555, 0.2562, 0.3629, 0.4704, 0.5773, 0.6832, 0.7885, 0.8939, 0.9468]),
    ("hu_guo", [0.0351, 0.0741, 0.1656, 0.2707, 0.3796, 0.4877, 0.5936, 0.6973, 0.7992, 0.8999, 0.9500]),
    ("zhiying_qishao", [0.1969, 0.2175, 0.2664, 0.3267, 0.3988, 0.4826, 0.5769, 0.6796, 0.7874, 0.8959, 0.9489]),
    ("carvalho_martins", [0.0929, 0.1289, 0.2116, 0.3040, 0.4011, 0.5002, 0.6000, 0.7000, 0.8000, 0.9000, 0.9500]),
];

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(law: &str, c: f64) -> f64 {
        match law {
            "hunt_crossley" => 1.5 * (1.0 - c),
            "herbert_mcwhannell" => 6.0 * (1.0 - c) / ((2.0 * c - 1.0).powi(2) + 3.0),
            "lee_wang" => 0.75 * (1.0 - c),
            "lankarani_nikravesh" => 0.75 * (1.0 - c * c),
            "gonthier" => (1.0 - c * c) / c,
            "flores" => 8.0 * (1.0 - c) / (5.0 * c),
            "hu_guo" => 1.5 * (1.0 - c) / c,
            "zhiying_qishao" => 0.75 * (1.0 - c * c) * (2.0 * (1.0 - c)).exp(),
            "carvalho_martins" => 1.5 * (1.0 - c) * (11.0 - c) / (1.0 + 9.0 * c),
            _ => f64::NAN,
        }
    }

    #[test]
    fn the_table_solves_the_impact_of_each_law() {
        for (law, delivered) in DELIVERED {
            for (asked, shown) in ASKED.into_iter().zip(delivered) {
                let chi = factor(law, asked);
                if chi.is_nan() {
                    assert_eq!((law, asked), ("zhang_sharf", shown), "`factor` lacks the formula of the law");
                    continue;
                }
                // The left side falls below the right one as e rises through the root.
                let (mut low, mut high) = (0.0, (1.0 / chi).min(1.0));
                for _ in 0..60 {
                    let e: f64 = 0.5 * (low + high);
                    let balance = ((1.0 + chi) / (1.0 - chi * e)).ln() - chi * (1.0 + e);
                    if balance < 0.0 { low = e } else { high = e }
                }
                assert!((low - shown).abs() < 1e-4, "{law} {asked}: {low} against {shown}");
            }
        }
    }

    #[test]
    fn the_page_s_sentences_hold() {
        let within = |law: &str, bound: f64, from: f64| {
            let row = DELIVERED.iter().find(|(name, _)| *name == law).expect("a law of the table");
            ASKED.into_iter().zip(row.1).all(|(asked, e)| asked < from || (e - asked).abs() < bound)
        };
        for (law, bound, from) in [
            ("carvalho_martins", 0.005, 0.3),
            ("gonthier", 0.05, 0.0),
            ("hu_guo", 0.05, 0.0),
            ("flores", 0.05, 0.0),
            ("zhiying_qishao", 0.05, 0.3),
            ("lankarani_nikravesh", 0.015, 0.9),
            ("hunt_crossley", 0.015, 0.9),
            ("herbert_mcwhannell", 0.025, 0.7),
        ] {
            assert!(within(law, bound, from), "{law}");
        }
        assert!(!within("lee_wang", 0.05, 0.9));
    }
}
