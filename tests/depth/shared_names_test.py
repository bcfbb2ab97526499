# SPDX-License-Identifier: GPL-3.0-or-later
"""Code compiled for one instruction set must not share a name with other code. The linker keeps one
copy of a shared name, and a processor without that instruction set might execute it. Arguments: nm,
and the object files of the libraries. The objects of *_avx2.cpp and *_avx512.cpp are compared with
all others."""

import functools
import re
import subprocess
import sys


@functools.cache
def shared_names(nm, path):
    """Weak and unique names, which the linker merges with the same names of other files."""
    lines = subprocess.run([nm, "--defined-only", path], check=True, capture_output=True,
                           text=True).stdout.splitlines()
    fields = [line.split() for line in lines]
    return {f[-1] for f in fields if len(f) == 3 and f[1] in "WwVvu"}


def has_code(name):
    """False for type information, tables and references to handlers: they hold no instructions."""
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
