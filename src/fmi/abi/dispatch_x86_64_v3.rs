//! Finds and loads the same library, compiled for newer processors.
//!
//! A package for Linux on x86-64 has the library twice: `NAME.so`, which importers load, runs on every such processor;
//! `NAME.x86-64-v3.so` needs a processor of the level v3 (System V ABI, AMD64 supplement, 3.1.1: AVX2, fused
//! multiplication and addition; common since 2013 to 2015) and takes a tenth to three fifths less time. Importers call
//! the first library, which lets the second one compute the motion, unless the scene has `solver.portable` set. If the
//! second library is missing, damaged or too new for the processor, the first one computes the motion itself.

/// The compilers' name of the level.
pub const LEVEL: &str = "x86-64-v3";

#[cfg(not(all(target_os = "linux", target_arch = "x86_64", not(target_feature = "fma"))))]
pub use absent::{Library, open};
#[cfg(all(target_os = "linux", target_arch = "x86_64", not(target_feature = "fma")))]
pub use beside::{Library, open};

#[cfg(all(target_os = "linux", target_arch = "x86_64", not(target_feature = "fma")))]
mod beside {
    use std::ffi::{CStr, CString, OsStr, c_void};
    use std::fs::File;
    use std::io::Read;
    use std::os::unix::ffi::OsStrExt;

    /// A loaded library. It is never unloaded.
    pub struct Library(*mut c_void);

    impl Library {
        /// Address of a function.
        pub fn find(&self, name: &str) -> Option<*const ()> {
            let name = CString::new(name).ok()?;
            // SAFETY: the library of the handle is never closed.
            let found = unsafe { libc::dlsym(self.0, name.as_ptr()) };
            if found.is_null() { None } else { Some(found.cast_const().cast()) }
        }
    }

    /// Opens the library for the processor's level, if there is one.
    pub fn open() -> Option<Library> {
        if !processor_has_level() {
            return None;
        }
        let own = own_path()?;
        let beside = [own.to_bytes().strip_suffix(b".so")?, b".", super::LEVEL.as_bytes(), b".so"].concat();
        if !is_whole(OsStr::from_bytes(&beside))? {
            return None;
        }
        let beside = CString::new(beside).ok()?;
        // SAFETY: the file of this name comes from the package; its initialisers are those of Rust.
        let library = unsafe { libc::dlopen(beside.as_ptr(), libc::RTLD_NOW | libc::RTLD_LOCAL) };
        if library.is_null() { None } else { Some(Library(library)) }
    }

    /// Whether an ELF file is complete. The loader would map the missing part of an incomplete file, too, and the
    /// process would be killed when it reads there. The table of sections comes last (System V ABI, ELF header:
    /// e_shoff, e_shentsize, e_shnum).
    fn is_whole(path: &OsStr) -> Option<bool> {
        let mut file = File::open(path).ok()?;
        let mut header = [0; 64];
        file.read_exact(&mut header).ok()?;
        let number =
            |at: usize, bytes: usize| header[at..at + bytes].iter().rev().fold(0, |n, &b| n << 8 | u64::from(b));
        let end = number(0x28, 8).checked_add(number(0x3A, 2) * number(0x3C, 2))?;
        Some(header.starts_with(b"\x7fELF") && file.metadata().ok()?.len() >= end)
    }

    fn processor_has_level() -> bool {
        macro_rules! has {
            ($($feature:tt)+) => { true $(&& std::is_x86_feature_detected!($feature))+ };
        }
        has!("avx" "avx2" "bmi1" "bmi2" "f16c" "fma" "lzcnt" "movbe" "popcnt" "sse3" "ssse3" "sse4.1" "sse4.2")
    }

    /// The file of this library.
    fn own_path() -> Option<CString> {
        let here = own_path as fn() -> Option<CString> as *const c_void;
        let mut found = libc::Dl_info {
            dli_fname: std::ptr::null(),
            dli_fbase: std::ptr::null_mut(),
            dli_sname: std::ptr::null(),
            dli_saddr: std::ptr::null_mut(),
        };
        // SAFETY: `found` is memory for the result.
        let known = unsafe { libc::dladdr(here, &raw mut found) } != 0;
        if !known || found.dli_fname.is_null() {
            return None;
        }
        // SAFETY: the loader's name of a loaded library.
        Some(unsafe { CStr::from_ptr(found.dli_fname) }.to_owned())
    }
}

#[cfg(not(all(target_os = "linux", target_arch = "x86_64", not(target_feature = "fma"))))]
mod absent {
    /// A type without values, since there is no such library.
    pub enum Library {}

    impl Library {
        /// Never called.
        pub fn find(&self, _: &str) -> Option<*const ()> {
            match *self {}
        }
    }

    /// Always `None`: this library is built for the level itself, or the platform has no levels.
    pub fn open() -> Option<Library> {
        None
    }
}
