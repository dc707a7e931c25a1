//! The HTTP client.

use std::fs;
use std::io::{self, Read, Write};
use std::time::Duration;

use super::{DataFile, FetchError, FetchOutcome};
use crate::output::temporary_file;

pub struct Client(ureq::Agent);

/// Mesh repositories redirect a download once or twice.
const REDIRECTS: u32 = 5;

/// The time limit for a connection, a response or the next bytes. A whole download has no time limit.
const TIMEOUT: Duration = Duration::from_secs(60);

/// The default limit of the download size, in bytes.
const MAX_BYTES: u64 = 8 << 30;

impl Default for Client {
    fn default() -> Self {
        Self::with_timeout(TIMEOUT)
    }
}

impl Client {
    pub fn with_timeout(timeout: Duration) -> Self {
        let config = ureq::Agent::config_builder()
            .max_redirects(REDIRECTS)
            .http_status_as_error(false)
            .timeout_resolve(Some(timeout))
            .timeout_connect(Some(timeout))
            .timeout_send_request(Some(timeout))
            .timeout_recv_response(Some(timeout))
            .timeout_per_read(Some(timeout))
            .user_agent(concat!("sahara/", env!("CARGO_PKG_VERSION")))
            .build();
        Self(config.into())
    }

    /// An incomplete or unverified download never appears at `file.path`. `progress` receives the number of bytes
    /// downloaded so far.
    ///
    /// # Errors
    /// If the SHA-256 of an existing or downloaded file is not `file.sha256`. If the download, a read or a write fails.
    pub fn fetch(&self, file: &DataFile, progress: &mut dyn FnMut(u64)) -> Result<FetchOutcome, FetchError> {
        if file.is_there()? {
            return Ok(FetchOutcome::AlreadyThere);
        }
        let refused = |cause: io::Error| FetchError::Write { path: file.path.clone(), cause };
        file.path.parent().map_or(Ok(()), fs::create_dir_all).map_err(refused)?;
        let mut part = temporary_file(&file.path).map_err(refused)?;
        let bytes = self.download(file, part.as_file_mut(), progress)?;
        file.verify(part.path())?;
        part.as_file().sync_all().map_err(refused)?;
        part.persist(&file.path).map_err(|refusal| refused(refusal.error))?;
        Ok(FetchOutcome::Downloaded { bytes })
    }

    fn download(&self, file: &DataFile, out: &mut fs::File, progress: &mut dyn FnMut(u64)) -> Result<u64, FetchError> {
        let url = || file.url.clone();
        let connection = |cause: String| FetchError::Connection { url: url(), cause };
        let response = self.0.get(&file.url).call().map_err(|error| {
            connection(match error {
                ureq::Error::TooManyRedirects => {
                    format!("it redirects more than {REDIRECTS} times, perhaps in a loop")
                }
                other => other.to_string(),
            })
        })?;
        let status = response.status().as_u16();
        if status != 200 {
            return Err(FetchError::Status { url: url(), status });
        }
        let length = response.headers().get("content-length").and_then(|length| length.to_str().ok()?.parse().ok());
        let most = file.bytes.unwrap_or(MAX_BYTES);
        let (mut got, mut buffer) = (0, vec![0; 1 << 16]);
        let mut body = response.into_body().into_reader();
        loop {
            if length.unwrap_or(0).max(got) > most {
                return Err(FetchError::TooLarge { url: url(), most });
            }
            match body.read(&mut buffer) {
                Ok(0) => break,
                Ok(n) => {
                    out.write_all(&buffer[..n])
                        .map_err(|cause| FetchError::Write { path: file.path.clone(), cause })?;
                    got += n as u64;
                    progress(got);
                }
                Err(cause) if cause.kind() == io::ErrorKind::Interrupted => {}
                Err(cause) => return Err(connection(format!("the connection ended after {got} bytes ({cause})"))),
            }
        }
        match length {
            Some(length) if got < length => {
                Err(connection(format!("the connection ended after {got} of {length} bytes")))
            }
            _ => Ok(got),
        }
    }
}
