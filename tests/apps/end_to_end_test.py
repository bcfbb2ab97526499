# SPDX-License-Identifier: GPL-3.0-or-later
"""From simulated photographs to evaluated clouds, in air and behind a tilted port under water. Four
views of 512 x 384 of the close-up scene, with true poses."""

import functools
import os
import re
import signal
import subprocess
import time

from programs import BIN, cloud_size, files_below, main, must, new_folder, read, read_json, write
from worlds import FINE, GSD, LEVEL_1, CloseUp


# All three filters of depth maps: the adjusting filter, which is off by default, is one more stage.
ALL_STAGES = ("--postprocess-dmaps", "7", *LEVEL_1)


class EndToEnd(CloseUp):
    SCENE = FINE

    @classmethod
    @functools.cache
    def expected(cls):
        """The outputs of a run under water with all stages, the same for all cases."""
        folder = os.path.join(new_folder(cls.addClassCleanup), "reference")
        cls.imported(os.path.join(folder, "scene.mvs"), "water")
        must("DensifyPointCloud", "-i", "scene.mvs", "-w", folder, "--refractive", "--max-threads", "1", *ALL_STAGES)
        return cls.outputs(folder)

    def check_cloud(self, result):
        # OpenMVS has a mean of half a GSD on such scenes at full resolution, this run a quarter.
        self.assertLess(result["accuracy"]["mean"], 0.4 * GSD)
        self.assertLess(result["accuracy"]["median"], 0.25 * GSD)
        self.assertGreater(result["scores"][0]["precision"], 0.95)
        # Four views do not see much of the object, so recall is far below one in air and in water.
        self.assertGreater(result["scores"][0]["recall"], 0.4)
        self.assertGreater(result["accuracy"]["count"], 60000)

    def test_in_air(self):
        self.import_scene("air", "air")
        self.densify("air", "--resolution-level", "0")
        self.check_cloud(self.scores("air", "air"))

    def test_under_water(self):
        self.import_scene("water", "water")
        self.densify("water", "--refractive", "--resolution-level", "0")
        self.check_cloud(self.scores("water", "water"))

    def test_ignoring_the_port_shows(self):
        self.import_scene("water", "ignored")
        self.densify("ignored", "--camera-model", "pinhole", "--number-views-fuse", "2", *LEVEL_1)
        ignored = self.scores("water", "ignored")["accuracy"]
        self.import_scene("water", "obeyed")
        self.densify("obeyed", "--refractive", "--number-views-fuse", "2", *LEVEL_1)
        obeyed = self.scores("water", "obeyed")["accuracy"]
        # The air gap of 3 cm and the tilt shift rays by centimetres. Matching errs by about 1 mm.
        self.assertGreater(ignored["median"], 5 * obeyed["median"])

    @staticmethod
    def outputs(folder):
        return {name: read(os.path.join(folder, name)) for name in files_below(folder)
                if name.endswith((".dmap", ".ply", ".json", "_dense.mvs"))}

    def check_outputs(self, folder, *leave_out):
        """Compares the outputs in a folder of this case with those of the shared run."""
        found = {name: data for name, data in self.outputs(self.path(folder)).items() if name not in leave_out}
        self.assertEqual(found.keys(), self.expected().keys())
        for name, content in found.items():
            self.assertEqual(content, self.expected()[name], name)

    def test_the_same_bytes_for_any_number_of_threads_and_after_a_kill(self):
        self.assertLess({"depth0003.dmap", "scene_dense.ply"}, set(self.expected()))
        for folder in ("two", "killed"):
            self.import_scene("water", folder)
        self.densify("two", "--refractive", "--max-threads", "2", *ALL_STAGES)
        self.check_outputs("two")

        self.kill_when_finished("killed", "depth0001.photometric.dmap")
        self.assertNotIn("scene_dense.ply", files_below(self.path("killed")))
        # The leftover of a process that was killed between two renames. No process has this id.
        write(self.path("killed", "depth0000.photometric.4194999.tmp.4194999.tmp.dmap"), b"half")
        resumed = self.densify("killed", "--refractive", *ALL_STAGES)
        self.assertRegex(resumed, r"Estimated depth maps: [123] maps existed already")
        self.check_outputs("killed")

        self.assertIn("All 4 depth maps exist already",
                      self.densify("killed", "--refractive", *ALL_STAGES))
        changed = self.densify("killed", "--refractive", "--iters", "3", *ALL_STAGES)
        self.assertNotRegex(changed, "exist(ed)? already", "maps of other options were taken over")

    def test_parts_in_any_order_give_the_bytes_of_one_run(self):
        self.import_scene("water", "parts")
        run = self.command("parts", "--refractive", *ALL_STAGES)
        self.succeeds(*run, "--plan", "plan.json", "--plan-parts", "3")
        plan = read_json(self.path("parts", "plan.json"))
        self.assertEqual((plan["images"], plan["parts"]), (4, 3))
        self.assertEqual(plan["stages"][0], "photometric")
        self.assertEqual(plan["stages"][-1], "adjusted")
        self.assertEqual(list(plan["per_part"]), sorted(plan["stages"]))
        self.assertEqual(len(read_json(self.path("parts", "depth_inputs.json"))["contents"]), 4)
        self.refuses(".photometric.dmap: is missing", *run, "--until", "geometric1", "--part", "1/3")
        for stage in [*plan["stages"][:-1], "maps"]:
            memory = plan["per_part"]["adjusted" if stage == "maps" else stage]["max_memory_mb"]
            for part in (2, 3, 1):
                self.succeeds(*run, "--until", stage, "--part", f"{part}/3", "--max-memory", memory)
        self.assertIn("All 4 depth maps exist already", self.succeeds(*run).stdout)
        self.check_outputs("parts", "plan.json", "depth_inputs.json")

    def test_refuses_wrong_parts(self):
        self.import_scene("air", "refused")
        self.refuses_each(
            self.command("refused", *LEVEL_1), *((f"--part {part}: must be", "--until", "maps", f"--part={part}")
                                               for part in ("0/2", "3/2", "1", "a/b", "1/2/3", "-1/2", "1/0")),
            ("--part 1/2: needs --until", "--part", "1/2"),
            ("--until fast: must be one of photometric", "--until", "fast"),
            ("--until maps: this run makes no", "--until", "maps", "--fusion-mode", "-1"),
            ("--plan ", "--plan", "p.json", "--until", "maps"), ("plan", "--plan", "scene.mvs"))
        self.assertNotIn("p.json", files_below(self.path("refused")))

    def test_the_same_bytes_under_a_small_cap_on_memory(self):
        """With all stages. A test of densify does the same without the filters."""
        self.import_scene("water", "capped")
        capped = self.command("capped", "--refractive", *ALL_STAGES, "--max-memory")
        said = self.refuses("--max-memory 20: ", *capped, "20")
        self.succeeds(*capped, int(re.search(r"needs (\d+)", said.stderr)[1]) + 5)
        self.check_outputs("capped")

    def test_crops_to_the_region_of_interest(self):
        self.import_scene("air", "region")
        small = ("--estimate-roi", "1", "--roi-border", "0.4", *LEVEL_1)
        self.densify("region", "--crop-to-roi", "0", *small)
        whole = cloud_size(read(self.path("region", "scene_dense.ply")))
        said = self.densify("region", *small)
        removed = int(re.search(r"Region of interest: (\d+) points outside removed", said)[1])
        self.assertGreater(removed, 0)
        left = cloud_size(read(self.path("region", "scene_dense.ply")))
        self.assertGreater(left, 0)
        self.assertEqual(left, whole - removed)

    def test_the_dense_scene_keeps_its_housing(self):
        self.import_scene("water", "again")
        self.densify("again", "--refractive", *LEVEL_1)
        self.assertEqual(read_json(self.path("again", "scene_dense.housing.json")),
                         read_json(self.path("again", "scene.housing.json")))
        before = read(self.path("again", "scene_dense.ply"))
        self.assertIn("All 4 depth maps exist already",
                      self.densify("again", "--refractive", *LEVEL_1, scene="scene_dense.mvs"))
        self.assertEqual(read(self.path("again", "scene_dense_dense.ply")), before)
        self.densify("again", "--camera-model", "pinhole", *LEVEL_1)
        self.assertNotIn("scene_dense.housing.json", files_below(self.path("again")))

    def test_says_and_draws_as_much_as_the_verbosity_asks_for(self):
        self.import_scene("air", "verbose")
        def pictures():
            return {name for name in files_below(self.path("verbose")) if name.endswith(".png")}
        progress = r"Estimated depth maps [123]/4 \(\d+%, \d+s, \d+s left\)"

        self.assertRegex(self.densify("verbose", *LEVEL_1), progress)
        self.assertEqual(pictures(), set())
        expected = self.outputs(self.path("verbose"))

        again = ("--geometric-iters", "1", *ALL_STAGES)
        said = self.densify("verbose", "-v", "1", *again)
        self.assertNotRegex(said, progress)
        for done in ("Scored neighbours", "Read images", "Estimated depth maps", "Fused depth maps"):
            self.assertIn(f"{done} 4/4 (100%, ", said)
        self.assertEqual(self.densify("verbose", "-v", "0", *LEVEL_1), "")
        self.assertEqual(pictures(), set())

        finished = {f"depth{image:04}{kind}.png" for image in range(4)
                    for kind in ("", ".normal", ".confidence")}
        self.assertIn("Memory ", self.densify("verbose", "-v", "3", *LEVEL_1))
        self.assertEqual(pictures(), finished)
        self.assertEqual(self.outputs(self.path("verbose")), expected)
        self.densify("verbose", "-v", "5", *again)
        self.assertIn("depth0002.photometric.png", pictures())
        self.assertIn("depth0002.geometric1.normal.png", pictures())

    def kill_when_finished(self, folder, file):
        process = subprocess.Popen(
            [os.path.join(BIN, "DensifyPointCloud"), *self.command(folder, "--refractive", *ALL_STAGES)[1:]],
            stdout=subprocess.DEVNULL)
        # Polls for the file. If it never appears, the assertion below fails.
        for _ in range(30000):
            if os.path.exists(self.path(folder, file)) or process.poll() is not None:
                break
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        self.assertEqual(process.wait(), -signal.SIGKILL, "the run ended before it could be killed")


