# SPDX-License-Identifier: GPL-3.0-or-later
"""apps/pipeline/reconstruct: from raw underwater photographs to a cloud in one command, which goes
on after it was killed at any step."""

import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

from pipeline_folder import reconstruct_command, simulate
from programs import BIN, main, new_folder, read_json
from readers import shown_scene
from support import colmap_text

STEPS = ["features", "lens", "matches", "poses", "refine", "import", "densify", "mesh",
         "refine-mesh", "texture", "map", "evaluate"]
PAGE = pathlib.Path(BIN).resolve().parent / "share" / "axialmvs" / "view" / "viewer.js"
if PAGE.exists():
    STEPS.insert(-1, "page")
QUICK = ("--densify=--resolution-level 1 --min-resolution 200", "--mesh=-d 4", "--refine-mesh=--scales 1")


@unittest.skipUnless(shutil.which("colmap"), "COLMAP is not installed")
class Reconstruct(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(new_folder(cls.addClassCleanup))
        cls.scene = cls.folder / "scene"
        simulate(cls.scene, "closeup", 6, (640, 480))
        cls.positions = cls.scene / "positions.txt"
        cls.positions.write_text(colmap_text.positions(cls.scene / "sparse"))

    def start(self, out, *more, **options):
        """Starts the script in the folder above `out`, with a relative path to `out`."""
        return subprocess.Popen(self.command(out, *more), cwd=out.parent, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, **options)

    def ended(self, out, *more):
        process = self.start(out, *more)
        said, complaint = process.communicate(timeout=600)
        return subprocess.CompletedProcess([], process.returncode, said, complaint)

    def command(self, out, *more):
        return reconstruct_command(
            "--truth", self.scene / "mesh.ply", "--scale-from", f"positions:{self.positions}", *more,
            source=("--images", self.scene / "water"), lens=self.scene / "sparse" / "cameras.txt",
            housing=self.scene / "housing.json", out=out.name)

    def killed_at(self, step, out):
        """Kills the pipeline with all its children soon after `step` began. Returns its output
        until then."""
        process = self.start(out, *QUICK, start_new_session=True)
        said = ""
        for line in process.stdout:
            said += line
            if f"] {step}" in line and "done before" not in line:
                break
        time.sleep(0.1)
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return said

    def test_goes_on_where_it_was_killed(self):
        out = self.folder / "killed"
        for number, step in enumerate(STEPS):
            said = self.killed_at(step, out)
            # The step before this one was killed, so this run had to finish it.
            self.assertGreaterEqual(said.count("done before"), number - 1, said)
        ended = self.ended(out, *QUICK)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertGreaterEqual(ended.stdout.count("done before"), len(STEPS) - 1, ended.stdout)
        self.check(out)
        again = self.ended(out, *QUICK)
        self.assertEqual(again.stdout.count("done before"), len(STEPS), again.stdout)

    def check(self, out):
        report = read_json(out, "refined", "report.json")
        self.assertLess(report["rms_after_px"], 1)
        self.assertEqual(len(report["images"]), 6)
        self.assertIn("mean distance to the truth", (out / "report.md").read_text())
        self.assertIn(f"<td>{report['rms_after_px']:.3f}</td>", (out / "report.html").read_text())
        evaluation = read_json(out, "evaluation.json")
        self.assertGreater(evaluation["accuracy"]["count"], 12500)  # 50,000 at full resolution
        self.assertLess(evaluation["accuracy"]["median"], 0.002)
        self.assertTrue((out / "scene_textured.glb").read_bytes().startswith(b"glTF"))
        for kind in ("dem", "ortho", "views"):
            self.assertTrue((out / f"scene_map.{kind}.tif").read_bytes().startswith(b"II"), kind)
        self.assertEqual((out / "page" / "index.html").exists(), "page" in STEPS)
        if "page" in STEPS:
            self.check_page(out)
            self.assertIn("of the rectangle of the map have a height:", (out / "report.html").read_text())

    def check_page(self, out):
        scene = shown_scene(out / "page")
        self.assertEqual([step["name"] for step in scene["run"]["steps"]], STEPS[:-2])
        for step in scene["run"]["steps"]:
            program = pathlib.Path(step["command"][0]).name
            self.assertTrue(step["version"].lower().startswith(program.lower() + " "), step["version"])
        self.assertEqual(len(scene["depth_maps"]), 6)
        self.assertTrue({"ortho", "height", "views"} <= {layer["id"] for layer in scene["map"]["layers"]})
        self.assertLess(scene["residuals"]["rms"], 1)
        self.assertEqual(len(scene["residuals"]["photographs"]), 6)
        self.assertEqual(scene["truth"], "mesh.ply")

    def test_says_what_is_missing(self):
        out = self.folder / "missing"
        for options, message in [
                (["--lens", "nowhere.txt"], "--lens nowhere.txt: not found"),
                (["--scale-from", "positions:none"],
                 "--scale-from positions:none: file not found"),
                (["--densify", "'a b"], "--densify 'a b: No closing quotation"),
                (["--until", "cloud", "--mesh", "--decimate 0.5"],
                 "--mesh --decimate 0.5: ReconstructMesh does not run with --until cloud"),
                (["--tiles", "2", "--map=--hillshade"],
                 "--map --hillshade: MapSurface does not run with --until texture"),
                (["--without", "mesh"], "--without mesh: mesh is not one of refine-mesh, texture, map, "
                 "page, report"),
                (["--without", "map", "--map=--hillshade"],
                 "--map --hillshade: contradicts --without map"),
                (["--compare=--align none"], "--compare --align none: is only for --earlier"),
                (["--earlier", str(self.scene)], f"--earlier {self.scene.resolve()}: has neither "
                 "scene_dense_refined.ply nor scene_dense_mesh.ply"),
                (["--tiles", "0"], "--tiles 0: must be from 1 to 1000"),
                (["--programs", str(self.scene)],
                 f"--programs {self.scene.resolve()}: RefinePoses not found; build the programs first")]:
            ended = self.ended(out, *options)
            self.assertEqual(ended.returncode, 1)
            self.assertEqual(ended.stderr, f"reconstruct: {message}\n")
            self.assertFalse(out.exists())

    def test_names_positions_of_no_photograph(self):
        out = self.folder / "positions"
        lines = colmap_text.positions(self.scene / "sparse").splitlines(keepends=True)
        misspelt = self.folder / "misspelt.txt"
        misspelt.write_text("# survey\n" + "".join(["other" + line for line in lines[:-2]]
                                                   + lines[-2:]))
        ended = self.ended(out, "--scale-from", f"positions:{misspelt}")
        self.assertEqual(ended.returncode, 1)
        self.assertEqual(ended.stderr, f"reconstruct: {misspelt}: 2 of its names are "
                                       f"photographs in {(self.scene / 'water').resolve()}, at "
                                       "least 3 are needed\n")
        self.assertFalse(out.exists())


if __name__ == "__main__":
    main()
