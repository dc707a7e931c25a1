#!/usr/bin/env python3
"""Whether two runs of one plan have the same counts and answers: whatever no clock decides.

    same.py RUNS OTHER_RUNS [REPORT OTHER_REPORT]

RUNS are folders of results, DIR/<study>/<case>.json; REPORT is what `sahara report DIR -o REPORT` has written.
"""

import json
import sys
from pathlib import Path

# What a clock, or the moment, decides. All else must be equal, so that a field which is new is compared until it is named here.
OF_CASES = {"provenance", "circumstances", "build_ns", "build_peak_bytes", "outside", "instructions_per_ray", "branch_misses_per_ray"}
OF_CASES |= {"ns", "slowest_ns"}
OF_REPORTS = {"build_samples_ns", "trace_ns", "samples_ns", "twin_samples_ns", "ns_per_ray", "mrays_per_s", "noise_floor"}
# The last is what came of a claim of `predictions`.
OF_REPORTS |= {"speedup", "value"}
MOMENT = OF_CASES | OF_REPORTS
# What is found by comparing times: even whether it is known.
BY_TIMES = {"dominated_by", "verdict"}


def counts(value):
    """A result without its times: of each is left whether it is known, and of samples how many there are."""
    if isinstance(value, dict):
        fields = ((name, field) for name, field in value.items() if name not in BY_TIMES)
        return {name: known(field) if name in MOMENT else counts(field) for name, field in fields}
    return [counts(item) for item in value] if isinstance(value, list) else value


def known(time):
    """What is left of a time, or of several."""
    return len(time) if isinstance(time, list) else time is not None


def difference(one, other, where=""):
    """Where two values differ first; nothing where they do not."""
    if isinstance(one, dict) and isinstance(other, dict):
        for name in [*one, *(name for name in other if name not in one)]:
            if found := difference(one.get(name), other.get(name), f"{where}.{name}"):
                return found
        return None
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        return next(filter(None, (difference(a, b, f"{where}[{i}]") for i, (a, b) in enumerate(zip(one, other)))), None)
    return None if one == other else f"{where}: {one!r} and {other!r}"


def results(folder):
    """The results of all cases, by study and case."""
    files = sorted(Path(folder).glob("*/*.json"))
    return {f"{file.parent.name}/{file.name}": counts(json.loads(file.read_text())) for file in files}


def rows(report):
    """The rows of a report, by file and line."""
    files = sorted(Path(report).glob("data/*.jsonl"))
    lines = {file.name: file.read_text().splitlines() for file in files}
    return {f"{name} line {i + 1}": counts(json.loads(line)) for name in lines for i, line in enumerate(lines[name])}


def different(read, one, other):
    """What differs between two folders, a sentence each."""
    one, other = read(one), read(other)
    if not one:
        return ["there is nothing to compare"]
    found = [f"{name} is in one of them only" for name in sorted(one.keys() ^ other.keys())]
    for name in sorted(one.keys() & other.keys()):
        if where := difference(one[name], other[name]):
            found.append(f"{name} differs in {where}")
    return found


if __name__ == "__main__":
    found = different(results, *sys.argv[1:3])
    if len(sys.argv) > 3:
        found += different(rows, *sys.argv[3:5])
    if found:
        sys.exit("\n".join(found))
    print(f"the same: {len(results(sys.argv[1]))} results")
