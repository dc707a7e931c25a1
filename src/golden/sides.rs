//! What a page shows of a comparison.

use image::DynamicImage;

use crate::output::OutputError;
use crate::render::ViewKind;

/// The pictures of a comparison that are there.
#[derive(Clone, Copy)]
pub struct Sides<'a> {
    pub expected: Option<&'a DynamicImage>,
    pub actual: Option<&'a DynamicImage>,
    pub values: Values,
}

/// What the values of a picture are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// Colours: the channels.
    Colours,
    /// Distances, the same in all channels.
    Depths,
    /// Numbers of primitives, [packed](crate::golden::numbers::packed).
    Primitives,
}

impl From<ViewKind> for Values {
    fn from(view: ViewKind) -> Self {
        match view {
            ViewKind::Depth => Self::Depths,
            ViewKind::Primitive => Self::Primitives,
            _ => Self::Colours,
        }
    }
}

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    #[error("this program is built without the feature `page`: leave --page out, or build it with the feature")]
    Unavailable,
    #[error(transparent)]
    Write(#[from] OutputError),
}
