//! The shipped scenes with every choice of clearances, with both drives, at three tolerances, with the default method.

use crate::accuracy::sixteen;
use crate::scenes::{Scenario, contests, directory, ladder, names};
use anyhow::{Context, Result};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::run::End;
use slidercrank::scene::{DriveMode, Method};

const DRIVES: [DriveMode; 2] = [DriveMode::Torque, DriveMode::Speed];
const TOLERANCES: [f64; 3] = [1e-4, 1e-6, 1e-8];
/// Variants of one scene.
const WAYS: usize = 16 * DRIVES.len() * TOLERANCES.len();

fn scenes() -> Vec<String> {
    [names(&directory()), contests(), ladder()].concat()
}

/// Number of all variants.
pub fn count() -> u64 {
    (scenes().len() * WAYS) as u64
}

/// The variant of this number, with a run of `turns` turns and the scene's loads and communication step. If the crank
/// does not turn at the start, the run has the scene's length.
///
/// # Errors
/// If there is no variant of this number, or its scene cannot be read.
pub fn scene_file(number: u64, turns: f64) -> Result<SceneFile> {
    let number = number as usize;
    let (scene, way) = (number / WAYS, number % WAYS);
    let (choice, way) = (way % 16, way / 16);
    let (mode, tolerance) = (DRIVES[way % DRIVES.len()], TOLERANCES[way / DRIVES.len()]);
    let name =
        scenes().into_iter().nth(scene).with_context(|| format!("there is no shipped scene of number {number}"))?;
    let case = sixteen(&Scenario::find(&name)?.file).swap_remove(choice);
    let mut file = case.file;
    file.scene.drive.mode = mode;
    (file.scene.solver.method, file.scene.solver.tolerance) = (Method::default(), tolerance);
    if file.scene.crank.speed_start != 0.0 {
        file.run.end = End::Turns(turns);
    }
    file.description = format!("{name} with play in {}, {} drive, tolerance {tolerance:e}", case.name, mode.name());
    Ok(file)
}
