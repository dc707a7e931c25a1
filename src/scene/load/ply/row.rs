//! What is kept of the rows of a PLY file.

use ply_rs_bw::ply::{Property, PropertyAccess};

pub(super) struct Vertex {
    pub position: [f32; 3],
    pub normal: [f32; 3],
}

/// The corners of a polygon.
pub(super) struct Face {
    pub corners: Vec<i64>,
}

/// A row that has to be read to find the next one.
pub(super) struct Skipped;

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self { position: [0.0; 3], normal: [0.0; 3] }
    }

    fn set_property(&mut self, name: &String, property: Property) {
        let place = match name.as_str() {
            "x" => &mut self.position[0],
            "y" => &mut self.position[1],
            "z" => &mut self.position[2],
            "nx" => &mut self.normal[0],
            "ny" => &mut self.normal[1],
            "nz" => &mut self.normal[2],
            _ => return,
        };
        // The header has been checked: these are numbers and no lists.
        *place = match property {
            Property::Char(n) => n.into(),
            Property::UChar(n) => n.into(),
            Property::Short(n) => n.into(),
            Property::UShort(n) => n.into(),
            Property::Int(n) => n as f32,
            Property::UInt(n) => n as f32,
            Property::Float(n) => n,
            Property::Double(n) => n as f32,
            _ => f32::NAN,
        };
    }
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self { corners: Vec::new() }
    }

    fn set_property(&mut self, name: &String, property: Property) {
        if !super::header::CORNERS.contains(&name.as_str()) {
            return;
        }
        fn wide<N: Into<i64>>(list: Vec<N>) -> Vec<i64> {
            list.into_iter().map(Into::into).collect()
        }
        self.corners = match property {
            Property::ListChar(list) => wide(list),
            Property::ListUChar(list) => wide(list),
            Property::ListShort(list) => wide(list),
            Property::ListUShort(list) => wide(list),
            Property::ListInt(list) => wide(list),
            Property::ListUInt(list) => wide(list),
            _ => Vec::new(),
        };
    }
}

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}
