//! A foreign FMU, compiled from C: the host opens it, runs it, and says clearly what is wrong with a bad one.
#![cfg(target_os = "linux")]

mod command;
mod host;
mod workshop;
