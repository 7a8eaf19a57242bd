//! What a communication step costs through the packaged FMU: `cargo bench --bench do_step`. The same
//! span at 10 µs, 100 µs and 1 ms, each beside the same steps with nothing to integrate (the ideal
//! mechanism at constant speed): the host's and the interface's own part.

use cpu_time::ThreadTime;
use fmu_harness::host::{Fmu, Log};
use fmu_harness::package::Package;
use fmu_harness::scenes::Scenario;
use std::sync::Arc;

const SCENES: [(&str, f64); 4] = [("wornpin", 0.24), ("guideplay", 0.4), ("allplay", 0.08), ("press", 0.05)];
const STEPS: [f64; 3] = [1e-3, 1e-4, 1e-5];

fn main() -> anyhow::Result<()> {
    let directory = tempfile::tempdir()?;
    println!("scene      communication step [us]  CPU s/s  of it stepping alone  x real time  against 1 ms");
    let open = |name: &str| -> anyhow::Result<Fmu> {
        let file = directory.path().join(format!("{name}.fmu"));
        Package::make(&Scenario::find(name)?)?.save(&file)?;
        Ok(Fmu::open(&file)?)
    };
    let ideal = open("ideal")?;
    for (name, span) in SCENES {
        let fmu = open(name)?;
        let mut first = None;
        for step in STEPS {
            let whole = seconds(&fmu, span, step)? / span;
            let stepping = whole - seconds(&ideal, span, step)? / span;
            let first = *first.get_or_insert(stepping);
            println!(
                "{name:10} {:24.0}  {whole:7.4}  {stepping:20.4}  {:11.1}  {:12.2}",
                step * 1e6,
                1.0 / stepping,
                stepping / first
            );
        }
    }
    Ok(())
}

/// [s] CPU time of `span` [s] in communication steps of `step` [s], the slider's position read at each.
fn seconds(fmu: &Fmu, span: f64, step: f64) -> anyhow::Result<f64> {
    let slave = fmu.instantiate("bench", Arc::new(Log::new(|_| {})), false)?;
    let mut slave = slave.enter_initialization(Some(1e-6), 0.0, None)?.exit_initialization()?;
    let count = (span / step).round() as usize;
    let start = ThreadTime::now();
    for point in 0..count {
        slave.do_step(point as f64 * step, step)?;
        slave.read_one("slider.x")?;
    }
    let seconds = start.elapsed().as_secs_f64();
    slave.terminate()?;
    Ok(seconds)
}
