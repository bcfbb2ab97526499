# SPDX-License-Identifier: GPL-3.0-or-later
"""The options among the words of a program's command, and the files and folders that they name. A
program looks up relative paths in its working folder (-w), and reads further options from a file there
(libs/base/program/program.h).

A program takes the begin of an option for the option, such as --mask-pa for --mask-path, and refuses a
begin that several of its options have. So `reconstruct` takes every begin of an option for the option
(has_option(), find_option()), wherever it looks for an option among words of the user."""

import pathlib
import re

# Options whose values the program writes.
WRITTEN = ("--output-file", "--pinhole-export", "--log-file", "--report", "--report-file", "--plan",
           "--output-view-neighbors-file", "--output-folder")


def abbreviates(word, option):
    """Whether `word` is `option`, perhaps in a shorter form."""
    return len(word) > 2 and word.startswith("--") and option.startswith(word)


def name_of(word):
    """The word without the value that may follow it: --mask-path of --mask-path=FOLDER."""
    return str(word).partition("=")[0]


def find_option(word, options):
    """The one of `options` that `word` gives, perhaps in a shorter form; None if it gives none."""
    name = name_of(word)
    return name if name in options else next(
        (option for option in options if abbreviates(name, option)), None)


def has_option(words, option):
    """Whether `option` is among `words`, perhaps in a shorter form."""
    return any(find_option(word, [option]) for word in words)


def without_options(words, options):
    """The `words` without these options and their values, also in shorter forms. The begin "--p" stays: several
    options have it, and the program refuses it."""
    kept, left = [], iter(words)
    for word in left:
        if len(name_of(word)) > 3 and find_option(word, options):
            if "=" not in str(word):
                next(left, None)  # the value
        else:
            kept.append(word)
    return kept


def options_in(words):
    """Name and value of each option among `words`; the name is empty where there is none."""
    name = ""
    for word in map(str, words):
        if word.startswith("--"):
            name, equals, value = word.partition("=")
            if equals:
                yield name, value
                name = ""
        elif re.match(r"-[A-Za-z]", word):
            name = word[:2]
            if word[2:]:
                yield name, word[2:]
                name = ""
        else:
            yield name, word
            name = ""


def value_of(words, long, short, default):
    values = [value for name, value in options_in(words)
              if name == short or abbreviates(name, long)]
    return values[-1] if values else default


def options_of_file(path):
    """The options in a file with a line `name = value` for each."""
    try:
        text = path.read_text(encoding="utf-8-sig", errors="replace")
    except OSError:
        return []
    lines = (line.partition("#")[0].partition("=") for line in text.splitlines())
    return [(f"--{name.strip()}", value.strip()) for name, equals, value in lines if equals]


def paths_in(options):
    """What may be paths among the values of `options`: also FILE of a value KIND:FILE."""
    for name, value in options:
        if name == "-o" or any(abbreviates(name, option) for option in WRITTEN):
            continue
        yield value
        if ":" in value:
            yield value.partition(":")[2]


def is_there(path):
    try:
        return path.exists()
    except (OSError, ValueError):  # too long for a path, for example
        return False


def read_by(command, words):
    """The existing files and folders that `words`, a part of the `command` of a program, and the
    program's file of options name, and this file. Relative paths are as the program sees them from
    its working folder."""
    program, *rest = map(str, command)
    folder = pathlib.Path(value_of(rest, "--working-folder", "-w", "."))
    file = folder / value_of(rest, "--config-file", "-c", f"{pathlib.Path(program).name}.cfg")
    named = [*paths_in(options_in(words)), *paths_in(options_of_file(file))]
    paths = dict.fromkeys([*(folder / name for name in named if name), file])
    return [path for path in paths if is_there(path)]
