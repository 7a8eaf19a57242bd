//! Every command on the scenes that are shipped with it: it ends well, and no row of a table is without numbers.
//!
//! `peers` has none of those that it compares with, as they come from elsewhere and take minutes; the study of `ssp`,
//! which takes minutes too, is run with a short plan by the tests of the hosts.

use crate::program::program;
use fmu_harness::scenes::{Scenario, contests, directory, names};
use rayon::prelude::*;
use slidercrank::fmi::slave::variables::VARIABLES;
use slidercrank::scene::parameter::{Kind, PARAMETERS};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};

/// The one shipped scene whose crank stands: it has no turns.
const STANDING: &str = "hold";
/// The one whose prescribed crank leaves nothing free: its motion has no neighbours.
const PRESCRIBED: &str = "ideal";
/// A short look at the dynamics.
const SHORT: [&str; 6] = ["--transient", "1", "--turns", "6", "--tangent-turns", "1"];
/// Under each table stands a sentence for every row without numbers.
const GAP: &str = "has no numbers";

/// How a command ends, and all that it says.
fn said(command: &mut Command) -> (ExitStatus, String) {
    let output = command.output().expect("the program starts");
    (output.status, String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr))
}

/// Runs a command and tells what is wrong with it.
fn wrong(arguments: &[&str], out: &Path) -> Option<String> {
    let (status, text) = said(program().args(arguments).arg("-o").arg(out));
    let well = status.success() && !text.contains(GAP) && !text.contains("NaN");
    (!well).then(|| format!("{}: {status}\n{text}", arguments.join(" ")))
}

/// Runs all of these, each with a directory of its own, and finds nothing wrong.
fn all_end_well(commands: &[Vec<&str>]) {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let one = |(number, arguments): (usize, &Vec<&str>)| wrong(arguments, &folder.path().join(number.to_string()));
    let found: Vec<String> = commands.par_iter().enumerate().filter_map(one).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// The one FMU file in a directory.
fn only_package(directory: &Path) -> PathBuf {
    let files = std::fs::read_dir(directory).expect("a directory").map(|entry| entry.expect("an entry").path());
    let mut packages: Vec<PathBuf> = files.filter(|file| file.extension().is_some_and(|end| end == "fmu")).collect();
    assert_eq!(packages.len(), 1, "{packages:?}");
    packages.remove(0)
}

fn shipped() -> Vec<String> {
    [names(&directory()), contests()].concat()
}

#[test]
fn accuracy_has_a_number_in_every_row_of_every_scene() {
    let scenes = shipped();
    let moving = scenes.iter().filter(|scene| *scene != STANDING);
    all_end_well(
        &moving.map(|scene| vec!["accuracy", "--scene", scene, "--transient", "0", "--turns", "1"]).collect::<Vec<_>>(),
    );
}

#[test]
fn dynamics_comes_to_a_verdict_on_every_scene() {
    let scenes = shipped();
    let moving = scenes.iter().filter(|scene| ![STANDING, PRESCRIBED].contains(&scene.as_str()));
    let mut commands: Vec<Vec<&str>> =
        moving.map(|scene| [&["dynamics", "--scene", scene], &SHORT[..]].concat()).collect();
    let range = ["--parameter", "joint.C.clearance", "--from", "1e-4", "--to", "5e-4", "--values", "3"];
    commands.push([&["dynamics", "--value-turns", "6"], &SHORT[..], &range[..]].concat());
    let range = ["--parameter", "joint.C.clearance", "--from", "2e-5", "--to", "2.01e-5", "--values", "2"];
    let follow = ["--follow-orbit", "--transient", "40", "--turns", "6", "--tangent-turns", "0", "--value-turns", "6"];
    commands.push([&["dynamics"], &follow[..], &range[..]].concat());
    all_end_well(&commands);
}

#[test]
fn branches_need_a_range_and_without_a_periodic_motion_the_simulated_points_are_written() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let follow = |to: &str| {
        let range = ["--parameter", "joint.C.clearance", "--from", "4e-4", "--to", to, "--values", "2"];
        let short =
            ["--follow-orbit", "--transient", "1", "--turns", "6", "--tangent-turns", "0", "--value-turns", "6"];
        said(program().arg("dynamics").args(short).args(range).arg("-o").arg(folder.path()))
    };
    let written = || folder.path().join("dynamics-wornpin-bifurcation.csv").exists();
    let (status, text) = follow("4e-4");
    assert!(!status.success() && text.contains("--from and --to are both 0.0004") && !written(), "{text}");
    let (status, text) = follow("5e-4");
    assert!(!status.success() && text.contains("does not settle") && written(), "{text}");
}

