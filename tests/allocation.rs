//! No allocation between initialization and termination: steps with contacts opening and closing,
//! inputs with slopes, outputs, derivatives and sensitivities.
#![allow(unsafe_code, reason = "a counting allocator, and calls of the C functions")]

use slidercrank::fmi::slave::Slave;
use slidercrank::fmi::slave::variables::{Access, VARIABLES};
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::abi::functions::bodies::*;
use slidercrank::fmi::v2::abi::types::*;
use slidercrank::scene::{JointModel, Scene, slot};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ffi::CString;
use std::ptr::{null, null_mut};

thread_local! {
    /// Allocations of this thread.
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, counting.
struct Counting;

// SAFETY: everything is the system's.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn vr(name: &str) -> u32 {
    let index = VARIABLES.iter().position(|variable| variable.name == name);
    u32::try_from(index.expect("a variable")).expect("few variables")
}

/// Runs a scene with clearance in the named joints; allocations on the way, and events.
fn run(joints: &[&str], method: i32) -> (usize, i32) {
    let guid = CString::new(slot::read().expect("a readable slot").1).expect("no zero");
    let callbacks = fmi2CallbackFunctions {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: null_mut(),
    };
    let outputs: Vec<u32> = (0..)
        .zip(VARIABLES)
        .filter(|(_, variable)| matches!(variable.access, Access::RealOutput(_)))
        .map(|(reference, _)| reference)
        .collect();
    let mut values = vec![0.0; outputs.len()];
    let orders = vec![1; outputs.len()];
    let (torque, load) = (vr("crank.torque"), vr("slider.load"));
    let (count, ok) = (outputs.len(), Status::Ok);
    // SAFETY: a live component, arrays of the lengths said.
    unsafe {
        let c = fmi2Instantiate(c"x".as_ptr(), 1, guid.as_ptr(), null(), &raw const callbacks, 0, 1);
        assert_eq!(fmi2SetReal(c, &vr("crank.speed_start"), 1, &300.0), ok);
        assert_eq!(fmi2SetInteger(c, &vr("solver.method"), 1, &method), ok);
        for joint in joints {
            assert_eq!(fmi2SetInteger(c, &vr(&format!("joint.{joint}.model")), 1, &2), ok);
        }
        assert_eq!(fmi2EnterInitializationMode(c), ok);
        assert_eq!(fmi2ExitInitializationMode(c), ok);
        let (mut point, step) = (0.0, 1e-4);
        let before = COUNT.get();
        for i in 0..200 {
            let value = f64::from(i % 7);
            assert_eq!(fmi2SetReal(c, &load, 1, &value), ok);
            assert_eq!(fmi2SetRealInputDerivatives(c, &torque, 1, &1, &value), ok);
            assert_eq!(fmi2DoStep(c, point, step, 1), ok);
            assert_eq!(fmi2GetReal(c, outputs.as_ptr(), count, values.as_mut_ptr()), ok);
            let rates = fmi2GetRealOutputDerivatives(c, outputs.as_ptr(), count, orders.as_ptr(), values.as_mut_ptr());
            assert_eq!(rates, ok);
            let along = fmi2GetDirectionalDerivative(c, outputs.as_ptr(), count, &load, 1, &1.0, values.as_mut_ptr());
            assert_eq!(along, ok);
            point += step;
        }
        let allocations = COUNT.get() - before;
        let mut events = 0;
        assert_eq!(fmi2GetInteger(c, &vr("solver.events"), 1, &mut events), ok);
        fmi2FreeInstance(c);
        (allocations, events)
    }
}

#[test]
fn steps_with_events_do_not_allocate() {
    for method in [1, 2, 3, 8] {
        for joints in [&[][..], &["C"], &["T"], &["A", "B", "C", "T"]] {
            let (allocations, events) = run(joints, method);
            assert_eq!(allocations, 0, "{joints:?}, method {method}");
            assert!(joints.is_empty() || events > 1, "{joints:?}: {events} events");
        }
    }
}

/// What an integrator of model exchange calls again and again, with contacts that close and open.
#[test]
fn model_exchange_does_not_allocate() {
    let mut scene = Scene::default();
    let joint = &mut scene.joint;
    for model in [&mut joint.a.model, &mut joint.b.model, &mut joint.c.model, &mut joint.t.model] {
        *model = JointModel::Clearance;
    }
    let mut slave = Slave::for_exchange(scene).expect("equations for another integrator");
    slave.initialize().expect("a start");
    let (states, indicators) = (slave.state_count().expect("states"), slave.indicator_count().expect("indicators"));
    let (mut y, mut rates, mut gaps) = (vec![0.0; states], vec![0.0; states], vec![0.0; indicators]);
    slave.write_states(&mut y).expect("states");
    let (start, before) = (y[0], COUNT.get());
    let mut closings = 0;
    for step in 0..200 {
        // To and fro across the main bearing's play.
        y[0] = start + 1e-3 * f64::from(step % 2);
        slave.set_time(1e-5 * f64::from(step)).expect("a time");
        slave.set_states(&y).expect("states");
        slave.write_derivatives(&mut rates).expect("rates");
        slave.write_indicators(&mut gaps).expect("indicators");
        closings += usize::from(slave.update_is_due().expect("an answer"));
        slave.update_discrete_states().expect("an update");
    }
    assert_eq!(COUNT.get() - before, 0);
    assert!(closings > 100, "{closings} closings and openings");
}
