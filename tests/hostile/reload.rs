//! A library that comes and goes, with instances in between and without regard to them.

use crate::brief;
use host::api::Api;
use host::{Slave, library};
use libloading::Library;
use slidercrank::fmi::v2::Status;

/// [s]
const H: f64 = 1e-4;

fn load() -> (Library, Api) {
    // SAFETY: our own library, whose initializers do nothing.
    let library = unsafe { Library::new(library()) }.expect("a shared library");
    let api = Api::loaded(&library).expect("all functions");
    (library, api)
}

/// An instance of a loaded library after some steps.
fn run(api: Api) -> Slave {
    let slave = Slave::of(api, "slave", true);
    assert_eq!(slave.enter(), Status::Ok);
    slave.wear();
    assert_eq!(slave.exit(), Status::Ok);
    slave.steps(0.0, H, 20);
    slave
}

#[test]
fn a_library_loaded_again_and_again_runs_as_the_linked_one() {
    let linked = run(Api::linked()).picture();
    for _ in 0..if brief() { 3 } else { 200 } {
        let (library, api) = load();
        assert_eq!(run(api).picture(), linked);
        library.close().expect("an unloaded library");
    }
}

#[test]
fn instances_outlive_a_host_that_closes_the_library_too_early() {
    let (library, api) = load();
    let slave = run(api);
    library.close().expect("an unloaded library");
    // The library asks to stay in memory: otherwise the next line would be the last one.
    slave.steps(slave.last_time(), H, 5);
    let (again, _) = load();
    slave.steps(slave.last_time(), H, 5);
    again.close().expect("an unloaded library");
    let linked = run(Api::linked());
    linked.steps(linked.last_time(), H, 10);
    assert_eq!(slave.picture(), linked.picture());
}

#[test]
fn threads_may_end_after_the_library_that_they_used() {
    let threads: Vec<_> = (0..4)
        .map(|_| {
            let (closed, wait) = std::sync::mpsc::channel::<()>();
            let thread = std::thread::spawn(move || {
                let (library, api) = load();
                let slave = run(api);
                // A refused call goes through the log and all that it keeps in a thread.
                assert_eq!(slave.step(f64::NAN, H), Status::Error);
                drop(slave);
                library.close().expect("an unloaded library");
                wait.recv().expect("the word to end");
            });
            (closed, thread)
        })
        .collect();
    for (closed, thread) in threads {
        closed.send(()).expect("a thread that waits");
        thread.join().expect("a thread that ends well");
    }
}
