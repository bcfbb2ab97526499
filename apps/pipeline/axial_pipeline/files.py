# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing and removing files. No file is ever half written under its final name."""

import json
import os
import pathlib
import shutil

from .failure import Failure


def write(path, content):
    """`content`: text or bytes."""
    temporary = path.with_name(path.name + ".tmp")
    temporary.write_bytes(content if isinstance(content, bytes) else content.encode())
    temporary.rename(path)


def write_names(path, names):
    """Writes a line for each name, as COLMAP and the programs read lists of photographs."""
    write(path, "".join(f"{name}\n" for name in names))


def copy_once(source, target):
    """Copies a file. Does nothing if `target` exists."""
    if target.exists():
        return
    temporary = target.with_name(target.name + ".tmp")
    shutil.copyfile(source, temporary)
    temporary.rename(target)


def count(folder):
    """The number of files in a folder and its subfolders."""
    return sum(path.is_file() for path in pathlib.Path(folder).rglob("*"))


def clear(path):
    """Removes a file, a folder or a link, if there is one. What a link leads to stays."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    elif os.path.lexists(path):
        path.unlink()


def below(folder):
    """All files and folders below `folder`, sorted. Links are followed, each folder is visited once."""
    found, visited = [], set()
    for root, folders, names in os.walk(folder, followlinks=True):
        place = os.path.realpath(root)
        if place in visited:
            folders.clear()
            continue
        visited.add(place)
        found += [pathlib.Path(root) / name for name in (*folders, *names)]
    return sorted(found)


def read_object(path):
    """The JSON object in a file; empty if there is no such file or if it is damaged."""
    try:
        value = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    return value if isinstance(value, dict) else {}


def few(names, most=3):
    """The first names, and how many more there are."""
    names = list(names)
    shown = ", ".join(names[:most])
    return shown if len(names) <= most else f"{shown} and {len(names) - most} more"


def existing(option, value, path=None, is_file=False):
    """The `path` in the `value` of an option as text: absolute, without links. Fails if it is not there, or if it
    must be a file and is none. `path`: of a value that says more."""
    path = pathlib.Path(path or value)
    if not (path.is_file() if is_file else path.exists()):
        raise Failure(f"{option} {value}: {'file ' if is_file else ''}not found")
    return str(resolved(option, path))


def resolved(option, path):
    """`path` as an absolute path without links. `option`: its name, for the Failure of a link that
    leads to itself."""
    try:
        return pathlib.Path(path).resolve()
    except (OSError, RuntimeError):  # RuntimeError: Python 3.11 and older
        raise Failure(f"{option} {path}: is a link that leads to itself") from None