#[test]
fn a_pattern_leaves_out_parameters_at_their_bounds_and_a_plain_name_is_refused() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let by = |name: &str| {
        let quantity = ["sensitivity", "--scene", "wornpin", "--turns", "0.02", "--of", "slider.v", "--to", name];
        said(program().args(quantity).arg("-o").arg(folder.path()))
    };
    let (status, text) = by("joint.C.*");
    let left_out = "Left out: joint.C.damping = 0 has no neighbours";
    assert!(status.success() && text.contains(left_out) && text.contains("joint.C.clearance"), "{text}");
    let page = std::fs::read_to_string(folder.path().join("sensitivity-wornpin.md")).expect("a page");
    assert!(page.contains(left_out), "{page}");
    for name in ["joint.C.damping", "joint.*.damping"] {
        let (status, text) = by(name);
        assert!(!status.success() && text.contains("has no neighbours"), "{text}");
    }
}

#[test]
fn the_other_commands_have_a_number_in_every_row() {
    let study = directory().with_file_name("studies").join("speed-and-clearance.toml").display().to_string();
    let wear = ["--transient", "1", "--turns", "3", "--tolerance", "0.1"];
    let realtime = ["wornpin", "allplay", "flexrod", STANDING];
    let mut commands = vec![
        vec!["effects", "--quick"],
        vec!["laws", "--turns", "0.1"],
        vec!["precision", "--quick", "--scene", "wornpin", "--window", "2 ms", "--span", "4 ms"],
        vec!["report", "--unmeasured", "--transient", "2", "--turns", "6"],
        vec!["campaign", "--kind", "machines", "--scenes", "4", "--turns", "5"],
        vec!["sweep", &study, "--plan"],
        vec![
            "sensitivity",
            "--scene",
            "wornpin",
            "--turns",
            "0.2",
            "--of",
            "accuracy.position@30deg,joint.C.force:peak",
            "--to",
            "rod.length",
        ],
        [&["wear", "--coefficient", "B=1e-17", "--coefficient", "C=1e-17,3e-17", "--strokes", "1e6"], &wear[..]]
            .concat(),
    ];
    commands.extend(realtime.map(|scene| vec!["realtime", "--scene", scene, "--steps", "50", "--budget", "1"]));
    commands.iter().for_each(|command| all_end_well(std::slice::from_ref(command)));
}

#[test]
fn a_setting_may_have_a_unit() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let results = ["crank.speed_start=3000 rpm", "crank.speed_start=314.1592653589793"].map(|setting| {
        let out = folder.path().join(setting);
        let arguments = ["run", "--scene", "ideal", "--turns", "0.1", "--set", setting];
        assert_eq!(wrong(&arguments, &out), None);
        std::fs::read_to_string(out.join("ideal.csv")).expect("a file")
    });
    assert!(results[0] == results[1]);
}

#[test]
fn a_setting_or_a_column_takes_the_place_of_one_input_and_leaves_the_others() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let write = |name: &str, text: &str| {
        let file = folder.path().join(name);
        std::fs::write(&file, text).expect("written");
        file.display().to_string()
    };
    let run = |arguments: &[&str]| {
        let arguments = [&["run", "--turns", "0.05"], arguments].concat();
        assert_eq!(wrong(&arguments, folder.path()), None);
        std::fs::read_to_string(folder.path().join("own.csv")).expect("a file")
    };
    let text = std::fs::read_to_string(directory().join("ideal.toml")).expect("a scene");
    let loaded = |load: u32| text.replace("[slider]\n", &format!("[slider]\nload = {load}\n"));
    let scene = write("own.toml", &loaded(500));
    let wanted = run(&["--scene", &scene]);
    let torque = write("torque.csv", "time,crank.torque\n0,1\n");
    assert!(run(&["--scene", &scene, "--input", &torque]) == wanted, "the load stays");

    write("own.toml", &loaded(100));
    let fmu = folder.path().join("own.fmu").display().to_string();
    let load = write("load.csv", "time,slider.load\n0,500\n");
    let set = ["--set", "slider.load=500"];
    for (subject, place) in [(["--scene", &scene], set), (["--fmu", &fmu], set), (["--fmu", &fmu], ["--input", &load])]
    {
        assert!(run(&[subject, place].concat()) == wanted, "{subject:?} {place:?}");
    }

    let twice = write("twice.csv", "time,slider.load,slider.load\n0,1,2\n");
    for (input, load) in [(&load, "slider.load=1"), (&twice, "crank.mass=1")] {
        let found = wrong(&["run", "--scene", &scene, "--input", input, "--set", load], folder.path());
        assert!(found.is_some_and(|text| text.contains("`slider.load`") && text.contains(input)), "{input}");
    }
}

