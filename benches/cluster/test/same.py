#!/usr/bin/env python3
"""Compares two runs of one plan in all fields that do not depend on time, such as counts and hits.

    same.py RUNS OTHER_RUNS [REPORT OTHER_REPORT]

RUNS are folders of results, DIR/<study>/<case>.json; REPORT is what `sahara report DIR -o REPORT` has written.
"""

import csv
import json
import sys
from pathlib import Path

# What a clock, or the moment, decides. All else must be equal, so a new field is compared until it is named here.
OF_CASES = {"provenance", "environment", "build_ns", "build_peak_bytes", "outside", "ns", "slowest_ns"}
# The command line that planned it, and how many answers `--quick` checks: it stops after a time.
OF_CASES |= {"case.command", "checked.rays"}
OF_REPORTS = {"build_ns", "build_peak_bytes", "trace_ns", "ns_per_ray", "slowest_ns", "mrays_per_s", "checked_rays"}
OF_REPORTS |= {"speedup", "speedup_low", "speedup_high"}
# Comparing times decides even whether these are known.
BY_TIMES = {"dominated_by", "pays_off_after_rays"}
# All that these hold is made of times.
TABLES_OF_TIMES = {"replicate.csv"}


def counts(value, of=""):
    """A result in which each time is replaced by whether it is known, and each list of samples by its length."""
    if isinstance(value, dict):
        is_moment = lambda name: name in OF_CASES or f"{of}.{name}" in OF_CASES
        return {name: known(field) if is_moment(name) else counts(field, name) for name, field in value.items()}
    return [counts(item, of) for item in value] if isinstance(value, list) else value


def known(time):
    """Whether a time is known; for a list, its length."""
    return len(time) if isinstance(time, list) else time is not None


def difference(one, other, where=""):
    """The first difference of two values, or None."""
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
    """The rows of a report, by file and row, with times replaced in the same way."""
    found = {}
    for file in sorted(Path(report).glob("data/*.csv")):
        if file.name in TABLES_OF_TIMES:
            continue
        with open(file, newline="") as text:
            for number, row in enumerate(csv.DictReader(text), 1):
                fields = ((name, field) for name, field in row.items() if name not in BY_TIMES)
                found[f"{file.name} row {number}"] = {name: field != "" if name in OF_REPORTS else field for name, field in fields}
    return found


def different(read, one, other):
    """The differences between two folders, one sentence each."""
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
