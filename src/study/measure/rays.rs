//! Fills the [`Rays`] record of a structure on a workload.

use std::ffi::OsStr;

use super::built::Built;
use super::check::declined;
use crate::escaped::Escaped as _;
use crate::report::number::plural;
use crate::request::known_defect;
use crate::scene::Workload;
use crate::study::epoch::{Checked, Rays, Structure};

pub fn new_record(built: &Built, workload: &Workload, hash: &str) -> Rays {
    let declined = declined(built.accel.as_ref(), workload);
    Rays {
        workload: workload.name.clone(),
        hash: hash.into(),
        query: workload.query,
        all: workload.rays.len(),
        untimed: declined.map(|what| format!("declined: it does not support {what}")),
        declined: declined.map(String::from),
        ..Rays::default()
    }
}

pub fn record_check(rays: &mut Rays, check: Checked, scene: &OsStr, built: &Built) {
    rays.wrong = check.errors > 0 && (rays.untimed.is_none() || rays.wrong);
    if rays.wrong {
        let structure = match built.choice.command() {
            Some(command) => format!("--runner {command:?}"),
            None => format!("-s {}", built.choice.label),
        };
        let hint = check.example.as_ref().map_or(String::new(), |(ray, sentence)| {
            format!("; {sentence}; see: sahara validate {} {structure} --ray \"{ray}\"", scene.escaped())
        });
        let counts = format!("{} on {}", plural(check.errors, "wrong hit"), plural(check.rays, "ray"));
        rays.drop_times(counts + &hint);
    }
    rays.checked = Some(check);
}

/// Removes all times of a structure that has wrong hits on at least one workload.
///
/// A structure with a known defect keeps its times on workloads without wrong hits.
pub fn drop_times_of_wrong_tree(structure: &mut Structure) {
    let Some(wrong) = structure.rays.iter().find(|rays| rays.wrong) else { return };
    if known_defect(&structure.name).is_none() {
        let reason = format!("its hits on {} rays are wrong", wrong.workload);
        let timed = structure.rays.iter_mut().filter(|rays| rays.untimed.is_none());
        timed.for_each(|rays| rays.drop_times(reason.clone()));
    }
}
