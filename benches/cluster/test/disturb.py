#!/usr/bin/env python3
"""Runs a plan on an engine, disturbs it, and compares its results with those of an undisturbed run.

    disturb.py local    Snakemake on this machine
    disturb.py slurm    Snakemake with the Slurm executor, on a cluster of one node that is started for the test
    disturb.py array    slurm-array.sh, on the same cluster

SAHARA names the program. All files are below a temporary folder, which is kept when the test fails.
"""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from pathlib import Path

sys.dont_write_bytecode = True

from engines import HERE, engine, output  # noqa: E402
from same import different, results, rows  # noqa: E402

STUDIES = ["attribution", "compare", "scaling"]
OPTIONS = ["--quick", "--scenes", "cube", "sphere", "torus", "teapot"]
# For anything that must come; a job takes seconds.
PATIENCE = 600


class Job:
    """A job that has begun, as recorded by record.sh."""

    def __init__(self, line):
        process, there, self.slurm, self.file = line.split(" ", 3)
        self.process, self.is_new = int(process), there == "missing"

    def lives(self):
        """Whether it runs."""
        with contextlib.suppress(OSError):
            state = Path(f"/proc/{self.process}/stat").read_text().rsplit(")", 1)[1].split()[0]
            return state not in "ZX"
        return False


class Watch(threading.Thread):
    """Watches the results: an existing file must keep its inode and its content.

    Modification times do not matter: Snakemake sets them for the files of a finished job.
    """

    def __init__(self, folder):
        super().__init__(daemon=True)
        self.folder, self.seen, self.changed, self.over = folder, {}, set(), False
        self.start()

    def run(self):
        while not self.over:
            for file in {*self.seen, *self.folder.glob("*/*.json")}:
                state = None
                with contextlib.suppress(OSError):
                    state = (file.stat().st_ino, file.read_bytes())
                if self.seen.setdefault(file, state) != state:
                    self.changed.add(str(file.relative_to(self.folder)))
            time.sleep(0.1)


