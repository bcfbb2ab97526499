# SPDX-License-Identifier: GPL-3.0-or-later
"""apps/pipeline/reconstruct with stand-ins for the programs, in a folder of its own."""

import os
import select
import subprocess

from pipeline_folder import InFolder, reconstruct_command
from programs import png

from axial_pipeline.programs import NAMES


def photograph(number):
    """The bytes of a photograph; each number gives another one."""
    return png([bytes([number] * 4)] * 3)


PHOTOGRAPHS = [photograph(number) for number in range(3)]
# A stand-in for every program of the pipeline; its file name tells which one. It runs in the folder
# above `out`. In a step, it appends its command line to the file `commands` and writes the files that
# the next program reads. If there is a pipe `pipe-NAME`, the program opens it and sleeps, so that the
# pipe closes when the program ends. With `child-pipe-NAME`, a child of the program does so.
STAND_IN = """#!/bin/sh
case "$*" in *--help) echo "--SpatialMatching.is_gps "; exit ;; *axial_first_check_*) exit ;; esac
name=${0##*/}
case $1 in --version|help) echo "$name 7.8"; exit ;; esac
echo "$name $*" >> commands
if [ -p "pipe-$name" ]; then exec > "pipe-$name"; echo begun; exec sleep 60; fi
if [ -p "child-pipe-$name" ]; then
  (exec > "child-pipe-$name"; echo begun; exec sleep 60); echo ended >> commands
fi
case "$name $*" in
  "colmap feature_extractor "*) touch out/features.db ;;
  "colmap mapper "*) mkdir out/colmap/0; printf '\\1\\0\\0\\0\\0\\0\\0\\0' > out/colmap/0/images.bin ;;
  *" --effective-lens "*) echo "1 OPENCV 4 3 9 9 2 1 0 0 0 0" > out/start_lens.txt ;;
  RefinePoses*) mkdir out/refined; echo '{"rms_before_px": 1, "rms_after_px": 1, "cameras": [],
    "observations_after": 1, "points_after": 1, "images": [], "scale_sigma": 0, "shape_sigma": 0, "depth_sigma": 0}' \
    > out/refined/report.json ;;
  InterfaceCOLMAP*--mask-path*) mkdir -p out/colmap_masks ;;
  InterfaceCOLMAP*) touch out/scene.mvs ;;
  DensifyPointCloud*) touch out/scene_dense.ply ;;
  ReconstructMesh*) touch out/scene_dense_mesh.ply ;;
  RefineMesh*) touch out/scene_dense_refined.ply ;;
  TextureMesh*) touch out/scene_textured.glb out/scene_textured.ply ;;
  TransformScene*) touch out/scene_dense.las ;;
  CompareSurveys*) touch out/scene.change.json ;;
  MapSurface*) touch out/scene_map.dem.tif out/scene_map.ortho.tif out/scene_map.views.tif ;;
esac
"""
# A stand-in for the browser that prints report.html: Chromium takes seconds to start.
BROWSER = """for word; do
  case $word in --print-to-pdf=*) printf '%%PDF-1.4\\n%%%%EOF\\n' > "${word#*=}" ;; esac
done"""


class StandIns(InFolder):
    """The whole script, with stand-in programs that end at once or sleep."""

    source = ("--images", "images")

    def setUp(self):
        super().setUp()
        self.put_on_path()
        for name in ("colmap", *NAMES, "TransformScene"):
            self.write(name, STAND_IN).chmod(0o755)
        self.put_script("chromium", BROWSER)
        for name in ("lens", "housing"):
            self.write(name, "")
        for number, content in enumerate(PHOTOGRAPHS):
            self.write(f"images/{number}.png", content)

    def add_to(self, program, script):
        """Lets a stand-in do more."""
        with (self.folder / program).open("a") as file:
            file.write(script)

    def start(self, *more):
        process = subprocess.Popen(reconstruct_command(*more, source=self.source, programs="."), cwd=self.folder,
                                   text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def ended(self, *more):
        process = self.start(*more)
        said, complaint = process.communicate(timeout=60)
        return subprocess.CompletedProcess([], process.returncode, said, complaint)

    def succeeds(self, *options):
        """Returns what the run said."""
        ended = self.ended(*options)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""), options)
        return ended.stdout

    def done_before(self, *options):
        """How many steps a run does not repeat."""
        return self.succeeds(*options).count("done before")

    def everything(self):
        """All names below the folder, with the contents of files."""
        return {path: path.read_bytes() if path.is_file() else None for path in self.folder.rglob("*")}

    def refused(self, *options):
        """Checks that the run ends in its first second, with one line, and changes nothing. Returns the
        line."""
        before = self.everything()
        ended = self.ended(*options)
        self.assertEqual((ended.returncode, ended.stderr.count("\n")), (1, 1), ended.stderr)
        self.assertTrue(ended.stderr.startswith("reconstruct: "), ended.stderr)
        self.assertNotIn("Traceback", ended.stderr)
        self.assertEqual(self.everything(), before)
        return ended.stderr.removeprefix("reconstruct: ").rstrip("\n")

    def commands(self):
        """The command lines of all programs so far."""
        file = self.folder / "commands"
        return file.read_text().splitlines() if file.exists() else []

    def command_of(self, program):
        """The last command line of a program."""
        return [line for line in self.commands() if line.startswith(program + " ")][-1]

    def held_at(self, program, prefix="pipe"):
        """Starts a run that stays in the step of this program. Returns the run and the pipe."""
        os.mkfifo(self.folder / f"{prefix}-{program}")
        pipe = os.open(self.folder / f"{prefix}-{program}", os.O_RDONLY | os.O_NONBLOCK)
        self.addCleanup(os.close, pipe)
        process = self.start()
        self.assertEqual(self.next_of(pipe), b"begun\n")
        return process, pipe

    def next_of(self, pipe):
        """What the program writes next to its pipe; empty if the program has ended."""
        self.assertTrue(select.select([pipe], [], [], 30)[0], "neither said anything nor ended")
        return os.read(pipe, 100)
