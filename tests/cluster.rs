//! The jobs of `study plan` on common engines: runs the test of `benches/cluster` if they are installed.

use std::process::Command;

/// Runs the plan on an engine with disturbances, and compares its result with an undisturbed one; skipped if a program
/// is missing.
#[track_caller]
fn disturbed(engine: &str, with_slurm: bool, with_snakemake: bool) {
    if with_slurm && std::env::var_os("SAHARA_SLURM").is_none_or(|wanted| wanted != "1") {
        println!("skipped: SAHARA_SLURM=1 starts a cluster");
        return;
    }
    if with_snakemake && Command::new("snakemake").arg("--version").output().is_err() {
        println!("skipped: there is no snakemake on the path");
        return;
    }
    let mut test = Command::new("python3");
    test.args(["benches/cluster/test/disturb.py", engine]).current_dir(env!("CARGO_MANIFEST_DIR"));
    let output = test.env("SAHARA", env!("CARGO_BIN_EXE_sahara")).env_remove("SAHARA_DATA").output();
    let output = output.expect("python3 runs");
    let (out, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "disturb.py {engine}: {out}{errors}");
    print!("{out}");
}

#[test]
#[ignore = "minutes: it measures a plan twice, job by job"]
fn snakemake_on_this_machine() {
    disturbed("local", false, true);
}

/// One cluster at a time.
#[test]
fn snakemake_and_a_job_array_on_slurm() {
    disturbed("slurm", true, true);
    disturbed("array", true, false);
}
