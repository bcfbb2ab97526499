# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files of an output folder earlier runs of `reconstruct` made. A run replaces and removes no
other files.

The record of a step (steps.Records) is written before the step begins, and names what the step makes.
Records of older versions name nothing: their steps made what the same steps make now."""

import fnmatch
import os

from . import files
from .failure import Failure
from .step_kinds import KINDS, ORDER, writes_of
from .steps import STATES, record_file, step_of

REPORT, REPORT_BEGINS = "report.md", b"# Reconstruction\n"
MOST_NAMED = 10


def own_files(name):
    """The log and the records of a step or job."""
    return [f"logs/{name}.log", *(record_file(name, state) + "*" for state in STATES)]


def is_record(record):
    """Whether a JSON object is a record of any version."""
    return isinstance(record.get("chain"), (str, list))


def made_by(name, record):
    """What an earlier run made in the step or job `name`, which has this record."""
    makes = record.get("makes", writes_of(name))
    texts = [text for text in makes if isinstance(text, str)] if isinstance(makes, list) else []
    return [*texts, *own_files(name)]


def owned(out):
    """What earlier runs in the folder `out` made, as patterns. Nothing if `out` has no record. A damaged
    record counts if another record shows that the folder is that of a run."""
    found = {}
    for path in (out / "steps").glob("*.json"):
        name, state = step_of(path)
        if state in STATES:
            record = files.read_object(path)
            found.setdefault(name, {})
            if is_record(record):
                found[name] = {**record, **found[name]}
    if not any(map(is_record, found.values())):
        return []
    return ["steps/options.json*", "steps/plan.json*",
            *(pattern for name, record in found.items() for pattern in made_by(name, record))]


def has_content(path):
    """Whether something would be lost without the file or folder `path`."""
    if path.is_dir() and not path.is_symlink():
        with os.scandir(path) as entries:
            return any(entries)
    return os.path.lexists(path)


def existing(out, pattern):
    """The names below `out` that match, and the folder of `pattern` if it cannot be entered."""
    folder, _, name = pattern.rpartition("/")
    try:
        names = os.listdir(out / folder)
    except OSError:
        return [folder] if folder and os.path.lexists(out / folder) else []
    matching = [f"{folder}/{one}" if folder else one for one in fnmatch.filter(names, name)]
    return [one for one in matching if has_content(out / one)]


def is_report(path):
    try:
        with open(path, "rb") as file:
            return file.read(len(REPORT_BEGINS)) == REPORT_BEGINS
    except OSError:
        return False


def other_files(out):
    """Names that every run writes, if `out` has files of these names that no run made."""
    lock = out / "lock"
    is_own_lock = lock.is_file() and not lock.is_symlink() and lock.stat().st_size == 0
    return [*(["lock"] if os.path.lexists(lock) and not is_own_lock else []),
            *([REPORT] if os.path.lexists(out / REPORT) and not is_report(out / REPORT) else [])]


# What --cluster writes besides. With depth maps and tiles, the names hold any numbers.
OF_CLUSTER = ["steps/options.json*", *(file for kind in KINDS.values() for name in kind.parts
                                       for file in own_files(name))]


def check(out, steps, is_cluster=False):
    """Fails, and names the files, if the `steps` of this run, given by name, would write or remove files
    in the folder `out` that no record of an earlier run names."""
    if os.path.lexists(out) and not out.is_dir():
        raise Failure(f"--output {out}: is not a folder")
    known = owned(out)
    written = [pattern for name in steps for pattern in (*writes_of(name), *own_files(name))]
    written += OF_CLUSTER if is_cluster else []
    foreign = {name for pattern in written for name in existing(out, pattern)
               if not any(fnmatch.fnmatchcase(name, one) for one in known)}
    refuse(out, sorted(foreign | set(other_files(out))))


def left_over(out, steps):
    """The files in the folder `out` that earlier runs made in steps that are not among `steps`, and that
    no longer belong to the results of the other steps."""
    stale = [name for name in ORDER if name not in steps and not (out / record_file(name)).exists()
             and (out / record_file(name, "begun")).exists()]
    return [one for name in stale for pattern in writes_of(name) for one in existing(out, pattern)]


def refuse(out, names):
    """Fails if there are `names`, which are files of somebody else in the folder `out`."""
    if names:
        raise Failure(f"--output {out}: {files.few(names, MOST_NAMED)}: no record of an earlier run names "
                      f"{'this file' if len(names) == 1 else 'these files'}, which this run would "
                      f"replace; move {'it' if len(names) == 1 else 'them'}, or give another --output")
