# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the program tests: running programs, and checking how they fail."""

import json
import os
import re
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import scenes

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))  # for `support`
BIN = os.environ.get("AXIAL_BIN", "")


def run(program, *arguments, file_size_limit=None, address_space=None, cwd=None, timeout=600):
    """Runs a program to its end. `file_size_limit` [bytes] simulates a full disk, and `address_space`
    [bytes] little memory. If
    SimulateUnderwater rendered a scene from the same arguments before, the scene is copied
    (scenes.py)."""

    def limit():
        # With the signal ignored, a write beyond the limit fails with an error, as on a full disk.
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        for kind, most in ((resource.RLIMIT_FSIZE, file_size_limit), (resource.RLIMIT_AS, address_space)):
            if most is not None:
                resource.setrlimit(kind, (most, most))

    def execute(command):
        return subprocess.run(
            command, cwd=cwd, text=True, errors="replace", stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, timeout=timeout,
            preexec_fn=limit if limited else None)

    limited = file_size_limit is not None or address_space is not None
    command = [os.path.join(BIN, program), *map(str, arguments)]
    if not limited and scenes.can_be_shared(command):
        return scenes.rendered(command, execute)
    return execute(command)


def must(program, *arguments, **options):
    """Runs a program that has to succeed, and returns its standard output. For setUpClass."""
    result = run(program, *arguments, **options)
    assert result.returncode == 0, f"{program} {arguments}: {result.stderr}"
    return result.stdout


def without_streams(closed, *command, **options):
    """A command that ended, whose standard streams of these numbers were closed."""
    streams = " ".join(f"{descriptor}>&-" for descriptor in closed)
    return subprocess.run(["bash", "-c", f'exec "$@" {streams}', "bash", *map(str, command)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=60, **options)


def dead_process():
    """The id of a process that has ended."""
    process = subprocess.Popen(["true"])
    process.wait()
    return process.pid


def files_below(folder):
    return {os.path.relpath(os.path.join(path, name), folder)
            for path, _, names in os.walk(folder) for name in names}


def read(path):
    with open(path, "rb") as file:
        return file.read()


def read_json(*path):
    return json.loads(read(os.path.join(*path)))


def write(path, data):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb" if isinstance(data, bytes) else "w") as file:
        file.write(data)


def contents(folder):
    """The bytes of all files below a folder, by name."""
    return {name: read(os.path.join(folder, name)) for name in files_below(folder)}


def png(rows, color_type=0, bits=8):
    """The bytes of a PNG. Each of `rows` holds its samples in the byte order of the format. `color_type`:
    0 grey, 2 RGB, 6 RGBA."""
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))
    width = 8 * len(rows[0]) // bits // {0: 1, 2: 3, 6: 4}[color_type]
    header = struct.pack(">IIBBBBB", width, len(rows), bits, color_type, 0, 0, 0)
    pixels = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels)
            + chunk(b"IEND", b""))


def cloud_size(ply):
    return int(re.search(rb"element vertex (\d+)", ply)[1])


def new_folder(clean_up):
    """A temporary folder. `clean_up`: addCleanup of a test, or addClassCleanup of a class of tests."""
    folder = tempfile.TemporaryDirectory(prefix="axial_")
    clean_up(folder.cleanup)
    return os.path.realpath(folder.name)


class ProgramTest(unittest.TestCase):
    def setUp(self):
        self.folder = new_folder(self.addCleanup)

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def succeeds(self, program, *arguments, **options):
        result = run(program, *arguments, **options)
        self.assertEqual(result.returncode, 0, f"{program} {arguments}: {result.stderr}")
        return result

    def refuses(self, expected, program, *arguments, **options):
        """Checks for exit code 1, one line on standard error that contains `expected`, no new
        file."""
        before = files_below(self.folder)
        result = run(program, *arguments, **options)
        said = f"{program} {arguments}: exit code {result.returncode}, said: {result.stderr!r}"
        self.assertEqual(result.returncode, 1, said)
        self.assertEqual(result.stderr.count("\n"), 1, said)
        self.assertTrue(result.stderr.endswith("\n"), said)
        self.assertIn(expected, result.stderr, said)
        self.assertEqual(files_below(self.folder) - before, set(), said)
        return result

    def refuses_and_keeps(self, expected, *command, **options):
        """As refuses(), and no file is changed."""
        before = contents(self.folder)
        result = self.refuses(expected, *command, **options)
        self.assertEqual(contents(self.folder), before, command)
        return result

    def refuses_each(self, command, *cases):
        """`cases`: the expected text and the arguments behind `command`."""
        for expected, *arguments in cases:
            with self.subTest(arguments=arguments):
                self.refuses_and_keeps(expected, *command, *arguments)

    def refuses_contents(self, path, command, *cases):
        """`cases`: the expected text, and the content of the file `path`, which is put back at the end."""
        before = read(path) if os.path.exists(path) else None
        for expected, content in cases:
            with self.subTest(expected=expected):
                write(path, content)
                self.refuses_and_keeps(expected, *command)
        os.remove(path)
        if before is not None:
            write(path, before)

    def new_files(self, folder, *command):
        """The names and contents of the files that a command adds to a folder, and its output."""
        before = files_below(folder)
        said = self.succeeds(*command).stdout
        return {name: read(os.path.join(folder, name)) for name in files_below(folder) - before}, said

    def near(self, found, expected, within):
        for a, b in zip(found, expected, strict=True):
            self.assertLess(abs(a - b), within)


def slow(test):
    """Marks a class that takes minutes: only `tests/run.sh --all` runs it."""
    test.slow = True
    return test


def main():
    """Runs all cases, or those of the classes on the command line. --list prints the classes, and those that take
    minutes only if AXIAL_EVERY_TEST is ON in the environment."""
    if sys.argv[1:] == ["--list"]:
        loader = unittest.defaultTestLoader
        every = os.environ.get("AXIAL_EVERY_TEST") == "ON"
        print("\n".join(name for name, value in vars(sys.modules["__main__"]).items()
                        if isinstance(value, type) and issubclass(value, unittest.TestCase)
                        and loader.getTestCaseNames(value) and (every or not vars(value).get("slow"))))
        return
    if not BIN:
        sys.exit("set AXIAL_BIN to the folder of the programs")
    unittest.main(verbosity=2)
