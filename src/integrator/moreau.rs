//! Moreau's midpoint rule: time stepping for rigid contacts, with Newton's restitution and Coulomb's friction (J. J.
//! Moreau, in Nonsmooth Mechanics and Applications, CISM 302, Springer 1988; M. Jean, Comput. Methods Appl. Mech. Eng.
//! 177 (1999) 235; applied to a slider-crank by P. Flores, R. Leine, C. Glocker, Multibody Syst. Dyn. 23 (2010) 165).
//!
//! A step of h from (q_A, u_A): q_M = q_A + (h/2)·u_A; the contacts with a gap ≤ 0 at q_M are closed;
//! M(q_M)·(u_E − u_A) = h·f + W_N·Λ_N + W_T·Λ_T, where ξ_N = γ_NE + e_N·γ_NA ≥ 0 is complementary to Λ_N ≥ 0 and
//! −Λ_T ∈ μ·Λ_N·Sgn(γ_TE); q_E = q_M + (h/2)·u_E. Impacts are not located: a step may hold several, and a lasting
//! contact is an impact in every step.
//!
//! Forces f that depend on velocity are taken at u_A + (h/2)·M⁻¹·f, not at u_A: so the rule is of order 2 where nothing
//! touches. Where an impact happens it errs by what is passed in a step, order 1.
//!
//! Penetration: an impact is noticed within a step and goes as deep as its approach in that time. A lasting contact is
//! kept by its velocity: on a curved surface each step leaves along the tangent, and this drift of (h·v_T)²/(2·radius) a
//! step, with what an impact left behind, is taken back in the position of least kinetic distance, down to what one
//! step gathers, h·|γ_N|, which is of order h². Less would make contacts open and close from step to step; a gap
//! that opens is never closed by it. Contacts that part are left alone: their energy is not touched.

use super::complementarity::{MOST_CONTACTS, NORMAL, Pairs, TANGENTIAL, Touching};
use super::error::IntegrationError;
use super::memory::{Front, Memory};
use super::problem::Extent;
use super::statistics::Statistics;
use super::step::{STEPS, lost_state};
use super::unilateral::{ContactLaw, Impulses, Unilateral};

/// Share of a just noticeable length that a lasting contact is pressed in: it keeps rounding from opening it.
const SKIN: f64 = 1e-6;

/// Time stepping with a fixed step.
pub struct Moreau<const N: usize> {
    step: f64,
    memory: Memory<N, Impulses<N>>,
}

/// An attempted step.
struct Made<const N: usize> {
    y: [f64; N],
    impulses: Impulses<N>,
    evaluations: u64,
}

/// The step up to its contacts: what they are solved from.
struct Middle<const N: usize> {
    t: f64,
    y: [f64; N],
    /// Velocities at the step's end without contacts, at the middle's positions.
    free: [f64; N],
}

/// The closed contacts of a step, in the order in which they are solved for.
struct Closed<const N: usize> {
    contacts: [usize; MOST_CONTACTS],
    touching: Touching,
    response: [[[f64; N]; 2]; MOST_CONTACTS],
    /// γ_NA and γ_N of the step without contacts.
    approach: [[f64; 2]; MOST_CONTACTS],
}

impl<const N: usize> Moreau<N> {
    /// Starts from the state `y` at `t` with steps of `step` [s].
    pub fn start<P>(problem: &P, step: f64, t: f64, y: [f64; N]) -> Self
    where
        P: Unilateral<N, Modes: Default> + ?Sized,
    {
        let mut front = Front { t, y, rates: [0.0; N], modes: Impulses::none(t, y) };
        problem.rates(&P::Modes::default(), t, &y, &mut front.rates);
        let statistics = Statistics { evaluations: 1, ..Statistics::default() };
        Self::resume(
            step,
            Memory { start: front, end: front, front, step, last_error: 0.0, crossings: 0, statistics },
        )
    }

    /// Goes on from a saved state.
    pub fn resume(step: f64, memory: Memory<N, Impulses<N>>) -> Self {
        Self { step, memory }
    }

    /// All that is needed to go on.
    pub fn memory(&self) -> &Memory<N, Impulses<N>> {
        &self.memory
    }

    /// Steps until `t` lies within the last step.
    ///
    /// # Errors
    /// See [`IntegrationError`]; the state at the error's time is intact.
    pub fn advance<P>(&mut self, problem: &P, t: f64) -> Result<(), IntegrationError>
    where
        P: Unilateral<N, Modes: Default> + ?Sized,
    {
        for _ in 0..STEPS {
            let start = self.memory.front;
            if start.t >= t {
                return Ok(());
            }
            // The step is what time really moves by: nothing drifts from its rounding.
            let end = start.t + self.step.min(problem.longest_step());
            if end <= start.t {
                return Err(IntegrationError::StepUnderflow { time: start.t, step: self.step, component: 0 });
            }
            let made = attempt(problem, &start, end - start.t)?;
            self.memory.start = start;
            self.commit(end, made, problem);
        }
        Err(IntegrationError::TooManySteps { time: self.memory.front.t, steps: STEPS })
    }

