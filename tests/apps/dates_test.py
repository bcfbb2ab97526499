# SPDX-License-Identifier: GPL-3.0-or-later
"""reconstruct --dates: the dates of photographs, the parts of a model, and the runs for each date."""

import json
import struct

from pipeline_folder import InFolder
from programs import main
from stand_ins import StandIns, photograph

from axial_pipeline import dates, exif, model_text
from axial_pipeline.failure import Failure

NAMES = [f"{folder}/{number}.png" for folder in ("may", "june") for number in range(3)]
FILE = "# dives\nmay,2024-05-31\njune/*.png\t2024-06-30\n"
HOUSING = '{"version": 1}'
# A model with a point that both dates see, one of each date, and one that only one photograph of each date sees.
CAMERAS = "1 PINHOLE 4 3 9 9 2 1\n"
IMAGES = "".join(f"{number} 1 0 0 0 0 0 0 1 {name}\n1 1 1 2 2 {2 + number // 4}\n"
                 for number, name in enumerate(NAMES, 1))
POINTS = ("1 0 0 1 9 9 9 0.1 " + " ".join(f"{number} 0" for number in range(1, 7)) + "\n"
          "2 0 0 2 9 9 9 0.1 1 1 2 1 3 1\n3 0 0 3 9 9 9 0.1 4 1 5 1 6 1\n4 0 0 4 9 9 9 0.1 1 2 4 2\n")
REPORT = {"rms_before_px": 1, "rms_after_px": 1, "cameras": [], "observations_after": 16, "points_after": 4,
          "images": [{"name": name, "observations": 3} for name in NAMES], "scale_sigma": 0, "shape_sigma": 0,
          "depth_sigma": 0}


def jpeg_taken(time):
    """The bytes of a JPEG file that was taken at this time."""
    text = time.encode() + b"\0"
    first = struct.pack("<HHHIII", 1, 0x8769, 4, 1, 26, 0)
    own = struct.pack("<HHHIII", 1, 0x9003, 2, len(text), 44, 0) + text
    return b"\xff\xd8\xff\xe1\0\0Exif\0\0II*\0\x08\0\0\0" + first + own


class OfPhotographs(InFolder):
    def found(self, text, names=NAMES):
        return dates.dates_in_file(self.write("dates.csv", text), names)

    def test_are_those_of_names_folders_and_patterns(self):
        found = self.found(FILE)
        self.assertEqual({name: found[name] for name in (NAMES[0], NAMES[5])},
                         {"may/0.png": "2024-05-31", "june/2.png": "2024-06-30"})
        self.assertEqual(self.found("may/1.png,2024-05-31\n")["may/0.png"], "")

    def test_wrong_lines_are_named(self):
        for text, said in (("may\n", "dates.csv:1: must be PHOTOGRAPHS,DATE"),
                           ("\nmay,31.5.2024\n", "dates.csv:2: '31.5.2024' is no date"),
                           ("may,2024-02-30\n", "'2024-02-30' is no date"),
                           ("july,2024-07-01\n", "'july' is no photograph"),
                           (FILE + "may/1.png,2024-06-01\n", "may/1.png has 2 dates: 2024-05-31, 2024-06-01")):
            with self.assertRaises(Failure) as failed:
                self.found(text)
            self.assertIn(said, str(failed.exception))

    def test_of_exif_are_days(self):
        for time, day in (("2024:05:31 10:20:30", "2024-05-31"), ("0000:00:00 00:00:00", ""), ("?", "")):
            self.assertEqual(exif.exif_in(jpeg_taken(time)).date, day)
        self.assertEqual(exif.exif_in(b"").date, "")


