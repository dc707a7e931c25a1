//! File names in JSON. A file name that is not UTF-8 is an array of bytes.

use std::ffi::{OsStr, OsString};

use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Name {
    Text(String),
    Bytes(Vec<u8>),
}

pub fn serialize<S: Serializer>(name: impl AsRef<OsStr>, serializer: S) -> Result<S::Ok, S::Error> {
    let name = name.as_ref();
    match name.to_str() {
        Some(text) => text.serialize(serializer),
        None => name.as_encoded_bytes().serialize(serializer),
    }
}

pub fn deserialize<'de, D: Deserializer<'de>, N: From<OsString>>(deserializer: D) -> Result<N, D::Error> {
    match Name::deserialize(deserializer)? {
        Name::Text(text) => Ok(OsString::from(text).into()),
        Name::Bytes(bytes) => of_bytes(bytes).map(N::from).ok_or_else(|| serde::de::Error::custom("not a file name")),
    }
}

#[cfg(unix)]
fn of_bytes(bytes: Vec<u8>) -> Option<OsString> {
    Some(std::os::unix::ffi::OsStringExt::from_vec(bytes))
}

/// Accepts only UTF-8.
#[cfg(not(unix))]
fn of_bytes(bytes: Vec<u8>) -> Option<OsString> {
    String::from_utf8(bytes).ok().map(OsString::from)
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::ffi::OsStringExt;
    use std::path::PathBuf;

    use super::*;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Named {
        #[serde(with = "super")]
        word: OsString,
        #[serde(with = "super")]
        path: PathBuf,
    }

    #[test]
    fn every_name_is_read_back() {
        for (name, json) in [(&b"a \"b\".obj"[..], r#""a \"b\".obj""#), (b"gr\xfcn", "[103,114,252,110]")] {
            let word = OsString::from_vec(name.to_vec());
            let named = Named { path: word.clone().into(), word };
            let text = serde_json::to_string(&named).unwrap();
            assert_eq!(text, format!("{{\"word\":{json},\"path\":{json}}}"));
            assert_eq!(serde_json::from_str::<Named>(&text).unwrap(), named);
        }
    }
}
