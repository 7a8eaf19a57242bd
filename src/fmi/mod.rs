//! The FMI face: one slave, and a folder for each version of FMI that importers speak.
//!
//! | folder | what it knows |
//! |---|---|
//! | [`slave`] | values, experiment, inputs, saved states, errors and log of one slave; no version of FMI |
//! | [`abi`] | what the C interfaces of all versions have in common: borrowed pointers, components, panics, engines |
//! | [`v2`] | FMI 2.0: lifecycle, statuses, C types, exported functions |
//! | [`v3`] | FMI 3.0: the same, with event mode and intermediate update |
//!
//! A version has a folder of its own, and takes nothing from another. A folder holds
//! - `lifecycle.rs`: the version's [table of calls and states](call_table), which also says what a call may touch
//!   ([`slave::Permission`]);
//! - `instance.rs`: a [`slave::Slave`] with the version's state, each function a safe method;
//! - `abi/`: the version's C types and the one list of its functions.
//!
//! Calls of all versions answer with the same five [statuses](status).
//!
//! A slave serves co-simulation or model exchange ([`slave::Interface`]): an integrator of ours moves its mechanism, or the
//! importer's does ([`slave::course`]). A version has the rows of both kinds in one table, its `lifecycle.rs`.
//!
//! Dependencies point one way: a version imports [`abi`] and [`slave`], and these import no version.
//! `unsafe` lives in `abi` alone, and no panic crosses it.
//!
//! A refused call changes nothing: values set together are applied all or none, and an instance that
//! answered with an error is where it was before, so that the importer may correct the call.

pub mod abi;
pub mod call_table;
pub mod slave;
pub mod status;
pub mod v2;
pub mod v3;
