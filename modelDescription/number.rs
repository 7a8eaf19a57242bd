//! Numbers as people read them, in messages and on the page.

/// The shortest decimal that is the same number, with an exponent outside 0.001 to 99999.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-3..1e5).contains(&size) { format!("{value}") } else { format!("{value:e}") }
}