    /// State at `t` in the last step, and the step's impulses. Velocities change evenly within a step, at impacts too.
    pub fn state_at<P>(&self, problem: &P, t: f64) -> ([f64; N], Impulses<N>)
    where
        P: Unilateral<N> + ?Sized,
    {
        let Memory { end, front, .. } = &self.memory;
        if t >= front.t {
            return (front.y, front.modes);
        }
        let step = self.memory.last_step(Extent::of(problem));
        (step.state((t - step.t) / step.h, &None), end.modes)
    }

    /// Takes back what lies beyond `t` in the last step: the front is at `t` again, reached by a step of its own, or
    /// by interpolation should that step fail. Contact forces stay those of the whole step: the impulses of a part
    /// over its length may be of any size. To be called with the problem that made the step.
    pub fn rewind<P>(&mut self, problem: &P, t: f64)
    where
        P: Unilateral<N, Modes: Default> + ?Sized,
    {
        let Memory { start, end, front, .. } = self.memory;
        if t >= front.t {
            return;
        }
        self.memory.statistics = self.memory.statistics_at(t);
        self.memory.statistics.steps -= 1;
        self.memory.crossings = 0;
        if t <= start.t {
            (self.memory.front, self.memory.end) = (start, start);
            return;
        }
        let made = attempt(problem, &start, t - start.t).unwrap_or_else(|_| {
            let (y, impulses) = self.state_at(problem, t);
            Made { y, impulses: Impulses { closed: start.modes.closed, ..impulses }, evaluations: 0 }
        });
        let impulses = Impulses { closed: made.impulses.closed, ..end.modes };
        self.commit(t, Made { impulses, ..made }, problem);
    }

    /// Makes `made` the step that ends at `t`.
    fn commit<P: Unilateral<N> + ?Sized>(&mut self, t: f64, made: Made<N>, problem: &P) {
        let Made { y, impulses, evaluations } = made;
        let start = &mut self.memory.start;
        let changes = impulses.closed.iter().zip(start.modes.closed).filter(|(now, before)| **now != *before).count();
        let mut end = Front { t, y, rates: [0.0; N], modes: impulses };
        let h = t - start.t;
        let p = Extent::of(problem).positions;
        for i in 0..p {
            let acceleration = (y[p + i] - start.y[p + i]) / h;
            (start.rates[i], end.rates[i]) = (start.y[p + i], y[p + i]);
            (start.rates[p + i], end.rates[p + i]) = (acceleration, acceleration);
        }
        self.memory.end = end;
        self.memory.front = end;
        self.memory.crossings = changes as u64;
        let statistics = &mut self.memory.statistics;
        statistics.steps += 1;
        statistics.evaluations += evaluations;
        statistics.events += changes as u64;
    }
}

/// A step of `h` from `start`.
fn attempt<const N: usize, P>(
    problem: &P,
    start: &Front<N, Impulses<N>>,
    h: f64,
) -> Result<Made<N>, IntegrationError>
where
    P: Unilateral<N, Modes: Default> + ?Sized,
{
    let time = start.t;
    let p = Extent::of(problem).positions;
    let middle = Middle::new(problem, start, h);
    let mut made =
        Made { y: middle.free, impulses: Impulses::none(middle.t, middle.y), evaluations: 2 };
    let closed = Closed::new(problem, start, &middle, h);
    let count = closed.touching.count;
    let mut impulses = Pairs::default();
    if count > 0 {
        made.evaluations += closed.responses();
        impulses = closed.solve().ok_or(IntegrationError::Complementarity { time, contacts: count })?;
        for (slot, impulse) in impulses.iter().enumerate().take(count) {
            for (response, impulse) in closed.response[slot].iter().zip(impulse) {
                for i in p..2 * p {
                    made.y[i] += response[i] * impulse;
                }
            }
            let contact = closed.contacts[slot];
            made.impulses.forces[contact] = impulse.map(|impulse| impulse / h);
            made.impulses.closed[contact] = impulse[NORMAL] > 0.0;
        }
    }
    for i in 0..p {
        made.y[i] = middle.y[i] + 0.5 * h * made.y[p + i];
    }
    if count > 0 {
        closed.press_back(problem, time + h, h, &impulses, &mut made.y);
    }
    match lost_state(problem, &made.y) {
        None => Ok(made),
        Some(component) => Err(IntegrationError::NotFinite { time, component }),
    }
}

impl<const N: usize> Middle<N> {
    fn new<P>(problem: &P, start: &Front<N, Impulses<N>>, h: f64) -> Self
    where
        P: Unilateral<N, Modes: Default> + ?Sized,
    {
        let p = Extent::of(problem).positions;
        let t = start.t + 0.5 * h;
        let mut y = start.y;
        for i in 0..p {
            y[i] += 0.5 * h * start.y[p + i];
        }
        let without = P::Modes::default();
        let mut rates = [0.0; N];
        problem.rates(&without, t, &y, &mut rates);
        let mut moving = y;
        for i in p..2 * p {
            moving[i] += 0.5 * h * rates[i];
        }
        problem.rates(&without, t, &moving, &mut rates);
        let mut free = y;
        for i in p..2 * p {
            free[i] += h * rates[i];
        }
        Self { t, y, free }
    }

