//! The kinds of workloads.
//!
//! To add one, write the function that makes its rays and add a line to the table below. Names, the command line and
//! `sahara list` follow from it.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::source::Source;
use super::{bounces, lines, picture, primary};
use crate::accel::Query;
use crate::geometry::Ray;
use crate::names::{Unknown, find, named_enum};

macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident, $name:literal, $query:ident, $make:path;)*) => {
        named_enum! {
            /// The kind of a workload: the origins and directions of its rays.
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
            #[serde(rename_all = "kebab-case")]
            pub enum WorkloadKind {
                $($(#[$doc])* $kind = $name,)*
            }
        }

        impl WorkloadKind {
            /// The query of these rays.
            pub fn query(self) -> Query {
                match self {
                    $(Self::$kind => Query::$query),*
                }
            }

            pub(super) fn rays(self, source: &mut Source) -> Vec<Ray> {
                match self {
                    $(Self::$kind => $make(source)),*
                }
            }
        }
    };
}

kinds! {
    /// From the eye through the middle of each pixel, in tiles of four by four pixels within blocks of 32 by 32.
    /// Secondary rays are in the same order.
    Primary, "primary", Closest, primary::centres;
    /// From the eye through the top left corner of each pixel: on regular meshes they hit edges and vertices.
    Corners, "corners", Closest, primary::corners;
    /// From each primary hit to each light, one light after the other, any hit.
    Shadow, "shadow", Any, bounces::shadow;
    /// From each primary hit, reflected about the shading normal, for any material.
    Mirror, "mirror", Closest, bounces::mirror;
    /// From each primary hit in a random direction, cosine-distributed about the shading normal.
    Diffuse, "diffuse", Closest, bounces::diffuse;
    /// Like [`WorkloadKind::Diffuse`], any hit, with a length of a tenth of the box's diagonal: ambient occlusion.
    Ambient, "ambient", Any, bounces::ambient;
    /// Lines through two random points of the sphere around the scene's box.
    Random, "random", Closest, lines::random;
    /// Rays along the axes, both ways, on a lattice; every fourth line of it has the coordinate of a vertex.
    Axis, "axis", Closest, lines::axis;
    /// The closest-hit rays of the whole picture: each pixel's primary ray and then its mirror rays.
    Image, "image", Closest, picture::closest;
    /// The any-hit rays of the whole picture, in the order of their origins' hits.
    ImageShadow, "image-shadow", Any, picture::shadow;
}

impl FromStr for WorkloadKind {
    type Err = Unknown;

    fn from_str(name: &str) -> Result<Self, Unknown> {
        find("workload", Self::ALL, name, Self::name)
    }
}
