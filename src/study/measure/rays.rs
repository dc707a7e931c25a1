//! The rays of a structure on a workload, before they are timed and after their hits are checked.

use std::ffi::OsStr;

use super::built::Built;
use super::check::declined;
use crate::escaped::Escaped as _;
use crate::request::known_defect;
use crate::scene::Workload;
use crate::study::epoch::{Checked, Rays, Structure};

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
        drop_times(rays, counts + &go_on);
    }
    rays.checked = Some(check);
}

/// A tree that is wrong on one workload has no time on the others either. Only the known defects of baselines from other
/// projects cost the times of their workload alone.
pub fn drop_times_of_wrong_tree(structure: &mut Structure) {
    let Some(wrong) = structure.rays.iter().find(|rays| rays.wrong) else { return };
    if known_defect(&structure.name).is_none() {
        let reason = format!("its hits on {} rays are wrong", wrong.workload);
        let timed = structure.rays.iter_mut().filter(|rays| rays.untimed.is_none());
        timed.for_each(|rays| drop_times(rays, reason.clone()));
    }
}

fn drop_times(rays: &mut Rays, reason: String) {
    *rays = Rays { untimed: Some(reason), ns: vec![], parts: vec![], rays: 0, checksum: 0, ..rays.clone() };
}
