use super::Entry;
use crate::report::words::each_once;

/// The runs of several histories as one, each run once, the oldest first. A commit that was measured again is no newer
/// for it: what follows a run in its own history follows it here as well.
pub fn merged(histories: Vec<Vec<Entry>>) -> Vec<Entry> {
    let dated = |history: Vec<Entry>| {
        // The date that a run counts by: no later than that of any that follows it.
        let mut next: Option<String> = None;
        let mut found: Vec<(String, Entry)> = vec![];
        for entry in history.into_iter().rev() {
            let own = entry.provenance.date.clone();
            let date = next.map_or(own.clone(), |next| next.min(own));
            next = Some(date.clone());
            found.push((date, entry));
        }
        found.reverse();
        found
    };
    let mut runs: Vec<(String, Entry)> = histories.into_iter().flat_map(dated).collect();
    runs.sort_by(|a, b| a.0.cmp(&b.0));
    each_once(runs.into_iter().map(|(_, entry)| entry))
}