class OfModels(InFolder):
    def test_have_their_photographs_and_the_points_that_two_of_them_see(self):
        for name, text in (("cameras", CAMERAS), ("images", IMAGES), ("points3D", POINTS)):
            self.write(f"out/refined/sparse/{name}.txt", text)
        self.write("out/refined/housing.json", HOUSING)
        self.write("out/refined/report.json", json.dumps(REPORT))
        out = self.folder / "out"
        found = dates.split(out, {name: "2024-05-31" if name < "m" else "2024-06-30" for name in NAMES})
        self.assertEqual(sorted(found["2024-05-31"]), NAMES[3:])
        refined = out / "dates" / "2024-05-31" / "refined"
        self.assertEqual(sorted(model_text.image_numbers(refined / "sparse")), NAMES[3:])
        self.assertEqual([line.split()[0] for line in (refined / "sparse/points3D.txt").read_text().splitlines()],
                         ["1", "3"])
        report = json.loads((refined / "report.json").read_text())
        self.assertEqual([report["points_after"], report["observations_after"], len(report["images"])], [2, 6, 3])
        times = lambda: {file: file.stat().st_mtime_ns for file in refined.rglob("*") if file.is_file()}
        before = times()
        dates.split(out, {name: "2024-05-31" if name < "m" else "2024-06-30" for name in NAMES})
        self.assertEqual(times(), before)


class OfRuns(StandIns):
    def setUp(self):
        super().setUp()
        for file in (self.folder / "images").iterdir():
            file.unlink()
        for number, name in enumerate(NAMES):
            self.write(f"images/{name}", photograph(number))
        self.write("dates.csv", FILE)
        for name, text in (("cameras.txt", CAMERAS), ("images.txt", IMAGES), ("points3D.txt", POINTS),
                           ("report.json", json.dumps(REPORT)), ("housing.json", HOUSING)):
            self.write(f"refined/{name}", text)
        self.add_to("RefinePoses", 'case "$*" in *" --database "*) mkdir out/refined/sparse\n'
                                   "cp refined/*.json out/refined; cp refined/*.txt out/refined/sparse ;; esac\n")
        results = {"InterfaceCOLMAP": "scene.mvs", "DensifyPointCloud": "scene_dense.ply",
                   "ReconstructMesh": "scene_dense_mesh.ply", "RefineMesh": "scene_dense_refined.ply",
                   "CompareSurveys": "scene.change.json"}
        for program, result in results.items():
            self.add_to(program, f'd=$(echo "$*" | grep -o "[^ ]*out/dates/[0-9-]*" | tail -1); touch "$d/{result}"\n')

    options = ("--dates", "dates.csv", "--without", "texture,map,page")

    def test_have_joint_poses_and_a_mesh_for_each_date(self):
        said = self.succeeds(*self.options)
        commands = [line.split()[0] for line in self.commands()]
        self.assertEqual([commands.count(name) for name in ("RefinePoses", "DensifyPointCloud", "CompareSurveys")],
                         [2, 2, 1])  # RefinePoses also computes the lens behind the port
        out = self.folder / "out"
        first, other = (out / "dates" / date for date in ("2024-05-31", "2024-06-30"))
        compare = next(line for line in self.commands() if line.startswith("CompareSurveys"))
        self.assertIn(f"-i {first}/scene_dense_refined.ply --other {other}/scene_dense_refined.ply", compare)
        self.assertIn("--align none", compare)
        self.assertIn("2024-05-31 (3 photographs), 2024-06-30 (3 photographs)", said)
        self.assertIn("| 2024-06-30 | 3 | dates/2024-06-30/report.md |", (out / "report.md").read_text())
        self.assertIn("- date: 2024-06-30", (other / "report.md").read_text())
        before = len(self.commands())
        self.succeeds(*self.options)
        self.assertEqual(len(self.commands()), before)

    def test_are_refused_before_anything_runs(self):
        for text, said in (("may,2024-05-31\n", "3 photographs have no date: june/0.png"),
                           ("*,2024-05-31\n", "all photographs are of 2024-05-31")):
            self.write("dates.csv", text)
            self.assertIn(said, self.refused(*self.options))
        self.assertIn("contradicts --dates", self.refused(*self.options, "--truth", "lens"))
        self.write("dates.csv", FILE)
        self.write("out/dates/mine", "")
        self.assertIn("has a folder dates/ that no run made", self.refused(*self.options))


if __name__ == "__main__":
    main()
