//! Downloads and verifies mesh files.
//!
//! Without the feature `fetch`, `sahara fetch` downloads no files.

#[cfg(feature = "fetch")]
mod client;
mod data_file;

use std::path::PathBuf;

use crate::escaped::Escaped as _;

#[cfg(feature = "fetch")]
pub use client::Client;
pub use data_file::DataFile;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FetchOutcome {
    AlreadyThere,
    Downloaded { bytes: u64 },
}

#[derive(Debug, thiserror::Error)]
pub enum FetchError {
    #[error("{file} cannot be fetched: its scene file has no sha256 to verify it{}", unpack.as_ref().map_or(String::new(), |how| format!("; download {url} yourself, then {how}, into {}", folder.escaped())))]
    NoHash { file: String, url: String, unpack: Option<String>, folder: PathBuf },
    #[error("{file} cannot be fetched: the url {url:?} in its scene file does not begin with https:// or http://")]
    UnsupportedUrl { file: String, url: String },
    #[error("{} exists with other contents (SHA-256 {found}, not {expected}): rename or remove it and fetch again", path.escaped())]
    OtherContents { path: PathBuf, found: String, expected: String },
    #[error("{url}: the server responds with status {status}: {}", advice(*status))]
    Status { url: String, status: u16 },
    #[error("{url}: {cause}: check the connection and fetch again")]
    Connection { url: String, cause: String },
    #[error(
        "{url}: the file has more than {most} bytes (the size in the scene file, or the default limit): the download \
         was discarded"
    )]
    TooLarge { url: String, most: u64 },
    #[error(
        "{url}: the download has the SHA-256 {found}, not {expected}: nothing is kept; the file has changed on the \
         server or in transit"
    )]
    Hash { url: String, found: String, expected: String },
    #[error("cannot read {}: {cause}: check its permissions", path.escaped())]
    Read { path: PathBuf, cause: std::io::Error },
    #[error("cannot write {}: {cause}: choose a writable folder with free space (SAHARA_DATA)", path.escaped())]
    Write { path: PathBuf, cause: std::io::Error },
}

fn advice(status: u16) -> &'static str {
    match status {
        404 | 410 => "the file is gone; `sahara fetch --list` prints its origin, to search for another copy",
        401 | 403 => "the server restricts access to the file",
        429 | 500.. => "try again later",
        _ => "open the address in a browser",
    }
}
