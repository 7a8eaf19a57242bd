//! Units and types → their elements of the model description.

use super::element::{Xml, leaf, parent};
use super::rows::{Declaration, Unit};
use std::io;

/// One unit with its display units.
pub(super) fn unit_definition(xml: &mut Xml, unit: &Unit) -> io::Result<()> {
    parent(xml, "Unit", vec![("name", unit.name.clone())], |xml| {
        if let Some(base) = &unit.base {
            let exponents = [("kg", base.kg), ("m", base.m), ("s", base.s), ("rad", base.rad)];
            let given = exponents.into_iter().filter(|(_, exponent)| *exponent != 0);
            leaf(xml, "BaseUnit", given.map(|(name, exponent)| (name, exponent.to_string())).collect())?;
        }
        unit.display.iter().try_for_each(|display| {
            let factor = format!("{:?}", display.factor);
            leaf(xml, "DisplayUnit", vec![("name", display.name.clone()), ("factor", factor)])
        })
    })
}

/// Every type of reals and every enumeration.
pub(super) fn type_definitions(xml: &mut Xml, declaration: &Declaration) -> io::Result<()> {
    for real in &declaration.types {
        let (name, description) = (real.name.clone(), real.description.clone());
        parent(xml, "SimpleType", vec![("name", name), ("description", description)], |xml| {
            let mut attributes = vec![("quantity", real.quantity.clone()), ("unit", real.unit.clone())];
            attributes.extend(real.display.clone().map(|display| ("displayUnit", display)));
            leaf(xml, "Real", attributes)
        })?;
    }
    for enumeration in &declaration.enumerations {
        let (name, description) = (enumeration.name.clone(), enumeration.description.clone());
        parent(xml, "SimpleType", vec![("name", name), ("description", description)], |xml| {
            parent(xml, "Enumeration", vec![], |xml| {
                enumeration.items.iter().try_for_each(|item| {
                    let (name, description) = (item.name.clone(), item.description.clone());
                    let value = item.value.to_string();
                    leaf(xml, "Item", vec![("name", name), ("value", value), ("description", description)])
                })
            })
        })?;
    }
    Ok(())
}
