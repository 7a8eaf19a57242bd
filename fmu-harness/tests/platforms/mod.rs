//! The library on other platforms: the bits of Linux on x86-64, and states that go on from one to another.
//!
//! These tests build the library once more for each platform, which takes minutes. They run for the platforms that the
//! environment variable `SLIDERCRANK_PLATFORMS` lists, all of them in `.ci/run`, and only where the tools are there: Wine
//! and MinGW-w64 for win64, QEMU and zig for linux-aarch64, zig for linux64 and darwin64. A test that does not run says why
//! in one line. What is not run here is not optimised.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

mod machine;
mod scene;

use crate::program::program;
use clap::ValueEnum;
use fmu_harness::host::{Archive, Description};
use fmu_harness::package::Version;
use fmu_harness::package::build::{Levels, Library, Profile};
use fmu_harness::package::elf::{self, Glibc};
use fmu_harness::package::platform::Platform;
use fmu_harness::package::{Stock, build, mach_o};
use fmu_harness::python::{Missing, environment};
use fmu_harness::scenes::{Scenario, directory, names};
use object::read::macho::{FatArch, MachOFatFile32, MachOFile64};
use object::{Endianness, NameOrOrdinal, Object};
use scene::{Packaged, STEPS};
use slidercrank::fmi::v2::abi::estimation;
use slidercrank::fmi::v2::abi::functions::NAMES;
use slidercrank::fmi::v3;
use std::collections::BTreeSet;
use std::io::Write;
use std::net::TcpListener;
use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

/// Lists the platforms to test, separated by commas.
const ASKED: &str = "SLIDERCRANK_PLATFORMS";

/// The scene whose state travels, with those whose states are others: rigid, flexible, stiff.
const TRAVELLERS: [&str; 3] = ["wornpin", "flexrod", "hold"];

fn is_asked(platform: Platform) -> bool {
    std::env::var(ASKED).is_ok_and(|list| list.split(',').any(|name| name.trim() == platform.name()))
}

/// Says so past the test harness, which swallows what a passed test prints.
fn skip(platform: Platform, why: &str) {
    drop(writeln!(std::io::stderr(), "{} is not tested: {why}", platform.name()));
}

/// The portable library of this machine as it is packaged: what the others are compared with.
fn reference() -> &'static Stock {
    static REFERENCE: OnceLock<Stock> = OnceLock::new();
    REFERENCE.get_or_init(|| Stock::build_for_old_linux(Levels::Portable).expect("a library"))
}

/// What it takes to build for a platform and, except for macOS, to run what was built.
fn prepare(platform: Platform) -> Result<(), String> {
    if platform != Platform::Darwin64 {
        machine::prepare(platform)?;
    }
    build::prepare(platform).map_err(|error| format!("{error:#}"))
}

/// The portable libraries of all platforms that are to be tested and can be.
fn built() -> &'static [Library] {
    static BUILT: OnceLock<Vec<Library>> = OnceLock::new();
    BUILT.get_or_init(|| {
        let wanted = Platform::value_variants().iter().copied();
        let wanted = wanted.filter(|platform| is_asked(*platform) && prepare(*platform).is_ok());
        let (run, seen): (Vec<_>, Vec<_>) = wanted.partition(|platform| *platform != Platform::Darwin64);
        let unoptimised = || build::in_profile(&seen, Levels::Portable, Profile::Unoptimised).expect("libraries");
        // Side by side, since some of it takes one processor only.
        let (libraries, (others, _)) = rayon::join(
            || build::for_platforms(&run, Levels::Portable).expect("libraries"),
            || rayon::join(unoptimised, || is_asked(Platform::Linux64).then(without_zig)),
        );
        [libraries, others].concat()
    })
}

fn built_for(platform: Platform) -> Vec<Library> {
    built().iter().filter(|library| library.platform == platform).cloned().collect()
}

/// The libraries of a platform, if it is to be tested and can be.
fn stock(platform: Platform) -> Option<&'static Stock> {
    static STOCKS: OnceLock<Vec<(Platform, Stock)>> = OnceLock::new();
    if !is_asked(platform) {
        skip(platform, &format!("{ASKED} does not list it"));
        return None;
    }
    if let Err(why) = prepare(platform) {
        skip(platform, &why);
        return None;
    }
    let stocks = STOCKS.get_or_init(|| {
        let mut platforms: Vec<Platform> = built().iter().map(|library| library.platform).collect();
        platforms.dedup();
        let stock = |platform: Platform| (platform, Stock::of(built_for(platform)).expect("a stock"));
        platforms.into_iter().map(stock).collect()
    });
    stocks.iter().find(|(known, _)| *known == platform).map(|(_, stock)| stock)
}

