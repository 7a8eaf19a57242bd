//! Joints by name: the three pins, and sets of joints.

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
    /// In the order of lists of pins.
    pub const ALL: [Self; 3] = [Self::MainBearing, Self::CrankPin, Self::SliderPin];
}

/// Some of the four joints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JointSet {
    /// A is among them.
    pub main_bearing: bool,
    /// B is among them.
    pub crank_pin: bool,
    /// C is among them.
    pub slider_pin: bool,
    /// T is among them.
    pub guide: bool,
}

impl JointSet {
    /// Whether `pin` is among them.
    #[inline(always)]
    pub const fn contains(self, pin: Pin) -> bool {
        match pin {
            Pin::MainBearing => self.main_bearing,
            Pin::CrankPin => self.crank_pin,
            Pin::SliderPin => self.slider_pin,
        }
    }

    /// The pins among them.
    pub fn pins(self) -> impl Iterator<Item = Pin> {
        Pin::ALL.into_iter().filter(move |&pin| self.contains(pin))
    }
}
