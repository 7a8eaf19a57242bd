//! The FMI face: one slave, and a folder for each version of FMI that importers speak.
//!
//! | folder | what it knows |
//! |---|---|
//! | [`slave`] | values, experiment, inputs, saved states, errors and log of one slave; no version of FMI |
//! | [`v2`] | FMI 2.0: lifecycle, statuses, C types, exported functions |
//! | [`v3`] | FMI 3.0: the same, with event mode and intermediate update |
//!
//! A version has a folder of its own. [`v3`] takes nothing from [`v2`] but the version-neutral part of its C
//! boundary. A folder holds
//! - `lifecycle.rs`: the version's [table of calls and states](call_table), which also says what a call may touch
//!   ([`slave::Permission`]);
//! - `status.rs`: the version's statuses, from [`slave::Severity`];
//! - `instance.rs`: a [`slave::Slave`] with the version's state, each function a safe method;
//! - `abi/`: the version's C types and the one list of its functions, from which the macro of
//!   `v2/abi/declare.rs` makes bodies, exports and types. Pointers are checked by [`v2::abi::borrow`],
//!   a component is lent to one call at a time by [`v2::abi::component`], and panics end in
//!   [`v2::abi::panic_guard`].
//!
//! A slave serves co-simulation or model exchange ([`slave::Interface`]): an integrator of ours moves its mechanism, or the
//! importer's does ([`slave::course`]). The rows of both kinds are in one table, `v2/lifecycle.rs`.
//!
//! Dependencies point one way: a version imports [`slave`], and [`slave`] imports no version.
//! `unsafe` lives in `abi` alone, and no panic crosses it.
//!
//! A refused call changes nothing: values set together are applied all or none, and an instance that
//! answered with an error is where it was before, so that the importer may correct the call.

pub mod call_table;
pub mod slave;
pub mod v2;
pub mod v3;
