# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions that are compiled for a special instruction set must not share a name with functions in
other object files. The linker would keep only one copy, and a processor without this instruction
set could execute it. Arguments: the program nm, then the object files of the libraries. The object
files of *_avx2.cpp and *_avx512.cpp are compared with all other files."""

import functools
import re
import subprocess
import sys


@functools.cache
def shared_names(nm, path):
    """The names that the linker merges with equal names in other files: weak and unique symbols."""
    lines = subprocess.run([nm, "--defined-only", path], check=True, capture_output=True,
                           text=True).stdout.splitlines()
    fields = [line.split() for line in lines]
    return {f[-1] for f in fields if len(f) == 3 and f[1] in "WwVvu"}


def has_code(name):
    """False for type information, tables and references to handlers: they have no instructions."""
    return not name.startswith(("_ZTI", "_ZTS", "_ZTV", "DW.ref."))


def main():
    nm, objects = sys.argv[1], sys.argv[2:]
    special = [path for path in objects if re.search("_avx(2|512)", path)]
    assert len(special) == 6, f"expected six files for instruction sets, got {special}"
    names = {path: {name for name in shared_names(nm, path) if has_code(name)} for path in special}
    assert any(names.values()), "no names at all"
    failed = False
    for path, own in names.items():
        for other in objects:
            if other == path:
                continue
            for name in sorted(own & shared_names(nm, other)):
                print(f"{path} and {other} share {name}")
                failed = True
    sys.exit(1 if failed else 0)


main()
