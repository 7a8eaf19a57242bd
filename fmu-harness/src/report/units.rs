//! Display of SI numbers with prefixes of units.

/// A unit with a prefix: displayed number = factor · SI number.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// The factor.
    pub factor: f64,
    /// The unit's symbol with its prefix.
    pub unit: String,
}

impl Shown {
    /// The multiple of `unit`, given as in modelDescription.xml, that suits numbers up to `peak`.
    pub fn of(unit: &str, peak: f64) -> Self {
        let (shown, large, small) = match unit {
            "N" => ("N", true, true),
            "m" => ("m", false, true),
            "N.m" => ("N·m", true, false),
            "J" => ("J", true, true),
            "m/s" => ("m/s", false, true),
            "m/s2" => ("m/s²", true, false),
            "rad/s" => ("rad/s", false, false),
            "rad/s2" => ("rad/s²", false, false),
            "rad" => ("rad", false, true),
            "s" => ("s", false, true),
            "1" => ("", false, false),
            other => (other, false, false),
        };
        let (factor, prefix) = match peak.abs() {
            peak if large && peak >= 2e6 => (1e-6, "M"),
            peak if large && peak >= 2e3 => (1e-3, "k"),
            peak if small && peak > 0.0 && peak < 2e-3 => (1e6, "µ"),
            peak if small && peak > 0.0 && peak < 1.0 => (1e3, "m"),
            _ => (1.0, ""),
        };
        Self { factor, unit: format!("{prefix}{shown}") }
    }

    /// `name [unit]`, for an axis.
    pub fn axis(&self, name: &str) -> String {
        if self.unit.is_empty() { name.into() } else { format!("{name} [{}]", self.unit) }
    }

    /// The SI number with four significant digits and its unit.
    pub fn print(&self, value: f64) -> String {
        let text = significant(value * self.factor);
        if self.unit.is_empty() { text } else { format!("{text} {}", self.unit) }
    }
}

/// A number with four significant digits; without exponent between 0.001 and a million.
pub fn significant(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if (1e-3..1e6).contains(&size) => {
            let decimals = (3.0 - size.log10().floor()).clamp(0.0, 6.0) as usize;
            format!("{value:.decimals$}")
        }
        _ => format!("{value:.3e}"),
    }
}

/// An integer in groups of three digits.
pub fn grouped(number: f64) -> String {
    let digits = format!("{:.0}", number.abs());
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place) % 3 == 0 {
            text.push(' ');
        }
        text.push(digit);
    }
    if number < 0.0 { format!("-{text}") } else { text }
}

/// A number with [`three_digits`], if it is known; a dash if it is not finite.
pub fn known(number: f64) -> String {
    if number.is_finite() { three_digits(number) } else { "–".into() }
}

/// A number with three significant digits, or more if it has more digits before the decimal point.
pub fn three_digits(number: f64) -> String {
    // Unit of the last digit.
    let rounded = format!("{number:.2e}").parse().unwrap_or(number);
    let size = f64::abs(rounded);
    if size >= 100.0 || size == 0.0 {
        return grouped(number);
    }
    let decimals = (2.0 - size.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{number:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_wear_the_prefix_of_their_size() {
        assert_eq!(Shown::of("N", 54_321.0).print(54_321.0), "54.32 kN");
        assert_eq!(Shown::of("m", 5e-4).print(5e-4), "500.0 µm");
        assert_eq!(Shown::of("m", 0.05).print(-0.05), "-50.00 mm");
        assert_eq!(Shown::of("m/s2", 19_419.4).print(19_419.4), "19.42 km/s²");
        assert_eq!(Shown::of("1", 0.3).print(0.3), "0.3000");
        assert_eq!(grouped(1234567.0), "1 234 567");
    }
}
