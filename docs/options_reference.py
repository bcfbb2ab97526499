#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes docs/options-reference.md from the --help of every program. Needs only the standard library.

    python3 docs/options_reference.py build/release/bin -o docs/options-reference.md

Without -o the page goes to standard output. The test tests/apps/documents_test.py compares the
page with the programs."""

import argparse
import dataclasses
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
COMMAND = "python3 docs/options_reference.py build/release/bin -o docs/options-reference.md"
# The scripts of apps/pipeline, and their names when they are installed.
SCRIPTS = {"reconstruct": "axial-reconstruct", "colmap-model": "axial-colmap-model"}
# The default of --programs is a path of the machine. With AXIAL_BIN, a script prints this text instead.
PROGRAMS_DEFAULT = "AXIAL_BIN of the environment, else the folder of the script if it is installed, " \
                   "else build/release/bin"
GENERIC = "Generic options"
HELP_WIDTH = 79  # of a full line of --help of the programs in C++

HEADER = f"""# Options reference

This page is generated from `--help`. Do not edit it; this command writes it again:

    {COMMAND}

[Options](options.md) explains the defaults that differ from OpenMVS, and which files and messages the programs write.

* The first column gives the short and the long name. A long name may be abbreviated as long as it stays unambiguous.
* Every option takes a value, unless the first column says "no value". Booleans take 0 or 1. `[1]` marks a boolean whose
  value may be left out: the name alone means 1.
* An empty default means that the option is not set, or that the text explains the default.
* The value of `-i` may also be given without `-i`.
* No default depends on the machine. For example, 0 threads mean that the program counts the cores when it runs. The
  folder of `--programs` depends on the installation: its text says where the programs are looked for.
