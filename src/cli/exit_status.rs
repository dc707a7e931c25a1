//! The exit status of the command `sahara`.

use std::io::{self, Write};
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::{interrupt, moved};
use crate::escaped::Escaped as _;
use crate::output;
use crate::study::{Status, StudyError};

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

/// Returns the exit code of a result. An `Err` is printed.
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
            Ok(message) => return print_clap_message(message),
            Err(error) => {
                output::print_error(format_args!("{error:#}"));
                of_error(&error)
            }
        },
    })
}

fn ended(status: u8) -> ExitCode {
    let Some(cause) = output::FAILURE.get() else { return ExitCode::from(status) };
    output::print_error(format_args!("cannot write to standard output: {cause}"));
    ExitCode::from(status.max(1))
}

fn of_error(error: &anyhow::Error) -> u8 {
    let is_wrong = error.downcast_ref::<StudyError>().is_some_and(StudyError::is_wrong_hit);
    if is_wrong { 2 } else { 1 }
}

/// Prints a message of clap. The message is an error, the help or the version.
pub(super) fn print_clap_message(message: clap::Error) -> ExitCode {
    if let (ErrorKind::UnknownArgument, Some(ContextValue::String(option))) =
        (message.kind(), message.get(ContextKind::InvalidArg))
        && let Err(sentence) = moved::check("option", &moved::OPTIONS, option.split('=').next().unwrap_or(option))
    {
        output::print_error(sentence);
        return ended(1);
    }
    let message = shown(message);
    let printed = message.print().and_then(|()| io::stdout().flush());
    if !message.use_stderr() {
        output::record_failure(printed);
    }
    ended(message.use_stderr().into())
}

/// Escapes the user's text in a message of clap. Removes the tip to pass an option as a value.
fn shown(mut message: clap::Error) -> clap::Error {
    let context: Vec<(ContextKind, ContextValue)> =
        message.context().map(|(kind, value)| (kind, value.clone())).collect();
    for (kind, mut value) in context {
        match &mut value {
            ContextValue::String(typed) => *typed = typed.escaped().to_string(),
            ContextValue::StyledStrs(tips) => tips.retain(|tip| !tip.to_string().contains("as a value, use")),
            _ => {}
        }
        message.insert(kind, value);
    }
    message
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_that_is_a_wrong_answer_has_the_status_of_wrong_answers() {
        let reported = |wrong_answer| StudyError::Reported { sentence: "why".into(), of_one_scene: true, wrong_answer };
        assert_eq!([true, false].map(|wrong| of_error(&reported(wrong).into())), [2, 1]);
        assert_eq!(of_error(&anyhow::anyhow!("no such file")), 1);
    }
}
