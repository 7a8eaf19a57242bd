//! Makes the tables of `src/scene` and `src/fmi`, and the lists of laws of `src/model`, from the declaration.

use model_description::{guid, tables, xml};
use std::{env, error::Error, fs, path::Path};

/// Set where the crate is linked as the FMU's shared library.
const SHARED: &str = "SLIDERCRANK_SHARED_LIBRARY";

fn main() -> Result<(), Box<dyn Error>> {
    let target = |property: &str| env::var(format!("CARGO_CFG_TARGET_{property}")).unwrap_or_default();
    // The command `package` links the crate as a shared library, and a test does; to all other programs it is a Rust
    // library.
    println!("cargo::rerun-if-env-changed={SHARED}");
    let argument = match (target("OS").as_str(), target("ENV").as_str(), env::var_os(SHARED)) {
        // A thread-local destructor that runs after the host's dlclose must still find its code. Programs may have it, too.
        ("linux", _, _) => Some("-z,nodelete"),
        // The linker's clock would make the bytes of every build others.
        ("windows", "gnu", Some(_)) => Some("--no-insert-timestamp"),
        // Or the library bears the path that it was linked at.
        ("macos", _, Some(_)) => Some("-install_name,@rpath/SliderCrank.dylib"),
        _ => None,
    };
    if let Some(argument) = argument {
        println!("cargo::rustc-link-arg=-Wl,{argument}");
    }
    let declaration = model_description::load()?;
    let starts: Vec<f64> = tables::starts(&declaration).collect();
    let digest = guid::digest(&xml::write(&declaration, &xml::Package::anonymous(&declaration, &starts))?);
    let guid = guid::guid(&digest, starts);
    let out_dir = env::var("OUT_DIR")?;
    let write = |name: &str, text: String| fs::write(Path::new(&out_dir).join(name), text);
    write("enumerations.rs", tables::enumerations(&declaration))?;
    write("elasticities.rs", tables::laws(&declaration, "Elasticity", "elasticities"))?;
    write("friction_laws.rs", tables::laws(&declaration, "FrictionLaw", "friction_laws"))?;
    write("parameters.rs", tables::parameters(&declaration, &digest, &guid))?;
    write("variables.rs", tables::variables(&declaration))?;
    Ok(())
}
