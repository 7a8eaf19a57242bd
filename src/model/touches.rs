//! Touches of the joints: how many there were, and how fast the surfaces met between two communication points.

/// Number of joints: main bearing, crank pin, slider pin and guide.
pub const JOINTS: usize = 4;
/// Index of the guide.
pub const GUIDE: usize = JOINTS - 1;

/// The touches of one joint. The guide's are those of its corners or faces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touches {
    /// Number of touches since the start; it saturates.
    pub count: u32,
    /// [m/s] Largest approach speed since the last communication point; 0 if there was no touch.
    pub largest: f64,
    /// [s] Time of the last touch.
    time: f64,
    /// [m/s] Largest approach speed at that time.
    latest: f64,
}

impl Touches {
    /// Index of the joint of a contact.
    pub fn joint(contact: usize) -> usize {
        contact.min(GUIDE)
    }

    /// Adds a touch at the time `t` [s] with an approach speed [m/s].
    pub fn add(&mut self, t: f64, speed: f64) {
        let speed = speed.max(0.0);
        self.latest = if self.count > 0 && self.time == t { self.latest.max(speed) } else { speed };
        (self.count, self.time, self.largest) = (self.count.saturating_add(1), t, self.largest.max(speed));
    }

    /// Begins an interval at the communication point `t` [s]. A step may end later; only touches at its end are then in
    /// the interval.
    pub fn begin_interval(&mut self, t: f64) {
        self.largest = if self.count > 0 && self.time > t { self.latest } else { 0.0 };
    }

    /// Memory of the touches: reals and count.
    pub fn parts(&self) -> ([f64; 3], u32) {
        ([self.largest, self.time, self.latest], self.count)
    }

    /// Restores touches from [`parts`](Self::parts); `None` if no run can have produced them.
    pub fn from_parts([largest, time, latest]: [f64; 3], count: u32) -> Option<Self> {
        let touches = Self { count, largest, time, latest };
        let sound = |speed: f64| (0.0..f64::INFINITY).contains(&speed);
        (sound(largest) && sound(latest) && time.is_finite() && (count > 0 || touches == Self::default()))
            .then_some(touches)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_touch_counts_in_the_interval_in_which_it_happens() {
        let mut touches = Touches::default();
        touches.add(1.0, 3.0);
        touches.add(1.5, 2.0);
        assert_eq!((touches.count, touches.largest), (2, 3.0));
        // The last step ends at 1.5, behind the communication point: the touch there is still to come.
        touches.begin_interval(1.2);
        assert_eq!(touches.largest, 2.0);
        touches.add(1.5, 2.5);
        touches.begin_interval(1.4);
        assert_eq!(touches.largest, 2.5);
        // One at a communication point belongs to the interval that ends there.
        touches.begin_interval(1.5);
        assert_eq!((touches.count, touches.largest), (3, 0.0));
    }

    #[test]
    fn an_approach_that_is_not_one_has_no_speed() {
        let mut touches = Touches::default();
        touches.add(0.0, -1.0);
        assert_eq!((touches.count, touches.largest), (1, 0.0));
    }
}
