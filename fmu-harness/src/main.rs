//! The command line. Without a command it packages a scene, runs the package and reports.

use clap::{Parser, Subcommand};
use fmu_harness::command::{
    Accuracy, Campaign, Dynamics, Effects, Inspect, Laws, Package, Peers, Precision, Realtime, Report, Run,
    Sensitivity, Ssp, Sweep, Wear,
};
use std::process::ExitCode;

/// Builds, packages and runs the slider-crank FMU.
///
/// Without a command: packages the scene as an FMU, loads the file as a host does, runs 20 crank turns of it and of the
/// same mechanism with ideal joints, prints a table, and writes the FMU, a CSV file and figures.
#[derive(Parser)]
#[command(version, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    run: Run,
}

#[derive(Subcommand)]
enum Command {
    /// Packages a scene as an FMU
    Package(Package),
    /// Runs a scene, or any co-simulation FMU of FMI 2.0 or 3.0
    Run(Run),
    /// Prints what an FMU declares
    Inspect(Inspect),
    /// Shows the effect of clearances on the slider's motion
    Accuracy(Accuracy),
    /// Compares the contact laws: peak forces and errors by elasticity and damping law
    Laws(Laws),
    /// Classifies the motion over many turns: periodic or chaotic
    Dynamics(Dynamics),
    /// Measures the cost of every effect
    Effects(Effects),
    /// Measures what other programs need for the same scene
    Peers(Peers),
    /// Measures the cost of accuracy
    Precision(Precision),
    /// Measures the time of single communication steps
    Realtime(Realtime),
    /// Makes one page of a scene, with an animation and figures that can be zoomed
    Report(Report),
    /// Tests randomly drawn scenes
    Campaign(Campaign),
    /// Writes the press with its controller as an SSP package
    Ssp(Ssp),
    /// Differentiates quantities of a run by parameters
    Sensitivity(Sensitivity),
    /// Runs a study: many runs with different parameters
    Sweep(Sweep),
    /// Wears the joints of a scene over many strokes
    Wear(Wear),
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let done = match cli.command {
        None => cli.run.execute(),
        Some(Command::Package(package)) => package.execute(),
        Some(Command::Run(run)) => run.execute(),
        Some(Command::Inspect(inspect)) => inspect.execute(),
        Some(Command::Accuracy(accuracy)) => accuracy.execute(),
        Some(Command::Laws(laws)) => laws.execute(),
        Some(Command::Dynamics(dynamics)) => dynamics.execute(),
        Some(Command::Effects(effects)) => effects.execute(),
        Some(Command::Peers(peers)) => peers.execute(),
        Some(Command::Precision(precision)) => precision.execute(),
        Some(Command::Realtime(realtime)) => realtime.execute(),
        Some(Command::Report(report)) => report.execute(),
        Some(Command::Campaign(campaign)) => campaign.execute(),
        Some(Command::Ssp(ssp)) => ssp.execute(),
        Some(Command::Sensitivity(sensitivity)) => sensitivity.execute(),
        Some(Command::Sweep(sweep)) => sweep.execute(),
        Some(Command::Wear(wear)) => wear.execute(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
