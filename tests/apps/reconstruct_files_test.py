# SPDX-License-Identifier: GPL-3.0-or-later
"""apps/pipeline/reconstruct with stand-ins for the programs: files of the user in its output folder, its
photographs and masks, damaged files, and results that are out of date."""

import json
import os
import shutil
import unittest.mock

from pipeline_folder import ColmapModelCase
from programs import main, png
from stand_ins import StandIns

from axial_pipeline import photographs, reconstruct_options
from axial_pipeline.failure import Failure


class OtherFiles(StandIns):
    """Files in the output folder that no run made."""

    def test_nothing_of_the_user_is_replaced(self):
        names = ["colmap/model.txt", "database.db", "features.db", "lock", "logs/poses.log", "refined/notes",
                 "report.md", "scene.mvs", "steps/mesh.begun.json", "depth0000.dmap", "evaluation.json",
                 "scene_dense.ply", "scene_dense_mesh.ply", "scene_map.dem.tif", "scene_textured.glb",
                 "scene_textured0.png", "undistorted/a.png"]
        for name in names:
            self.write(f"out/{name}")
        said = self.refused("--truth", "lens")
        for name in ("colmap", "database.db", "depth0000.dmap", "evaluation.json", "and 7 more"):
            self.assertIn(name, said)
        for name in names[:9]:
            shutil.rmtree(self.folder / "out")
            self.write(f"out/{name}")
            named = name.split("/")[0] if name.startswith(("colmap", "refined")) else name
            self.assertEqual(self.refused(),
                             f"--output {self.folder}/out: {named}: no record of an earlier run names this "
                             "file, which this run would replace; move it, or give another --output")
        self.assertEqual(self.commands(), [])

    def test_files_with_other_names_do_not_matter(self):
        kept = {name: self.write(f"out/{name}") for name in
                ("scene.blend", "logs/mine.log", "steps/mine.json", "my_database.db", "depth.txt",
                 "scene_textured.glb")}
        (self.folder / "out" / "colmap").mkdir()
        self.succeeds("--until", "mesh")
        for path in kept.values():
            self.assertEqual(path.read_text(), "mine")
        self.assertIn("scene_textured.glb: no record", self.refused())

    def test_poses_can_be_the_last_result(self):
        said = self.succeeds("--until", "poses")
        self.assertIn(f"Poses: {self.folder}/out/refined", said)
        self.assertTrue((self.folder / "out" / "report.md").exists())
        self.assertFalse((self.folder / "out" / "scene.mvs").exists())
        self.assertEqual(self.done_before("--until", "cloud"), 5)
        for options, line in [
                (("--truth", "lens"), f"--truth {self.folder}/lens: is compared with the cloud, which --until "
                 "poses does not make"),
                (("--earlier", "lens"), f"--earlier {self.folder}/lens: needs the mesh, which --until poses does "
                 "not make"),
                (("--cluster", "local"), "--cluster local: is for the steps after the poses, which --until poses "
                 "does not run"),
                (("--densify=--iters 2",), "--densify --iters 2: DensifyPointCloud does not run with --until "
                 "poses")]:
            self.assertEqual(self.refused("--until", "poses", *options), line)

    def test_a_folder_of_an_older_version_goes_on(self):
        self.succeeds()
        records = self.folder / "out" / "steps"
        for path in records.glob("*.json"):
            record = json.loads(path.read_text())
            path.write_text(json.dumps({key: value for key, value in record.items()
                                        if key not in ("makes", "ended")}))
        self.assertEqual(self.done_before(), 11)
        (records / "poses.done.json").unlink()  # killed there
        self.assertEqual(self.done_before("--map=--hillshade"), 3)
        (records / "features.done.json").write_text("")
        (records / "features.begun.json").write_text("")
        self.assertEqual(self.done_before(), 0)

    def test_a_record_names_what_its_version_makes(self):
        """A file that a newer version would write, too, may be the user's."""
        self.succeeds("--until", "cloud")
        record = self.folder / "out" / "steps" / "features.begun.json"
        made = json.loads(record.read_text())
        self.assertIn("still_features.png", made["makes"])
        record.write_text(json.dumps({**made, "makes": ["features.db"]}))
        self.write("out/still_features.png")
        self.assertIn("still_features.png: no record", self.refused("--until", "cloud"))

    def test_an_output_that_is_no_folder_is_refused(self):
        os.symlink("out", self.folder / "out")
        self.assertEqual(self.refused(), "--output out: is a link that leads to itself")
        (self.folder / "out").unlink()
        self.write("out")
        self.assertEqual(self.refused(), f"--output {self.folder}/out: is not a folder")

    def test_a_link_is_removed_and_what_it_leads_to_stays(self):
        self.succeeds()
        shutil.rmtree(self.folder / "out" / "colmap")
        mine = self.write("mine/photograph")
        os.symlink(self.folder / "mine", self.folder / "out" / "colmap")
        self.write("lens", "other")
        self.succeeds()
        self.assertTrue(mine.exists())
        self.assertTrue((self.folder / "out" / "colmap" / "best").is_dir())


