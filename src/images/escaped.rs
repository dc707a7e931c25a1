//! Escapes names for terminals.

use std::ffi::OsStr;
use std::fmt::{self, Display, Formatter};
use std::path::Path;

/// Prints names safely. Unescaped control characters in a file name could change the terminal or break a table.
pub trait Escaped {
    /// The name on one line. Control characters appear, for example, as `\n` or `\u{1b}`. Invalid UTF-8 bytes appear,
    /// for example, as `\xff`.
    fn escaped(&self) -> Escape<'_>;
}

impl<S: AsRef<OsStr> + ?Sized> Escaped for S {
    fn escaped(&self) -> Escape<'_> {
        Escape(self.as_ref())
    }
}

#[derive(Clone, Copy)]
pub struct Escape<'a>(&'a OsStr);

impl Display for Escape<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for chunk in self.0.as_encoded_bytes().utf8_chunks() {
            for c in chunk.valid().chars() {
                if is_control(c) { write!(f, "{}", c.escape_default()) } else { write!(f, "{c}") }?;
            }
            chunk.invalid().iter().try_for_each(|byte| write!(f, "\\x{byte:02x}"))?;
        }
        Ok(())
    }
}

/// Whether `c` is a control character, a line or paragraph separator, or a text direction mark.
fn is_control(c: char) -> bool {
    c.is_control() || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Quotes `word` for a shell if necessary. The result is one line.
///
/// A word with control characters or invalid UTF-8 becomes, for example, `$'a\xff'`. The shells bash, zsh and ksh
/// understand this syntax.
pub fn quoted(word: impl AsRef<OsStr>) -> String {
    let word = word.as_ref();
    let Some(text) = word.to_str().filter(|text| !text.chars().any(is_control)) else {
        let plain = |byte: u8| matches!(byte, b' '..=b'~') && !b"'\\".contains(&byte);
        let byte = |&byte: &u8| if plain(byte) { char::from(byte).into() } else { format!("\\x{byte:02x}") };
        return format!("$'{}'", word.as_encoded_bytes().iter().map(byte).collect::<String>());
    };
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:=,+@%".contains(c);
    if !text.is_empty() && text.chars().all(plain) { text.into() } else { format!("'{}'", text.replace('\'', "'\\''")) }
}

pub fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or(path.as_os_str()).escaped().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_change_a_terminal_is_escaped_and_text_is_not() {
        for (name, shown) in [
            ("plain name.obj", "plain name.obj"),
            ("grün \u{1f642}.obj", "grün \u{1f642}.obj"),
            ("a\\b 'c' \"d\"", "a\\b 'c' \"d\""),
            ("\u{1b}[31mred\n\t", "\\u{1b}[31mred\\n\\t"),
            ("a\u{202e}jbo.b", "a\\u{202e}jbo.b"),
        ] {
            assert_eq!(name.escaped().to_string(), shown);
        }
        assert_eq!(stem(Path::new("folder/a\n.obj")), "a\\n");
    }

    #[test]
    fn arguments_can_be_pasted_back() {
        assert_eq!(quoted("sah-kd:leaf=8"), "sah-kd:leaf=8");
        assert_eq!(quoted("0,0,0 1,0,0"), "'0,0,0 1,0,0'");
        assert_eq!(quoted("it's"), "'it'\\''s'");
        assert_eq!(quoted(""), "''");
        let arguments = ["sahara", "a b.ply", "it's", "", "--camera", "0,0,1 0,0,0", "\\", "c.ply"];
        assert_eq!(shlex::split(&arguments.map(quoted).join(" ")).unwrap(), arguments);
        assert_eq!(quoted("a\nb's \\"), "$'a\\x0ab\\x27s \\x5c'");
    }

    #[cfg(unix)]
    #[test]
    fn bytes_that_are_no_text_stay_apart() {
        use std::os::unix::ffi::OsStrExt;
        let names = [&b"gr\xfcn.obj"[..], b"gr\xfdn.obj", b"it's \\x41\n\xe2\x82\xff"].map(OsStr::from_bytes);
        assert_eq!(names[0].escaped().to_string(), "gr\\xfcn.obj");
        assert_ne!(names[0].escaped().to_string(), names[1].escaped().to_string());
        assert_eq!(quoted(names[2]), "$'it\\x27s \\x5cx41\\x0a\\xe2\\x82\\xff'");
    }
}
