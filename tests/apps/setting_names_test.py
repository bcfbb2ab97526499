# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages of libraries mark settings (setting() in libs/public/axial/base.h), and programs put options in their place:
no library names an option, and the programs' tables are complete."""

import pathlib
import re
import unittest

from programs import main, new_folder, write

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Files that parse or declare the options that they name.
DECLARE_OPTIONS = {"libs/base/program/newer_options.cpp", "libs/base/program/option_values.cpp", "libs/base/program/program.cpp",
                   "libs/boundary/options.cpp", "libs/io/openmvs/scene_options.cpp", "libs/map/map_place.cpp",
                   "libs/survey/photograph_options.cpp"}
COMMAND_LINES = "libs/experiments/"  # puts together command lines of programs

# The programs that name the settings of each library, and how many settings the library has at least.
PROGRAMS = {"libs/densify": (5, ["DensifyPointCloud"]), "libs/pose": (5, ["RefinePoses"]),
            "libs/map": (3, ["MapSurface"]), "libs/compare": (2, ["CompareSurveys"]),
            "libs/mesh": (3, ["ReconstructMesh"]),
            "libs/boundary": (2, ["MapSurface", "TextureMesh", "ReconstructMesh", "CompareSurveys"]),
            "libs/texture": (1, ["TextureMesh"]), "libs/video": (1, ["ExtractFrames"]),
            "libs/io/obj": (2, ["ReconstructMesh", "RefineMesh"]), "libs/io/colmap": (3, ["InterfaceCOLMAP"]),
            "libs/survey": (2, ["DensifyPointCloud", "RefineMesh", "TextureMesh", "MapSurface"])}


def literals(text):
    """The string literals of C++ source, without those in comments."""
    token = r'//[^\n]*|/\*.*?\*/|\'(?:\\.|[^\'\\\n])\'|R"\((?P<raw>.*?)\)"|"(?P<plain>(?:\\.|[^"\\\n])*)"'
    for found in re.finditer(token, text, re.S):
        literal = found["plain"] if found["raw"] is None else found["raw"]
        if literal is not None:
            yield literal


def options_in_libraries(root, declare_options):
    """One line for each option that a library names, and for each exception that is none."""
    found, needed = [], set()
    for folder in ("libs", "refractive"):
        for file in sorted((root / folder).rglob("*")):
            name = file.relative_to(root).as_posix()
            if file.suffix not in (".h", ".cpp") or name.startswith(COMMAND_LINES):
                continue
            text = file.read_text(encoding="utf-8")
            named = [literal for literal in literals(text) if re.search(r"--[a-z{]", literal)]
            if name in declare_options and named:
                needed.add(name)
            else:
                found += [f'{name} names an option: "{literal}"' for literal in named]
    return found + [f"{name} names no option" for name in sorted(declare_options - needed)]


def sources(folder):
    """The text of all C++ files of a folder."""
    return "\n".join(path.read_text(encoding="utf-8") for path in folder.rglob("*") if path.suffix in (".h", ".cpp"))


def shared_declarations():
    """Name and text of the functions that declare options of several programs."""
    text = (ROOT / "libs" / "survey" / "photograph_options.cpp").read_text(encoding="utf-8")
    return re.findall(r"^void (declare_\w+)\((.*?)^}", text, re.M | re.S)


def settings_named(program):
    """The settings that a program's table names: the fields of its options' names, and those of rules sets(...)."""
    page = (ROOT / "docs" / "options-reference.md").read_text(encoding="utf-8")
    sections = dict(re.findall(r"^## (\w+)\n(.*?)(?=^## |\Z)", page, re.M | re.S))
    options = re.findall(r"`--([a-z-]+)", sections[program] + page.split("\n## ")[1])
    table = sources(ROOT / "apps" / program)
    for name, declaration in shared_declarations():
        table += declaration if f"{name}(" in table else ""
    return {name.replace("-", "_") for name in options} | set(re.findall(r'\.sets\("([^"]+)"', table))


def names_asked_for(folder):
    """The settings that a library's messages name."""
    text = sources(folder)
    in_table = re.findall(r'"(\w+_sigma)"', text) if folder.name == "pose" else []  # number_groups()
    return set(re.findall(r'\bsetting\("([^"]+)"\)', text)) | set(in_table)


class SettingNames(unittest.TestCase):
    def test_libraries_name_no_options(self):
        self.assertEqual(options_in_libraries(ROOT, DECLARE_OPTIONS), [])

    def test_programs_have_an_option_for_each_setting(self):
        for library, (least, programs) in PROGRAMS.items():
            asked = names_asked_for(ROOT / library)
            self.assertGreaterEqual(len(asked), least, library)
            for program in programs:
                self.assertEqual(asked - settings_named(program), set(), program)


class OptionsInLibraries(unittest.TestCase):
    """A tree of one library that names an option somewhere."""

    def expect(self, faults, name, text, declare_options=frozenset()):
        folder = pathlib.Path(new_folder(self.addCleanup))
        write(folder / name, text)
        found = options_in_libraries(folder, set(declare_options))
        self.assertEqual(len(found), faults, found)

    def test_a_message_with_an_option_is_a_fault(self):
        for text in ('fail("--mask-path {}: is no folder", x);', 'fail("{} (see --bit-depth)", x);',
                     'fail("--{}-sigma", x);', 'char c = \'"\'; f("a \\" --b");'):
            self.expect(1, "libs/a/a.cpp", text)
            self.expect(1, "refractive/a.h", text)

    def test_comments_and_other_text_may_name_options(self):
        for text in ('// "--mask-path"\n', "/* --mask\n-path */", 'f("a -- b", i--);',
                     "--count;", '"Housing {}: {}"'):
            self.expect(0, "libs/a/a.h", text)
        self.expect(0, "libs/experiments/chain.cpp", 'run("--refractive");')

    def test_an_exception_without_need_is_a_fault(self):
        self.expect(0, "libs/a/a.cpp", 'f("--a");', {"libs/a/a.cpp"})
        self.expect(1, "libs/a/a.cpp", 'f("a");', {"libs/a/a.cpp"})


if __name__ == "__main__":
    main()
