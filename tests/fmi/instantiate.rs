//! What an instance needs to come into being, and what it does not.

use host::api::Api;
use host::guid;
use host::log::Log;
use slidercrank::fmi::v2::abi::types::fmi2CallbackFunctions;
use std::ffi::{CStr, CString};
use std::ptr::null;

/// Instantiates and frees; whether there was an instance.
fn instantiate(
    name: Option<&CStr>,
    fmu_type: i32,
    guid: Option<&CStr>,
    location: Option<&CStr>,
    callbacks: *const fmi2CallbackFunctions,
    logging_on: i32,
) -> bool {
    let pointer = |text: Option<&CStr>| text.map_or(null(), CStr::as_ptr);
    let api = Api::linked();
    // SAFETY: strings and callbacks are valid or NULL.
    unsafe {
        let c = (api.Instantiate)(pointer(name), fmu_type, pointer(guid), pointer(location), callbacks, 1, logging_on);
        (api.FreeInstance)(c);
        !c.is_null()
    }
}

#[test]
fn platform_and_version_are_the_standards() {
    let api = Api::linked();
    // SAFETY: both answer static strings.
    let [platform, version] =
        unsafe { [(api.GetTypesPlatform)(), (api.GetVersion)()].map(|text| CStr::from_ptr(text)) };
    assert_eq!((platform, version), (c"default", c"2.0"));
}

#[test]
fn a_wrong_guid_is_told_with_the_right_one() {
    let log = Log::default();
    for logging_on in [0, 1] {
        assert!(!instantiate(Some(c"x"), 1, Some(c"{wrong}"), None, &log.callbacks(), logging_on));
        let line = log.only();
        assert!(line.text.contains("{wrong}") && line.text.contains(guid().to_str().expect("text")));
        assert_eq!((line.instance.as_str(), line.status), ("x", 3));
        assert_eq!(line.category, "logStatusError");
    }
    assert!(!instantiate(Some(c"x"), 1, None, None, &log.callbacks(), 1));
    assert!(log.only().text.contains("NULL"));
}

#[test]
fn every_spelling_of_a_file_uri_is_silent_and_others_cost_a_remark() {
    let (log, guid) = (Log::default(), guid());
    let silent = [
        "file:/x/resources",
        "file:///x/resources",
        "file:////x/resources",
        "file://localhost/x/resources",
        "file:///a%20b/{4f}/resources",
        "file:////a b/resources/",
        "FILE:///x",
        "",
    ];
    for location in silent {
        let location = CString::new(location).expect("no zero");
        assert!(instantiate(Some(c"x"), 1, Some(&guid), Some(&location), &log.callbacks(), 1));
        assert_eq!(log.take(), [], "{location:?}");
    }
    assert!(instantiate(Some(c"x"), 1, Some(&guid), None, &log.callbacks(), 1));
    assert_eq!(log.take(), []);
    for location in [c"http://x/y%20z", c"/x/resources", c"file://elsewhere/x", c"nonsense", c"file:///\xff\xfe%"] {
        assert!(instantiate(Some(c"x"), 1, Some(&guid), Some(location), &log.callbacks(), 1));
        let line = log.only();
        assert_eq!((line.status, line.category.as_str()), (0, "logRemark"), "{location:?}");
        assert!(instantiate(Some(c"x"), 1, Some(&guid), Some(location), &log.callbacks(), 0));
        assert_eq!(log.take(), []);
    }
}