class ColmapModelFiles(ColmapModelCase):
    """Files of the user in the output folder of colmap-model."""

    def test_nothing_of_the_user_is_replaced(self):
        self.put_script("bin/colmap", '[ "$1" = mapper ] && exit 9; touch out/database.db; exit 0')
        for name in ("database.db", "models/0/images.bin", "model/notes", "mapper.log"):
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            mine = self.write(f"out/{name}", "mine")
            ended = self.run_it()
            self.assertEqual(ended.returncode, 1)
            self.assertEqual(ended.stderr.splitlines(), [
                f"colmap-model: --output out: {name.split('/')[0]}: no record of an earlier run names this "
                "file, which this run would replace; move it, or give another --output"])
            self.assertEqual(mine.read_text(), "mine")
        shutil.rmtree(self.folder / "out")
        self.write("out/colmap-model.json", '{"makes": 3}')
        self.assertIn("out: colmap-model.json: no record", self.run_it().stderr)
        shutil.rmtree(self.folder / "out")
        for _ in range(2):  # the second run finds what the first one left when COLMAP failed
            self.assertIn("colmap: exit code 9", self.run_it().stderr)

    def test_a_model_without_these_masks_is_not_kept_for_one_with_them(self):
        for name in ("cameras.bin", "images.bin", "points3D.bin"):
            self.write(f"out/model/{name}", "")
        self.assertIn("kept from an earlier run", self.run_it().stdout)
        self.write("mask.png", png([bytes(4)] * 3))
        self.assertEqual(self.run_it("--masks", "mask.png").stderr,
                         "colmap-model: out/model: was made with other masks, or without masks; remove it, or give "
                         "another --output\n")


