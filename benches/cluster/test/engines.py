"""The engines: how the jobs of a plan are started on each, and whether jobs remain."""

import contextlib
import os
import signal
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
CLUSTER = HERE.parent


def output(*command, **options):
    """What a command prints; it must succeed."""
    return subprocess.run(command, check=True, capture_output=True, text=True, **options).stdout


class Snakemake:
    """Snakemake, on this machine or with the Slurm executor. A job that fails is run again by itself."""

    # Without accounting the executor would wait for ever for the answers of sacct. The first look is early: the jobs are short.
    SLURM = ["--executor", "slurm", "--slurm-status-command", "squeue", "--slurm-no-account", "--jobs", "100"]
    SLURM += ["--slurm-init-seconds-before-status-checks", "5"]

    def __init__(self, place, studies, options, slurm):
        self.place = place
        config = [f"studies={' '.join(studies)}", f"options={' '.join(options)}"]
        where = self.SLURM if slurm else ["--cores", "1"]
        self.command = ["snakemake", "--snakefile", str(CLUSTER / "Snakefile"), "--keep-going", "--retries", "2", *where]
        self.command += ["--config", *config]
        self.process = None

    def start(self):
        """Starts all that is missing."""
        with open(self.place / "snakemake.log", "a") as log:
            self.process = subprocess.Popen(self.command, cwd=self.place, stdin=subprocess.DEVNULL, stdout=log, stderr=log)

    def is_over(self):
        """Whether no job is left."""
        return self.process.poll() is not None

    def succeeded(self):
        """Whether it exited successfully."""
        return self.process.wait() == 0

    @contextlib.contextmanager
    def paused(self):
        """While paused, no failed job is retried; otherwise the number of starts would be random."""
        self.process.send_signal(signal.SIGSTOP)
        try:
            yield
        finally:
            self.process.send_signal(signal.SIGCONT)

    def stop(self):
        """Kills it: on SIGTERM it would wait for its jobs, possibly on a drained node."""
        if not self.is_over():
            self.process.kill()
            self.process.wait()


class Array:
    """slurm-array.sh. A failed task is not retried; submitting the array again measures the missing cases."""

    def __init__(self, place, studies, options):
        self.place = place
        plan = output(os.environ["SAHARA"], "study", "plan", *studies, *options, "--dir", "runs", cwd=place)
        (place / "plan.txt").write_text(plan)
        self.tasks = len(plan.splitlines())
        self.job = None

    def start(self):
        """Starts the whole plan; a task whose file is there ends at once."""
        script = str(CLUSTER / "slurm-array.sh")
        array = ["sbatch", "--parsable", f"--array=1-{self.tasks}%2"]
        self.job = output(*array, script, "plan.txt", cwd=self.place).strip()

    def is_over(self):
        """Whether no task is left."""
        return not output("squeue", "--noheader", f"--jobs={self.job}")

    def succeeded(self):
        """Whether each task has succeeded."""
        states = output("squeue", "--noheader", "--states=all", "--array", "--format=%T", f"--jobs={self.job}").split()
        return states == ["COMPLETED"] * self.tasks

    def paused(self):
        """A failed task is not run again by itself."""
        return contextlib.nullcontext()

    def stop(self):
        """Ends its tasks."""
        subprocess.run(["scancel", self.job], check=False)


def engine(name, place, studies, options):
    """The engine of that name, working in the folder `place`; exits with a message if a program is missing."""
    needed = {"local": ["snakemake"], "slurm": ["snakemake", "slurmctld", "munged"], "array": ["slurmctld", "munged"]}
    if name not in needed:
        sys.exit(f"there is no engine {name}: it is one of {', '.join(needed)}")
    return Array(place, studies, options) if name == "array" else Snakemake(place, studies, options, name == "slurm")
