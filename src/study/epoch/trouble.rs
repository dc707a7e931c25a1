use super::Epoch;
use crate::report::words::each_once;
use crate::study::Trouble;

/// Everything without a time, each once.
pub fn troubles<'a>(epochs: impl IntoIterator<Item = &'a Epoch>) -> Vec<Trouble> {
    let mut troubles: Vec<Trouble> = vec![];
    for epoch in epochs {
        for structure in &epoch.structures {
            let trouble =
                |sentence, refused, wrong| Trouble { structure: structure.name.clone(), sentence, refused, wrong };
            let on = format!("{} on {}", structure.label, epoch.title());
            let refused =
                structure.refused.iter().map(|why| trouble(format!("{on} is refused: {why}."), true, structure.wrong));
            let untimed = structure.rays.iter().filter_map(|rays| {
                let why = rays.untimed.as_ref()?;
                Some(trouble(format!("{on}, {} rays, has no time: {why}.", rays.workload), false, rays.wrong))
            });
            troubles.extend(refused.chain(untimed));
        }
    }
    each_once(troubles)
}
