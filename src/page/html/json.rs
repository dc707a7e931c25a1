//! JSON in a page.

use serde::Serialize;

/// JSON as it may stand in a script element, which no text in it can end.
pub fn json(data: &impl Serialize) -> String {
    serde_json::to_string(data).expect("data have text keys").replace('<', "\\u003c")
}
