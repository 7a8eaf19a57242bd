//! Arrays of FMI 3.0: what the slider's four corners have each. They are local, so that importers without arrays can leave
//! them aside; the outputs of the guide tell the deepest corner and the number of those that touch.

use super::element::Attributes;

/// Value reference of the corners' penetrations.
pub const PENETRATIONS: u32 = 50_000;
/// Value reference of the corners' contacts.
pub const CONTACTS: u32 = 50_001;
/// Number of corners.
pub const CORNERS: usize = 4;

/// An array with an entry for each corner.
pub(super) struct CornerArray {
    /// The standard's name of its type.
    pub of_type: &'static str,
    /// Its attributes.
    pub attributes: Attributes<'static>,
}

/// Both arrays.
pub(super) fn corner_arrays() -> [CornerArray; 2] {
    let order = "of each corner of the slider (upper two, then lower two; the one at greater x first)";
    let array =
        |of_type, reference: u32, name: &str, description: String, variability: &str, own: Attributes<'static>| {
            let mut attributes = vec![
                ("name", name.into()),
                ("valueReference", reference.to_string()),
                ("description", description),
                ("causality", "local".into()),
                ("variability", variability.into()),
            ];
            attributes.extend(own);
            CornerArray { of_type, attributes }
        };
    let length = vec![
        ("initial", "calculated".into()),
        ("declaredType", "SmallLength".into()),
        ("unit", "m".into()),
        ("nominal", "1e-5".into()),
    ];
    let penetration =
        format!("Joint T: penetration {order} and the guide; negative across a gap, 0 for an ideal guide");
    let contact = format!("Joint T: contact {order}");
    let discrete = vec![("initial", "calculated".into())];
    [
        array("Float64", PENETRATIONS, "joint.T.corner.penetration", penetration, "continuous", length),
        array("Boolean", CONTACTS, "joint.T.corner.contact", contact, "discrete", discrete),
    ]
}