#[test]
fn a_run_of_too_many_communication_points_is_refused_before_it_starts() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    for (option, number) in [("--step", "1e-12"), ("--turns", "1e9"), ("--stop", "1e6")] {
        let found = wrong(&["run", "--scene", "ideal", option, number], folder.path());
        assert!(found.is_some_and(|text| text.contains("more than 20000000 communication points")), "{option}");
    }
}

#[test]
fn a_reader_that_goes_away_takes_nothing_with_it() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let arguments = ["sensitivity", "--scene", "wornpin", "--turns", "0.05", "--of", "slider.v", "--to", "rod.length"];
    let mut command = program();
    command.args(arguments).arg("-o").arg(folder.path()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("an end");
    assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(folder.path().join("sensitivity-wornpin.csv").exists());
}

#[test]
fn the_page_has_a_section_for_each_effect_that_the_scene_calls_for() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let text = std::fs::read_to_string(directory().join("wornpin.toml")).expect("a scene");
    let oil = "lubrication = \"short_bearing\"\nroughness = \"10 um\"\npeak.audit = true\nwear.audit = true\n";
    let with_oil = text.replace("[joint.C]\n", &format!("[energy]\naudit = true\n\n[joint.C]\n{oil}"));
    for (name, text, wanted) in [("with-oil", with_oil, true), ("dry", text, false)] {
        let file = folder.path().join(format!("{name}.toml"));
        std::fs::write(&file, text).expect("written");
        let mut command = program();
        command.arg("report").arg("--scene").arg(&file).args(["--unmeasured", "--transient", "1", "--turns", "6"]);
        let (status, text) = said(command.arg("-o").arg(folder.path()));
        assert!(status.success(), "{name}: {text}");
        let page = std::fs::read_to_string(folder.path().join(format!("report-{name}.html"))).expect("a page");
        for heading in ["Oil", "Between communication points", "Energies"] {
            assert_eq!(page.contains(&format!("<h2>{heading}</h2>")), wanted, "{name}: {heading}");
        }
    }
}

#[test]
fn a_row_without_numbers_is_told_under_the_table_and_fails_the_command() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    // A driven crank must pass where its rod, as long as the crank, stands across the guide.
    let scene = folder.path().join("stuck.toml");
    let text = std::fs::read_to_string(directory().join("wornpin.toml")).expect("a scene");
    let stuck = text.replace("[rod]\nlength = \"120 mm\"", "[rod]\nlength = \"50 mm\"");
    assert_ne!(stuck, text, "the rod has another length");
    std::fs::write(&scene, stuck).expect("written");
    let scene = scene.display().to_string();
    let arguments = ["accuracy", "--scene", &scene, "--transient", "0", "--turns", "1"];
    let found = wrong(&arguments, folder.path()).expect("some of its mechanisms cannot go round");
    assert!(found.contains("none has no numbers: none: "), "{found}");
    assert!(found.contains("error: ") && found.contains("1 of the rows above has no numbers"), "{found}");
}

#[test]
fn run_comes_to_the_end_of_every_scene_and_inspect_tells_every_variable_of_its_package() {
    for scene in shipped() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let turns: &[&str] = if scene == STANDING { &[] } else { &["--turns", "0.5"] };
        assert_eq!(wrong(&[&["run", "--scene", &scene], turns].concat(), folder.path()), None);
        let packaged = only_package(folder.path());
        let (status, text) = said(program().arg("inspect").arg(&packaged));
        assert!(status.success() && text.contains("model: SliderCrank"), "{scene}: {status}\n{text}");
        let table: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
        let row = |name: &str| table.iter().find(|row| row.first() == Some(&name));
        for (reference, variable) in VARIABLES.iter().enumerate() {
            let told = row(variable.name).is_some_and(|row| row[1] == reference.to_string());
            assert!(told, "{scene}: {}\n{text}", variable.name);
        }
        let file = Scenario::find(&scene).expect("a shipped scene").file;
        for parameter in PARAMETERS.iter().filter(|parameter| matches!(parameter.kind, Kind::Real { .. })) {
            let start = row(parameter.name).and_then(|row| row[5].parse().ok());
            assert_eq!(start, Some(parameter.value(&file.scene)), "{scene}: {}", parameter.name);
        }
    }
}

