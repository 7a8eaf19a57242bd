//! A library that comes and goes, through the functions of FMI 3.0.

use crate::brief;
use host::{guid, library, vr};
use libloading::Library;
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::*;
use slidercrank::fmi::v3::abi::types::fmi3Instance;
use std::ptr::{null, null_mut};

/// [s]
const H: f64 = 1e-4;

/// A function of a loaded library that has the type of the linked one.
macro_rules! loaded {
    ($library:ident $name:ident $arguments:tt) => {{
        let mut function: unsafe extern "C" fn $arguments -> _ = $name;
        if let Some(library) = $library {
            // SAFETY: the function of this name has this type.
            function = unsafe { *library.get(stringify!($name).as_bytes()).expect("an exported function") };
        }
        function
    }};
}

/// Where the slider comes to in the linked library, or in a loaded one.
fn run(library: Option<&Library>) -> u64 {
    let make = loaded!(library fmi3InstantiateCoSimulation(_, _, _, _, _, _, _, _, _, _, _, _));
    let enter = loaded!(library fmi3EnterInitializationMode(_, _, _, _, _, _));
    let set_enumeration = loaded!(library fmi3SetInt64(_, _, _, _, _));
    let set = loaded!(library fmi3SetFloat64(_, _, _, _, _));
    let exit = loaded!(library fmi3ExitInitializationMode(_));
    let step = loaded!(library fmi3DoStep(_, _, _, _, _, _, _, _));
    let get = loaded!(library fmi3GetFloat64(_, _, _, _, _));
    let free = loaded!(library fmi3FreeInstance(_));
    let (token, [mut event, mut over, mut early], mut time, mut x) = (guid(), [7; 3], 0.0, f64::NAN);
    // SAFETY: a live instance, strings, arrays of one entry.
    unsafe {
        let slave: fmi3Instance =
            make(c"x".as_ptr(), token.as_ptr(), null(), 0, 0, 0, 0, null(), 0, null_mut(), None, None);
        assert!(!slave.is_null());
        assert_eq!(enter(slave, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
        assert_eq!(set_enumeration(slave, &vr("joint.C.model"), 1, &2, 1), Status::Ok);
        assert_eq!(set(slave, &vr("crank.speed_start"), 1, &500.0, 1), Status::Ok);
        assert_eq!(exit(slave), Status::Ok);
        for _ in 0..20 {
            assert_eq!(step(slave, time, H, 1, &mut event, &mut over, &mut early, &mut time), Status::Ok);
        }
        // A refused call goes through the log and all that it keeps in a thread.
        assert_eq!(step(slave, f64::NAN, H, 1, &mut event, &mut over, &mut early, &mut time), Status::Error);
        assert_eq!(get(slave, &vr("slider.x"), 1, &mut x, 1), Status::Ok);
        free(slave);
    }
    x.to_bits()
}

#[test]
fn a_library_loaded_again_and_again_runs_as_the_linked_one() {
    let linked = run(None);
    for _ in 0..if brief() { 3 } else { 200 } {
        // SAFETY: our own library, whose initializers do nothing.
        let library = unsafe { Library::new(library()) }.expect("a shared library");
        assert_eq!(run(Some(&library)), linked);
        library.close().expect("an unloaded library");
    }
}