class Photographs(StandIns):
    """The folder of the photographs."""

    def test_too_few_are_refused(self):
        for number in (2, 1):
            (self.folder / "images" / f"{number}.png").unlink()
        images = self.folder / "images"
        self.assertEqual(self.refused(), f"--images {images}: has one photograph, 0.png; at least 2 are "
                                         "needed")
        self.write("images/0.png", "text")
        self.assertEqual(self.refused(), f"--images {images}: has no photographs (0.png: not an image); at "
                                         "least 2 are needed")

    def test_what_colmap_would_do_wrong_is_refused(self):
        images = self.folder / "images"
        other = self.write("images/.hidden/small.png", png([bytes(2)] * 2))
        self.assertEqual(self.refused(), f"--images {images}: the photographs have different sizes: 3 of 4 x "
                         "3 pixels (0.png first), 1 of 2 x 2 pixels (.hidden/small.png); all must be of one "
                         "camera and setting: move the others to another folder")
        for number in range(3, 8):
            (images / f"{number}.png").write_bytes((images / "0.png").read_bytes())
        for number in range(3):
            (images / f"b{number}.png").write_bytes(other.read_bytes())
        self.assertIn("8 of 4 x 3 pixels (0.png first), 4 of 2 x 2 pixels (b0.png, b1.png, b2.png and 1 more)",
                      self.refused())
        for path in [other, *images.glob("b*.png")]:
            path.unlink()
        for name in ("0.mask.png", "0.png.png", "0_mask.png"):
            shutil.copy(images / "0.png", images / name)
            self.assertIn(f"{name} is the mask of 0.png, and COLMAP would take it for a photograph",
                          self.refused())
            (images / name).unlink()
        os.symlink("loop.png", images / "loop.png")
        self.assertEqual(self.refused(), f"--images {images}/loop.png: is a link that leads to itself; remove "
                                         "it, because COLMAP stops there")

    def test_files_beside_photographs_make_no_label_ambiguous(self):
        self.write("images/0.xmp")
        self.write("positions.txt", "0 0 0 0\n1 1 0 0\nimages//./2 0 1 0\n")
        self.assertNotIn("not photographs", self.succeeds("--scale-from", "positions:positions.txt"))

    def test_a_pipe_is_no_photograph(self):
        os.mkfifo(self.folder / "images" / "pipe.png")
        self.assertIn("pipe.png: not an image, not used", self.succeeds())

    def test_what_colmap_leaves_out_is_told(self):
        images = self.folder / "images"
        self.write("images/notes.txt")
        os.symlink("nowhere", images / "broken.png")
        os.symlink(self.folder, images / "elsewhere")
        self.write("images/dive 2/a.png", (images / "0.png").read_bytes()[:-12])
        said = self.succeeds().splitlines()
        self.assertEqual(said[:4], [
            f"{images}: broken.png, notes.txt: not an image, not used",
            f"{images}: elsewhere: a link to a folder, which COLMAP does not enter: not used",
            f"{images}: 1 of 4 photographs are in subfolders, and are used, too: dive 2/a.png",
            f"{images}: warning: dive 2/a.png: the end of the image is missing; copy it again"])

    def test_names_that_are_not_utf8_are_refused(self):
        image = os.fsencode(self.folder / "images") + b"/n\xff.png"
        shutil.copy(self.folder / "images" / "0.png", image)
        self.assertIn("images/n\\xff.png: the name is not UTF-8; rename it", self.refused())
        os.remove(image)
        self.assertEqual(self.refused("--truth", os.fsdecode(b"n\xff.ply")),
                         "--truth n\\xff.ply: the name is not UTF-8; rename it")

    def test_sizes_of_images(self):
        """Of a PNG, of JPEG files with and without a segment before the size, and of TIFF files in both
        orders of bytes."""
        def tiff(order, mark):
            short = (4).to_bytes(2, order) + b"\0\0"
            entries = [(256, 3, short), (257, 4, (3).to_bytes(4, order))]
            table = b"".join(tag.to_bytes(2, order) + kind.to_bytes(2, order) + (1).to_bytes(4, order) + value
                             for tag, kind, value in entries)
            return mark + (8).to_bytes(4, order) + (2).to_bytes(2, order) + table

        frame = b"\xff\xc2\0\x0b\x08\0\x03\0\x04\x01\x01\x11\0\xff\xd9"
        for data in (png([bytes(4)] * 3), b"\xff\xd8" + frame, b"\xff\xd8\xff\xe1\0\x05abc" + frame,
                     tiff("little", b"II*\0"), tiff("big", b"MM\0*")):
            image = photographs.image_of(self.write("image", data))
            self.assertEqual((image.size, image.is_whole), ((4, 3), True))
            for end in range(len(data)):
                photographs.image_of(self.write("image", data[:end]))  # no exception
        self.assertFalse(photographs.image_of(self.write("image", b"\xff\xd8" + frame[:-2])).is_whole)
        self.assertIsNone(photographs.image_of(self.write("image", "")))


class DamagedFiles(StandIns):
    """Files of an earlier run that are damaged."""

    def test_a_damaged_report_is_made_again(self):
        self.succeeds()
        for damaged in ("", "{", "[1]", "[" * 100000, b"\xff"):
            self.write("out/refined/report.json", damaged)
            self.assertEqual(self.done_before(), 4)

    def test_a_report_of_another_version_is_named(self):
        self.succeeds()
        report = self.write("out/refined/report.json", '{"rms_before_px": "1"}')
        ended = self.ended()
        self.assertEqual((ended.returncode, ended.stderr), (1, f"reconstruct: {report}: is damaged, or of "
                         "another version; remove it, and the same command makes it again\n"))
        report.unlink()
        self.succeeds()

    def test_damaged_records_are_no_records(self):
        self.succeeds()
        record = self.folder / "out" / "steps" / "map.done.json"
        whole = json.loads(record.read_text())
        for damaged in ("", "{", "[]", "[" * 100000, json.dumps({**whole, "seconds": "1"}), b"\xff\xfe",
                        json.dumps({**whole, "seconds": float("nan")})):
            self.write("out/steps/map.done.json", damaged)
            self.assertEqual(self.done_before(), 10)
        self.write("out/steps/map.done.json", json.dumps({"chain": whole["chain"]}))
        self.assertEqual(self.done_before(), 11)