class Disturbed:
    """A run of an engine that is being disturbed."""

    def __init__(self, place, running, plan, watch):
        self.place, self.engine, self.plan, self.watch = place, running, plan, watch
        # How often each case has been begun in vain.
        self.in_vain = Counter()

    def jobs(self):
        """All jobs that have begun."""
        notes = self.place / "jobs"
        return [Job(line) for line in notes.read_text().splitlines()] if notes.exists() else []

    def new_job(self):
        """Waits for a job that has just begun to measure a case which was not disturbed yet."""
        before = len(self.jobs())
        found = []

        def begun():
            found[:] = [job for job in self.jobs()[before:] if job.is_new and job.lives() and not self.in_vain[job.file]]
            assert found or not self.engine.is_over(), "all jobs are done, and nothing is left to disturb"
            return found

        wait(begun, "another job begins")
        return found[-1]

    def said(self, job):
        """The standard error of a job."""
        return (self.place / f"{job.process}.err").read_text()

    def killed(self):
        """A job is killed with -9: it must leave no result."""
        job = self.new_job()
        os.kill(job.process, signal.SIGKILL)
        self.in_vain[job.file] += 1
        wait(lambda: not job.lives(), "the job is dead")
        return f"killed {job.file}"

    def duplicated(self):
        """The same job once more at the same time: one result wins, the other job says so and succeeds."""
        job = self.new_job()
        # Held until the second one has begun, for it may be short.
        os.kill(job.process, signal.SIGSTOP)
        again = subprocess.Popen(["sh", "-c", SHELL + self.plan[job.file]], cwd=self.place)
        both = lambda: sum(other.is_new for other in self.jobs() if other.file == job.file) == 2
        wait(lambda: both() or again.poll() is not None, "the second job begins")
        os.kill(job.process, signal.SIGCONT)
        assert again.wait() == 0, f"a second job for {job.file} failed"
        assert both(), "the two were not at the same time"
        self.in_vain[job.file] += 1
        return f"measured {job.file} twice at once"

    def repeated(self):
        """A job for a case that is already measured: it measures nothing."""
        file = next(iter(self.watch.seen)).relative_to(self.place)
        subprocess.run(["sh", "-c", SHELL + self.plan[str(file)]], cwd=self.place, check=True)
        job = [job for job in self.jobs() if job.file == str(file)][-1]
        assert not job.is_new and self.said(job).strip(), f"nothing is said of {file}, which was there"
        return f"repeated {file}"

    def filled(self):
        """The disk is full when a job writes: it reports an error and leaves no file."""
        folder = self.place / "runs"
        if not os.path.ismount(folder):
            return "skipped the full disk: only root may mount a small one"
        job = self.new_job()
        before = [other.process for other in self.jobs() if not other.lives()]
        ballast = folder / "ballast"
        with self.engine.paused():
            with contextlib.suppress(OSError), open(ballast, "wb", buffering=0) as full:
                while full.write(bytes(1 << 12)):
                    pass
            wait(lambda: not job.lives(), "the job ends")
            ballast.unlink()
            # Others may have met the full disk as well.
            others = [other for other in self.jobs() if other.process not in before]
            wait(lambda: not any(other.lives() for other in others), "the others end")
            lost = [other for other in others if not (self.place / other.file).exists()]
        assert job.file in [other.file for other in lost], f"{job.file} is there, on a full disk"
        self.in_vain.update(other.file for other in lost)
        errors = [line for line in self.said(job).splitlines() if line.startswith("error: ")]
        assert len(errors) == 1, f"a full disk is told in one sentence, not: {self.said(job)}"
        return f"filled the disk of {job.file}: {errors[0]}"

    def requeued(self):
        """Slurm ends a job and runs it again."""
        job = self.new_job()
        output("scontrol", "requeue", job.slurm)
        self.in_vain[job.file] += 1
        wait(lambda: not job.lives(), "the job is ended")
        # Slurm would wait for two minutes.
        now = ["scontrol", "update", f"JobId={job.slurm}", "StartTime=now"]
        wait(lambda: not subprocess.run(now, check=False, capture_output=True).returncode, "the job is in the queue again")
        return f"requeued {job.file}"

    def drained(self):
        """A node is drained: running jobs finish and no job starts; then it is resumed."""
        job = self.new_job()
        node = output("sinfo", "--noheader", "--format=%n").strip()
        output("scontrol", "update", f"NodeName={node}", "State=DRAIN", "Reason=test")
        # Those that Slurm has given the node before may not have come to sahara yet.
        wait(lambda: not output("squeue", "--noheader", "--states=RUNNING,COMPLETING"), "the node is empty")
        before = len(self.jobs())
        time.sleep(3)
        assert (self.place / job.file).exists(), f"{job.file}, which ran on a drained node, was not finished"
        assert len(self.jobs()) == before, "a job began on a drained node"
        output("scontrol", "update", f"NodeName={node}", "State=RESUME")
        return f"drained the node of {job.file}"


def wait(until, what):
    """Waits until a condition holds."""
    end = time.monotonic() + PATIENCE
    while not until():
        assert time.monotonic() < end, f"not within {PATIENCE} s: {what}"
        time.sleep(0.05)


# A plan is a shell script, of commands that begin with the word sahara.
SHELL = 'sahara() { command "$SAHARA" "$@"; }\n'


def planned(folder):
    """Returns the lines of the plan for a folder by their files."""
    plan = output(os.environ["MEASURES"], "study", "plan", *STUDIES, *OPTIONS, "--dir", "runs", cwd=folder)
    lines = plan.splitlines()
    assert len({line.split()[-1] for line in lines}) == len(lines) > 0, f"two jobs for one file, or none: {plan}"
    return {line.split()[-1]: line for line in lines}