"""


@dataclasses.dataclass(frozen=True)
class Option:
    names: tuple  # ("-i", "--input-file")
    default: str
    text: str
    value: str = "needed"  # "needed", "optional" or "none"


@dataclasses.dataclass(frozen=True)
class Program:
    name: str
    description: str
    generic: list
    own: list


def joined(lines, width):
    """The text of a description that is broken into lines of at most `width` characters. A line that
    is broken at a blank keeps the blank, unless the blank is just behind a full line. A word that is
    longer than half a line may be broken within the word."""
    text = ""
    for line in lines:
        text += line
        last_word = line.rsplit(" ", 1)[-1]
        if len(line) < width or len(last_word) < width // 2:
            text = text.rstrip(" ") + " "
    return text.strip()


def option_of(head, text):
    """`head`: "-c [ --config-file ] arg (=NAME.cfg)"."""
    names = tuple(re.findall(r"(?<![\w-])--?[a-zA-Z][\w-]*", head.split(" arg")[0].split(" [=")[0]))
    default = re.search(r" \(=(.*)\)$", head)
    value = "optional" if "[=arg" in head else "needed" if " arg" in head else "none"
    return Option(names, default[1] if default else "", text, value)


def parse_help(text):
    """The description and the options in the --help of a program in C++, by the titles of the groups
    of options."""
    first, *lines = text.splitlines()
    column = next(line.index("print this help") for line in lines if "print this help" in line)
    groups, group, options = {}, "", []
    for line in lines:
        if re.match(r"\S.*:$", line):
            group = line[:-1]
        elif line.startswith("  -"):
            head, begin = line, ""
            if len(line) > column and line[column - 1] == " ":
                head, begin = line[:column], line[column:]
            options.append((group, head.strip(), [begin] if begin else []))
        elif line.strip():
            options[-1][2].append(line[column:])
        elif options:
            group = ""
    for group, head, words in options:
        text = joined(words, HELP_WIDTH - column)
        groups.setdefault(group, []).append(option_of(head, text))
    return first.split(": ", 1)[1], groups


def parse_script_help(text):
    """The description and the options in the --help of a Python script, in lines that are not
    broken."""
    usage, description, *rest = text.split("\n\n")
    required = set(re.findall(r"(?<!\S)--?[a-zA-Z][\w-]*", re.sub(r"\[[^]]*\]", "", usage)))
    options, head = [], ""
    for line in "\n".join(rest).splitlines():
        if line.startswith("  -"):
            head, _, begin = line.strip().partition("  ")
            options.append([head, begin.strip()])
        elif line.startswith("    "):
            options[-1][1] += " " + line.strip()
    found = []
    for head, text in options:
        names = tuple(re.findall(r"(?<![\w-])--?[a-zA-Z][\w-]*", re.sub(r"\{.*?\}", "", head)))
        choices = re.search(r"\{(.*?)\}", head)
        default = re.search(r" \(default: (\S+)\)$", text)
        text = text[:default.start()] if default else text
        if choices:
            text += ": " + " or ".join(choices[1].split(","))
        value = "needed" if choices or re.search(r" [A-Z_]+", head) else "none"  # IMAGES is a value
        given = "required" if required & set(names) else default[1] if default else ""
        found.append(Option(names, given, text.strip(), value))
    return description, found


def help_of(command):
    """Runs `command` --help in an empty folder, so that no cfg file is read, and with the same
    environment everywhere."""
    environment = {"PATH": os.environ.get("PATH", ""), "LC_ALL": "C.UTF-8", "COLUMNS": "1000",
                   "AXIAL_BIN": PROGRAMS_DEFAULT, "PYTHONDONTWRITEBYTECODE": "1"}
    if "LD_LIBRARY_PATH" in os.environ:
        environment["LD_LIBRARY_PATH"] = os.environ["LD_LIBRARY_PATH"]
    with tempfile.TemporaryDirectory(prefix="axial_") as folder:
        done = subprocess.run([*map(str, command), "--help"], cwd=folder, env=environment, text=True,
                              capture_output=True, stdin=subprocess.DEVNULL, timeout=60)
    if done.returncode != 0:
        sys.exit(f"{command[-1]} --help: exit code {done.returncode}: {done.stderr}")
    return done.stdout


def program(folder, name):
    # The default cfg file is named after the program.
    text = help_of([folder / name]).replace(f"(={name}.cfg)", "(=NAME.cfg)")
    description, groups = parse_help(text)
    own = [option for group, options in groups.items() if group != GENERIC for option in options]
    return Program(name, description, groups[GENERIC], own)


def script(name):
    path = ROOT / "apps" / "pipeline" / name
    description, options = parse_script_help(help_of([sys.executable, path]))
    return Program(name, description, [], options)


def escaped(text):
    """Text for a cell of a Markdown table."""
    return re.sub(r"([\\|<*])|(?<!\w)_(?=\w)|(?<=>)_", lambda found: "\\" + found[0], text)


def row(option):
    names = ", ".join(f"`{name}`" for name in option.names)
    value = {"needed": "", "optional": " [1]", "none": " (no value)"}[option.value]
    default = option.default
    if default and default != "required":
        default = f"`{default}`"
    return f"| {names}{value} | {default} | {escaped(option.text)} |"


def table(options):
    return "\n".join(["| option | default | meaning |", "|---|---|---|", *map(row, options)])


def capitalised(text):
    text = text[0].upper() + text[1:]
    return text if text.endswith(".") else text + "."


def page(folder):
    names = sorted(path.parent.name for path in (ROOT / "apps").glob("*/main.cpp"))
    programs = [program(folder, name) for name in names]
    common = [option for option in programs[0].generic
              if sum(option in other.generic for other in programs) > len(programs) // 2]
    by_name = {option.names: option for option in common}
    parts = [HEADER, "## Options of every program\n",
             "All programs except the two scripts. NAME is the name of the program.\n",
             table(common) + "\n"]
    for one in programs:
        different = [option for option in one.generic if by_name.get(option.names) != option]
        parts += [f"## {one.name}\n", escaped(capitalised(one.description)) + "\n"]
        parts += [table([*one.own, *different]) + "\n"]
    for name, installed in SCRIPTS.items():
        one = script(name)
        parts += [f"## {name}\n", f"`apps/pipeline/{name}`, installed as `{installed}`. "
                  f"{escaped(capitalised(one.description))}\n", table(one.own) + "\n"]
    return "\n".join(parts)


def main():
    parser = argparse.ArgumentParser(description="Writes the page of all options from --help.")
    parser.add_argument("programs", type=pathlib.Path, help="folder of the programs")
    parser.add_argument("-o", "--output", type=pathlib.Path,
                        help="page to write (default: standard output)")
    given = parser.parse_args()
    text = page(given.programs.resolve())
    if given.output:
        given.output.write_text(text, encoding="utf-8")
    else:
        sys.stdout.write(text)


if __name__ == "__main__":
    main()
