//! A shipped scene on one platform: its packaged library, and commands to the importer.

use super::machine::{Answer, run};
use fmu_harness::host::{Archive, Description, Kind, Variable};
use fmu_harness::inputs;
use fmu_harness::package::Stock;
use fmu_harness::package::Version;
use fmu_harness::package::platform::Platform;
use fmu_harness::scenes::Scenario;
use slidercrank::scene::profile::Chord;
use slidercrank::scene::run::End;
use std::fmt::Write;
use std::fs;
use std::ops::Range;
use std::path::Path;
use tempfile::TempDir;

/// Communication steps of a run.
pub const STEPS: usize = 20;

/// The packaged library of a scene, unpacked.
pub struct Packaged {
    platform: Platform,
    scenario: Scenario,
    description: Description,
    folder: TempDir,
}

impl Packaged {
    pub fn new(platform: Platform, stock: &Stock, scene: &str) -> Self {
        let scenario = Scenario::find(scene).expect("a shipped scene");
        let folder = TempDir::new().expect("a folder");
        let file = folder.path().join("scene.fmu");
        stock.package(&scenario).expect("a package").save(&file).expect("written");
        let mut archive = Archive::open(&file).expect("an archive");
        archive.unpack(folder.path()).expect("unpacked");
        let library = format!("SliderCrank{}", platform.affixes().1);
        let binary = folder.path().join("binaries").join(Version::Fmi2.folders(platform)[0]).join(&library);
        fs::rename(binary, folder.path().join(library)).expect("the library");
        let description = Description::parse(&archive.description().expect("a text")).expect("a description");
        Self { platform, scenario, description, folder }
    }

    /// From the start, all steps; the state is saved to `saved` before the step of this number if told.
    pub fn run_from_start(&self, settings: &[(&str, i32)], save: Option<(usize, &Path)>) -> Answer {
        let mut commands = String::new();
        for (name, value) in settings {
            let variable = self.description.variable(name).expect("a variable");
            writeln!(commands, "setInteger {} {value}", variable.reference).expect("room");
        }
        self.write_inputs(&mut commands, 0.0, self.step());
        writeln!(commands, "start {}", bits(0.0)).expect("room");
        match save {
            None => self.write_steps(&mut commands, 0..STEPS),
            Some((step, file)) => {
                self.write_steps(&mut commands, 0..step);
                writeln!(commands, "save {}", file.display()).expect("room");
                self.write_steps(&mut commands, step..STEPS);
            }
        }
        self.run(&commands)
    }

    /// The steps from this one on, from the state in a file.
    pub fn run_from_state(&self, file: &Path, step: usize) -> Answer {
        let mut commands = format!("restore {}\n", file.display());
        self.write_steps(&mut commands, step..STEPS);
        self.run(&commands)
    }

    /// Names and values of an enumeration.
    pub fn items(&self, variable: &str) -> Vec<(String, i32)> {
        let variable = self.description.variable(variable).expect("a variable");
        self.description.items(variable).to_vec()
    }

    fn run(&self, commands: &str) -> Answer {
        run(self.platform, self.folder.path(), self.description.model.get("guid").expect("a guid"), commands)
    }

    fn write_steps(&self, commands: &mut String, steps: Range<usize>) {
        let step = self.step();
        for number in steps {
            let time = number as f64 * step;
            self.write_inputs(commands, time, step);
            writeln!(commands, "doStep {} {}", bits(time), bits(step)).expect("room");
            for output in self.outputs() {
                let getter = if output.kind == Kind::Real { "getReal" } else { "getInteger" };
                writeln!(commands, "{getter} {}", output.reference).expect("room");
            }
        }
    }

    fn write_inputs(&self, commands: &mut String, time: f64, step: f64) {
        let crank = &self.scenario.file.scene.crank;
        // About the crank's angle and speed: an input may depend on them, and may be anything.
        let angle = crank.angle_start + crank.speed_start * time;
        for input in inputs::of_scene(&self.scenario.file.inputs) {
            let reference = self.description.variable(&input.name).expect("an input").reference;
            let Chord { value, slope } = input.profile.chord([time, time + step], angle, crank.speed_start);
            writeln!(commands, "setReal {reference} {}", bits(value)).expect("room");
            writeln!(commands, "setSlope {reference} {}", bits(slope)).expect("room");
        }
    }

    /// [s] Of half a turn, or of a twentieth of a scene that has none.
    fn step(&self) -> f64 {
        let run = &self.scenario.file.run;
        let stop = run.stop(&self.scenario.file.scene);
        let span = if let End::Turns(turns) = run.end { 0.5 * stop / turns } else { stop / 20.0 };
        span / STEPS as f64
    }

    /// Those of the mechanism and the counts of the integrator's work.
    fn outputs(&self) -> impl Iterator<Item = &Variable> {
        let kinds = [Kind::Real, Kind::Integer, Kind::Enumeration];
        let variables = self.description.variables.iter();
        variables.filter(move |variable| variable.causality() == "output" && kinds.contains(&variable.kind))
    }
}

fn bits(number: f64) -> String {
    format!("{:016x}", number.to_bits())
}
