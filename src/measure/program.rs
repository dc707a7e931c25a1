//! The running program: its identity and its start.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::{SystemTime, UNIX_EPOCH};

use sha2::{Digest, Sha256};

/// The first 16 digits of the SHA-256 of the running program; `unknown` if its file cannot be read. Another source,
/// compiler or flag gives another program, committed or not.
pub fn build() -> &'static str {
    static BUILD: OnceLock<String> = OnceLock::new();
    BUILD.get_or_init(|| file_id(&executable()).unwrap_or_else(|_| "unknown".into()))
}

/// The file of the running program. Linux keeps it at this path even after another file has taken its name.
pub fn executable() -> PathBuf {
    let kept = Path::new("/proc/self/exe");
    if kept.exists() { kept.into() } else { std::env::current_exe().unwrap_or_default() }
}

/// The SHA-256 of bytes: the identity of data files and corpora.
pub fn digest(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}

/// The first 16 digits of the SHA-256 of a file.
///
/// # Errors
/// If it cannot be read.
pub fn file_id(path: &Path) -> io::Result<String> {
    file_sha256(path).map(|digits| digits[..16].to_owned())
}

/// The SHA-256 of a file, in hexadecimal.
///
/// # Errors
/// If it cannot be read.
pub fn file_sha256(path: &Path) -> io::Result<String> {
    let mut hasher = Sha256::new();
    io::copy(&mut File::open(path)?, &mut hasher)?;
    Ok(format!("{:x}", hasher.finalize()))
}

/// The time of the first call, in UTC: `2026-03-01T12:30:59Z`.
pub fn started() -> &'static str {
    static STARTED: OnceLock<String> = OnceLock::new();
    let now = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    STARTED.get_or_init(|| utc(now()))
}

/// The date `seconds` after the beginning of 1970.
fn utc(seconds: u64) -> String {
    let (days, second) = (seconds / 86400, seconds % 86400);
    // Count years from March: a leap day is then the last day of a year. Eras of 400 years have equal length (Howard
    // Hinnant: chrono-compatible low-level date algorithms, 2021).
    let shifted = days + 719_468;
    let (era, day_of_era) = (shifted / 146_097, shifted % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted_month + 2) / 5 + 1;
    let month = if shifted_month < 10 { shifted_month + 3 } else { shifted_month - 9 };
    let year = 400 * era + year_of_era + u64::from(month <= 2);
    let (hour, minute, second) = (second / 3600, second / 60 % 60, second % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        let known = [
            (0, "1970-01-01T00:00:00Z"),
            (951_782_399, "2000-02-28T23:59:59Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (951_868_800, "2000-03-01T00:00:00Z"),
            (1_735_689_599, "2024-12-31T23:59:59Z"),
            (1_740_787_200, "2025-03-01T00:00:00Z"),
            (4_107_542_400, "2100-03-01T00:00:00Z"),
        ];
        for (seconds, text) in known {
            assert_eq!(utc(seconds), text);
        }
    }

    #[test]
    fn a_file_is_known_by_its_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            file_id(&path).unwrap()
        };
        assert_eq!(write("a", b"abc"), "ba7816bf8f01cfea");
        assert_eq!(write("b", b"abc"), write("a", b"abc"));
        assert_ne!(write("a", b"abd"), write("b", b"abc"));
        assert!(file_id(&folder.path().join("none")).is_err());
        assert_ne!(build(), "unknown");
    }
}