/// Every output of every shipped scene, and of one scene by every method, at every communication point.
fn has_the_bits_of_linux64(platform: Platform, other: &Stock) {
    machine::prepare(Platform::Linux64).expect("a C compiler");
    let mut methods = vec![];
    for scene in names(&directory()) {
        let (own, other) =
            (Packaged::new(Platform::Linux64, reference(), &scene), Packaged::new(platform, other, &scene));
        let wanted = own.run_from_start(&[], None);
        assert!(wanted.succeeded && wanted.numbers.lines().count() > 20 * STEPS, "{scene}\n{}", wanted.numbers);
        assert_same(&other.run_from_start(&[], None), &wanted, &scene);
        if scene == "wornpin" {
            methods = own.items("solver.method");
            for (name, value) in &methods {
                let settings = [("solver.method", *value)];
                let (found, wanted) = (other.run_from_start(&settings, None), own.run_from_start(&settings, None));
                assert_same(&found, &wanted, &format!("{scene} by {name}"));
            }
        }
    }
    assert!(methods.len() > 5, "the scene of the methods has been run");
}

fn assert_same(found: &machine::Answer, wanted: &machine::Answer, what: &str) {
    let first =
        found.numbers.lines().zip(wanted.numbers.lines()).enumerate().find(|(_, (found, wanted))| found != wanted);
    let [found_lines, wanted_lines] = [found, wanted].map(|answer| answer.numbers.lines().count());
    assert!(
        found == wanted,
        "{what}: {found_lines} lines for {wanted_lines}, success {} for {}, first difference (line, (found, wanted)): {first:?}",
        found.succeeded,
        wanted.succeeded
    );
}

#[test]
fn windows_computes_the_bits_of_linux() {
    let Some(windows) = stock(Platform::Win64) else { return };
    has_the_bits_of_linux64(Platform::Win64, windows);
}

#[test]
fn arm_computes_the_bits_of_x86_64() {
    let Some(arm) = stock(Platform::LinuxAarch64) else { return };
    has_the_bits_of_linux64(Platform::LinuxAarch64, arm);
}

#[test]
fn the_library_for_this_linux_computes_the_bits_of_the_one_for_an_old_one() {
    if stock(Platform::Linux64).is_some() {
        has_the_bits_of_linux64(Platform::Linux64, &without_zig().stock);
    }
}

#[test]
fn a_state_that_is_saved_on_one_platform_goes_on_to_the_bit_on_another() {
    let others = [Platform::Win64, Platform::LinuxAarch64];
    let others: Vec<_> = others.into_iter().filter_map(|platform| Some((platform, stock(platform)?))).collect();
    if others.is_empty() {
        return;
    }
    machine::prepare(Platform::Linux64).expect("a C compiler");
    let folder = tempfile::tempdir().expect("a folder");
    let middle = STEPS / 2;
    for scene in TRAVELLERS {
        let mut places = vec![(Platform::Linux64, Packaged::new(Platform::Linux64, reference(), scene))];
        places.extend(others.iter().map(|(platform, stock)| (*platform, Packaged::new(*platform, stock, scene))));
        let states = places.iter().map(|(platform, packaged)| {
            let file = folder.path().join(format!("{scene}-{}", platform.name()));
            (file.clone(), packaged.run_from_start(&[], Some((middle, &file))))
        });
        let states: Vec<_> = states.collect();
        let whole = &states[0].1;
        assert!(whole.succeeded, "{scene}");
        let bytes = |file: &Path| std::fs::read(file).expect("a state");
        for (file, run) in &states {
            assert_same(run, whole, &format!("{scene}, {}", file.display()));
            assert!(bytes(file) == bytes(&states[0].0), "{} holds other bytes", file.display());
            for (platform, packaged) in &places {
                let rest = packaged.run_from_state(file, middle);
                let half = whole.numbers.lines().count() / 2;
                let wanted: String = whole.numbers.lines().skip(half).map(|line| format!("{line}\n")).collect();
                let what = format!("{} goes on on {}", file.display(), platform.name());
                assert_same(&rest, &machine::Answer { succeeded: true, numbers: wanted }, &what);
            }
        }
    }
}

