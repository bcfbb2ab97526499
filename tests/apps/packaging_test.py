# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of packaging/ agree with the project: versions, license, and names of files, packages and programs. What
they make is tested by install/install_test and by the acceptance points archive-elsewhere and debian-packages."""

import json
import os
import pathlib
import re
import subprocess
import unittest

from programs import BIN, main

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGING = ROOT / "packaging"


def text_of(name):
    return (ROOT / name).read_text(encoding="utf-8")


VERSION = re.search(r"project\(AxialMVS VERSION (\S+)", text_of("CMakeLists.txt"))[1]


class DebianFiles(unittest.TestCase):
    def test_the_changes_are_those_of_the_changelog(self):
        versions = re.findall(r"^axialmvs \((\S+)\)", text_of("packaging/debian/changelog"), re.M)
        self.assertEqual(versions, re.findall(r"^## \[(\d[^]]*)\]", text_of("CHANGELOG.md"), re.M))

    def test_dates_of_the_changes(self):
        dates = re.findall(r"^## \[\d[^]]*\] - (\S+)$", text_of("CHANGELOG.md"), re.M)
        written = [subprocess.run(["date", "-u", "-d", date, "+%a, %d %b %Y"], text=True, check=True,
                                  capture_output=True, env={"LC_ALL": "C", "PATH": os.environ["PATH"]}).stdout.strip()
                   for date in dates]
        self.assertEqual(re.findall(r">  (.*) 00:00:00 \+0000$", text_of("packaging/debian/changelog"), re.M), written)

    def test_the_copyright_has_the_licenses_of_the_source(self):
        stated = re.findall(r"^License: (.*)", text_of("packaging/debian/copyright"), re.M)
        self.assertEqual(set(stated), {"GPL-3+", "BSD-3-clause", "GPL-3+ and Expat", "Expat"})
        written = " ".join(re.sub(r"^ \.?", "", text_of("packaging/debian/copyright"), flags=re.M).split())
        _, terms = text_of("refractive/LICENSE").split("AxialMVS developers")
        self.assertIn(" ".join(terms.split()), written)

    def test_each_package_has_its_overrides_with_a_reason(self):
        packages = re.findall(r"^\s*axial_install_debian_files\((\S+) \w+\)",
                              text_of("cmake/AxialPackages.cmake"), re.M)
        self.assertEqual(len(packages), 2)
        for package in packages:
            lines = text_of(f"packaging/debian/{package}.lintian-overrides").splitlines()
            self.assertTrue(lines[0].startswith("# "))
            for line in lines:
                self.assertRegex(line, f"^(# |{package}: )")


class Dockerfile(unittest.TestCase):
    LINES = re.sub(r"^#.*\n", "", text_of("packaging/Dockerfile"), flags=re.M).replace("\\\n", " ").splitlines()
    STEPS = [line.split(maxsplit=1) for line in LINES if line.strip()]

    def values(self, instruction):
        return [value for name, value in self.STEPS if name == instruction]

    def test_it_has_known_instructions(self):
        self.assertLessEqual({name for name, _ in self.STEPS},
                             {"FROM", "WORKDIR", "COPY", "RUN", "USER", "ENV", "CMD"})

    def test_each_copied_file_exists(self):
        for copied in self.values("COPY"):
            for source in copied.split()[:-1]:
                self.assertTrue((ROOT / source).exists(), source)

    def test_stages_that_are_named_exist(self):
        stages = re.findall(r" AS (\w+)", "\n".join(self.values("FROM")))
        for run in self.values("RUN"):
            for stage in re.findall(r"from=(\w+)", run):
                self.assertIn(stage, stages)

    def test_the_commands_of_the_stages_parse(self):
        for run in self.values("RUN"):
            command = re.sub(r"^(--\S+ )+", "", run)
            subprocess.run(["sh", "-n", "-c", command], check=True)

    def test_the_user_of_the_image_is_not_root(self):
        last = self.STEPS[max(i for i, (name, _) in enumerate(self.STEPS) if name == "FROM"):]
        user, = [value for name, value in last if name == "USER"]
        self.assertIn(f"useradd --create-home {user}", [value for name, value in last if name == "RUN"])
        self.assertIn(json.loads(dict(last)["CMD"])[0].removeprefix("axial-"), os.listdir(ROOT / "apps/pipeline"))

    def test_the_documented_commands_are_those_of_the_file(self):
        comment = re.sub(r"^# ?", "", text_of("packaging/Dockerfile"), flags=re.M)
        commands = re.findall(r"^ +docker .*(?:\\\n.*)*", text_of("docs/install.md"), re.M)
        self.assertEqual(len(commands), 2)
        for command in commands:
            self.assertIn(" ".join(command.split()), " ".join(comment.split()))


class Conda(unittest.TestCase):
    def setUp(self):
        text = text_of("packaging/conda/meta.yaml")
        self.version = re.search(r'{% set version = "(.*)" %}', text)[1]
        plain = re.sub(r"{%.*%}\n", "", text).replace("{{ version }}", self.version)
        # Debian's Python has the module, because snakemake needs it.
        convert = "import json, sys, yaml; print(json.dumps(yaml.safe_load(sys.stdin)))"
        read = subprocess.run(["/usr/bin/python3", "-c", convert], input=plain, text=True, capture_output=True,
                              check=True)
        self.recipe = json.loads(read.stdout)

    def test_version_license_and_archive(self):
        self.assertEqual((self.version, self.recipe["package"]["version"]), (VERSION, VERSION))
        self.assertEqual(self.recipe["about"]["license"], "GPL-3.0-or-later")
        archive = pathlib.PurePath("packaging/conda", self.recipe["source"]["url"])
        self.assertEqual(os.path.normpath(archive), f"build/axialmvs-{VERSION}-linux-x86_64.tar.xz")

    def test_glibc_is_that_of_the_documents(self):
        needed = re.search(r"glibc (\S+) is in", text_of("docs/install.md"))[1]
        self.assertIn(f"__glibc >={needed}", self.recipe["requirements"]["run"])

    def test_its_programs_exist(self):
        scripts = {f"axial-{name}" for name in os.listdir(ROOT / "apps/pipeline")}
        for command in self.recipe["test"]["commands"]:
            self.assertIn(command.split()[0], {*os.listdir(BIN), *scripts})

    def test_the_script_parses(self):
        subprocess.run(["bash", "-n", PACKAGING / "conda/build.sh"], check=True)


if __name__ == "__main__":
    main()
