//! The machines that the tests have: this one, Windows as Wine shows it, and Linux on ARM as QEMU does. On each runs the
//! same importer, `host.c`, compiled for it.

use fmu_harness::package::build::workspace;
use fmu_harness::package::platform::Platform;
use fmu_harness::package::tools;
use fmu_harness::python::{Missing, environment};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;

/// What one run of the importer came to.
#[derive(Debug, PartialEq)]
pub struct Answer {
    pub succeeded: bool,
    /// The numbers that were asked for, one a line.
    pub numbers: String,
}

/// Where the importers are and what Wine writes.
pub fn place() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("platforms")
}

/// Makes what a platform's importer takes, once for all tests; an error tells what is missing for it.
pub fn prepare(platform: Platform) -> Result<(), String> {
    static LINUX: OnceLock<Result<(), String>> = OnceLock::new();
    static WINDOWS: OnceLock<Result<(), String>> = OnceLock::new();
    static ARM: OnceLock<Result<(), String>> = OnceLock::new();
    match platform {
        Platform::Linux64 => LINUX.get_or_init(gcc),
        Platform::Win64 => WINDOWS.get_or_init(wine),
        Platform::LinuxAarch64 => ARM.get_or_init(qemu),
        Platform::Darwin64 => return Err("no machine runs libraries of macOS here".into()),
    }
    .clone()
}

/// Runs the importer of a platform in the folder where its library `SliderCrank` is.
pub fn run(platform: Platform, folder: &Path, guid: &str, commands: &str) -> Answer {
    let mut command = match platform {
        Platform::Win64 => wine_command(&place().join("host.exe")),
        Platform::LinuxAarch64 => {
            let mut command = Command::new(QEMU);
            command.args(["-L", ARM_LIBRARIES]).arg(place().join("host-aarch64"));
            command
        }
        _ => Command::new(place().join("host")),
    };
    let (input, output) = (folder.join("commands"), folder.join("numbers"));
    fs::write(&input, commands).expect("written");
    let status = command
        .arg(format!("./SliderCrank{}", platform.affixes().1))
        .arg(guid)
        .current_dir(folder)
        .stdin(fs::File::open(&input).expect("commands"))
        .stdout(fs::File::create(&output).expect("a file"))
        .stderr(Stdio::inherit())
        .status()
        .expect("the importer starts");
    // Windows ends lines otherwise.
    let numbers = fs::read_to_string(output).expect("numbers").replace('\r', "");
    Answer { succeeded: status.success(), numbers }
}

fn gcc() -> Result<(), String> {
    compile(Command::new("cc").arg("-O1"), "host.c", "host", &["-ldl"])
}

const QEMU: &str = "qemu-aarch64-static";
/// Where Debian's libc6-arm64-cross is.
const ARM_LIBRARIES: &str = "/usr/aarch64-linux-gnu";

fn qemu() -> Result<(), String> {
    found(QEMU, "qemu-user-static")?;
    if !Path::new(ARM_LIBRARIES).join("lib").is_dir() {
        return Err(format!("{ARM_LIBRARIES} is missing: on Debian `apt-get install libc6-arm64-cross` installs it"));
    }
    let zig = environment("zig", Missing::Make).map_err(|error| format!("{error:#}"))?;
    let cache = workspace().join("target").join("zig-cache");
    let mut compiler = Command::new(zig);
    compiler.args(["-m", "ziglang", "cc", "-target", "aarch64-linux-gnu.2.17", "-O1"]);
    compiler.env("ZIG_GLOBAL_CACHE_DIR", &cache).env("ZIG_LOCAL_CACHE_DIR", &cache);
    compile(&mut compiler, "host.c", "host-aarch64", &["-ldl"])
}

fn wine() -> Result<(), String> {
    found(WINE, "wine wine64")?;
    found(tools::MINGW, "gcc-mingw-w64-x86-64-win32")?;
    let prefix = place().join("wine");
    let system = prefix.join("drive_c").join("windows").join("system32");
    if !system.is_dir() {
        fs::create_dir_all(&prefix).map_err(|error| error.to_string())?;
        let status = wine_command(Path::new("wineboot")).arg("--init").stderr(Stdio::null()).status();
        if !status.is_ok_and(|status| status.success()) || !system.is_dir() {
            return Err("Wine cannot make its folder".into());
        }
    }
    compile(Command::new(tools::MINGW).arg("-O1"), "host.c", "host.exe", &[])?;
    let library = "bcryptprimitives.dll";
    if !system.join(library).is_file() {
        compile(Command::new(tools::MINGW).args(["-O1", "-shared"]), "bcryptprimitives.c", library, &["-ladvapi32"])?;
        fs::copy(place().join(library), system.join(library)).map_err(|error| error.to_string())?;
    }
    stay_up()
}

/// Keeps a program under Wine waiting for input until the tests end: Wine's own services then run all the time, and a
/// program starts in a fraction of a second. FMPy gives up on a program that takes longer.
fn stay_up() -> Result<(), String> {
    static WAITING: OnceLock<Child> = OnceLock::new();
    let mut command = wine_command(Path::new("cmd"));
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
    let waiting = command.spawn().map_err(|error| error.to_string())?;
    WAITING.get_or_init(|| waiting);
    // Once another program has ended, the services are there.
    wine_command(Path::new("cmd")).args(["/c", "exit"]).status().map_err(|error| error.to_string())?;
    Ok(())
}

/// Ends all programs under Wine, such as a server that FMPy has left behind.
pub fn stop_wine() {
    drop(wine_command(Path::new("wineboot")).arg("--kill").status());
}

const WINE: &str = "wine";

/// Variables that Wine is told its own folder by, and to be quiet.
pub fn wine_variables() -> [(&'static str, OsString); 2] {
    [("WINEPREFIX", place().join("wine").into()), ("WINEDEBUG", "-all".into())]
}

fn wine_command(program: &Path) -> Command {
    let mut command = Command::new(WINE);
    command.arg(program).envs(wine_variables());
    command
}

fn found(program: &str, packages: &str) -> Result<(), String> {
    let mut command = Command::new(program);
    let status = command.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
    let missing = || format!("{program} is missing: on Debian `apt-get install {packages}` installs it");
    if status.is_ok_and(|status| status.success()) { Ok(()) } else { Err(missing()) }
}

fn compile(compiler: &mut Command, source: &str, program: &str, libraries: &[&str]) -> Result<(), String> {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join("platforms");
    fs::create_dir_all(place()).map_err(|error| error.to_string())?;
    compiler.arg("-o").arg(place().join(program)).arg(sources.join(source)).args(libraries);
    let name = compiler.get_program().to_string_lossy().into_owned();
    let output = compiler.output().map_err(|error| format!("{name} cannot be started: {error}"))?;
    let words = String::from_utf8_lossy(&output.stderr);
    if output.status.success() { Ok(()) } else { Err(format!("{name} cannot compile {source}: {words}")) }
}