/// A server of FMPy loads the library under Wine. `in_wine.py` tells what that takes.
#[test]
fn fmpy_runs_the_package_for_windows() {
    let Some(windows) = stock(Platform::Win64) else { return };
    // The port of FMPy's server is fixed.
    if TcpListener::bind(("127.0.0.1", 8080)).is_err() {
        return skip(Platform::Win64, "another program uses port 8080, which FMPy's server needs");
    }
    let python = environment("hosts", Missing::Make).expect("the environment of the hosts");
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = Scenario::find("wornpin").expect("a shipped scene");
    let files = [("linux64", reference()), ("win64", windows)].map(|(name, stock)| {
        let file = folder.path().join(format!("{name}.fmu"));
        stock.package(&scenario).expect("a package").save(&file).expect("written");
        file
    });
    // FMPy calls `wine64`, which Debian keeps out of PATH.
    let programs = folder.path().join("programs");
    std::fs::create_dir(&programs).expect("a folder");
    std::os::unix::fs::symlink("/usr/lib/wine/wine64", programs.join("wine64")).expect("a link");
    let path = fmu_harness::package::tools::path_with(&programs).expect("a path");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join("platforms").join("in_wine.py");
    let output = Command::new("timeout")
        .args(["--kill-after=5", "120"])
        .arg(python)
        .arg("-B")
        .arg(script)
        .args(files)
        .envs(machine::wine_variables())
        .env("PATH", path)
        .output()
        .expect("timeout, of the coreutils");
    let [told, complaint] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    if !output.status.success() {
        machine::stop_wine();
    }
    assert!(output.status.success() && told.contains("1001 points"), "{}\n{told}\n{complaint}", output.status);
}

#[test]
fn linux_on_arm_needs_a_file_of_its_own_in_fmi_2_alone() {
    let platforms = [Platform::Linux64, Platform::LinuxAarch64];
    if platforms.iter().any(|platform| stock(*platform).is_none()) {
        return;
    }
    let scenario = Scenario::find("wornpin").expect("a shipped scene");
    let files = |version: Version| -> Vec<(&str, Vec<String>)> {
        let stocks = Stock::build_for(version, &platforms, Levels::Portable).expect("libraries");
        let libraries = |stock: Stock| {
            let file = tempfile::NamedTempFile::new().expect("a file");
            stock.package_for(version, &scenario).expect("a package").save(file.path()).expect("written");
            let names = Archive::open(file.path()).expect("an archive").names();
            names.into_iter().filter(|name| name.starts_with("binaries/")).collect()
        };
        stocks.into_iter().map(|(ending, stock)| (ending, libraries(stock))).collect()
    };
    let name = |folder: &str| format!("binaries/{folder}/SliderCrank.so");
    let [own, arm] = ["", "-linux-aarch64"].map(|ending| (ending, vec![name("linux64")]));
    assert_eq!(files(Version::Fmi2), [own, arm]);
    assert_eq!(files(Version::Fmi3), [("", vec![name("x86_64-linux"), name("aarch64-linux")])]);
}

/// Bytes that differ from build to build, or tell where it was, and functions of a newer Linux than asked for.
#[test]
fn packages_of_other_platforms_tell_neither_place_nor_time_and_ask_for_no_new_linux() {
    let home = std::env::home_dir().expect("a home").join(".cargo");
    for platform in [Platform::Linux64, Platform::LinuxAarch64, Platform::Win64, Platform::Darwin64] {
        let Some(stock) = stock(platform) else { continue };
        let scenario = Scenario::find("wornpin").expect("a shipped scene");
        let library = library(stock, platform, &scenario);
        for place in [&build::workspace(), &home] {
            let place = place.to_string_lossy().into_owned().into_bytes();
            assert!(!library.windows(place.len()).any(|window| window == place), "{} names {place:?}", platform.name());
        }
        match platform {
            Platform::Linux64 | Platform::LinuxAarch64 => {
                let newest = elf::glibc(&library).expect("an ELF library that needs glibc");
                assert!(newest <= Glibc { major: 2, minor: 17 }, "{} needs glibc {newest}", platform.name());
            }
            Platform::Win64 => {
                // Microsoft PE specification, 3.3: the header's place is at 0x3C, and the time 8 bytes after its start.
                let word = |at: usize| u32::from_le_bytes(library[at..at + 4].try_into().expect("four bytes"));
                assert_eq!(word(word(0x3C) as usize + 8), 0, "the time of the link");
            }
            Platform::Darwin64 => {}
        }
    }
}

/// The platform's library as it is packaged.
fn library(stock: &Stock, platform: Platform, scenario: &Scenario) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.fmu");
    stock.package(scenario).expect("a package").save(&file).expect("written");
    let mut archive = Archive::open(&file).expect("an archive");
    archive.unpack(folder.path()).expect("unpacked");
    let description = Description::parse(&archive.description().expect("a text")).expect("a description");
    let element = description.co_simulation.as_ref().expect("co-simulation");
    let name = format!("{}{}", element.get("modelIdentifier").expect("a name"), platform.affixes().1);
    std::fs::read(folder.path().join("binaries").join(Version::Fmi2.folders(platform)[0]).join(name))
        .expect("the library")
}

