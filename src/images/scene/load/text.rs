//! Parses text files as bytes, because names need not be UTF-8.

use std::borrow::Cow;

use super::error::Fault;

/// Removes a UTF-8 byte order mark.
pub(super) fn without_byte_order_mark(bytes: &[u8]) -> Result<&[u8], Fault> {
    match bytes {
        [0xef, 0xbb, 0xbf, text @ ..] => Ok(text),
        // A byte order mark of UTF-16 or UTF-32, or ASCII characters in UTF-16.
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [0, 0, 0xfe, 0xff, ..] | [0, 1..=127, 0, ..] | [1..=127, 0, _, 0, ..] => {
            Err(Fault::line(1, "it is text in UTF-16 or UTF-32: save it as UTF-8"))
        }
        _ => Ok(bytes),
    }
}

/// Lines end with `\n`, `\r\n` or `\r`. Line numbers start at 1.
pub(super) fn lines(text: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    let lines = text.split(|&byte| byte == b'\n').map(|line| line.strip_suffix(b"\r").unwrap_or(line));
    (1..).zip(lines.flat_map(|line| line.split(|&byte| byte == b'\r')))
}

/// A `\` at the end of a line continues the statement, except in a comment. Each statement is returned with the number
/// of its first line.
pub(super) fn statements(text: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, [u8]>)> {
    let mut lines = lines(text);
    std::iter::from_fn(move || {
        let (number, mut line) = lines.next()?;
        let mut whole = Vec::new();
        while let Some(head) = continued(line) {
            whole.extend_from_slice(head);
            whole.push(b' ');
            line = lines.next().map_or(&[], |(_, line)| line);
        }
        if whole.is_empty() {
            return Some((number, Cow::Borrowed(line)));
        }
        whole.extend_from_slice(line);
        Some((number, Cow::Owned(whole)))
    })
}

fn continued(line: &[u8]) -> Option<&[u8]> {
    let head = line.strip_suffix(b"\\")?;
    let has_comment = all_words(line).any(|word| word.starts_with(b"#"));
    (!has_comment).then_some(head)
}

/// The words of a statement before its comment.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    all_words(line).take_while(|word| !word.starts_with(b"#"))
}

fn all_words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// The name after a keyword. A `#` that touches a word is part of the name, as in `Material #2`.
pub(super) fn name(line: &[u8]) -> &[u8] {
    let line = line.trim_ascii_start();
    let keyword = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    let name = &line[keyword..];
    let is_space = |byte: Option<&u8>| byte.is_none_or(u8::is_ascii_whitespace);
    let is_comment = |&i: &usize| name[i] == b'#' && is_space(name.get(i - 1)) && is_space(name.get(i + 1));
    let end = (1..name.len()).find(is_comment).unwrap_or(name.len());
    name[..end].trim_ascii()
}

pub(super) fn is_among(keywords: &str, keyword: &[u8]) -> bool {
    keywords.split(' ').any(|known| known.as_bytes() == keyword)
}

pub(super) fn number<N: std::str::FromStr>(word: &[u8]) -> Option<N> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_in_three_ways() {
        let all = |text: &'static str| lines(text.as_bytes()).collect::<Vec<_>>();
        assert_eq!(all("a\nb\r\n\rc\r"), [(1, &b"a"[..]), (2, b"b"), (3, b""), (4, b"c")]);
    }

    #[test]
    fn wide_text_is_refused_and_a_byte_order_mark_is_skipped() {
        assert_eq!(without_byte_order_mark(b"\xef\xbb\xbfv 0").unwrap(), b"v 0");
        for wide in
            [&b"\xff\xfev\0 \0"[..], b"\xfe\xff\0v", b"v\0 \x000\0", b"\0v\0 ", b"\0\0\xfe\xff\0\0\0v", b"v\0\0\0"]
        {
            assert!(without_byte_order_mark(wide).unwrap_err().problem.contains("UTF-16"));
        }
        assert!(without_byte_order_mark(&[0; 8]).is_ok() && without_byte_order_mark(b"").is_ok());
    }
}
