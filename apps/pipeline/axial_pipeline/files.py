# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing and removing files. No file is ever half written under its final name."""

import pathlib
import shutil


def write(path, text):
    temporary = path.with_name(path.name + ".tmp")
    temporary.write_text(text)
    temporary.rename(path)


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
    """Removes a file or a folder, if there is one."""
    if path.is_dir():
        shutil.rmtree(path)
    elif path.exists():
        path.unlink()