def undisturbed(folder):
    """The plan, one job after the other."""
    folder.mkdir()
    plan = "\n".join(planned(folder).values())
    subprocess.run(["sh", "-e", "-c", SHELL + plan], cwd=folder, check=True, stderr=subprocess.DEVNULL)


def report(folder):
    """Merges the results of a folder."""
    output(os.environ["MEASURES"], "report", "runs", "-o", "report", "--no-pictures", cwd=folder)
    return folder / "report"


def disturbed(name, place):
    """The plan on an engine, with all disturbances."""
    (place / "runs").mkdir(parents=True)
    with small_disk(place / "runs"), cluster(place.parent / "slurm", name != "local"):
        watch = Watch(place / "runs")
        running = engine(name, place, STUDIES, OPTIONS)
        run = Disturbed(place, running, planned(place), watch)
        running.start()
        try:
            whats = [run.killed, run.duplicated, run.filled, run.repeated]
            for what in whats + ([] if name == "local" else [run.requeued, run.drained]):
                print(f"  {what()}", flush=True)
            wait(running.is_over, "all jobs are done")
            if not running.succeeded():
                print("  the same again, for what has failed", flush=True)
                running.start()
                wait(running.is_over, "all jobs are done")
            assert running.succeeded(), f"{name} has failed: see its log in {place}"
            begun = Counter(job.file for job in run.jobs() if job.is_new)

            # And once more: there is nothing left to do.
            running.start()
            wait(running.is_over, "all jobs are done")
            assert running.succeeded() and begun == Counter(job.file for job in run.jobs() if job.is_new), "measured anew"
        finally:
            running.stop()
        watch.over = True
        watch.join()
        assert not watch.changed, f"written twice, or gone: {watch.changed}"
        twice = {file: n for file, n in begun.items() if n != 1 + run.in_vain[file]}
        assert not twice, f"begun so often, without having been disturbed: {twice}"
        # What is left when the small disk is gone.
        shutil.copytree(place / "runs", place / "kept")
    (place / "runs").rmdir()
    (place / "kept").rename(place / "runs")


@contextlib.contextmanager
def small_disk(folder):
    """A disk of a few megabytes in place of a folder, where that is allowed."""
    mount = ["mount", "-t", "tmpfs", "-o", "size=64m", "tmpfs", str(folder)]
    is_there = subprocess.run(mount, check=False, capture_output=True).returncode == 0
    try:
        yield
    finally:
        if is_there:
            output("umount", "--lazy", str(folder))


@contextlib.contextmanager
def cluster(folder, is_wanted):
    """Slurm, if wanted."""
    start = [str(HERE / "start_slurm.sh"), str(folder)]
    if is_wanted:
        os.environ["SLURM_CONF"] = str(folder / "slurm.conf")
        os.environ["PATH"] = f"{folder / 'bin'}:{os.environ['PATH']}"
        output(*start)
    try:
        yield
    finally:
        if is_wanted:
            output(*start, "stop")


def main(name):
    """The test of an engine."""
    folder = Path(tempfile.mkdtemp(prefix="sahara-cluster-"))
    print(f"{name}, in {folder}", flush=True)
    os.environ["MEASURES"] = shutil.which(os.environ.get("SAHARA", "sahara")) or sys.exit("no sahara: name it by SAHARA")
    os.environ["SAHARA"] = str(HERE / "record.sh")
    for run, do in [("undisturbed", undisturbed), ("disturbed", lambda place: disturbed(name, place))]:
        os.environ["RECORD"] = str(folder / run)
        do(folder / run)
    one, other = folder / "undisturbed", folder / "disturbed"
    found = different(results, one / "runs", other / "runs") + different(rows, report(one), report(other))
    assert not found, "\n".join(found)
    print(f"  the same as undisturbed: {len(results(one / 'runs'))} results, and all counts and answers of the report")
    shutil.rmtree(folder)


if __name__ == "__main__":
    # Cluster and disk are taken down as well when the test is ended.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("ended"))
    main(*sys.argv[1:])
