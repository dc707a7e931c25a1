//! All workloads without parameters.
//!
//! To add a workload, write the function that makes its rays and add a line to the table below. The command line and
//! `sahara list` use this table.

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
            /// The query of the rays.
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
    /// Rays from the eye through the middle of each pixel, in tiles of four by four pixels within blocks of 32 by 32
    /// pixels. Secondary rays have the order of their primary rays.
    Primary, "primary", Closest, primary::centres;
    /// Rays from the eye through the top left corner of each pixel. On regular meshes, they hit edges and vertices.
    Corners, "corners", Closest, primary::corners;
    /// Rays from each primary hit to each light, any hit. The rays of one light are consecutive.
    Shadow, "shadow", Any, bounces::shadow;
    /// Rays from each primary hit, on any material, in the direction reflected about the shading normal.
    Mirror, "mirror", Closest, bounces::mirror;
    /// Rays from each primary hit in a random direction, cosine-distributed about the shading normal.
    Diffuse, "diffuse", Closest, bounces::diffuse;
    /// Ambient occlusion: like [`WorkloadKind::Diffuse`], but any hit, with a tenth of the box's diagonal as `t_max`.
    Ambient, "ambient", Any, bounces::ambient;
    /// Lines through two random points of the sphere around the scene's box.
    Random, "random", Closest, lines::random;
    /// Rays in both directions of each axis, on a lattice. Every fourth row and column lies at a vertex coordinate.
    Axis, "axis", Closest, lines::axis;
    /// The closest-hit rays of the whole picture: the primary ray of each pixel, then its mirror rays.
    Image, "image", Closest, picture::closest;
    /// The any-hit rays of the whole picture: shadow rays in the order of [`WorkloadKind::Image`].
    ImageShadow, "image-shadow", Any, picture::shadow;
}

impl FromStr for WorkloadKind {
    type Err = Unknown;

    fn from_str(name: &str) -> Result<Self, Unknown> {
        find("workload", Self::ALL, name, Self::name)
    }
}
