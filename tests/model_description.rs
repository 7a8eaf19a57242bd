//! The model description, against the standard's rules that the usual validators miss.

use slidercrank::fmi::description::model_description;
use slidercrank::scene::Scene;
use std::{env, fs};

const COMMITTED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/modelDescription/modelDescription.xml");

#[test]
fn the_committed_copy_is_fresh() {
    let made = model_description(&Scene::default(), None, None).expect("the declared description");
    if env::var_os("BLESS").is_some() {
        fs::write(COMMITTED, &made).expect("modelDescription.xml written");
    }
    let committed = fs::read_to_string(COMMITTED).unwrap_or_default();
    assert!(committed == made, "modelDescription.xml is stale: run the tests once with BLESS=1");
}