/// Without any program at hand.
#[test]
fn what_is_missing_is_told_in_one_line_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    for (platform, wanted) in [("win64", "apt-get install gcc-mingw"), ("linux-aarch64", "zig cannot be set up")] {
        let file = folder.path().join("scene.fmu");
        let mut command = program();
        command.args(["package", "--platforms", platform, "-o"]).arg(&file).env("PATH", folder.path());
        let output = command.output().expect("the program starts");
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && told.lines().count() == 1 && told.contains(wanted), "{told}");
        assert!(told.contains(platform), "{told}");
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 0);
    }
}

/// What `package` does without zig.
struct WithoutZig {
    printed: String,
    complaint: String,
    /// The library that it built, linked by this machine's linker.
    stock: Stock,
}

/// `python3` is not on PATH, so zig cannot be installed; the C compiler and Rust are.
fn without_zig() -> &'static WithoutZig {
    static WITHOUT_ZIG: OnceLock<WithoutZig> = OnceLock::new();
    WITHOUT_ZIG.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let path = std::env::var_os("PATH").expect("PATH");
        for program in ["cc", "ld", "as", "cargo", "rustc"] {
            let found = std::env::split_paths(&path).map(|folder| folder.join(program)).find(|file| file.is_file());
            std::os::unix::fs::symlink(found.expect(program), folder.path().join(program)).expect("a link");
        }
        let mut command = program();
        command.args(["package", "--portable", "-o"]).arg(folder.path().join("scene.fmu"));
        command.env("PATH", folder.path());
        let output = command.output().expect("the program starts");
        let [printed, complaint] =
            [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        assert!(output.status.success(), "{complaint}");
        let (platform, triple) = (Platform::Linux64, Platform::Linux64.triples()[0]);
        let file = build::workspace().join("target").join("library").join(triple).join("fmu").join("libslidercrank.so");
        let stock = Stock::of(vec![Library { platform, triple, level: None, file }]).expect("a library");
        WithoutZig { printed, complaint, stock }
    })
}

#[test]
fn without_zig_the_package_for_this_linux_is_made_and_says_what_it_needs() {
    if !is_asked(Platform::Linux64) {
        return skip(Platform::Linux64, &format!("{ASKED} does not list it"));
    }
    let WithoutZig { printed, complaint, stock } = without_zig();
    assert_eq!(complaint.lines().filter(|line| line.starts_with("zig cannot be set up: ")).count(), 1, "{complaint}");
    let newest = elf::glibc(&library(stock, Platform::Linux64, &Scenario::find("wornpin").expect("a shipped scene")));
    let newest = newest.expect("an ELF library that needs glibc");
    assert!(printed.contains(&format!("needs glibc {newest} or newer")), "{printed}");
}

/// It cannot be run here. What can be seen: two processors, every function of the standard, digests that fit the bytes.
#[test]
fn the_library_for_macos_is_whole() {
    let Some(stock) = stock(Platform::Darwin64) else { return };
    let bytes = library(stock, Platform::Darwin64, &Scenario::find("wornpin").expect("a shipped scene"));
    let file = MachOFatFile32::parse(&*bytes).expect("a universal file");
    let wanted = [NAMES, estimation::NAMES, v3::abi::functions::NAMES, v3::abi::estimation::NAMES].concat();
    let wanted: BTreeSet<String> = wanted.into_iter().map(|name| format!("_{name}")).collect();
    assert_eq!(file.arches().len(), 2);
    for arch in file.arches() {
        let slice = arch.data(&*bytes).expect("a library");
        let library = MachOFile64::<Endianness>::parse(slice).expect("a library");
        let exports = library.exports().expect("exports");
        let names: BTreeSet<String> = exports
            .filter_map(|export| match export.expect("an export").name() {
                NameOrOrdinal::Name(name) => Some(String::from_utf8_lossy(name).into_owned()),
                NameOrOrdinal::Ordinal(_) => None,
            })
            .collect();
        let missing: Vec<&String> = wanted.difference(&names).collect();
        assert!(missing.is_empty(), "{:?} lacks {missing:?}", arch.architecture());
        let mut signed = slice.to_vec();
        mach_o::sign(&mut signed).expect("a library");
        assert!(signed == slice, "{:?}: the digests are not those of the bytes", arch.architecture());
    }
    // The digests that the linker made are those that this code makes, and on ARM there are some.
    for library in built_for(Platform::Darwin64) {
        let bytes = std::fs::read(&library.file).expect("read");
        let mut signed = bytes.clone();
        mach_o::sign(&mut signed).expect("a library");
        assert!(signed == bytes, "{}", library.triple);
        let Some(changed) = signed.get_mut(0x400) else { continue };
        *changed ^= 1;
        let changed = signed.clone();
        mach_o::sign(&mut signed).expect("a library");
        assert_eq!(signed != changed, library.triple.starts_with("aarch64"), "{}: signed", library.triple);
    }
}
