//! Functions beside those of FMI 3.0, for estimators. They are allowed where `fmi3DoStep` is; a refused call changes
//! nothing. `fmu-harness/docs/guide.md` has their C prototypes.
//!
//! # Safety
//! As of the [functions](super::functions) of the standard.
#![allow(clippy::missing_safety_doc, reason = "said above, once")]

use super::super::lifecycle::Call;
use super::call::call_as;
use crate::fmi::abi::estimation::{self, estimators};
use crate::fmi::status::Status;
use std::ffi::{c_char, c_void};

estimators!(slidercrank_fmi3_phase_names slidercrank_fmi3_step_jacobian slidercrank_fmi3_set_phase);
