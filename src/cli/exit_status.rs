//! How the command ends: a number for what it found.

use std::io;
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::interrupt;
use crate::output::OutputError;
use crate::study::{Status, StudyError};

/// One rule for all commands; what a baseline is known to get wrong is no fault of a run.
pub(crate) const STATUSES: &str = "Exit status:
  0  right
  1  usage, input or output that cannot be had, or a scene that could not be measured
  2  wrong answers, or answers without an end
  3  a regression (compare --fail-on-regression)
  4  the samples do not tell whether there is a regression
  5  right, but for a structure that could not be built, panicked or could not take part
130  interrupted by Ctrl-C: what was measured is shown and kept, and the same command goes on
Wrong answers of a baseline from another project whose defects are documented are shown, cost it its time, and do not \
change the status: 2 is for everything else. Tables name the defects.

`-` in place of a file to write is standard output; tables and messages go to standard error then.";

/// Ends with what was found; an error is told first.
pub(super) fn of(found: anyhow::Result<Status>) -> ExitCode {
    match found {
        Ok(Status::Right) => ExitCode::SUCCESS,
        Ok(Status::Failed) => ExitCode::from(1),
        Ok(Status::Wrong) => ExitCode::from(2),
        Ok(Status::Regression) => ExitCode::from(3),
        Ok(Status::Undecided) => ExitCode::from(4),
        Ok(Status::Refused) => ExitCode::from(5),
        Ok(Status::Interrupted) => interrupt::end(),
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => match error.downcast::<clap::Error>() {
            Ok(message) => told(message),
            Err(error) => {
                crate::output::tell(format_args!("error: {error:#}"));
                ExitCode::from(of_error(&error))
            }
        },
    }
}

/// A wrong answer may be found as an error, where nothing else can be said of a run.
fn of_error(error: &anyhow::Error) -> u8 {
    let is_wrong = error.downcast_ref::<StudyError>().is_some_and(StudyError::is_wrong_answer);
    if is_wrong { 2 } else { 1 }
}

/// Prints what the command line is told. Help and version are answers, not errors; a reader that has gone away is no
/// error either.
pub(super) fn told(message: clap::Error) -> ExitCode {
    let message = advised(message);
    let _ = message.print();
    ExitCode::from(u8::from(message.use_stderr()))
}

/// Where --quick is no option, one that is written alike is no help: the command that has it is named instead.
fn advised(mut message: clap::Error) -> clap::Error {
    let is_unknown = message.kind() == ErrorKind::UnknownArgument;
    if is_unknown && message.get(ContextKind::InvalidArg) == Some(&ContextValue::String("--quick".into())) {
        message.remove(ContextKind::SuggestedArg);
        // It shows the same option.
        message.remove(ContextKind::Usage);
        let tip = "`sahara study all --quick` runs the quick form of every study, `sahara study plan NAME --quick` prints that of one";
        message.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    message
}

/// Whether the reader of our output has gone away, as `head` does.
fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let of_file = error.downcast_ref::<OutputError>().and_then(|error| match error {
        OutputError::Write { cause, .. } => Some(cause),
        _ => None,
    });
    error.downcast_ref::<io::Error>().or(of_file).is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
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