class ThroughTheWaterSurface(CloseUp):
    """Cameras in air above the same scene, ten times as large: 3 to 4 m above a calm water surface,
    with 4 m of water below it."""
    SCENE = (*FINE, "--scale", "10", "--water-level", "4")

    def densify_quickly(self, folder, *arguments):
        return self.densify(folder, *arguments, "--number-views-fuse", "2", *LEVEL_1)

    def reconstructed(self, medium, folder, *arguments):
        self.import_scene(medium, folder)
        self.densify_quickly(folder, *arguments)
        return self.scores(medium, folder)["accuracy"]

    def test_refraction_counts(self):
        air = self.reconstructed("air", "air")
        obeyed = self.reconstructed("water", "obeyed", "--refractive")
        ignored = self.reconstructed("water", "ignored", "--camera-model", "pinhole")
        # On the part of the ray in water the parallax is a quarter smaller. Pixels on the object
        # are smaller, too.
        self.assertLess(obeyed["mean"], 1.25 * air["mean"])
        self.assertGreater(obeyed["count"], 0.8 * air["count"])
        # From above, 4 m of water look 1 m shallower. Matching errs by about 1 cm.
        self.assertGreater(ignored["median"], 20 * obeyed["median"])
        # A resumed run accepts the side files of its maps, although a water surface is farther away
        # than the glass of any housing.
        self.assertIn("All 4 depth maps exist already",
                      self.densify_quickly("obeyed", "--refractive"))


if __name__ == "__main__":
    main()
