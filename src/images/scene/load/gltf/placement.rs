//! The transforms that place a mesh in world space.

use std::iter::{once, repeat};

use glam::{DMat4, DQuat, DVec3};
use gltf::scene::Transform;
use gltf::{Mesh, Node};

use super::accessors::{Accessors, Elements, fault};
use crate::scene::load::error::Fault;

pub(super) struct Placement<'a> {
    pub node: Node<'a>,
    pub mesh: Mesh<'a>,
    /// The accessors of translations, rotations and scales of instances.
    pub instances: [Option<usize>; 3],
}

impl<'a> Placement<'a> {
    pub fn copies(&self, accessors: Accessors) -> Result<usize, Fault> {
        let mut copies = None;
        for accessor in self.instances.into_iter().flatten() {
            let count = accessors.get(accessor)?.count();
            if *copies.get_or_insert(count) != count {
                let other = "but another accessor of the same instances has a different number";
                return Err(fault(accessor, format!("it has {count} elements, {other}")));
            }
        }
        Ok(copies.unwrap_or(1))
    }

    /// If the node has a skin, the first joint of the skin places the mesh. In the pose in which the skin was bound,
    /// all joints have the same effect.
    pub fn transforms(&self, worlds: &[DMat4], accessors: Accessors<'a>) -> Elements<'a, DMat4> {
        let mut world = worlds[self.node.index()];
        if let Some(skin) = self.node.skin()
            && let Some(joint) = skin.joints().next()
        {
            world = worlds[joint.index()];
            let inverse = skin.inverse_bind_matrices().map(|matrices| accessors.read(matrices.index())).transpose()?;
            world *= inverse.and_then(|mut all| all.next()).map_or(DMat4::IDENTITY, |m| DMat4::from_cols_array(&m));
        }
        if self.instances == [None; 3] {
            return Ok(Box::new(once(world)));
        }
        let [translations, rotations, scales] = self.instances;
        let vectors = read_or(translations, accessors, [0.0; 3])?.zip(read_or(scales, accessors, [1.0; 3])?);
        let instances = vectors.zip(read_or(rotations, accessors, [0.0, 0.0, 0.0, 1.0])?);
        let local = |((translation, scale), rotation)| decomposed(translation, rotation, scale);
        Ok(Box::new(instances.map(move |instance| world * local(instance))))
    }
}

fn read_or<const N: usize>(from: Option<usize>, accessors: Accessors, default: [f64; N]) -> Elements<[f64; N]> {
    from.map_or(Ok(Box::new(repeat(default))), |accessor| accessors.read(accessor))
}

pub(super) fn local(node: &Node) -> DMat4 {
    match node.transform() {
        Transform::Matrix { matrix } => DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from))),
        Transform::Decomposed { translation, rotation, scale } => {
            decomposed(translation.map(f64::from), rotation.map(f64::from), scale.map(f64::from))
        }
    }
}

fn decomposed(translation: [f64; 3], rotation: [f64; 4], scale: [f64; 3]) -> DMat4 {
    // Normalize the rotation, because rotations in files are rounded.
    let rotation = DQuat::from_array(rotation);
    let length = rotation.length();
    let rotation = if length > 0.0 && length.is_finite() { rotation / length } else { DQuat::IDENTITY };
    DMat4::from_scale_rotation_translation(DVec3::from(scale), rotation, DVec3::from(translation))
}
