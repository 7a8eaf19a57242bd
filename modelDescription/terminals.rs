//! Terminals → `terminalsAndIcons.xml` of FMI 3.0.

use super::element::{leaf, parent};
use super::rows::Declaration;
use super::xml::{begin, text};
use std::io;

/// [mm] Width and height of the icon on a diagram.
const ICON: [f64; 2] = [48.0, 19.6];

/// The terminals, and the size of the icon beside them.
pub fn write(declaration: &Declaration) -> io::Result<String> {
    let mut xml = begin()?;
    parent(&mut xml, "fmiTerminalsAndIcons", vec![("fmiVersion", "3.0".into())], |xml| {
        parent(xml, "GraphicalRepresentation", vec![], |xml| {
            let number = |value: f64| format!("{value:?}");
            let [x, y] = ICON.map(|length| 0.5 * length);
            let corners = vec![("x1", number(-x)), ("y1", number(-y)), ("x2", number(x)), ("y2", number(y))];
            let mut system = corners.clone();
            system.push(("suggestedScalingFactorTo_mm", number(1.0)));
            leaf(xml, "CoordinateSystem", system)?;
            leaf(xml, "Icon", corners)
        })?;
        parent(xml, "Terminals", vec![], |xml| {
            declaration.terminals.iter().try_for_each(|terminal| {
                let attributes = vec![
                    ("name", terminal.name.clone()),
                    ("matchingRule", "plug".into()),
                    ("description", terminal.description.clone()),
                ];
                parent(xml, "Terminal", attributes, |xml| {
                    terminal.members.iter().try_for_each(|member| {
                        let attributes = vec![
                            ("variableName", member.variable.get_ref().clone()),
                            ("memberName", member.name.clone()),
                            ("variableKind", member.kind.clone()),
                        ];
                        leaf(xml, "TerminalMemberVariable", attributes)
                    })
                })
            })
        })
    })?;
    text(xml)
}
