//! The cases and what must hold of each. Figures behind a claim are what was measured, and leave a margin.

use crate::claims::Holds::{self, Also, Depth, Ends, Energy, Rests, Statistics, Work};
use crate::claims::check;
use crate::{run, special};

/// The error of a mechanism with ideal joints at the end of its rod's reach.
const REACH: &str = "the rod stands across the guide";

/// A test for every case, and their names.
macro_rules! cases {
    ($($name:ident: [$($claim:expr),+ $(,)?])+) => {
        $(#[test]
        fn $name() {
            let claims: &[Holds] = &[$($claim),+];
            check(&stringify!($name).replace('_', "-"), claims);
        })+
        const NAMES: &[&str] = &[$(stringify!($name)),+];
    };
}

cases! {
    blanking: [Energy(1e-8), Depth(2.0), Work(250_000)]
    bristles_and_a_mode: [Depth(2.0), Work(80_000)]
    bristles_fast: [Depth(2.0), Work(90_000)]
    bristles_in_a_press: [Depth(2.0), Work(100_000)]
    bristles_under_load: [Depth(2.0), Work(60_000)]
    buckling: [Energy(1e-7), Work(10_000), Also(special::sags_and_swings)]
    chatter: [Energy(1e-7), Depth(2.0), Work(30_000), Rests(1e-6), Also(special::calms_down)]
    crawling: [Depth(2.0), Work(70_000)]
    creeping: [Depth(2.0), Work(1_100_000)]
    dead_centre_worn: [Energy(1e-8), Depth(2.0), Work(100_000)]
    deep_start: [Energy(1e-7), Depth(2.0), Work(500_000), Also(special::lets_go)]
    equal: [Energy(1e-5), Ends(REACH), Work(1_000)]
    equal_worn: [Energy(1e-6), Depth(6.0), Work(1_200_000)]
    fast: [Energy(1e-8), Depth(2.0), Work(500_000)]
    five_modes_pressed: [Depth(2.0), Work(180_000)]
    friction: [Energy(1e-7), Depth(2.0), Work(1_500_000)]
    grazing: [Energy(1e-7), Depth(2.0), Work(10_000), Rests(1e-6), Also(special::calms_down)]
    grazing_unlimited: [Energy(1e-8), Depth(2.0), Work(100_000)]
    hour: [Energy(1e-6), Work(15_000_000), Also(special::keeps_time)]
    inner_dead_centre: [Energy(1e-8), Work(10_000), Also(special::stands_and_falls)]
    jammed: [Energy(1e-7), Depth(2.0), Work(5_000_000), Also(special::is_jammed)]
    jumps: [Energy(1e-8), Depth(2.0), Work(300_000), Also(special::jumps_count)]
    longsteps: [Energy(1e-6), Depth(2.0), Work(20_000_000), Also(special::any_step_will_do)]
    loose_main_bearing: [Depth(2.0), Work(3_000), Also(special::touches_are_noticed)]
    nanosteps: [Energy(1e-7), Depth(2.0), Work(700), Also(special::any_step_will_do)]
    nearly_equal: [Energy(1e-5), Work(30_000), Also(special::goes_round)]
    oil_blows: [Energy(1e-6), Work(2_000_000)]
    outer_dead_centre: [Energy(0.0), Work(10_000), Also(special::stands)]
    pressed_everywhere: [Depth(2.0), Work(400_000)]
    rattle: [Work(9_000_000), Depth(2.0), Statistics]
    rattle_everywhere: [Work(15_000_000), Depth(2.0), Statistics]
    restitution: [Energy(1e-6), Depth(2.0), Work(4_000_000)]
    rolling: [Energy(1e-8), Depth(2.0), Work(8_000_000), Also(special::rolls_round)]
    short: [Energy(1e-5), Ends(REACH), Work(2_000)]
    short_driven: [Ends(REACH), Work(1_000)]
    short_elastic: [Energy(1e-6), Ends(REACH), Work(150_000)]
    sixteen_modes: [Energy(1e-8), Depth(2.0), Work(50_000)]
    slow: [Energy(1e-8), Depth(2.0), Work(300_000)]
    small_and_large: [Energy(1e-8), Depth(2.0), Work(600_000)]
    sticking: [Energy(1e-7), Depth(2.0), Work(15_000), Rests(1e-9), Also(special::sticks)]
    stiffness: [Energy(1e-8), Depth(2.0), Work(1_200_000)]
    thick_oil: [Energy(1e-6), Work(2_000_000)]
    three_pins_tight: [Depth(2.0), Work(800_000)]
    torque_step: [Energy(1e-8), Depth(2.0), Work(300_000), Also(special::has_one_spike)]
    worn_pin_tight: [Depth(2.0), Work(110_000)]
}

#[test]
fn every_scene_file_has_its_row() {
    let entries = std::fs::read_dir(run::folder("cases")).expect("the folder of cases").flatten();
    let mut files: Vec<String> =
        entries.map(|entry| entry.path().file_stem().unwrap_or_default().to_string_lossy().replace('-', "_")).collect();
    files.sort();
    assert_eq!(files, NAMES);
}
