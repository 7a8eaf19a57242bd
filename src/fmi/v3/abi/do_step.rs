//! `fmi3DoStep` with its intermediate updates: no borrow of the instance is alive while the importer's callback runs.

use super::super::error::Error;
use super::super::instance::Instance;
use super::super::lifecycle::Call;
use super::super::step::{Done, Stage};
use super::call::{Hosted, answer, call};
use super::types::{fmi3Boolean, fmi3Float64, fmi3Instance};
use crate::fmi::abi::borrow::place;
use crate::fmi::abi::component::{Lent, lend};
use crate::fmi::status::Status;
use std::thread::yield_now;

/// Where the importer wants to have the answers. The places may be one and the same, so they are borrowed one at a time.
#[derive(Clone, Copy)]
pub struct Answers {
    /// `eventHandlingNeeded`
    pub event: *mut fmi3Boolean,
    /// `terminateSimulation`
    pub terminate: *mut fmi3Boolean,
    /// `earlyReturn`
    pub early: *mut fmi3Boolean,
    /// `lastSuccessfulTime`
    pub time: *mut fmi3Float64,
}

impl Answers {
    /// Refuses places that nothing can be written to.
    unsafe fn check(&self) -> Result<(), Error> {
        // SAFETY: the caller vouches for what is behind the pointers; each borrow ends at once.
        unsafe {
            place("eventHandlingNeeded", self.event)?;
            place("terminateSimulation", self.terminate)?;
            place("earlyReturn", self.early)?;
            place("lastSuccessfulTime", self.time)?;
        }
        Ok(())
    }

    /// Writes the answers. The mechanism never asks for the simulation's end.
    unsafe fn write(&self, done: &Done) -> Result<(), Error> {
        // SAFETY: as in `check`.
        unsafe {
            *place("eventHandlingNeeded", self.event)? = done.event.into();
            *place("terminateSimulation", self.terminate)? = 0;
            *place("earlyReturn", self.early)? = done.early.into();
            *place("lastSuccessfulTime", self.time)? = done.time;
        }
        Ok(())
    }
}

/// Moves an instance from the communication point by one step, or to where the step returns early.
///
/// # Safety
/// As [`lend`]; and the answers' places are NULL or the importer's.
pub unsafe fn do_step(instance: fmi3Instance, point: f64, size: f64, answers: &Answers) -> Status {
    let mut stage = None;
    // SAFETY: the caller vouches for all pointers.
    let mut status = unsafe {
        call(instance, Call::DoStep, |instance| {
            answers.check()?;
            instance.begin_step(point, size)?;
            go_on(instance, answers, &mut stage)
        })
    };
    while let Some(Stage::Update(update)) = stage.take() {
        // SAFETY: as above. The loan ends before the callback.
        let callback = unsafe { lend_again(instance) }.instance().update;
        let return_at = callback.and_then(|callback| callback.call(&update));
        // SAFETY: as above.
        let mut lent = unsafe { lend_again(instance) };
        status = answer(&mut lent, Call::DoStep.name(), &mut |instance| {
            instance.end_update(return_at);
            // SAFETY: as above.
            unsafe { go_on(instance, answers, &mut stage) }.map(Into::into)
        });
    }
    status
}

/// One part of the step; its answers if it is the last one.
unsafe fn go_on(instance: &mut Instance, answers: &Answers, stage: &mut Option<Stage>) -> Result<(), Error> {
    let next = instance.go_on()?;
    *stage = Some(next);
    match next {
        // SAFETY: the caller vouches for the places.
        Stage::Done(done) => unsafe { answers.write(&done) },
        Stage::Update(_) => Ok(()),
    }
}

/// Lends an instance whose step is under way. In an intermediate update nothing can free the instance, so a call of
/// another thread that keeps it busy is waited for.
unsafe fn lend_again<'a>(instance: fmi3Instance) -> Lent<'a, Hosted> {
    loop {
        // SAFETY: the instance was lent before and could not be freed since.
        if let Some(lent) = unsafe { lend::<Hosted>(instance) } {
            return lent;
        }
        yield_now();
    }
}
