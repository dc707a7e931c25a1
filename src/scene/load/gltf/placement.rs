//! The transforms of a mesh to world space: of its node, of its instances, or of the joints of its skin.

use std::iter::{once, repeat, repeat_with};

use glam::{DMat4, DQuat, DVec3};
use gltf::scene::Transform;
use gltf::{Mesh, Skin};

use super::accessors::{Accessors, Elements, fault};
use super::shape::Attribute;
use crate::scene::load::error::Fault;

/// A node that shows a mesh.
pub(super) struct Placement<'a> {
    pub node: usize,
    pub world: DMat4,
    pub mesh: Mesh<'a>,
    /// A mesh with a skin is placed by its joints, not by the node.
    pub skin: Option<Skin<'a>>,
    /// The accessors of translations, rotations and scales of instances.
    pub instances: [Option<usize>; 3],
}

/// The transform of a mesh, or those of the joints of its skin.
pub(super) enum Pose {
    Rigid(DMat4),
    Skinned(Vec<DMat4>),
}

impl<'a> Placement<'a> {
    /// How often the mesh is shown, and how many joints or matrices that takes.
    pub fn sizes(&self, accessors: Accessors) -> Result<[usize; 2], Fault> {
        if let Some(skin) = &self.skin {
            let matrices = skin.inverse_bind_matrices().map_or(0, |matrices| matrices.count());
            return Ok([1, skin.joints().len().max(matrices)]);
        }
        let mut copies = None;
        for accessor in self.instances.into_iter().flatten() {
            let count = accessors.get(accessor)?.count();
            if *copies.get_or_insert(count) != count {
                return Err(fault(accessor, format!("it has {count} elements, unlike others of the same instances")));
            }
        }
        Ok([copies.unwrap_or(1), 0])
    }

    /// The poses of the mesh; `worlds` are the transforms of all nodes.
    pub fn poses(&self, worlds: &[DMat4], accessors: Accessors<'a>) -> Elements<'a, Pose> {
        let world = self.world;
        if let Some(skin) = &self.skin {
            // Vertices name joints by at most 16 bits.
            let named = skin.joints().take(1 << 16);
            let mut joints: Vec<DMat4> = named.map(|joint| worlds[joint.index()]).collect();
            if let Some(matrices) = skin.inverse_bind_matrices() {
                let (number, count) = (matrices.index(), matrices.count());
                if count < joints.len() {
                    return Err(fault(number, format!("it has {count} matrices for {} joints", joints.len())));
                }
                let inverse = accessors.matrices(matrices)?.map(double);
                joints.iter_mut().zip(inverse).for_each(|(joint, inverse)| *joint *= inverse);
            }
            return Ok(Box::new(once(Pose::Skinned(joints))));
        }
        let [translations, rotations, scales] = self.instances;
        if self.instances == [None; 3] {
            return Ok(Box::new(once(Pose::Rigid(world))));
        }
        let vectors = |accessor: Option<usize>, default: f32| -> Elements<'a, [f32; 3]> {
            accessor.map_or(Ok(Box::new(repeat([default; 3]))), |accessor| accessors.floats(accessor))
        };
        let identity: Box<dyn Iterator<Item = [f32; 4]>> = Box::new(repeat([0.0, 0.0, 0.0, 1.0]));
        let rotations = rotations.map_or(Ok(identity), |accessor| accessors.floats(accessor))?;
        let instances = vectors(translations, 0.0)?.zip(rotations).zip(vectors(scales, 1.0)?);
        Ok(Box::new(instances.map(move |((translation, rotation), scale)| {
            Pose::Rigid(world * local(Transform::Decomposed { translation, rotation, scale }))
        })))
    }
}

impl Pose {
    /// The transform of each vector of an attribute. A skin does not move vectors without weights.
    pub fn transforms<'a>(&'a self, attribute: &Attribute, accessors: Accessors<'a>) -> Elements<'a, DMat4> {
        let joints = match self {
            Self::Rigid(transform) => return Ok(Box::new(repeat(*transform))),
            Self::Skinned(joints) => joints,
        };
        let mut sets = Vec::new();
        for &[numbers, weights] in &attribute.influences {
            let highest = accessors.floats::<4>(numbers)?.flatten().fold(0.0, f32::max) as usize;
            if highest >= joints.len() {
                return Err(fault(numbers, format!("it names joint {highest}, and the skin has {}", joints.len())));
            }
            sets.push(accessors.floats::<4>(numbers)?.zip(accessors.floats::<4>(weights)?));
        }
        Ok(Box::new(repeat_with(move || {
            let (mut sum, mut total) = (DMat4::ZERO, 0.0);
            for (numbers, weights) in sets.iter_mut().filter_map(Iterator::next) {
                for (number, weight) in numbers.into_iter().zip(weights.map(f64::from)) {
                    sum += joints[number as usize] * weight;
                    total += weight;
                }
            }
            if total == 0.0 { DMat4::IDENTITY } else { sum * total.recip() }
        })))
    }
}

/// The transform of a node or an instance relative to what it belongs to.
pub(super) fn local(transform: Transform) -> DMat4 {
    match transform {
        Transform::Matrix { matrix } => double(matrix),
        Transform::Decomposed { translation, rotation, scale } => {
            // A unit quaternion in f32 is not of unit length in f64.
            let rotation = DQuat::from_array(rotation.map(f64::from));
            let length = rotation.length();
            let rotation = if length > 0.0 && length.is_finite() { rotation / length } else { DQuat::IDENTITY };
            let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
            DMat4::from_scale_rotation_translation(vector(scale), rotation, vector(translation))
        }
    }
}

fn double(columns: [[f32; 4]; 4]) -> DMat4 {
    DMat4::from_cols_array_2d(&columns.map(|column| column.map(f64::from)))
}
