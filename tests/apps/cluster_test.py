# SPDX-License-Identifier: GPL-3.0-or-later
"""`reconstruct --cluster`: the workflow gives the bytes of `reconstruct` alone, on this machine and on
two nodes of a Slurm cluster, also if it is killed or a node dies."""

import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest
import unittest.mock

import small_slurm
from pipeline_folder import reconstruct_command, simulate
from programs import BIN, main, new_folder, slow
from support import colmap_text

RESULTS = ("scene_dense.mvs", "scene_dense.ply", "scene_dense_mesh.ply", "scene_dense_refined.ply",
           *(f"scene_textured.tile{tile}-2.{kind}" for tile in (1, 2) for kind in ("glb", "ply")),
           "scene_map.dem.tif", "scene_map.ortho.tif")
VIEWS = 16
LONGEST_WAIT = 300  # [s]: other tests may use the processors
SLURM = ("--cluster", "slurm", "--snakemake=--max-status-checks-per-second 1")
ON_TWO_NODES = unittest.skipIf(small_slurm.reason_to_skip(), small_slurm.reason_to_skip())
DENSIFY = "--resolution-level 0 --min-resolution 100 --geometric-iters 1 --plan-parts 2"

# COLMAP's models differ from run to run. This stand-in gives every run the same model.
COLMAP = """#!/bin/sh
[ "$2" = --help ] && exit
case $1 in
  feature_extractor) touch "$3" ;;
  mapper) cp -r "{model}" "$7/0" ;;
esac
"""

# Never ends if it is to make a part of the maps.
SLOW = """#!/bin/sh
for word; do
  [ "$word" = --part ] && exec sleep 600
done
exec "{program}" "$@"
"""

# Fails like a program that needs more memory than the first job of its step has.
HUNGRY = """#!/bin/sh
for word; do
  [ "$before" = --max-memory ] && [ "$word" -lt 10000 ] && exit 1
  before=$word
done
exec "{program}" "$@"
"""


def put_script(path, text):
    path.write_text(text)
    path.chmod(0o755)


