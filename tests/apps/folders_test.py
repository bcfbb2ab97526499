# SPDX-License-Identifier: GPL-3.0-or-later
"""The arrows between the folders of the source tree (CONTRIBUTING.md, "The source tree"): a library
links a library if and only if one of its files includes a header of that library. The build alone
does not check this, because libraries are linked on behalf of other libraries, too, and because
headers without functions need no link. The arrows that CONTRIBUTING.md draws are those of CMake."""

import pathlib
import re
import unittest

from programs import main, new_folder

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Links without an include, and the reason for the link.
LINKED_FOR = {("lens", "base"): "the definitions of fmt with which the precompiled headers are made"}
GENERATED = {"axial_commit.h"}  # headers that the build writes


def libraries(root):
    """The folder of each library."""
    folders = {path.parent.name: path.parent for path in root.glob("libs/*/CMakeLists.txt")}
    return {"refractive": root / "refractive"} | folders


def linked(folder, names):
    """The libraries of the project that the CMakeLists.txt of `folder` links."""
    text = re.sub(r"#.*", "", (folder / "CMakeLists.txt").read_text(encoding="utf-8"))
    words = []
    for call, arguments in re.findall(r"(\w+)\s*\(([^()]*)\)", text):
        if call in ("add_axial_library", "add_axial_app"):
            words += re.split(r"\bLINK\b", arguments, maxsplit=1)[-1].split()
        elif call == "target_link_libraries":
            words += [word.removeprefix("axial_") for word in arguments.split()[1:]]
    return names & set(words)


