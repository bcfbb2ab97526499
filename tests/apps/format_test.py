# SPDX-License-Identifier: GPL-3.0-or-later
"""The layout of the C++ files is that of clang-format, with the options in .clang-format. Each source file names its
license."""

import os
import pathlib
import subprocess
import tempfile
import unittest

from programs import main, write

ROOT = pathlib.Path(__file__).resolve().parents[2]


FOLDERS = ("refractive", "libs", "apps", "packaging", "python", "tests")
LICENSES = {"refractive": "BSD-3-Clause"}  # of the other folders: GPL-3.0-or-later


def source_files(root, folder, suffixes):
    return [str(file) for file in sorted((root / folder).rglob("*")) if file.suffix in suffixes]


def misplaced(root):
    """The C++ files of the source folders below `root` that clang-format would change."""
    files = [file for folder in FOLDERS for file in source_files(root, folder, (".h", ".cpp"))]
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


class License(unittest.TestCase):
    def test_each_file_names_the_license_of_its_folder(self):
        for folder in FOLDERS:
            expected = "SPDX-License-Identifier: " + LICENSES.get(folder, "GPL-3.0-or-later")
            for file in source_files(ROOT, folder, (".h", ".cpp", ".py")):
                with open(file, encoding="utf-8") as text:
                    self.assertIn(expected, text.readline() + text.readline(), file)


if __name__ == "__main__":
    main()
