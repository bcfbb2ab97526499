# SPDX-License-Identifier: GPL-3.0-or-later
"""Wrong input, made from a seed: each program gets a small valid set of files, of which one is
damaged, or one option is given a nasty value. A program may succeed, or end with exit code 1 and one
line on standard error that names a file or an option. Then nothing but this line may be left: outputs
are complete or absent, and those of an earlier run stay. Faults are kept with the damaged file:

    python3 tests/acceptance/mutations.py [--count N] [--first N] [--programs NAME...] [--jobs N]
        [--bin FOLDER] [--work FOLDER]

A mutation is repeated by --programs NAME --first SEED --count 1. The point `mutations` of
tests/acceptance.sh runs 1,000 mutations of each program."""

import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from mutation_inputs import PROGRAMS, make_inputs
from mutation_kinds import damage, nasty_option

MEMORY = 1 << 30  # most resident memory of a run [bytes]
ADDRESS_SPACE = 8 << 30  # a guard of the machine, far above MEMORY [bytes]
SECONDS = 20  # of processor time, and three times as much in all; the valid runs take below 1 s
CHUNK = 50  # mutations of one program that a worker makes in a row


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(command, folder):
    """Exit code (negative: signal; None: no end), standard error, and peak memory [bytes]."""
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stderr=said,
                                   stdout=subprocess.DEVNULL, preexec_fn=limit)
        end = time.monotonic() + 3 * SECONDS
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() > end:
                process.send_signal(signal.SIGKILL)
                os.wait4(process.pid, 0)
                process.returncode = -signal.SIGKILL
                return None, "", 0
            time.sleep(0.002)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        code = None if process.returncode == -signal.SIGXCPU else process.returncode
        return code, said.read().decode(errors="replace"), usage.ru_maxrss * 1024


class Folder:
    """A copy of the inputs in which runs take place, and its files as they should be."""

    def __init__(self, source, path):
        shutil.copytree(source, path, symlinks=True)
        self.path, self.kept, self.stamps = path, {}, {}
        for file in self.files():
            self.kept[file] = (path / file).read_bytes()
            self.stamps[file] = self.stamp(file)

    def files(self):
        found = set()
        for folder, folders, names in os.walk(self.path):
            links = [name for name in folders if os.path.islink(os.path.join(folder, name))]
            found |= {os.path.relpath(os.path.join(folder, name), self.path)
                      for name in names + links}
        return found

    def stamp(self, file):
        state = os.lstat(self.path / file)
        return state.st_mtime_ns, state.st_size, state.st_mode, state.st_ino

    def changes(self, but):
        """The files that differ, without `but`."""
        present = self.files()
        return sorted(file for file in present | self.kept.keys() if file not in but
                      and (file not in present or file not in self.kept or
                           (self.stamp(file) != self.stamps[file] and
                            (self.path / file).read_bytes() != self.kept[file])))

    def remove(self, file):
        path = self.path / file
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        elif os.path.lexists(path):
            path.unlink()

    def write(self, file):
        (self.path / file).parent.mkdir(parents=True, exist_ok=True)
        (self.path / file).write_bytes(self.kept[file])
        self.stamps[file] = self.stamp(file)

    def restore(self):
        for file in self.files() - self.kept.keys():
            self.remove(file)
        for file in self.kept:
            path = self.path / file
            if not os.path.lexists(path) or self.stamp(file) != self.stamps[file]:
                self.remove(file)
                self.write(file)


def command_of(program, binaries, options):
    return [str(binaries / program.name), *options]


def is_named(line, program, options, folder):
    """Whether an error names a file, an option or a value of the command."""
    values = [word.split("=", 1)[-1] for word in options]
    words = {os.path.basename(word) for word in values} | set(values) | {
        os.path.basename(file) for file in folder.kept} | set(program.may_name)
    words |= {"--", "command line", str(folder.path.parent)}
    return any(word and word in line for word in words)


