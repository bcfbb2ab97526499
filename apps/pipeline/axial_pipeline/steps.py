# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps that are done once. A killed run that is started again with the same commands and inputs
continues with the step that was killed. With other commands or inputs, it continues with the first
step that differs."""

import hashlib
import json
import math
import pathlib
import shlex
import time

from . import files
from .programs import version_of
from .running import logged
from .step_kinds import writes_of


class Step:
    """One command, the files from outside that it `reads`, and the file or folder that it `makes`, or
    the Files or Tiles.

    `anew`: paths that are removed before the command starts, because the command would add to them.
    `changed`: paths that are removed only if an earlier step or an input changed, because otherwise
    the command continues with them. `before`, `after`: functions, called before the command and
    after its success. `excuse`: a text by which the command says that it found nothing, after which
    the step goes on. `settings`: words that say what `before` and `after` do, where neither the command
    nor a file that the step reads says it."""

    def __init__(self, name, command, makes, reads=(), anew=(), changed=(), before=lambda: None,
                 after=lambda: None, excuse=None, settings=()):
        self.name = name
        self.command = [str(word) for word in command]
        self.makes = makes
        self.reads = [pathlib.Path(path) for path in reads]
        self.anew = anew
        self.changed = changed
        self.before = before
        self.after = after
        self.writes = writes_of(name)
        self.excuse = excuse
        self.settings = list(settings)

    def fingerprint(self):
        """The settings, and names, sizes and times of change of all files that the step reads."""
        found = []
        for path in self.reads:
            found += files.below(path) if path.is_dir() else [path]
        return [*self.settings, *([str(file), file.stat().st_size, file.stat().st_mtime_ns]
                                  for file in found if file.is_file())]


class Files:
    """The result of a step that makes several files."""

    def __init__(self, *paths):
        self.paths = paths

    def exists(self):
        return all(path.exists() for path in self.paths)


class Tiles:
    """The result of a step that makes several files. A tile without content has no file, so one of
    them is enough."""

    def __init__(self, folder, pattern):
        self.folder, self.pattern = folder, pattern

    def exists(self):
        return any(self.folder.glob(self.pattern))


class Report:
    """The result of a step that makes a file of JSON. A damaged file does not exist."""

    def __init__(self, path):
        self.path = path

    def exists(self):
        return bool(files.read_object(self.path))


def read_record(path):
    """A record; empty if there is none or if it is damaged."""
    record = files.read_object(path)
    seconds = record.get("seconds", 0)
    is_whole = isinstance(seconds, (int, float)) and math.isfinite(seconds)
    return {"seconds": 0, **record} if record and is_whole else {}


def digest(chain):
    """What a record says about a chain, which has a line for each photograph."""
    return hashlib.sha256(json.dumps(chain).encode()).hexdigest()


STATES = ("begun", "done")  # of records


def record_file(name, state="done"):
    """The record that a step or job is "done" or "begun", relative to the folder of the output files."""
    return f"steps/{name}.{state}.json"


def step_of(path):
    """The name of the step or job to which the record `path` belongs, and its state."""
    name, _, state = path.name.removesuffix(".json").rpartition(".")
    return name, state


class Records:
    """Says for each step of a run in the folder `out` whether it was begun and done, and with the digest of
    which chain: the commands and inputs of all steps up to this one."""

    def __init__(self, out):
        self.out = out

    def read(self, step, state="done"):
        return read_record(self.out / record_file(step.name, state))

    def write(self, step, state, record):
        path = self.out / record_file(step.name, state)
        path.parent.mkdir(parents=True, exist_ok=True)
        files.write(path, json.dumps(record))

    def forget(self, names):
        """Removes the records that the steps with these names are done."""
        for name in names:
            files.clear(self.out / record_file(name))


def with_chains(todo):
    """The steps of `todo`, each with the commands and inputs of all steps up to it."""
    chain = []
    for step in todo:
        chain = [*chain, step.command, step.fingerprint()]
        yield step, chain


def chain_to(name, todo):
    """The chain of the step of `todo` with this name."""
    return next(chain for step, chain in with_chains(todo) if step.name == name)


def is_done(step, chain, records):
    return records.read(step).get("chain") == digest(chain) and step.makes.exists()


def perform(step, chain, records, logs, limits=()):
    """Runs a step that is not done. Returns its time in seconds. `limits`: words that the command
    gets in addition, which never change its result."""
    changed = records.read(step, "begun").get("chain") != digest(chain)
    for path in [*step.anew, *(step.changed if changed else [])]:
        files.clear(path)
    makes = {"makes": step.writes} if step.writes else {}
    records.write(step, "begun", {"chain": digest(chain), **makes})
    begin = time.monotonic()
    logs.mkdir(exist_ok=True)
    step.before()
    logged([*step.command, *limits], logs / f"{step.name}.log", step.name, step.excuse)
    step.after()
    seconds = round(time.monotonic() - begin, 1)
    records.write(step, "done", {"chain": digest(chain), "seconds": seconds, "ended": time.time(),
                                 "version": version_of(step.command)})
    return seconds


def names_from(number, todo, order):
    """The names of the steps that use the result of the step todo[number], and its own name. `order`:
    the names of all steps, including those that do not run."""
    name = todo[number].name
    others = order[order.index(name) + 1:] if name in order else []
    return {*(step.name for step in todo[number:]), *others}


def run_all(todo, out, order=()):
    """Runs the steps that are not done, with records in `out`/steps and logs in `out`/logs. Returns
    the time of every step in seconds, by the step's name. `order`: as for names_from()."""
    records, seconds = Records(out), {}
    for number, (step, chain) in enumerate(with_chains(todo)):
        headline = f"[{number + 1}/{len(todo)}] {step.name}"
        if is_done(step, chain, records):
            seconds[step.name] = records.read(step)["seconds"]
            print(f"{headline}: done before", flush=True)
            continue
        records.forget(names_from(number, todo, order))
        print(f"{headline}\n    {shlex.join(step.command)}", flush=True)
        seconds[step.name] = perform(step, chain, records, out / "logs")
    return seconds
