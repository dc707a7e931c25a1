//! The exit status of the command.

use std::io::{self, Write};
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::{interrupt, moved};
use crate::escaped::Escaped as _;
use crate::output;
use crate::study::{Status, StudyError};

/// One rule for all commands. Known defects of a baseline or peer are not a failure of a run.
pub(crate) const STATUSES: &str = "\
Exit status:
  0    correct
  1    bad usage, unreadable input, unwritable output, or a failed measurement
  2    wrong hits, different pictures, or a query that never returned
  3    regression (diff --fail-on-regression)
  4    inconclusive: measure more to tell whether the threshold is exceeded
  5    correct, but a structure failed to build, panicked or was skipped
  130  interrupted by Ctrl-C; with a journal the same command resumes

Wrong hits of structures of other projects (obvhs, Embree, tinybvh, bvh, parry)
with known defects do not change the status; tables name the defects. `-` as an
output file is standard output; tables and messages then go to standard error.";

/// Exits with the status of the result; prints an error first.
pub(super) fn of(found: anyhow::Result<Status>) -> ExitCode {
    ended(match found {
        Ok(Status::Right) => 0,
        Ok(Status::Failed) => 1,
        Ok(Status::Wrong) => 2,
        Ok(Status::Regression) => 3,
        Ok(Status::Undecided) => 4,
        Ok(Status::Refused) => 5,
        Ok(Status::Interrupted) => return interrupt::end(),
        Err(error) => match error.downcast::<clap::Error>() {
            Ok(message) => return told(message),
            Err(error) => {
                output::tell_error(format_args!("{error:#}"));
                of_error(&error)
            }
        },
    })
}

/// Reports a result that could not be written; it is a failure unless the verdict is more severe.
fn ended(status: u8) -> ExitCode {
    let Some(cause) = output::FAILURE.get() else { return ExitCode::from(status) };
    output::tell_error(format_args!("cannot write to standard output: {cause}"));
    ExitCode::from(status.max(1))
}

/// A wrong hit may be an error if it leaves no other result.
fn of_error(error: &anyhow::Error) -> u8 {
    let is_wrong = error.downcast_ref::<StudyError>().is_some_and(StudyError::is_wrong_answer);
    if is_wrong { 2 } else { 1 }
}

fn moved(message: &clap::Error) -> Option<String> {
    match (message.kind(), message.get(ContextKind::InvalidArg)?) {
        (ErrorKind::UnknownArgument, ContextValue::String(option)) => {
            moved::said("option", &moved::OPTIONS, option.split('=').next().unwrap_or(option))
        }
        _ => None,
    }
}

/// Prints a message of the parser. Help and version are not errors.
pub(super) fn told(message: clap::Error) -> ExitCode {
    if let Some(sentence) = moved(&message) {
        output::tell_error(sentence);
        return ended(1);
    }
    let message = shown(advised(message));
    let printed = message.print().and_then(|()| io::stdout().flush());
    if !message.use_stderr() {
        output::note(printed);
    }
    ended(message.use_stderr().into())
}

/// Removes tips that do not help: no command takes an option after `--`.
fn advised(mut message: clap::Error) -> clap::Error {
    if let Some(ContextValue::StyledStrs(mut tips)) = message.remove(ContextKind::Suggested) {
        tips.retain(|tip| !tip.to_string().contains("as a value, use"));
        message.insert(ContextKind::Suggested, ContextValue::StyledStrs(tips));
    }
    message
}

/// The message contains the typed text: escape it.
fn shown(mut message: clap::Error) -> clap::Error {
    let typed: Vec<(ContextKind, String)> = message
        .context()
        .filter_map(|(kind, value)| match value {
            ContextValue::String(text) => Some((kind, text.escaped().to_string())),
            _ => None,
        })
        .collect();
    for (kind, text) in typed {
        message.insert(kind, ContextValue::String(text));
    }
    message
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_that_is_a_wrong_answer_has_the_status_of_wrong_answers() {
        let told = |wrong_answer| StudyError::Reported { sentence: "why".into(), of_one_scene: true, wrong_answer };
        assert_eq!([true, false].map(|wrong| of_error(&told(wrong).into())), [2, 1]);
        assert_eq!(of_error(&anyhow::anyhow!("no such file")), 1);
    }
}
