//! Tests of the harness, of what it packages, and of its commands, as one program: it is linked once, and its tests share
//! the processors. `cargo test -p fmu-harness --test all commands::` runs those of one module.

#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
#[macro_use]
mod pytest;

mod browser;
mod campaign;
mod commands;
mod dynamics;
mod effects;
mod foreign;
mod fuzz;
mod hosts;
mod laws;
mod newer;
mod package;
mod peers;
mod picture;
mod platforms;
mod precision;
mod program;
mod python;
mod sweep;
mod wear;
