//! The transforms of a mesh to world space: of its node, of its instances, or of the joints of its skin.

use std::iter::{once, repeat, repeat_with};

use glam::{DMat4, DQuat, DVec3};
use gltf::scene::Transform;
use gltf::{Mesh, Node};

use super::accessors::{Accessors, Elements, fault};
use super::shape::Attribute;
use crate::scene::load::error::Fault;

/// A node that shows a mesh. If it has a skin, the mesh is placed by the skin's joints and not by the node.
pub(super) struct Placement<'a> {
    pub node: Node<'a>,
    pub mesh: Mesh<'a>,
    /// The accessors of translations, rotations and scales of instances.
    pub instances: [Option<usize>; 3],
}

/// The transform of a mesh, or the transforms of the joints of its skin.
pub(super) enum Pose {
    Rigid(DMat4),
    Skinned(Vec<DMat4>),
}

impl<'a> Placement<'a> {
    /// How often the mesh is shown, and how many joints or matrices that takes.
    pub fn sizes(&self, accessors: Accessors) -> Result<[usize; 2], Fault> {
        if let Some(skin) = self.node.skin() {
            let matrices = skin.inverse_bind_matrices().map_or(0, |matrices| matrices.count());
            return Ok([1, skin.joints().len().max(matrices)]);
        }
        let mut copies = None;
        for accessor in self.instances.into_iter().flatten() {
            let count = accessors.get(accessor)?.count();
            if *copies.get_or_insert(count) != count {
                let other = "but another accessor of the same instances has a different number";
                return Err(fault(accessor, format!("it has {count} elements, {other}")));
            }
        }
        Ok([copies.unwrap_or(1), 0])
    }

    /// The poses of the mesh; `worlds` are the transforms of all nodes.
    pub fn poses(&self, worlds: &[DMat4], accessors: Accessors<'a>) -> Elements<'a, Pose> {
        let world = worlds[self.node.index()];
        if let Some(skin) = self.node.skin() {
            // Vertices name joints by at most 16 bits.
            let named = skin.joints().take(1 << 16);
            let mut joints: Vec<DMat4> = named.map(|joint| worlds[joint.index()]).collect();
            if let Some(matrices) = skin.inverse_bind_matrices() {
                let (number, count) = (matrices.index(), matrices.count());
                if count < joints.len() {
                    return Err(fault(number, format!("it has {count} matrices for {} joints", joints.len())));
                }
                let inverse = accessors.read(number)?.map(|matrix| DMat4::from_cols_array(&matrix));
                joints.iter_mut().zip(inverse).for_each(|(joint, inverse)| *joint *= inverse);
            }
            return Ok(Box::new(once(Pose::Skinned(joints))));
        }
        if self.instances == [None; 3] {
            return Ok(Box::new(once(Pose::Rigid(world))));
        }
        let [translations, rotations, scales] = self.instances;
        let vectors = read_or(translations, accessors, [0.0; 3])?.zip(read_or(scales, accessors, [1.0; 3])?);
        let instances = vectors.zip(read_or(rotations, accessors, [0.0, 0.0, 0.0, 1.0])?);
        Ok(Box::new(instances.map(move |((translation, scale), rotation)| {
            Pose::Rigid(world * decomposed(translation, rotation, scale))
        })))
    }
}

fn read_or<const N: usize>(from: Option<usize>, accessors: Accessors, default: [f64; N]) -> Elements<[f64; N]> {
    from.map_or(Ok(Box::new(repeat(default))), |accessor| accessors.read(accessor))
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
            let highest = accessors.read::<4>(numbers)?.flatten().fold(0.0, f64::max) as usize;
            if highest >= joints.len() {
                return Err(fault(numbers, format!("it names joint {highest}, but the skin has {}", joints.len())));
            }
            sets.push(accessors.read::<4>(numbers)?.zip(accessors.read::<4>(weights)?));
        }
        Ok(Box::new(repeat_with(move || {
            let (mut sum, mut total) = (DMat4::ZERO, 0.0);
            for (number, weight) in sets.iter_mut().filter_map(Iterator::next).flat_map(|(n, w)| n.into_iter().zip(w)) {
                sum += joints[number as usize] * weight;
                total += weight;
            }
            if total == 0.0 { DMat4::IDENTITY } else { sum * total.recip() }
        })))
    }
}

/// The transform of a node relative to its parent.
pub(super) fn local(node: &Node) -> DMat4 {
    match node.transform() {
        Transform::Matrix { matrix } => DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from))),
        Transform::Decomposed { translation, rotation, scale } => {
            decomposed(translation.map(f64::from), rotation.map(f64::from), scale.map(f64::from))
        }
    }
}

fn decomposed(translation: [f64; 3], rotation: [f64; 4], scale: [f64; 3]) -> DMat4 {
    // A unit quaternion in f32 is not of unit length in f64.
    let rotation = DQuat::from_array(rotation);
    let length = rotation.length();
    let rotation = if length > 0.0 && length.is_finite() { rotation / length } else { DQuat::IDENTITY };
    DMat4::from_scale_rotation_translation(DVec3::from(scale), rotation, DVec3::from(translation))
}
