//! All workloads without parameters.
//!
//! To add a workload, write a function that makes the rays, and add a line to `kinds!`.

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
            /// A workload without parameters.
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
            #[serde(rename_all = "kebab-case")]
            pub enum WorkloadKind {
                $($(#[$doc])* $kind = $name,)*
            }
        }

        impl WorkloadKind {
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
    /// Rays from the eye through the middle of each pixel, in tiles. Secondary rays keep this order.
    Primary, "primary", Closest, primary::centres;
    /// Rays from the eye through the top left corner of each pixel. On regular meshes, they hit edges and vertices.
    Corners, "corners", Closest, primary::corners;
    /// Any-hit rays from each primary hit to each light. The rays of one light are consecutive.
    Shadow, "shadow", Any, bounces::shadow;
    /// One ray per primary hit on any material, reflected about the shading normal.
    Mirror, "mirror", Closest, bounces::mirror;
    /// Rays from each primary hit in a random direction, cosine-distributed about the shading normal.
    Diffuse, "diffuse", Closest, bounces::diffuse;
    /// Like [`WorkloadKind::Diffuse`], but any-hit rays of limited length. The length is a tenth of the diagonal of the
    /// scene's box.
    Ambient, "ambient", Any, bounces::ambient;
    /// Each ray passes through two random points on the sphere around the scene's box.
    Random, "random", Closest, lines::random;
    /// Rays in both directions of each axis.
    Axis, "axis", Closest, lines::axis;
    /// For each pixel, the primary ray and then the mirror rays.
    Image, "image", Closest, picture::closest;
    /// The shadow rays of the picture, sorted by pixel and then by recursion level.
    ImageShadow, "image-shadow", Any, picture::shadow;
}

impl FromStr for WorkloadKind {
    type Err = Unknown;

    fn from_str(name: &str) -> Result<Self, Unknown> {
        find("workload", Self::ALL, name, Self::name)
    }
}