class Masks(StandIns):
    """--masks reaches COLMAP and all programs that know masks."""

    def test_masks_reach_every_program(self):
        self.write("masks/0.png")
        self.succeeds("--masks", "masks", "--ignore-mask-label", "7")
        out = self.folder / "out"
        self.assertEqual(self.commands()[0], f"InterfaceCOLMAP -i {self.folder}/images --mask-path "
                         f"{self.folder}/masks --ignore-mask-label 7 -o {out}/colmap_masks")
        self.assertIn(f"--ImageReader.mask_path {out}/colmap_masks", self.commands()[1])
        for program in ("DensifyPointCloud", "RefineMesh", "TextureMesh", "MapSurface"):
            self.assertEqual(self.command_of(program).count(f"--mask-path {out}/colmap_masks"), 1, program)
        for program in ("ReconstructMesh", "RefinePoses"):
            self.assertNotIn("--mask-path", self.command_of(program))

    def test_options_of_a_program_come_first(self):
        self.write("masks/0.png")
        self.succeeds("--masks", "masks", "--texture=--mask-path other", "--densify=--mask-p x")
        self.assertIn("--mask-path other", self.command_of("MapSurface"))
        for program in ("TextureMesh", "MapSurface", "DensifyPointCloud"):
            self.assertNotIn(f"{self.folder}/out/colmap_masks", self.command_of(program))

    def test_shortened_options_are_those_of_the_program(self):
        """The begin of an option is the option, as the programs read it."""
        self.write("masks/0.png")
        self.succeeds("--masks", "masks", "--texture=--mask-pa other --ignore-mask=3")
        for program in ("TextureMesh", "MapSurface"):
            self.assertNotIn(f"{self.folder}/out/colmap_masks", self.command_of(program))
        self.assertIn("--mask-path other --ignore-mask-label=3", self.command_of("MapSurface"))
        self.succeeds("--texture=--mask-pa other", "--map=--mask-p mine")
        self.assertIn("--mask-p mine", self.command_of("MapSurface"))
        self.assertNotIn("other", self.command_of("MapSurface"))
        self.write("before.ply")
        self.succeeds("--earlier", "before.ply", "--compare=--al none")
        self.assertNotIn("--align", self.command_of("CompareSurveys"))

    def test_changed_masks_begin_anew(self):
        mask = self.write("masks/0.png")
        options = ["--masks", "masks"]
        self.assertEqual([self.done_before(*options) for _ in range(2)], [0, 12])
        mask.write_text("changed")
        self.assertEqual(self.done_before(*options), 0)
        self.assertEqual(self.done_before(), 0)

    def test_wrong_options_are_refused(self):
        self.write("masks/0.png")
        for options, said in (
                (["--masks", "none"], "--masks none: not found"),
                (["--ignore-mask-label", "1"], "--ignore-mask-label 1: is only for --masks"),
                (["--masks", "masks", "--ignore-mask-label", "a"],
                 "--ignore-mask-label a: must be a number from 0 to 65535")):
            self.assertEqual(self.refused(*options), said)
        for name in ("densify", "map"):
            option = f"--{name}=--ignore-mask-lab 3"
            self.assertEqual(self.refused("--masks", "masks", option),
                             f"{option.replace('=', ' ', 1)}: the label of --masks is given by "
                             "--ignore-mask-label of reconstruct")
        self.write("out/colmap_masks/0.png")
        self.assertIn("lies in the folder that this run writes", self.refused("--masks", "out/colmap_masks"))


