//! Options of studies that time structures on scenes with their meshes, and what they plan.

use super::Plan;
use super::args::{Measuring, Rays, SLOWEST, ScenesAndMeshes, Structures, with_twin};
use super::epoch::{Epoch, Settings};
use crate::registry::Registry;
use crate::scene::{Scene, WorkloadKind};

/// Options of a study that has no others.
#[derive(Clone, Debug, clap::Args)]
pub struct EpochArgs {
    #[command(flatten)]
    scenes: ScenesAndMeshes,
    #[command(flatten)]
    structures: Structures,
    #[command(flatten)]
    rays: Rays,
    #[command(flatten)]
    measuring: Measuring,
}

impl EpochArgs {
    /// Epochs of `structures` and a twin on rays of these `kinds`, unless others are named.
    pub fn plan(
        &self,
        registry: &Registry,
        structures: &[&str],
        kinds: &[WorkloadKind],
    ) -> anyhow::Result<Plan<Epoch>> {
        let structures = with_twin(self.structures.chosen(registry, structures)?);
        let settings = self.measuring.settings(registry, structures, self.rays.asked(kinds))?;
        let settings = Settings { slowest: SLOWEST, ..settings };
        plan_on(&self.scenes, |scenes| settings.plan(scenes, self.measuring.epochs))
    }
}

/// What `plan` makes of the scenes, with their note and their files.
pub fn plan_on(named: &ScenesAndMeshes, plan: impl FnOnce(Vec<Scene>) -> Plan<Epoch>) -> anyhow::Result<Plan<Epoch>> {
    let scenes = named.read()?;
    let note = named.note(&scenes);
    let mut plan = plan(scenes);
    plan.notes.extend(note);
    Ok(Plan { inputs: named.named.files(), ..plan })
}
