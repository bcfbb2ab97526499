# SPDX-License-Identifier: GPL-3.0-or-later
"""The file that tells the page of ViewScene how a survey was made: the steps of `reconstruct` with
their commands, times, versions and warnings (docs/view.md)."""

import collections
import json
import re

from . import control, files, jobs
from .steps import Records

FOUND = ("lenses", "cameras", "lines", "videos", "date", "joint", "dated", "doubled",
         "exposures")  # what the first checks add to the options

WARNINGS = re.compile(
    r"^\d\d:\d\d:\d\d \[\w+\] warning: (?P<ours>.*)$"  # libs/base/log.cpp
    r"|^W\d{4,8} [\d:.]+ +\d+ (?P<colmap>.*)$"  # COLMAP, by glog
    r"|^WARNING: (?P<old_colmap>.*)$", re.MULTILINE)


def warnings_of(logs):
    """The warnings in the files `logs`, each once with the number of times that it occurs."""
    counts = collections.Counter()
    for log in logs:
        if log.is_file():
            found = WARNINGS.finditer(log.read_text(errors="replace"))
            counts.update(match[match.lastgroup].strip() for match in found)
    return [{"text": text, "times": times} for text, times in counts.items()]


def entry_of(step, todo, out):
    logs = [out / "logs" / f"{name}.log" for name in (*jobs.parts_of(step.name, todo, out), step.name)]
    return {"name": step.name, "command": step.command, "seconds": jobs.seconds_of(step, todo, out),
            "version": Records(out).read(step).get("version"), "warnings": warnings_of(logs)}


def command_of(given):
    """The words of a command that has the options `given`."""
    found = {**vars(given), "lens": vars(given).get("lenses"), "video": vars(given).get("videos")}
    found["images"] = "" if found["video"] else vars(given).get("images")  # the first checks set it for videos
    return ["reconstruct", *(f"--{name.replace('_', '-')}={one}" for name, value in found.items()
                             if value and name not in FOUND for one in (value if isinstance(value, list) else [value]))]


def write_run(path, given, todo, out):
    """Writes the file `path` about the steps `todo`, which are done, of a run in the folder `out`.
    `given`: the options of `reconstruct`."""
    run = {"command": command_of(given), "steps": [entry_of(step, todo, out) for step in todo]}
    refined = files.read_object(out / "refined" / "report.json").get("control")
    if refined:
        run["control"] = control.rows_of(refined)
    files.write(path, json.dumps(run, indent=1))
