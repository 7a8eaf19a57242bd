//! The same library, compiled for newer processors, beside this one.
//!
//! A package for Linux on x86-64 has the library twice: `NAME.so`, which importers look for, runs on every such
//! processor; `NAME.x86-64-v3.so` needs one of the level v3 (System V ABI, AMD64 supplement, 3.1.1: AVX2, fused
//! multiplication and addition; usual since 2013 to 2015) and takes an eighth to a seventh less time. Where the second is
//! missing, or of no use, the first does it all.

/// Name of the level, as compilers have it.
pub const LEVEL: &str = "x86-64-v3";

#[cfg(all(target_os = "linux", target_arch = "x86_64", not(target_feature = "fma")))]
pub use beside::{Library, open};
#[cfg(not(all(target_os = "linux", target_arch = "x86_64", not(target_feature = "fma"))))]
pub use none::{Library, open};

#[cfg(all(target_os = "linux", target_arch = "x86_64", not(target_feature = "fma")))]
mod beside {
    use std::ffi::{CStr, CString, c_void};

    /// A loaded library. It stays for as long as the process.
    pub struct Library(*mut c_void);

    impl Library {
        /// Address of a function.
        pub fn find(&self, name: &str) -> Option<*const ()> {
            let name = CString::new(name).ok()?;
            // SAFETY: the handle is of a library that is never closed.
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
        let beside = CString::new(beside).ok()?;
        // SAFETY: what lies there under this name the package has put there; its initialisers are Rust's.
        let library = unsafe { libc::dlopen(beside.as_ptr(), libc::RTLD_NOW | libc::RTLD_LOCAL) };
        if library.is_null() { None } else { Some(Library(library)) }
    }

    fn processor_has_level() -> bool {
        macro_rules! has {
            ($($feature:tt)+) => { true $(&& std::is_x86_feature_detected!($feature))+ };
        }
        has!("avx" "avx2" "bmi1" "bmi2" "f16c" "fma" "lzcnt" "movbe" "popcnt" "sse3" "ssse3" "sse4.1" "sse4.2")
    }

    /// The file that this code was loaded from.
    fn own_path() -> Option<CString> {
        let here = own_path as fn() -> Option<CString> as *const c_void;
        let mut found = libc::Dl_info {
            dli_fname: std::ptr::null(),
            dli_fbase: std::ptr::null_mut(),
            dli_sname: std::ptr::null(),
            dli_saddr: std::ptr::null_mut(),
        };
        // SAFETY: `found` is a place for the answer.
        let known = unsafe { libc::dladdr(here, &raw mut found) } != 0;
        if !known || found.dli_fname.is_null() {
            return None;
        }
        // SAFETY: the loader's name of a library that is loaded.
        Some(unsafe { CStr::from_ptr(found.dli_fname) }.to_owned())
    }
}

#[cfg(not(all(target_os = "linux", target_arch = "x86_64", not(target_feature = "fma"))))]
mod none {
    /// Of which there is none.
    pub enum Library {}

    impl Library {
        /// Never asked.
        pub fn find(&self, _: &str) -> Option<*const ()> {
            match *self {}
        }
    }

    /// This library is for the level itself, or there are no levels.
    pub fn open() -> Option<Library> {
        None
    }
}
