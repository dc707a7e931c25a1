//! The rays of a structure on a workload, before they are timed and after their hits are checked.

use std::ffi::OsStr;

use super::built::Built;
use super::check::declined;
use crate::escaped::Escaped as _;
use crate::scene::Workload;
use crate::study::epoch::{Checked, Rays};

/// A structure on a workload before it is checked and timed.
pub fn untimed(built: &Built, workload: &Workload, hash: &str) -> Rays {
    let declined = declined(built.accel.as_ref(), workload);
    Rays {
        workload: workload.name.clone(),
        hash: hash.into(),
        query: workload.query,
        all: workload.rays.len(),
        untimed: declined.map(|what| format!("declined: it has no {what}")),
        declined: declined.map(String::from),
        ..Rays::default()
    }
}

/// Records what was checked; wrong answers have no time, and the ray that shows it is named.
pub fn settle(rays: &mut Rays, check: Checked, scene: &OsStr, built: &Built) {
    rays.wrong = check.errors > 0 && (rays.untimed.is_none() || rays.wrong);
    if rays.wrong {
        let structure = match built.choice.command() {
            Some(command) => format!("--runner {command:?}"),
            None => format!("-s {}", built.choice.label),
        };
        let go_on = check.example.as_ref().map_or(String::new(), |(ray, sentence)| {
            format!("; {sentence}; see: sahara validate {} {structure} --ray \"{ray}\"", scene.escaped())
        });
        let counts = format!("{} wrong hits on {} rays", check.errors, check.rays);
        *rays =
            Rays { untimed: Some(counts + &go_on), ns: vec![], parts: vec![], rays: 0, checksum: 0, ..rays.clone() };
    }
    rays.checked = Some(check);
}