def faults_of(program, folder, outcome, options, damaged, long_allowed):
    """What is wrong with a run, as lines."""
    code, said, memory = outcome
    faults = []
    if code is None:
        return [] if long_allowed else ["does not end"]
    if code not in (0, 1):
        faults.append(f"exit code {code}" if code > 0 else f"signal {-code}")
    if memory > MEMORY and not long_allowed:
        faults.append(f"{memory >> 20} MB of memory")
    changed = folder.changes({damaged})
    if code == 1:
        if said.count("\n") != 1 or not said.endswith("\n"):
            faults.append(f"{said.count(chr(10))} lines on standard error")
        elif not is_named(said, program, options, folder):
            faults.append("names no file and no option")
        half = [file for file in changed if not re.fullmatch(program.kept_on_error, file)]
        if half:
            faults.append(f"left or changed although it failed: {', '.join(half[:5])}")
    # Temporary files have a number between their name and their extension (base/atomic_file.h).
    left = [file for file in changed if re.search(r"\.(tmp|part)|~$", os.path.basename(file))]
    if left:
        faults.append(f"temporary files are left: {', '.join(left[:5])}")
    return faults


def keep_fault(target, program, seed, folder, damaged, command, outcome, faults):
    place = target / f"{program.name}-{seed}"
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    path = folder.path / damaged if damaged else folder.path
    kind = ("option" if not damaged else "link" if path.is_symlink() else "file" if path.is_file() else
            "pipe" if path.is_fifo() else "folder")
    if kind == "file":
        shutil.copy(path, place / os.path.basename(damaged))
    (place / "fault.json").write_text(json.dumps(
        {"command": command, "damaged": damaged, "kind": kind, "faults": faults, "exit_code": outcome[0],
         "stderr": outcome[1][-4000:], "memory": outcome[2]}, indent=1))


def mutate(program, folder, seed):
    """Damages a file, or an option. Returns the options, the damaged file (None: an option), and
    whether a run may take long."""
    random_of = random.Random(f"{program.name} {seed}")
    if random_of.random() < 0.5:  # no earlier outputs
        for file in program.outputs_in(folder.kept):
            folder.remove(file)
            folder.kept.pop(file)
    options = list(program.options)
    if random_of.random() < 0.2:
        options = nasty_option(random_of, options, program.option_names)
        return options, None, True
    file = random_of.choice(program.inputs)
    damage(random_of, folder.path, file, sorted(folder.kept))
    return options, file, False


def run_chunk(name, first, count, binaries, work):
    """Runs some mutations of a program. Returns the faults as (program, seed, lines), and how many
    runs succeeded."""
    program = PROGRAMS[name]
    source = work / "inputs" / name
    program.option_names = json.loads((work / "inputs" / f"{name}.options.json").read_text())
    found, good = [], 0
    with tempfile.TemporaryDirectory(dir=work, prefix=f"run-{name}-") as place:
        folder = Folder(source, pathlib.Path(place) / "files")
        whole = dict(folder.kept)
        for seed in range(first, first + count):
            folder.kept = dict(whole)
            folder.restore()
            options, damaged, long_allowed = mutate(program, folder, seed)
            command = command_of(program, binaries, options)
            outcome = run(command, folder.path)
            faults = faults_of(program, folder, outcome, options, damaged, long_allowed)
            good += outcome[0] == 0
            if faults:
                keep_fault(work / "faults", program, seed, folder, damaged, command, outcome, faults)
                found.append((name, seed, faults))
    return found, good


def run_all(names, first, count, jobs, binaries, work):
    """Returns all faults, and the number of runs that succeeded, by program."""
    make_inputs(names, binaries, work / "inputs")
    faults, good = [], dict.fromkeys(names, 0)
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        runs = {pool.submit(run_chunk, name, begin, min(CHUNK, first + count - begin), binaries,
                            work): name
                for name in names for begin in range(first, first + count, CHUNK)}
        for done in concurrent.futures.as_completed(runs):
            found, succeeded = done.result()
            good[runs[done]] += succeeded
            faults += found
            for name, seed, lines in found:
                print(f"{name} {seed}: {'; '.join(lines)}", flush=True)
    return faults, good


def parsed():
    root = pathlib.Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, default=1000, help="mutations of each program")
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--programs", nargs="+", default=list(PROGRAMS), choices=list(PROGRAMS))
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--bin", type=pathlib.Path, default=root / "build" / "release" / "bin")
    parser.add_argument("--work", type=pathlib.Path, default=root / "build" / "mutations")
    return parser.parse_args()


def main():
    given = parsed()
    begin = time.monotonic()
    faults, good = run_all(given.programs, given.first, given.count, given.jobs,
                           given.bin.resolve(), given.work.resolve())
    for name, count in good.items():
        print(f"{name}: {given.count} mutations, {count} accepted, "
              f"{sum(fault[0] == name for fault in faults)} faults")
    print(f"{len(faults)} faults in {(time.monotonic() - begin) / 60:.1f} minutes; files in "
          f"{given.work / 'faults'}")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
