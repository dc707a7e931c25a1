//! The HTTP client.

use std::fs::{self, OpenOptions};
use std::io::{self, Read, Write};
use std::time::{Duration, Instant};

use super::{DataFile, FetchError, FetchOutcome};

/// Downloads files. Gives up on a server that does not respond or stalls.
pub struct Client {
    agent: ureq::Agent,
    patience: Duration,
}

/// Redirects that are followed: repositories need one or two.
const REDIRECTS: u32 = 5;

/// The time limit for a connection, a response or the next bytes.
const PATIENCE: Duration = Duration::from_secs(60);

/// A server that sends fewer bytes within the time limit has stalled.
const LEAST_PROGRESS: u64 = 16 << 10;

/// The size limit of a file whose scene file gives no size.
const MOST: u64 = 8 << 30;

impl Default for Client {
    fn default() -> Self {
        Self::with_patience(PATIENCE)
    }
}

impl Client {
    /// A client with the time limit `patience` for a connection, a response and bytes; the default is a minute.
    pub fn with_patience(patience: Duration) -> Self {
        let config = ureq::Agent::config_builder()
            .max_redirects(REDIRECTS)
            .http_status_as_error(false)
            .timeout_resolve(Some(patience))
            .timeout_connect(Some(patience))
            .timeout_send_request(Some(patience))
            .timeout_recv_response(Some(patience))
            .timeout_per_read(Some(patience))
            .user_agent(concat!("sahara/", env!("CARGO_PKG_VERSION")))
            .build();
        Self { agent: config.into(), patience }
    }

    /// Downloads `file`, resuming an earlier download; verifies it and moves it to its place in one step. `progress` is
    /// called with the number of bytes so far.
    ///
    /// # Errors
    /// If the file exists with other contents, or the server does not send it or sends other contents. A partial
    /// download is kept, so that it can be resumed.
    pub fn fetch(&self, file: &DataFile, progress: &mut dyn FnMut(u64)) -> Result<FetchOutcome, FetchError> {
        if file.is_there()? {
            return Ok(FetchOutcome::AlreadyThere);
        }
        if let Some(folder) = file.path.parent() {
            fs::create_dir_all(folder).map_err(|cause| FetchError::Write { path: folder.into(), cause })?;
        }
        let there = fs::metadata(file.part()).map_or(0, |part| part.len());
        let mut resumed = if file.bytes.is_none_or(|bytes| there <= bytes) { there } else { 0 };
        if resumed == 0 || file.bytes != Some(resumed) {
            resumed = self.download(file, resumed, progress)?;
        }
        let bytes = fs::metadata(file.part()).map_or(0, |part| part.len());
        file.finish()?;
        Ok(FetchOutcome::Downloaded { bytes, resumed })
    }

    /// Downloads from byte `from` on, or all if the server does not support ranges. Returns the first byte.
    fn download(&self, file: &DataFile, from: u64, progress: &mut dyn FnMut(u64)) -> Result<u64, FetchError> {
        let connection = |cause: ureq::Error| FetchError::Connection { url: file.url.clone(), cause: sentence(&cause) };
        let mut request = self.agent.get(&file.url);
        if from > 0 {
            request = request.header("Range", format!("bytes={from}-"));
        }
        let response = request.call().map_err(connection)?;
        let header = |name: &str| response.headers().get(name)?.to_str().ok().map(str::to_owned);
        let begins =
            header("content-range").and_then(|range| range.strip_prefix("bytes ")?.split('-').next()?.parse().ok());
        let start = match response.status().as_u16() {
            200 => 0,
            206 if begins == Some(from) => from,
            // The partial download belongs to another file or is too long: start again.
            206 | 416 if from > 0 => return self.download(file, 0, progress),
            status => return Err(FetchError::Status { url: file.url.clone(), status }),
        };
        let length: Option<u64> = header("content-length").and_then(|length| length.parse().ok());
        let expected = length.map(|length| start.saturating_add(length)).or(file.bytes);
        if file.bytes.is_none() && expected.is_some_and(|expected| expected > MOST) {
            return Err(too_large(file));
        }

        let body = response.into_body().into_reader();
        let got = self.append(file, start, expected, body, progress)?;
        match expected {
            Some(expected) if got < expected => {
                Err(FetchError::Cut { url: file.url.clone(), got, expected: Some(expected) })
            }
            _ => Ok(start),
        }
    }

    /// Appends the body to the first `start` bytes of the partial download. Returns the number of bytes at the end of
    /// the body.
    fn append(
        &self,
        file: &DataFile,
        start: u64,
        expected: Option<u64>,
        mut body: impl Read,
        progress: &mut dyn FnMut(u64),
    ) -> Result<u64, FetchError> {
        let part = file.part();
        let refused = |cause: io::Error| FetchError::Write { path: part.clone(), cause };
        let open = OpenOptions::new().create(true).append(true).open(&part);
        let mut out = open.map_err(refused)?;
        out.set_len(start).map_err(refused)?;
        let (mut got, mut buffer) = (start, vec![0; 1 << 16]);
        let stalled = |got: u64| FetchError::Stalled { url: file.url.clone(), got, patience: self.patience };
        let (mut since, mut got_then) = (Instant::now(), got);
        loop {
            let n = match body.read(&mut buffer) {
                Ok(0) => return Ok(got),
                Ok(n) => n,
                Err(cause) if cause.kind() == io::ErrorKind::Interrupted => continue,
                Err(cause) if is_timeout(&cause) => return Err(stalled(got)),
                // A broken connection counts as an early end of the body.
                Err(cause) if got == start => {
                    return Err(FetchError::Connection { url: file.url.clone(), cause: cause.to_string() });
                }
                Err(_) => {
                    return Err(FetchError::Cut { url: file.url.clone(), got, expected });
                }
            };
            got += n as u64;
            let most = file.bytes.unwrap_or(MOST);
            if got > most {
                drop(out);
                fs::remove_file(&part).map_err(refused)?;
                return Err(match file.bytes {
                    Some(expected) => FetchError::Long { url: file.url.clone(), expected },
                    None => too_large(file),
                });
            }
            out.write_all(&buffer[..n]).map_err(refused)?;
            progress(got);
            if since.elapsed() >= self.patience {
                if got - got_then < LEAST_PROGRESS {
                    return Err(stalled(got));
                }
                (since, got_then) = (Instant::now(), got);
            }
        }
    }
}

fn is_timeout(error: &io::Error) -> bool {
    let inner = error.get_ref().and_then(|error| error.downcast_ref());
    error.kind() == io::ErrorKind::TimedOut || matches!(inner, Some(ureq::Error::Timeout(_)))
}

fn too_large(file: &DataFile) -> FetchError {
    FetchError::TooLarge { url: file.url.clone(), most: MOST }
}

fn sentence(error: &ureq::Error) -> String {
    match error {
        ureq::Error::TooManyRedirects => format!("it redirects more than {REDIRECTS} times, perhaps in a circle"),
        other => other.to_string(),
    }
}
