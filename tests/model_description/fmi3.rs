//! The descriptions of FMI 3.0: committed copies for review, and that they tell what that of FMI 2.0 tells.

use crate::made;
use roxmltree::{Document, Node};
use slidercrank::fmi::slave::states::{clocks, exchange};
use slidercrank::fmi::v3::variables::time_reference;
use slidercrank::model_description::exchange::FIRST_INDICATOR;
use slidercrank::model_description::{load, tables, terminals, xml, xml_v3};
use slidercrank::scene::{Scene, slot};
use std::{env, fs};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../modelDescription/");

fn description() -> String {
    let declaration = load().expect("a declaration");
    let (starts, guid): (Vec<f64>, _) = (tables::starts(&declaration).collect(), slot::guid(&Scene::default()));
    let scene = Scene::default();
    let (exchange, clocks) = (exchange(&scene), clocks(&scene));
    let anonymous = xml::Package::anonymous(&declaration, &starts);
    let package = xml::Package { guid: &guid, exchange: exchange.as_ref(), clocks: &clocks, ..anonymous };
    xml_v3::write(&declaration, &package).expect("a description")
}

#[test]
fn the_committed_copies_are_fresh() {
    let terminals = terminals::write(&load().expect("a declaration")).expect("terminals");
    for (name, made) in [("modelDescription-fmi3.xml", description()), ("terminalsAndIcons.xml", terminals)] {
        let file = format!("{FOLDER}{name}");
        if env::var_os("BLESS").is_some() {
            fs::write(&file, &made).expect("a file");
        }
        let committed = fs::read_to_string(&file).unwrap_or_default();
        assert!(committed == made, "{name} is stale: run the tests once with BLESS=1");
    }
}

/// Whichever element has this attribute.
fn attribute<'a>(nodes: &[Node<'a, '_>], name: &str) -> Option<&'a str> {
    nodes.iter().find_map(|node| node.attribute(name))
}

#[test]
fn every_variable_is_that_of_fmi2_and_the_time_comes_on_top() {
    let (two, three) = (made(), description());
    let (two, three) = (Document::parse(&two).expect("XML"), Document::parse(&three).expect("XML"));
    let of = |document: &Document, name: &str| {
        document.descendants().filter(|node| node.has_tag_name(name)).map(|node| node.id()).collect::<Vec<_>>()
    };
    let old: Vec<Node> = of(&two, "ScalarVariable").into_iter().filter_map(|id| two.get_node(id)).collect();
    let list = of(&three, "ModelVariables").into_iter().filter_map(|id| three.get_node(id)).next().expect("variables");
    let mut new: Vec<Node> = list.children().filter(Node::is_element).collect();
    // An ideal mechanism has one event indicator, which is a variable here, and no clocks.
    for (name, kind) in [("joint.T.corner.contact", "Boolean"), ("joint.T.corner.penetration", "Float64")] {
        let array = new.pop().expect("variables");
        assert_eq!((array.attribute("name"), array.tag_name().name()), (Some(name), kind));
        let dimension = array.first_element_child().and_then(|dimension| dimension.attribute("start"));
        assert_eq!(dimension, Some("4"));
    }
    let indicator = new.pop().expect("variables");
    assert_eq!(indicator.attribute("name"), Some("indicator.change_point"));
    assert_eq!(indicator.attribute("valueReference"), Some(FIRST_INDICATOR.to_string().as_str()));
    let (time, new) = new.split_first().expect("variables");
    assert_eq!(time.attribute("causality"), Some("independent"));
    assert_eq!(time.attribute("valueReference"), Some(time_reference().to_string().as_str()));
    assert_eq!(old.len(), new.len());
    for (old, new) in old.iter().zip(new) {
        let kind = old.first_element_child().expect("a type");
        for name in [
            "name",
            "valueReference",
            "description",
            "causality",
            "variability",
            "initial",
            "declaredType",
            "unit",
            "displayUnit",
            "min",
            "max",
            "nominal",
            "unbounded",
            "start",
        ] {
            let told = attribute(&[*old, kind], name);
            assert_eq!(new.attribute(name), told, "{name} of {:?}", old.attribute("name"));
        }
        let types = [("Real", "Float64"), ("Integer", "Int32"), ("Boolean", "Boolean"), ("Enumeration", "Enumeration")];
        assert!(types.contains(&(kind.tag_name().name(), new.tag_name().name())));
    }
}
