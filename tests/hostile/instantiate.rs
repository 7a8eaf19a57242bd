//! Every combination of what `fmi2Instantiate` can be given.

use host::api::Api;
use host::guid;
use host::log::Log;
use slidercrank::fmi::v2::abi::types::fmi2CallbackFunctions;
use std::ffi::CStr;
use std::ptr::{null, null_mut};

/// A text and what is wrong with it.
type Text<'a> = (Option<&'a CStr>, Option<&'a str>);

const NAMES: [Text<'_>; 4] =
    [(Some(c"x"), None), (Some(c"\xff%s#n#"), None), (None, Some("instanceName")), (Some(c""), Some("instanceName"))];
const TYPES: [(i32, Option<&str>); 5] =
    [(1, None), (0, None), (2, Some("fmuType")), (i32::MIN, Some("fmuType")), (i32::MAX, Some("fmuType"))];
/// A location that is odd costs a remark.
const LOCATIONS: [(Option<&CStr>, bool); 4] =
    [(None, false), (Some(c"file:///x%20y"), false), (Some(c"http://x/%s"), true), (Some(c"\xff"), true)];
const FLAGS: [i32; 4] = [0, 1, -1, i32::MIN];

#[test]
fn there_is_an_instance_or_one_line_that_tells_why_not() {
    let (log, right) = (Log::default(), guid());
    let api = Api::linked();
    let guids: [Text<'_>; 5] = [
        (Some(&right), None),
        (None, Some("fmuGUID is NULL")),
        (Some(c""), Some("fmuGUID ''")),
        (Some(c"{wrong}"), Some("fmuGUID '{wrong}'")),
        (Some(c"\xfe\n%d"), Some("fmuGUID '")),
    ];
    let pointer = |text: Option<&CStr>| text.map_or(null(), CStr::as_ptr);
    let whole = log.callbacks();
    let odd = (&raw const whole).cast::<u8>().wrapping_add(1).cast();
    let mut made = 0;
    for (name, no_name) in NAMES {
        for (kind, no_kind) in TYPES {
            for (guid, no_guid) in guids {
                for (location, remark) in LOCATIONS {
                    for (callbacks, heard) in [(&raw const whole, true), (null(), false), (odd, false)] {
                        for logging_on in FLAGS {
                            for visible in FLAGS {
                                let (name, guid, location) = (pointer(name), pointer(guid), pointer(location));
                                // SAFETY: strings and callbacks are valid, NULL or misaligned.
                                let c = unsafe {
                                    (api.Instantiate)(name, kind, guid, location, callbacks, visible, logging_on)
                                };
                                let causes: Vec<&str> = [no_name, no_kind, no_guid].into_iter().flatten().collect();
                                assert_eq!(c.is_null(), !heard || !causes.is_empty());
                                let lines = log.take();
                                let told = heard && if c.is_null() { true } else { remark && logging_on != 0 };
                                assert_eq!(lines.len(), usize::from(told), "{lines:?}");
                                for line in lines {
                                    assert!(line.text.starts_with("fmi2Instantiate: "), "{line:?}");
                                    let cause = causes.iter().any(|cause| line.text.contains(cause));
                                    assert!(cause || !c.is_null() && line.status == 0, "{line:?}");
                                }
                                made += usize::from(!c.is_null());
                                // SAFETY: live or NULL, and not used again.
                                unsafe { (api.FreeInstance)(c) };
                            }
                        }
                    }
                }
            }
        }
    }
    assert_eq!(made, 2 * 2 * LOCATIONS.len() * FLAGS.len() * FLAGS.len());
}

#[test]
fn callbacks_may_all_be_missing() {
    let nothing = fmi2CallbackFunctions {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: null_mut(),
    };
    let (api, right) = (Api::linked(), guid());
    for (guid, made) in [(right.as_c_str(), true), (c"wrong", false)] {
        // SAFETY: valid strings and callbacks; a live instance is not used after it is freed.
        unsafe {
            let c = (api.Instantiate)(c"x".as_ptr(), 1, guid.as_ptr(), null(), &raw const nothing, 1, 1);
            assert_eq!(!c.is_null(), made);
            if made {
                // Refused, with nobody to tell.
                (api.DoStep)(c, f64::NAN, f64::NAN, 1);
            }
            (api.FreeInstance)(c);
        }
    }
}
