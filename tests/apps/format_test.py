# SPDX-License-Identifier: GPL-3.0-or-later
"""The layout of the C++ files is that of clang-format, with the options in .clang-format."""

import os
import pathlib
import subprocess
import tempfile
import unittest

from programs import main, write

ROOT = pathlib.Path(__file__).resolve().parents[2]


def misplaced(root):
    """The C++ files of the source folders below `root` that clang-format would change."""
    files = [str(file) for folder in ("refractive", "libs", "apps", "tests")
             for file in sorted((root / folder).rglob("*")) if file.suffix in (".h", ".cpp")]
    if not files:
        raise AssertionError(f"no C++ files in {root}")
    checked = subprocess.run(["clang-format", "--dry-run", "-Werror", *files], cwd=root, text=True,
                             stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)
    faults = {line.split(":")[0] for line in checked.stderr.splitlines() if " error: " in line}
    return sorted(os.path.relpath(file, root) for file in faults)


class Format(unittest.TestCase):
    def test_all_files_have_the_layout(self):
        self.assertEqual(misplaced(ROOT), [], "mend with: clang-format -i FILE")

    def test_another_layout_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            write(root / ".clang-format", (ROOT / ".clang-format").read_bytes())
            write(root / "libs" / "good.h", "int f();\n")
            write(root / "libs" / "bad.h", "int  f( );\n")
            self.assertEqual(misplaced(root), ["libs/bad.h"])


if __name__ == "__main__":
    main()
