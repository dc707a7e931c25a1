//! Jobs of a plan that have no result.

use std::fs;
use std::path::{Path, PathBuf};

use crate::escaped::Escaped as _;
use crate::report::number::plural;
use crate::study::process::OUT;

/// What the plan is called in the folder of its results, if it is kept there.
const FILE: &str = "plan.txt";

/// A sentence, if a folder of results holds their plan, and jobs of it have none.
pub fn without_result(folder: &Path) -> Option<String> {
    let path = folder.join(FILE);
    let results = results(&fs::read_to_string(&path).ok()?, folder);
    let missing: Vec<&PathBuf> = results.iter().filter(|result| !result.exists()).collect();
    let first = missing.first()?.escaped();
    let (jobs, missing) = (plural(results.len(), "job"), missing.len());
    Some(format!(
        "{missing} of {jobs} of {} have no result, the first of them {first}: the same plan measures them.",
        path.escaped()
    ))
}

/// The files of the jobs of a plan, wherever it was made: a folder of a study and in it one of a case.
fn results(plan: &str, folder: &Path) -> Vec<PathBuf> {
    let result = |line: &str| {
        let words = shlex::split(line)?;
        let [.., option, file] = &words[..] else { return None };
        let file = Path::new(file);
        (option.strip_prefix("--") == Some(OUT)).then_some(())?;
        Some(folder.join(file.parent()?.file_name()?).join(file.file_name()?))
    };
    plan.lines().filter_map(result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jobs_without_a_result_are_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        assert_eq!(without_result(path), None, "there is no plan");
        let plan = "sahara --level avx2 '--case={\"study\":\"scaling\"}' --out 'far away/scaling/a.json'\n\
                    sahara '--case={\"scene\":\"it'\\''s\"}' --out runs/scaling/b.json\n\nsee notes/of/may\n";
        fs::write(path.join(FILE), plan).unwrap();
        fs::create_dir(path.join("scaling")).unwrap();
        fs::write(path.join("scaling/a.json"), "").unwrap();
        let sentence = without_result(path).unwrap();
        let first = path.join("scaling/b.json");
        assert!(sentence.starts_with("1 of 2 jobs of ") && sentence.contains(first.to_str().unwrap()), "{sentence}");
        fs::write(first, "").unwrap();
        assert_eq!(without_result(path), None, "all are there");
    }
}