@unittest.skipUnless(shutil.which("snakemake"), "snakemake is not installed")
class Workflow(unittest.TestCase):
    """A survey of small views, and the folder of a run of `reconstruct` alone, with which all cases compare. Jobs of
    Slurm start snakemake twice, so cases with Slurm begin with a copy of this folder (as_left_alone)."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(new_folder(cls.addClassCleanup))
        scene = cls.folder / "scene"
        simulate(scene, "survey", VIEWS, (160, 120))
        colmap_text.copy(scene / "sparse", cls.folder / "model", lambda number: number % 60 == 0)
        cls.programs = cls.folder / "bin"
        cls.programs.mkdir()
        for program in pathlib.Path(BIN).resolve().iterdir():
            (cls.programs / program.name).symlink_to(program)
        (cls.programs / "TextureMesh").unlink()
        put_script(cls.programs / "TextureMesh",
                   HUNGRY.format(program=pathlib.Path(BIN).resolve() / "TextureMesh"))
        (cls.folder / "colmap").mkdir()
        put_script(cls.folder / "colmap" / "colmap", COLMAP.format(model=cls.folder / "model"))
        cls.environment = {**os.environ, "PATH": f"{cls.folder / 'colmap'}:{os.environ['PATH']}"}
        cls.reconstruct("out")
        (cls.folder / "out").rename(cls.folder / "alone")

    def as_left_alone(self, *removed):
        """The folder "out" as the run alone left it, without the files of the patterns `removed`."""
        out = self.folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(self.folder / "alone", out)
        for pattern in removed:
            for file in out.glob(pattern):
                file.unlink()

    @classmethod
    def start(cls, out, *more, **process):
        scene = cls.folder / "scene"
        command = reconstruct_command(
            "--matcher", "exhaustive", "--refine-poses=--poses known", f"--densify={DENSIFY}", "--tiles", 2, "--until",
            "map", *more, source=("--images", scene / "water"), lens=scene / "sparse" / "cameras.txt",
            housing=scene / "housing.json", out=out, programs=cls.programs)
        return subprocess.Popen(command, cwd=cls.folder, env=cls.environment, text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, **process)

    @classmethod
    def reconstruct(cls, out, *more):
        process = cls.start(out, *more)
        said = process.communicate(timeout=2 * LONGEST_WAIT)[0]
        assert process.returncode == 0, said
        return said

    def steps_done(self, out):
        return {file.name.removesuffix(".done.json")
                for file in (self.folder / out / "steps").glob("*.done.json")}

    def check(self, out, results=RESULTS):
        for name in results:
            self.assertEqual((self.folder / out / name).read_bytes(),
                             (self.folder / "alone" / name).read_bytes(), name)

    def check_jobs(self, out, *tiled):
        """That jobs made the depth maps, and the tiles of the steps `tiled`."""
        parts = {f"depth-{stage}-{part}of2" for stage in ("photometric", "geometric1")
                 for part in (1, 2)}
        tiles = {f"{step}-tile-{tile}of2" for step in tiled for tile in (1, 2)}
        self.assertLessEqual(parts | {"depth-photometric-whole"} | tiles, self.steps_done(out))

    def wait_for_part(self, process, out):
        """Waits until a job of the depth maps has begun and is not done."""
        steps = self.folder / out / "steps"
        end = time.monotonic() + LONGEST_WAIT
        while not list(steps.glob("depth-*.begun.json")):
            self.assertIsNone(process.poll())
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)


class OnThisMachine(Workflow):
    def test_gives_the_same_bytes_after_it_was_killed(self):
        process = self.start("killed", "--cluster", "local")
        self.wait_for_part(process, "killed")
        process.kill()
        process.communicate(timeout=30)  # returns when all processes have closed their output
        before = self.steps_done("killed")
        self.assertIn("plan", before)
        self.assertNotIn("densify", before)
        # TextureMesh fails, because jobs on this machine are not repeated.
        process = self.start("killed", "--cluster", "local")
        said = process.communicate(timeout=2 * LONGEST_WAIT)[0]
        self.assertEqual(process.returncode, 1)
        self.assertIn("reconstruct: texture: texture: exit code 1, its output is in", said)
        self.assertIn("reconstruct: snakemake: exit code 1; ", said)
        self.assertNotIn("rule refine:", said)
        said = self.reconstruct("killed", "--cluster", "local", "--snakemake=--set-resources "
                                "texture:mem_mb=20000 --resources mem_mb=20000")
        self.assertNotIn("rule densify:", said)
        self.check("killed")
        self.check_jobs("killed", "densify", "mesh")
        # Alone, nothing is left to do.
        self.assertEqual(self.reconstruct("killed").count("done before"), 11)
        self.assertNotIn("\nrule ", self.reconstruct("killed", "--cluster", "local"))

    def test_uses_complete_depth_maps_for_other_options_of_the_fusion(self):
        """A run alone has removed the maps of all stages but the last."""
        twice = f"--densify={DENSIFY.replace('iters 1', 'iters 2')}"
        other = f"{twice} --number-views-fuse 2"
        a_map, clouds = self.folder / "out" / "depth0005.dmap", []
        self.as_left_alone()
        self.reconstruct("out", "--until", "cloud", twice)
        before = a_map.stat().st_mtime_ns
        self.reconstruct("out", "--until", "cloud", other, "--cluster", "local")
        self.assertEqual(a_map.stat().st_mtime_ns, before)
        clouds.append((self.folder / "out" / "scene_dense.ply").read_bytes())
        self.assertEqual(list((self.folder / "out").glob("depth*.*.dmap")), [])
        self.as_left_alone("*.dmap*")
        self.reconstruct("out", "--until", "cloud", other)
        clouds.append((self.folder / "out" / "scene_dense.ply").read_bytes())
        self.assertEqual(list((self.folder / "out").glob("depth*.*.dmap")), [])
        self.assertEqual(*clouds)


@slow
class OnTwoNodes(Workflow):
    def start_cluster(self):
        self.cluster = small_slurm.Cluster()
        self.addCleanup(self.cluster.stop)
        self.cluster.start()
        environment = unittest.mock.patch.dict(self.environment, SLURM_CONF=self.cluster.environment["SLURM_CONF"])
        environment.start()
        self.addCleanup(environment.stop)

    def node_of_part(self):
        """A job of the depth maps that runs, and its node."""
        for line in self.cluster.ask("squeue", "-h", "-t", "R", "-o", "%A %N %j").splitlines():
            job, node, name = line.split()
            if name.startswith("depth-photometric-1of2"):
                return job, node
        return None

    @ON_TWO_NODES
    def test_an_interrupted_run_leaves_no_jobs(self):
        """With eight jobs that never end, snakemake asks for their states most of the time. While it
        asks, it cancels nothing itself."""
        self.start_cluster()
        programs = self.folder / "slow"
        shutil.copytree(self.programs, programs, symlinks=True)
        (programs / "DensifyPointCloud").unlink()
        put_script(programs / "DensifyPointCloud",
                   SLOW.format(program=pathlib.Path(BIN).resolve() / "DensifyPointCloud"))
        self.as_left_alone("steps/poses.done.json")
        process = self.start("out", *SLURM, f"--densify={DENSIFY[:-1]}8", "--programs",
                             str(programs), start_new_session=True)
        self.cluster.wait_for(lambda: self.cluster.ask("squeue", "-h", "-o", "%j").count("of8-") == 8, LONGEST_WAIT)
        time.sleep(4)  # until snakemake asks for the states of all of them
        os.killpg(process.pid, signal.SIGINT)  # like Ctrl-C
        said = process.communicate(timeout=LONGEST_WAIT)[0]
        self.assertEqual(process.returncode, 1)
        self.assertIn("reconstruct: stopped; the same command continues from here", said)
        left = set(self.cluster.ask("squeue", "--noheader", "--format", "%T").split())
        self.assertLessEqual(left, {"COMPLETING"})

    @ON_TWO_NODES
    def test_gives_the_same_bytes_also_if_a_node_dies(self):
        self.start_cluster()
        # The records of begun steps stay: without them, the rest of the files would be the user's.
        self.as_left_alone("*.dmap*", "steps/densify.done.json", "scene_dense.*")
        process = self.start("out", *SLURM, "--until", "cloud")
        self.cluster.wait_for(self.node_of_part, LONGEST_WAIT)
        job, node = self.node_of_part()
        self.cluster.kill(node)
        self.assertNotIn("depth-photometric-1of2", self.steps_done("out"))
        said = process.communicate(timeout=LONGEST_WAIT)[0]
        self.assertEqual(process.returncode, 0, said)
        self.assertRegex(self.cluster.log("slurmctld"),
                         f"requeue job JobId={job} due to failure of node {node}")
        self.check("out", RESULTS[:2])
        self.check_jobs("out", "densify")
        for node in small_slurm.NODES:
            self.assertRegex(self.cluster.log("slurmctld"), f"( on |NodeList=){node}\\b")

    @ON_TWO_NODES
    def test_a_job_that_fails_gets_twice_the_memory(self):
        self.start_cluster()
        self.as_left_alone("steps/texture.done.json", "scene_textured.*")
        said = self.reconstruct("out", *SLURM, "--until", "texture")
        self.assertIn("Trying to restart job", said)
        self.check("out", RESULTS[:-2])


if __name__ == "__main__":
    main()
