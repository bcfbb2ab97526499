# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages of docs/ and the README: the options reference is what the programs print, links lead
somewhere, and quoted messages are in the source."""

import difflib
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from programs import BIN, main

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs"))
import options_reference  # noqa: E402

PAGES = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *(ROOT / "data").rglob("*.md")]


class OptionsReference(unittest.TestCase):
    def generated(self, **environment):
        """The page that the generator writes now, in another folder and environment."""
        with tempfile.TemporaryDirectory(prefix="axial_") as folder:
            page = pathlib.Path(folder) / "page.md"
            done = subprocess.run(
                [sys.executable, str(ROOT / "docs" / "options_reference.py"), BIN, "-o", page],
                cwd=folder, env={**os.environ, **environment}, text=True, capture_output=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            return page.read_text(encoding="utf-8")

    def test_page_is_what_the_programs_print(self):
        page = (ROOT / "docs" / "options-reference.md").read_text(encoding="utf-8")
        new = self.generated()
        if new != page:
            differences = "\n".join(difflib.unified_diff(
                page.splitlines(), new.splitlines(), "docs/options-reference.md", "--help",
                lineterm="", n=0))
            self.fail(f"{differences}\ndocs/options-reference.md is not what --help prints. This "
                      f"command renews it:\n    {options_reference.COMMAND}")

    def test_page_does_not_depend_on_the_environment(self):
        self.assertEqual(self.generated(COLUMNS="40", LC_ALL="C", AXIAL_BIN="/elsewhere"),
                         self.generated(COLUMNS="200"))

    def test_broken_lines_are_joined(self):
        """The program breaks lines at blanks, and words that are longer than half a line."""
        joined = options_reference.joined
        self.assertEqual(joined(["base of ", "paths"], 10), "base of paths")
        self.assertEqual(joined(["01234 6789", "paths"], 10), "01234 6789 paths")
        self.assertEqual(joined(["012 abcdef", "ghi jk"], 10), "012 abcdefghi jk")


class Links(unittest.TestCase):
    def anchors(self, page):
        """The anchors that GitHub gives to the headings of a page."""
        found = set()
        text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
        for heading in re.findall(r"^#+ (.*)$", text, re.M):
            plain = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
            anchor = re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")
            number = 0
            while (f"{anchor}-{number}" if number else anchor) in found:
                number += 1
            found.add(f"{anchor}-{number}" if number else anchor)
        return found

    def test_links_lead_to_files_and_headings(self):
        for page in PAGES:
            for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
                if re.match(r"[a-z]+:", link):
                    continue
                file, _, anchor = link.partition("#")
                target = (page.parent / file).resolve() if file else page
                where = f"{page.relative_to(ROOT)}: {link}"
                self.assertTrue(target.exists(), where)
                if anchor:
                    self.assertIn(anchor, self.anchors(target), where)

    def test_every_page_is_in_the_index(self):
        index = (ROOT / "docs" / "README.md").read_text(encoding="utf-8")
        for page in (ROOT / "docs").glob("*.md"):
            if page.name != "README.md":
                self.assertIn(f"({page.name})", index)


class Version(unittest.TestCase):
    def test_changelog_and_citation_have_the_version_of_cmake(self):
        version = re.search(r"project\(AxialMVS VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
        citation = (ROOT / "docs" / "CITATION.cff").read_text(encoding="utf-8")
        changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
        latest, date = re.search(r"^## \[(\d[^]]*)\] - (\S+)$", changelog, re.M).groups()
        self.assertEqual(latest, version)
        self.assertIn(f"\nversion: {version}\ndate-released: {date}\n", citation)


class Pictures(unittest.TestCase):
    def test_all_together_are_small(self):
        pictures = list((ROOT / "docs" / "images").iterdir())
        self.assertLess(sum(picture.stat().st_size for picture in pictures), 1_000_000)

    def test_each_is_shown_by_a_page(self):
        shown = {name for page in PAGES
                 for name in re.findall(r"images/(\w+\.\w+)", page.read_text(encoding="utf-8"))}
        pictures = {picture.name for picture in (ROOT / "docs" / "images").iterdir()}
        self.assertEqual(pictures - shown, set())


class Messages(unittest.TestCase):
    def test_quoted_messages_are_in_the_source(self):
        """In troubleshooting.md, "..." stands for a value. A message may be put together from two
        texts at a ": ". A library's message contains "{}" where the program puts the option that sets
        a setting, with the value of OptionList::sets()."""
        source = "\n".join(path.read_text(encoding="utf-8")
                           for folder in ("apps", "libs") for path in (ROOT / folder).rglob("*")
                           if path.suffix in (".cpp", ".h", ".py"))
        source = re.sub(r'"\s*f?"', "", source)  # joins the literals of one message
        options = sorted(re.findall(r'add\w*\(\s*"([\w-]+)', source), key=len, reverse=True)
        values = re.findall(r'\.sets\("[^"]*", "([^"]+)"\)', source)
        self.assertGreater(len(options), 100)
        self.assertGreater(len(values), 2)
        option = f"--(?:{'|'.join(options)})(?:{'|'.join(values)})?"
        page = (ROOT / "docs" / "troubleshooting.md").read_text(encoding="utf-8")
        quoted = re.findall(r"^    (.*)$", page, re.M)
        self.assertGreater(len(quoted), 50)
        for message in quoted:
            for part in re.split(r"\.\.\.|: ", message):
                text = part.strip(" :")
                unnamed = re.sub(option, "{}", text)
                self.assertTrue(text in source or unnamed in source, (text, message))


class Headers(unittest.TestCase):
    """The reference of the headers is made without warnings (docs/Doxyfile)."""

    def made(self, folder, **settings):
        settings = {"OUTPUT_DIRECTORY": folder, **settings}
        text = (ROOT / "docs" / "Doxyfile").read_text(encoding="utf-8")
        text += "".join(f"{name} = {value}\n" for name, value in settings.items())
        return subprocess.run(["doxygen", "-"], input=text, cwd=ROOT, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def test_every_header_has_a_page_with_its_comments(self):
        with tempfile.TemporaryDirectory() as folder:
            result = self.made(folder)
            self.assertEqual((result.returncode, result.stdout), (0, ""))
            pages = pathlib.Path(folder) / "html"
            for part in ("refractive", "libs/public/axial"):
                for header in (ROOT / part).glob("*.h"):
                    page = pages / (header.name.replace("_", "__").replace(".", "_8") + ".html")
                    self.assertTrue(page.is_file(), header)
            ray = (pages / "structaxial_1_1refractive_1_1AxialRay.html").read_text(encoding="utf-8")
            self.assertIn("The direction has unit length.", ray)

    def test_a_warning_is_an_error(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.md"
            page.write_text("# Page\n\nSee \\ref missing.\n", encoding="utf-8")
            result = self.made(folder, INPUT=page, USE_MDFILE_AS_MAINPAGE=page)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn("missing", result.stdout)


if __name__ == "__main__":
    main()