def included(root, folder, file):
    """Pairs of an include in `file` and the library that has this header, in the compiler's order
    of folders. The library is None for files outside the libraries and for headers that do not
    exist."""
    owners = {path.resolve(): name for name, path in libraries(root).items()}
    for header in root.glob("libs/public/axial/*.h"):  # scene_images.h belongs to the library scene
        owners[header.resolve()] = header.stem.split("_")[0]
    text = file.read_text(encoding="utf-8")
    for sign, name in re.findall(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', text, re.M):
        places = [root / "libs/public", root / "libs", root]
        if sign == '"':
            places = [file.parent, *places, folder]  # the last for headers in private/
        found = [(place / name).resolve() for place in places if (place / name).is_file()]
        if found:
            yield name, next((owners[up] for up in (found[0], *found[0].parents) if up in owners), None)
        elif sign == '"' and name not in GENERATED:
            yield name, None


def faults(root, linked_for):
    """One line for each include without a link, each link without an include, and each exception
    that is none."""
    found = []
    folders = libraries(root)
    for library, folder in folders.items():
        links, used = linked(folder, set(folders)), set()
        for file in sorted(folder.rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            for header, other in included(root, folder, file):
                used.add(other)
                if other != library and other not in links:
                    found.append(f"{file.relative_to(root)} includes {header}, but {library} "
                                 f"does not link {other or 'a library with this header'}")
        allowed = {link for one, link in linked_for if one == library}
        found += [f"{library} links {link}, but includes none of its headers"
                  for link in sorted(links - used - allowed)]
        found += [f"{library} needs no exception for {link}"
                  for link in sorted(allowed - (links - used))]
    return found


def needed(links, direct):
    """The libraries of `links` that no other library of `links` links, directly or not."""
    def below(name):
        return set().union(*({other} | below(other) for other in direct[name]))
    return links - set().union(*(below(name) for name in links))


def arrows(root):
    """The lines "folder -> folders" of the libraries and programs, as CONTRIBUTING.md draws them: without the
    arrows that follow from others."""
    folders = libraries(root)
    direct = {name: linked(folder, set(folders)) for name, folder in folders.items()}
    programs = {path.parent.name: linked(path.parent, set(folders)) for path in root.glob("apps/*/CMakeLists.txt")}
    return {f"{name} -> {' '.join(sorted(needed(links, direct)))}"
            for name, links in (direct | programs).items() if links}


class Folders(unittest.TestCase):
    def test_includes_and_links_agree(self):
        self.assertEqual(faults(ROOT, LINKED_FOR), [])

    def test_all_libraries_of_the_build_are_read(self):
        text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
        built = " ".join(re.findall(r"(?:set\(|APPEND )AXIAL_LIBRARIES ([^)]*)\)", text)).split()
        self.assertEqual(set(libraries(ROOT)), set(built))
        links = {name: linked(folder, set(built)) for name, folder in libraries(ROOT).items()}
        self.assertEqual(links["refractive"] | links["base"], set())
        self.assertEqual([name for name in built[2:] if not links[name]], [])
        for i, name in enumerate(built):
            self.assertLessEqual(links[name], set(built[:i]), name)

    def test_public_headers_include_no_private_header(self):
        names = set(libraries(ROOT))
        for header in (ROOT / "libs/public/axial").glob("*.h"):
            self.assertIn(header.stem.split("_")[0], names)
            included_names = re.findall(r'#include "([^"]+)"', header.read_text(encoding="utf-8"))
            private = [name for name in included_names if not name.startswith(("axial/", "refractive/"))]
            self.assertEqual(private, [], header)

    def test_contributing_draws_the_arrows_of_cmake(self):
        text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
        lines = re.findall(r"^    (\w+ -> .*)$", text, re.M)
        drawn = {arrow for line in lines for arrow in line.split("; ")}
        self.assertEqual(sorted(drawn), sorted(arrows(ROOT)), "CONTRIBUTING.md, The source tree")


class WrongFolders(unittest.TestCase):
    """A tree of three libraries in which a file or a list of links is changed."""

    def setUp(self):
        self.root = pathlib.Path(new_folder(self.addCleanup))
        self.write("refractive/CMakeLists.txt", "target_link_libraries(axial_refractive INTERFACE "
                                                "Eigen3::Eigen)\n")
        self.write("refractive/ray.h", "#include <cmath>\n")
        self.write("libs/low/CMakeLists.txt", "add_axial_library(low SOURCES a.cpp\n"
                                              "  LINK refractive opencv_core)\n")
        self.write("libs/low/a.h", '#include "refractive/ray.h"\n')
        self.write("libs/low/a.cpp", '#include "low/a.h"\n#include "private/part.h"\n')
        self.write("libs/low/private/part.h", "")
        self.write("libs/high/CMakeLists.txt", "# LINK refractive\n"
                                               "add_axial_library(high SOURCES b.cpp LINK low)\n")
        self.write("libs/high/b.cpp", '#include "low/a.h"\n')

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text, encoding="utf-8")

    def expect(self, *parts, linked_for=()):
        found = faults(self.root, linked_for)
        self.assertEqual(len(found), len(parts), found)
        for part, fault in zip(parts, found):
            self.assertIn(part, fault)

    def test_the_unchanged_tree_has_no_fault(self):
        self.expect()

    def test_an_include_needs_a_direct_link(self):
        for include in ('"refractive/ray.h"', "<refractive/ray.h>", '"../../refractive/ray.h"'):
            self.write("libs/high/b.cpp", f'#include "low/a.h"\n  # include {include}\n')
            self.expect("libs/high/b.cpp includes")

    def test_an_include_upwards_is_a_fault(self):
        self.write("libs/high/b.h", "")
        self.write("libs/low/private/part.h", '#include "high/b.h"\n')
        self.expect("low does not link high")
        self.write("libs/low/private/part.h", "")
        self.write("refractive/ray.h", '#include "low/a.h"\n')
        self.expect("refractive does not link low")

    def test_arrows_that_follow_from_others_are_not_drawn(self):
        self.write("libs/high/CMakeLists.txt", "add_axial_library(high SOURCES b.cpp LINK low refractive)\n")
        self.write("apps/Tool/CMakeLists.txt", "add_axial_app(Tool SOURCES main.cpp LINK high low)\n")
        self.assertEqual(arrows(self.root), {"low -> refractive", "high -> low", "Tool -> high"})

    def test_private_headers_are_for_their_library(self):
        self.write("libs/high/b.cpp", '#include "low/a.h"\n#include "private/part.h"\n')
        self.expect("libs/high/b.cpp includes private/part.h")

    def test_a_link_needs_an_include(self):
        self.write("libs/high/b.cpp", "")
        self.expect("high links low, but includes none")
        self.expect(linked_for={("high", "low")})

    def test_an_exception_without_need_is_a_fault(self):
        self.expect("high needs no exception for low", linked_for={("high", "low")})


if __name__ == "__main__":
    main()
