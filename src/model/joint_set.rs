//! Names of the three pins, and sets of joints.

/// A revolute joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pin {
    /// A: the crank's journal in the ground.
    MainBearing,
    /// B: the crank's pin in the rod's big end.
    CrankPin,
    /// C: the slider's pin in the rod's small end.
    SliderPin,
}

impl Pin {
    /// All pins, in the order of lists by pin.
    pub const ALL: [Self; 3] = [Self::MainBearing, Self::CrankPin, Self::SliderPin];
}

/// A subset of the four joints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JointSet {
    /// Whether A is in the set.
    pub main_bearing: bool,
    /// Whether B is in the set.
    pub crank_pin: bool,
    /// Whether C is in the set.
    pub slider_pin: bool,
    /// Whether T is in the set.
    pub guide: bool,
}

impl JointSet {
    /// Whether `pin` is in the set.
    #[inline(always)]
    pub const fn contains(self, pin: Pin) -> bool {
        match pin {
            Pin::MainBearing => self.main_bearing,
            Pin::CrankPin => self.crank_pin,
            Pin::SliderPin => self.slider_pin,
        }
    }

    /// The pins in the set.
    pub fn pins(self) -> impl Iterator<Item = Pin> {
        Pin::ALL.into_iter().filter(move |&pin| self.contains(pin))
    }
}
