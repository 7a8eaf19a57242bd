//! FMI: a slave for all versions, and a folder for each version of FMI.
//!
//! | folder | contents |
//! |---|---|
//! | [`slave`] | values, experiment, inputs, saved states, errors and log of one slave; independent of the version of FMI |
//! | [`abi`] | the common part of the C interfaces of all versions: borrowed pointers, components, panics, engines |
//! | [`v2`] | FMI 2.0: lifecycle, statuses, C types, exported functions |
//! | [`v3`] | FMI 3.0: the same, with event mode and intermediate update |
//!
//! The folder of a version uses nothing from other versions. It contains
//! - `lifecycle.rs`: the version's [table of calls and states](call_table), which also gives the variables that a
//!   call may use ([`slave::Permission`]);
//! - `instance.rs`: a [`slave::Slave`] with the version's state, each function a safe method;
//! - `abi/`: the version's C types and the one list of its functions.
//!
//! Calls of all versions return the same five [statuses](status).
//!
//! A slave serves co-simulation or model exchange ([`slave::Interface`]): an integrator of ours moves its mechanism, or the
//! importer's does ([`slave::course`]). A version has the rows of both kinds in one table, its `lifecycle.rs`.
//!
//! Dependencies point one way: a version imports [`abi`] and [`slave`], and these import no version.
//! `unsafe` code is only in `abi`, which also catches all panics.
//!
//! A refused call changes nothing: values that are set together are all applied, or none of them, and an instance that
//! returned an error is in the same state as before, so that the importer can correct the call.

pub mod abi;
pub mod call_table;
pub mod slave;
pub mod status;
pub mod v2;
pub mod v3;