    /// Velocities in the contacts where a step of `h` without contacts ends.
    fn end<P: Unilateral<N> + ?Sized>(&self, problem: &P, h: f64) -> Pairs {
        let p = Extent::of(problem).positions;
        let mut y = self.free;
        for i in 0..p {
            y[i] += 0.5 * h * self.free[p + i];
        }
        problem.contacts(self.t + 0.5 * h, &y).velocity
    }
}

impl<const N: usize> Closed<N> {
    /// The contacts that are closed at the middle of the step.
    fn new<P: Unilateral<N> + ?Sized>(
        problem: &P,
        start: &Front<N, Impulses<N>>,
        middle: &Middle<N>,
        h: f64,
    ) -> Self {
        let mut closed = Self {
            contacts: [0; MOST_CONTACTS],
            touching: Touching::default(),
            response: [[[0.0; N]; 2]; MOST_CONTACTS],
            approach: [[0.0; 2]; MOST_CONTACTS],
        };
        let before = problem.contacts(start.t, &start.y);
        for (contact, (gap, velocity)) in before.gap.iter().zip(&before.velocity).enumerate() {
            if gap + 0.5 * h * velocity[NORMAL] <= 0.0 {
                closed.contacts[closed.touching.count] = contact;
                closed.touching.count += 1;
            }
        }
        if closed.touching.count > 0 {
            closed.linearize(problem, middle, &before.velocity, &middle.end(problem, h));
        }
        closed
    }

    fn linearize<P: Unilateral<N> + ?Sized>(&mut self, problem: &P, middle: &Middle<N>, before: &Pairs, free: &Pairs) {
        let p = Extent::of(problem).positions;
        let laws = problem.contact_laws();
        let velocities = |rates: &[f64; N]| {
            let mut y = middle.y;
            y[p..2 * p].copy_from_slice(&rates[p..2 * p]);
            problem.contacts(middle.t, &y).velocity
        };
        let still = velocities(&[0.0; N]);
        let count = self.touching.count;
        for (slot, &contact) in self.contacts.iter().enumerate().take(count) {
            let ContactLaw { restitution, friction } = laws[contact];
            let [arriving, leaving] = [before[contact][NORMAL], free[contact][NORMAL]];
            self.approach[slot] = [arriving, leaving];
            self.touching.bias[slot] = [leaving + restitution * arriving, free[contact][TANGENTIAL]];
            self.touching.friction[slot] = friction;
            for part in self.parts(slot) {
                let response = problem.response(middle.t, &middle.y, contact, part);
                let moved = velocities(&response);
                for (other, &to) in self.contacts.iter().enumerate().take(count) {
                    for a in [NORMAL, TANGENTIAL] {
                        self.touching.delassus[other][a][slot][part] = moved[to][a] - still[to][a];
                    }
                }
                self.response[slot][part] = response;
            }
        }
    }

    /// The parts in which a contact may exert an impulse: without friction, its normal.
    fn parts(&self, slot: usize) -> std::ops::Range<usize> {
        NORMAL..if self.touching.friction[slot] > 0.0 { TANGENTIAL + 1 } else { TANGENTIAL }
    }

    fn responses(&self) -> u64 {
        (0..self.touching.count).map(|slot| self.parts(slot).len() as u64).sum()
    }

    /// The impulses of the laws. A wedge that friction locks may have none that returns speed; it has one that
    /// returns nothing.
    fn solve(&self) -> Option<Pairs> {
        self.touching.impulses().or_else(|| {
            let mut plastic = self.touching.clone();
            for (bias, approach) in plastic.bias.iter_mut().zip(&self.approach).take(plastic.count) {
                bias[NORMAL] = approach[1];
            }
            plastic.impulses()
        })
    }

    /// Moves the positions in `y` out of the penetration of lasting contacts, down to what a step gathers. Where
    /// there is no way out, as in a jam, they stay.
    fn press_back<P: Unilateral<N> + ?Sized>(
        &self,
        problem: &P,
        t: f64,
        h: f64,
        impulses: &Pairs,
        y: &mut [f64; N],
    ) {
        let gaps = problem.contacts(t, y).gap;
        let mut places = self.touching.clone();
        places.friction = [0.0; MOST_CONTACTS];
        let mut deep = false;
        for slot in 0..places.count {
            let [arriving, leaving] = self.approach[slot].map(f64::abs);
            let least = -(SKIN * problem.guard_scale() + h * arriving.max(leaving));
            let spare = gaps[self.contacts[slot]] - least;
            let lasting = impulses[slot][NORMAL] > 0.0;
            places.bias[slot] = [if lasting { spare } else { spare.max(0.0) }, 0.0];
            deep |= lasting && spare < 0.0;
        }
        let Some(shifts) = deep.then(|| places.impulses()).flatten() else {
            return;
        };
        let p = Extent::of(problem).positions;
        for (response, shift) in self.response.iter().zip(shifts).take(places.count) {
            for i in 0..p {
                y[i] += response[NORMAL][p + i] * shift[NORMAL];
            }
        }
    }
}