/// With the Python environment of the hosts, which their tests make.
#[test]
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn ssp_packages_the_press_with_its_drive() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let found = wrong(&["ssp"], folder.path());
    assert_eq!(found, None);
    let package = std::fs::read(folder.path().join("press.ssp")).expect("a package");
    let names = |name: &[u8]| package.windows(name.len()).any(|window| window == name);
    assert!(names(b"SystemStructure.ssd") && names(b"resources/press.fmu"));
}

#[cfg(unix)]
mod peers {
    use super::{GAP, contests, said};
    use crate::program::program;
    use fmu_harness::scenes::file;
    use rayon::prelude::*;
    use std::os::unix::fs::PermissionsExt;
    use std::path::{Path, PathBuf};
    use std::process::Command;

    /// A scene of `peers` so short that its runs take no time; all its rows have numbers where it is good to 1e-2.
    fn shortened(scene: &str, folder: &Path) -> PathBuf {
        let text = std::fs::read_to_string(file(scene).expect("a shipped scene")).expect("a text");
        let (before, run) = text.split_once("[run]\n").expect("a run");
        let after = run.split_once("\n\n").expect("what comes after it").1;
        let short = folder.join(format!("{}.toml", scene.replace('/', "-")));
        std::fs::write(&short, format!("{before}[run]\nstop = \"0.1 ms\"\nstep = \"10 us\"\n\n{after}"))
            .expect("written");
        short
    }

    /// A folder of programs that stand before those of the machine: no C interface is built, and there is no Python with
    /// the competitors' packages. None of them is left, whatever is installed.
    fn without_competitors(folder: &Path) -> Command {
        let write = |name: &str, refused: &str, real: &str| {
            let text = format!(
                "#!/bin/sh\ncase \"$*\" in *{refused}*) exit 1;; esac\nPATH=${{PATH#*:}}\nexec {real} \"$@\"\n"
            );
            let file = folder.join(name);
            std::fs::write(&file, text).expect("written");
            std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o755)).expect("allowed to run");
        };
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
        write("cargo", "slidercrank-equations", &format!("'{cargo}'"));
        write("python3", "peers.txt", "python3");
        let path = std::env::var("PATH").expect("a path");
        let mut command = program();
        command.env("CARGO", folder.join("cargo")).env("PATH", format!("{}:{path}", folder.display()));
        command
    }

    /// One scene for each set of competitors, with those that know no other.
    const CONTESTS: [(&str, &[&str]); 4] = [
        ("peers/ideal", &["SUNDIALS", "heyoka", "diffsol", "MuJoCo"]),
        ("peers/wornpin", &["SUNDIALS", "heyoka", "diffsol", "SciPy", "Exudyn"]),
        ("peers/guideplay", &["SUNDIALS", "heyoka", "diffsol", "Siconos"]),
        ("flexrod", &["SUNDIALS"]),
    ];

    #[test]
    fn ours_are_run_and_each_competitor_that_is_missing_is_named() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        assert!(contests().iter().all(|scene| CONTESTS.iter().any(|(known, _)| known == scene)));
        CONTESTS.par_iter().for_each(|&(scene, competitors)| {
            let [place, out] = ["programs", "out"].map(|name| folder.path().join(scene).join(name));
            std::fs::create_dir_all(&place).expect("a folder");
            let short = shortened(scene, &place);
            let (status, text) =
                said(without_competitors(&place).arg("peers").arg("--scene").arg(&short).arg("-o").arg(&out));
            let gaps: Vec<&str> = text.lines().filter(|line| line.contains(GAP)).collect();
            for competitor in competitors {
                let told = format!("{GAP}: not installed: ");
                assert!(gaps.iter().any(|gap| gap.starts_with(competitor) && gap.contains(&told)), "{scene}\n{text}");
            }
            let expected = |gap: &&str| competitors.iter().any(|competitor| gap.starts_with(competitor));
            assert!(gaps.iter().all(expected) && text.contains("SliderCrank dopri5"), "{scene}\n{text}");
            assert!(!text.contains("NaN"), "{scene}\n{text}");
            // It says that the table is not whole.
            let rows = format!("{} of the rows above have no numbers", gaps.len());
            assert!(!status.success() && text.contains(&rows), "{scene}: {status}\n{text}");
            for ending in ["csv", "md", "svg"] {
                assert!(out.join(format!("peers.{ending}")).is_file(), "{scene}: {ending}");
            }
        });
    }
}