class OutOfDate(StandIns):
    """Inputs that changed, and results of earlier runs."""

    def test_changed_files_below_relative_paths_are_noticed(self):
        """DensifyPointCloud works in the output folder, the other programs in that of the command."""
        for program, option, file, done in (
                ("DensifyPointCloud", "--densify=--mask-path own", "out/own/deep/0.png", 6),
                ("DensifyPointCloud", "--densify=--iters 2 -c a.cfg", "out/a.cfg", 6),
                ("TextureMesh", "--texture=--mask-path own", "own/deep/0.png", 9),
                ("RefineMesh", "--refine-mesh=--scales 1", "RefineMesh.cfg", 8)):
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            self.write(file)
            self.succeeds(option)
            self.assertEqual(self.done_before(option), 11, program)
            self.write(file, "changed")
            self.assertEqual(self.done_before(option), done, program)

    def test_masks_that_a_file_of_options_names_are_noticed(self):
        self.write("out/DensifyPointCloud.cfg", "# masks\nmask-path = own\n")
        self.write("out/own/0.png")
        os.symlink(self.folder / "linked", self.folder / "out" / "own" / "more")
        self.write("linked/1.png")
        self.succeeds()
        for file in ("out/own/0.png", "linked/1.png", "out/DensifyPointCloud.cfg"):
            self.assertEqual(self.done_before(), 11)
            self.write(file, f"changed mask-path = own {file}")
            self.assertEqual(self.done_before(), 6, file)
            self.write("out/DensifyPointCloud.cfg", "# masks\nmask-path = own\n")
            self.succeeds()

    def test_an_output_of_a_program_is_not_its_input(self):
        self.add_to("DensifyPointCloud", "mkdir -p out/export; date +%N > out/export/a; date +%N > out/log\n")
        options = ["--densify=--pinhole-export export --log-file=log"]
        self.succeeds(*options)
        self.assertEqual(self.done_before(*options), 11)

    def test_an_earlier_mesh_that_is_out_of_date_is_not_taken(self):
        with unittest.mock.patch("builtins.print"):
            find = lambda: reconstruct_options.mesh_of_earlier_survey(self.folder / "out").name
            self.succeeds("--without", "map,page")
            self.assertEqual(find(), "scene_dense_refined.ply")
            self.succeeds("--mesh=--smooth 1", "--without", "refine-mesh,map,page")
            self.assertEqual(find(), "scene_dense_mesh.ply")
            (self.folder / "out" / "steps" / "mesh.done.json").unlink()
            with self.assertRaisesRegex(Failure, "its mesh is older than its cloud, or was not completed"):
                find()
            self.succeeds("--without", "map,page")
            self.assertEqual(find(), "scene_dense_refined.ply")

    def test_an_earlier_mesh_of_an_older_version_is_judged_by_times(self):
        self.succeeds("--without", "map,page")
        records = self.folder / "out" / "steps"
        for path in records.glob("*.done.json"):
            record = json.loads(path.read_text())
            del record["ended"]
            path.write_text(json.dumps(record))
        self.assertEqual(reconstruct_options.mesh_of_earlier_survey(self.folder / "out").name,
                         "scene_dense_refined.ply")
        os.utime(records / "refine-mesh.done.json", (1e9, 1e9))
        self.assertEqual(reconstruct_options.mesh_of_earlier_survey(self.folder / "out").name,
                         "scene_dense_mesh.ply")

    def test_results_that_this_run_does_not_renew_are_told(self):
        self.succeeds()
        line = ("Of an earlier run, not of this one: scene_textured.glb, scene_textured.ply, "
                "scene_map.dem.tif, scene_map.ortho.tif, scene_map.views.tif")
        self.assertNotIn("earlier run", self.succeeds("--until", "mesh"))  # nothing changed
        said = self.succeeds("--until", "mesh", "--mesh=--smooth 1").splitlines()
        self.assertEqual([sorted(one) for one in said if "earlier run" in one], [sorted(line)])

    def test_tiles_of_an_earlier_run_are_removed(self):
        tile = self.folder / "out" / "scene_textured.tile3-4.glb"
        self.add_to("TextureMesh", "touch out/scene_textured.tile1-4.glb; [ -e once ] || touch once "
                    "out/scene_textured.tile3-4.glb\n")
        self.succeeds("--tiles", "4")
        self.assertTrue(tile.exists())
        self.succeeds("--tiles", "4", "--texture=--outlier-threshold 0.1")
        self.assertFalse(tile.exists())

    def test_maps_of_other_options_are_removed(self):
        self.succeeds()
        for name in ("scene_map.hillshade.tif", "scene_map.contours.geojson", "scene_map.sigma.tif"):
            self.write(f"out/{name}")
        self.succeeds("--map=--hillshade")
        self.assertEqual([path.name for path in (self.folder / "out").glob("scene_map.*")
                          if path.read_text() == "mine"], [])

    def test_files_of_the_user_beside_results_stay(self):
        self.succeeds()
        kept = [self.write(f"out/{name}") for name in
                ("scene_map.qgz", "scene_map.dem.tif.aux.xml", "scene_textured_cleaned.ply",
                 "scene_textured.blend", "scene_textured0 edited.png",
                 "scene_textured_material_0 edited_map_Kd.png")]
        textures = [self.write(f"out/scene_textured{end}.png") for end in
                    ("1", "_material_0_map_Kd", "_material_12_map_Kd", "_gltf0", "_gltf12")]
        self.succeeds("--texture=--outlier-threshold 0.1")
        self.assertEqual([path.name for path in kept if not path.exists()], [])
        self.assertEqual([path.name for path in textures if path.exists()], [])


if __name__ == "__main__":
    main()
