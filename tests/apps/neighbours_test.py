# SPDX-License-Identifier: GPL-3.0-or-later
"""Beside OpenMVS: its depth maps in the working folder, its options, and what it may read of ours."""

import os
import shutil
import struct
import tempfile

from programs import ProgramTest, cloud_size, files_below, main, read, run, write

QUICK = ("--resolution-level", "1", "--min-resolution", "100", "--iters", "1",
         "--number-views-fuse", "2")


class Dmap:
    """A .dmap field by field (docs/formats.md)."""

    def __init__(self, data):
        self.content = data[2]
        self.image = struct.unpack_from("<II", data, 4)
        self.size = struct.unpack_from("<II", data, 12)
        self.range = struct.unpack_from("<ff", data, 20)
        length = struct.unpack_from("<H", data, 28)[0]
        self.name = data[30:30 + length]
        at = 30 + length
        count = struct.unpack_from("<I", data, at)[0]
        self.ids = struct.unpack_from(f"<{count}I", data, at + 4)
        at += 4 + 4 * count
        self.camera = list(struct.unpack_from("<21d", data, at))  # K, R, C
        at += 21 * 8
        pixels = self.size[0] * self.size[1]
        self.depths = data[at:at + 4 * pixels]
        self.normals = data[at + 4 * pixels:at + 16 * pixels]
        self.rest = data[at + 16 * pixels:]

    def bytes(self, normals=True):
        content = self.content if normals else self.content & ~2
        return (b"DR" + struct.pack("<BBIIIIff", content, 0, *self.image, *self.size, *self.range)
                + struct.pack("<H", len(self.name)) + self.name
                + struct.pack(f"<I{len(self.ids)}I", len(self.ids), *self.ids)
                + struct.pack("<21d", *self.camera) + self.depths
                + (self.normals if normals else b"") + self.rest)


class Scene(ProgramTest):
    """Five small views of the close-up scene, in air and under water, densified once."""
    VIEWS = 5

    @classmethod
    def setUpClass(cls):
        if cls is Scene:
            return
        cls.shared = tempfile.TemporaryDirectory(prefix="axial_")
        cls.addClassCleanup(cls.shared.cleanup)
        cls.truth = os.path.join(cls.shared.name, "closeup")
        cls.must("SimulateUnderwater", "--preset", "closeup", "--coarseness", 4, "--views",
                 cls.VIEWS, "--width", 320, "--height", 240, "-o", cls.truth)
        for medium in ("air", "water"):
            port = ["--housing", os.path.join(cls.truth, "housing.json")] if medium == "water" else []
            cls.must("InterfaceCOLMAP", "-i", cls.truth, "--image-folder",
                     os.path.join(cls.truth, medium), "-o", cls.densified(medium, "scene.mvs"), *port)
            cls.must("DensifyPointCloud", "-i", "scene.mvs", "-w", cls.densified(medium), *QUICK)

    @classmethod
    def must(cls, *command):
        result = run(*command)
        assert result.returncode == 0, result.stderr
        return result

    @classmethod
    def densified(cls, medium, *name):
        return os.path.join(cls.shared.name, medium, *name)

    def copy(self, medium, *leave_out):
        """The densified folder, without files whose names end in one of `leave_out`."""
        self.folder = self.shared.name  # maps hold the way from their folder to their image
        folder = self.path("copy")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.densified(medium), folder)
        for name in files_below(folder):
            if name.endswith(leave_out):
                os.remove(os.path.join(folder, name))
        return folder

    def command(self, folder, *arguments):
        quick = [word for i in range(0, len(QUICK), 2) if QUICK[i] not in arguments
                 for word in QUICK[i:i + 2]]
        return ("DensifyPointCloud", "-i", "scene.mvs", "-w", folder, *quick, *arguments)

    def maps(self, folder):
        return {name: (read(os.path.join(folder, name)),
                       os.stat(os.path.join(folder, name)).st_mtime_ns)
                for name in files_below(folder) if ".dmap" in name}

    def cloud(self, folder):
        return read(os.path.join(folder, "scene_dense.ply"))


def dmap_names():
    return [f"depth{i:04}.dmap" for i in range(Scene.VIEWS)]


class ForeignMaps(Scene):
    def assert_refused_and_kept(self, folder, expected, *arguments):
        before = self.maps(folder)
        self.refuses(expected, *self.command(folder, *arguments))
        self.assertEqual(self.maps(folder), before)

    def test_are_never_overwritten_unasked(self):
        for medium in ("air", "water"):
            for mode in ("0", "1"):
                for which in (dmap_names(), ["depth0003.dmap"]):
                    with self.subTest(medium=medium, mode=mode, which=which):
                        folder = self.copy(medium, "_dense.ply", "_dense.mvs",
                                           *(name + ".json" for name in which))
                        self.assert_refused_and_kept(folder, which[0], "--fusion-mode", mode)
        self.assert_refused_and_kept(folder, "--overwrite-dmaps 1")
        write(os.path.join(folder, "depth0003.dmap"), b"")  # of whom?
        self.assert_refused_and_kept(folder, "depth0003.dmap")

    def test_are_told_from_ours_by_their_content(self):
        folder = self.copy("air")
        for i, name in enumerate(dmap_names()):
            path = os.path.join(folder, name)
            whole = read(path)
            foreign = Dmap(whole)
            foreign.depths = foreign.depths[:-4] + struct.pack("<f", 0.5 + i)
            write(path, foreign.bytes())
            self.assert_refused_and_kept(folder, name)
            write(path, whole)
        self.assertIn("depth maps are there already", self.succeeds(*self.command(folder)).stdout)

    def test_are_overwritten_when_asked(self):
        for medium in ("air", "water"):
            folder = self.copy(medium, "_dense.ply", "depth0001.dmap.json")
            write(os.path.join(folder, "depth0002.dmap"), b"DR of another program")
            said = self.succeeds(*self.command(folder, "--overwrite-dmaps", "1")).stdout
            self.assertIn("depth0001.dmap", said)
            for name in files_below(folder):
                if name.endswith((".dmap", ".ply", ".json")):
                    self.assertEqual(read(os.path.join(folder, name)),
                                     read(self.densified(medium, name)), name)

    def test_ours_of_other_options_are_replaced_as_before(self):
        for medium in ("air", "water"):
            folder = self.copy(medium)
            self.succeeds(*self.command(folder, "--geometric-iters", "1"))
            self.succeeds(*self.command(folder))
            self.assertEqual(self.cloud(folder), read(self.densified(medium, "scene_dense.ply")))

    def test_ours_that_are_damaged_are_made_anew_with_a_word(self):
        folder = self.copy("air")
        path = os.path.join(folder, "depth0001.dmap")
        whole = read(path)
        for wrong in (whole[:1000], b""):
            write(path, wrong)
            said = self.succeeds(*self.command(folder)).stdout
            self.assertIn("depth0001.dmap: is damaged", said)
            self.assertEqual(read(path), whole)


class FusingWhatExists(Scene):
    FUSE = ("--fusion-mode", "-1")

    def fuse(self, folder, *arguments):
        """Fuses; no map may change, appear or go."""
        before = self.maps(folder)
        said = self.succeeds(*self.command(folder, *self.FUSE, *arguments)).stdout
        self.assertEqual(self.maps(folder), before)
        return said

    def test_maps_of_others_give_the_cloud_that_ours_give(self):
        # Side files of dry cameras say nothing that the maps do not.
        folder = self.copy("air", "_dense.ply", "_dense.mvs", ".dmap.json")
        said = self.fuse(folder)
        self.assertIn("5 of 5 images have a depth map, 5 by other programs", said)
        expected = read(self.densified("air", "scene_dense.ply"))
        self.assertGreater(cloud_size(expected), 3000)
        self.assertEqual(self.cloud(folder), expected)
        self.fuse(folder, "--max-threads", "1")
        self.assertEqual(self.cloud(folder), expected)

    def test_the_resolution_is_that_of_the_maps(self):
        folder = self.copy("air", "_dense.ply", ".dmap.json")
        for level in ("0", "3"):
            said = self.fuse(folder, "--resolution-level", level, "--min-resolution", "20")
            self.assertEqual(self.cloud(folder), read(self.densified("air", "scene_dense.ply")), said)

    def test_our_own_maps_behind_a_port(self):
        folder = self.copy("water", "_dense.ply")
        self.fuse(folder, "--iters", "7")  # whatever the options of matching
        self.assertEqual(self.cloud(folder), read(self.densified("water", "scene_dense.ply")))

    def test_foreign_content_beside_our_side_file(self):
        folder = self.copy("air", "_dense.ply")
        path = os.path.join(folder, "depth0002.dmap")
        foreign = Dmap(read(path))
        foreign.depths = bytes(len(foreign.depths))
        write(path, foreign.bytes())
        self.assertIn("1 by other programs", self.fuse(folder))
        self.assertLess(cloud_size(self.cloud(folder)),
                        cloud_size(read(self.densified("air", "scene_dense.ply"))))

    def test_without_normals(self):
        folder = self.copy("air", "_dense.ply", ".dmap.json")
        for name in dmap_names():
            path = os.path.join(folder, name)
            write(path, Dmap(read(path)).bytes(normals=False))
        self.fuse(folder)
        whole = cloud_size(read(self.densified("air", "scene_dense.ply")))
        self.assertGreater(cloud_size(self.cloud(folder)), 0.7 * whole)

    def test_only_some_images(self):
        folder = self.copy("air", "_dense.ply", "depth0004.dmap", "depth0004.dmap.json")
        said = self.fuse(folder)
        quiet = self.fuse(folder, "-v", "0")
        self.assertIn("4 of 5 images have a depth map", quiet)
        self.assertIn("depth0004.dmap", quiet)
        self.assertIn("4 of 5 images have a depth map", said)
        self.assertIn("0004.png: has no depth map", said.replace(".jpg", ".png"))
        self.assertGreater(cloud_size(self.cloud(folder)), 1000)

    def test_what_cannot_be_fused(self):
        folder = self.copy("air", ".dmap", ".dmap.json", "_dense.ply", "_dense.mvs")
        self.refuses("no depth map is there", *self.command(folder, *self.FUSE))
        folder = self.copy("water", "depth0001.dmap.json", "_dense.ply", "_dense.mvs")
        self.refuses("depth0001.dmap: is a pinhole's", *self.command(folder, *self.FUSE))
        self.refuses("disparity", *self.command(folder, "--fusion-mode", "-2"))

    def test_maps_of_other_poses_or_lenses(self):
        folder = self.copy("air", ".dmap.json", "_dense.ply", "_dense.mvs")
        path = os.path.join(folder, "depth0002.dmap")
        whole = read(path)
        # A focal length 2 % off, a principal point 3 px off, a centre 2 cm off.
        for number, change in ((0, lambda f: 1.02 * f), (2, lambda c: c + 6), (18, lambda x: x + 0.02)):
            other = Dmap(whole)
            other.camera[number] = change(other.camera[number])
            write(path, other.bytes())
            self.refuses("depth0002.dmap: its camera sees the scene",
                         *self.command(folder, *self.FUSE))
        write(path, whole[:-4])
        self.refuses("depth0002.dmap: has", *self.command(folder, *self.FUSE))


class RefractiveOutputs(Scene):
    def test_say_which_of_openmvs_programs_may_read_them(self):
        for medium, mentioned in (("water", True), ("air", False)):
            said = self.succeeds(*self.command(self.copy(medium))).stdout
            last = said.strip().splitlines()[-1]
            for program in ("ReconstructMesh", "RefineMesh", "TextureMesh", "scene_dense.mvs"):
                self.assertEqual(program in last, mentioned, said)


class Cloud:
    """The vertices of a PLY of ours as dictionaries of tuples."""
    SIZES = {"float32": "f", "uint8": "B", "uint32": "I"}

    def __init__(self, data):
        header, body = data.split(b"end_header\n", 1)
        self.fields = [line.split()[1:] for line in header.decode().splitlines()
                       if line.startswith("property")]
        self.points, at = [], 0
        for _ in range(cloud_size(data)):
            point = {}
            for kind, *rest in self.fields:
                count, item = 1, kind
                if kind == "list":
                    count, item = body[at], rest[1]
                    at += 1
                point[rest[-1]] = struct.unpack_from(f"<{count}{self.SIZES[item]}", body, at)
                at += struct.calcsize(f"<{count}{self.SIZES[item]}")
            self.points.append(point)
        assert at == len(body)


def position(point):
    return tuple(point[axis][0] for axis in "xyz")


def ascii_ply(points, with_views=True):
    """`points`: (x, y, z), [images]."""
    lists = "property list uchar uint view_indices\n" if with_views else ""
    lines = [" ".join(map(str, (*xyz, *((len(views), *views) if with_views else ()))))
             for xyz, views in points]
    return (f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty float x\n"
            f"property float y\nproperty float z\n{lists}end_header\n" + "\n".join(lines) + "\n")


class Options(Scene):
    """What scripts of OpenMVS pass."""

    def same_cloud(self, folder, *arguments):
        """Runs; the cloud must be the one without these options. Returns what was said."""
        said = self.succeeds(*self.command(folder, *arguments)).stdout
        self.assertEqual(self.cloud(folder), read(self.densified("air", "scene_dense.ply")))
        return said

    def sparse(self, folder):
        self.succeeds(*self.command(folder, "--fusion-mode", "1", "-o", "sparse.mvs"))
        return Cloud(read(os.path.join(folder, "sparse.ply")))

    def test_values_without_effect_are_named(self):
        folder = self.copy("air")
        for option, values in (("--tower-mode", (4, 3, 2, 1, -1)), ("--filter-point-cloud", (1,)),
                               ("--archive-type", (0, 2, 3))):
            for value in values:
                said = self.same_cloud(folder, option, value)
                self.assertEqual(said.count(f"{option} {value}: "), 1, said)
            self.assertNotIn(option, self.same_cloud(folder))
        self.refuses("--archive-type 7", *self.command(folder, "--archive-type", "7"))
        self.refuses("--no-option-of-2-4", *self.command(folder, "--no-option-of-2-4", "1"))

    def test_the_output_s_folder_is_made(self):
        folder = self.copy("air")
        self.succeeds(*self.command(folder, "-o", "new/folders/result.mvs"))
        self.assertEqual(read(os.path.join(folder, "new", "folders", "result.ply")),
                         read(self.densified("air", "scene_dense.ply")))

    def test_dense_config_file(self):
        folder = self.copy("air")
        file = os.path.join(folder, "Densify.ini")
        config = ("--dense-config-file", "Densify.ini")
        self.assertIn("was not there", self.same_cloud(folder, *config))
        self.assertIn("Depth Diff Threshold = 0.005", read(file).decode())
        self.assertIn("All 5 depth maps are there already", self.same_cloud(folder, *config))

        # OpenMVS's options replace these titles' values, and it knows nothing of the last ones.
        write(file, "[Densify]\n# of 2.3\nEstimation Iters = 9\nMin Views Fuse = 5\n"
                    "Random Iters = 6\nDepth Dif Threshold = 1\nNo Such = 2\n")
        said = self.same_cloud(folder, *config)
        for line in ("unknown, passed over: Depth Dif Threshold, No Such\n",
                     "without effect here: Random Iters\n", "Estimation Iters, Min Views Fuse\n"):
            self.assertEqual(said.count(line), 1, said)

        whole = cloud_size(self.cloud(folder))
        write(file, "Depth Diff Threshold = 0.00001\n")
        said = self.succeeds(*self.command(folder, *config)).stdout
        self.assertIn("All 5 depth maps are there already", said)
        self.assertLess(cloud_size(self.cloud(folder)), 0.7 * whole)

        write(file, "NCC Threshold Keep = 0.05\n")
        said = self.succeeds(*self.command(folder, *config)).stdout
        self.assertNotIn("there already", said)
        self.assertLess(cloud_size(self.cloud(folder)), 0.9 * whole)

        for wrong, said in (("Max Views", "line 2"), ("Max Views = many", "many"),
                            ("Max Views = -1", "Max Views")):
            write(file, "\n" + wrong + "\n")
            self.refuses(said, *self.command(folder, *config))

    def test_a_cloud_in_place_of_the_sparse_points(self):
        folder = self.copy("air")
        self.sparse(folder)
        said = self.same_cloud(folder, "-p", "sparse.ply")
        self.assertIn("All 5 depth maps are there already", said)
        for points, with_views, expected in (
                ([((0, 0, 1), [0])], False, "view_indices"),
                ([((0, 0, 1), [0, 5])], True, "image 5"),
                ([((0, 0, "nan"), [0, 1])], True, "other.ply")):
            write(os.path.join(folder, "other.ply"), ascii_ply(points, with_views))
            self.refuses(expected, *self.command(folder, "-p", "other.ply"))

    def test_view_neighbours(self):
        folder = self.copy("air", "_dense.ply")
        said = self.succeeds(*self.command(folder, "--output-view-neighbors-file", "views.txt"))
        lines = [list(map(int, line.split()))
                 for line in read(os.path.join(folder, "views.txt")).decode().splitlines()]
        self.assertEqual([line[0] for line in lines], list(range(self.VIEWS)), said.stdout)
        for image, *neighbours in lines:
            self.assertEqual(sorted([image, *neighbours]), list(range(self.VIEWS)))
        self.assertNotIn("scene_dense.ply", files_below(folder))

        pairs = {0: [3], 1: [4, 0], 4: [2]}
        write(os.path.join(folder, "views.txt"), "# pairs\n" + "".join(
            f"{image} {' '.join(map(str, others))}\n" for image, others in pairs.items()))
        self.succeeds(*self.command(folder, "--view-neighbors-file", "views.txt",
                                    "--fusion-mode", "1"))
        for image, name in enumerate(dmap_names()):
            ids = Dmap(read(os.path.join(folder, name))).ids
            if image in pairs:
                self.assertEqual(ids, (image, *pairs[image]))
            else:
                self.assertEqual(len(ids), self.VIEWS)

        for wrong, expected in (("0 9", "line 1: '9'"), ("0 x", "'x'"), ("0", "image 0"),
                                ("0 0", "its own"), ("0 1\n0 2", "line 2")):
            write(os.path.join(folder, "views.txt"), wrong + "\n")
            self.refuses(expected, *self.command(folder, "--view-neighbors-file", "views.txt"))

    def test_points_with_many_views(self):
        folder = self.copy("air")
        sparse = self.sparse(folder)
        for least, with_scene in ((3, False), (-4, True)):
            self.succeeds(*self.command(folder, "--export-number-views", least))
            name = os.path.join(folder, f"scene_dense_{abs(least)}views")
            expected = [position(p) for p in sparse.points
                        if len(set(p["view_indices"])) >= abs(least)]
            self.assertGreater(len(expected), 10)
            self.assertLess(len(expected), len(sparse.points))
            self.assertEqual([position(p) for p in Cloud(read(name + ".ply")).points], expected)
            self.assertEqual(os.path.exists(name + ".mvs"), with_scene)

    def test_scales_of_points(self):
        folder = self.copy("air")
        sparse = self.sparse(folder)
        cameras = [Dmap(read(os.path.join(folder, name))).camera for name in dmap_names()]
        self.succeeds(*self.command(folder, "--estimate-scale", "2.5"))
        cloud = Cloud(read(os.path.join(folder, "scene_dense_scale.ply")))
        self.assertEqual(len(cloud.points), len(sparse.points))
        for point, known in zip(cloud.points, sparse.points):
            widths = []
            for view in known["view_indices"]:
                focal, R, C = cameras[view][0] * 2, cameras[view][9:18], cameras[view][18:]
                z = sum(r * (x - c) for r, x, c in zip(R[6:], position(known), C))
                widths.append(z / focal)
            self.assertAlmostEqual(point["value"][0], 2.5 * sum(widths) / len(widths), 5)
            self.assertEqual(point["confidence"][0], len(widths))

    def test_points_that_others_see_through_are_filtered(self):
        folder = self.copy("air")
        dense = Cloud(self.cloud(folder)).points[::7]
        centre = Dmap(read(os.path.join(folder, "depth0000.dmap"))).camera[18:]
        surface = [(position(p), p["view_indices"]) for p in dense]
        seen = [xyz for xyz, views in surface if 0 in views][:100]
        self.assertGreater(len(seen), 50)
        floating = [(tuple((a + b) / 2 for a, b in zip(xyz, centre)), [0]) for xyz in seen]
        write(os.path.join(folder, "points.ply"), ascii_ply(surface + floating))
        self.succeeds(*self.command(folder, "-p", "points.ply", "--filter-point-cloud", "-1"))
        kept = Cloud(read(os.path.join(folder, "scene_dense_filtered.ply"))).points
        self.assertIn("scene_dense_filtered.mvs", os.listdir(folder))
        single = lambda xyz: struct.pack("<3f", *xyz)
        kept = {single(position(p)) for p in kept}
        self.assertFalse(kept & {single(xyz) for xyz, _ in floating})
        self.assertGreater(len(kept), 0.9 * len(surface))

    def test_log_file(self):
        folder = self.copy("air")
        said = self.succeeds(*self.command(folder, "--log-file", "run.log")).stdout
        wrong = ("--log-file", "run.log", "-p", "no-such.ply")
        error = self.refuses("no-such.ply", *self.command(folder, *wrong)).stderr
        log = read(os.path.join(folder, "run.log")).decode()
        for line in said.splitlines() + [error.strip().replace("DensifyPointCloud: ", "] ")]:
            self.assertIn(line.split("] ", 1)[1], log)
        self.refuses("no/log", *self.command(folder, "--log-file", "/proc/no/log"))
        scene = read(self.path(folder, "scene.mvs"))
        self.refuses("is no log", *self.command(folder, "--log-file", "scene.mvs"))
        self.assertEqual(read(self.path(folder, "scene.mvs")), scene)
        for program in ("InterfaceCOLMAP", "SimulateUnderwater", "EvaluateReconstruction"):
            self.assertIn("--log-file", run(program, "--help").stdout)

    def test_normalised_intrinsics(self):
        self.copy("air")
        self.succeeds("InterfaceCOLMAP", "-i", self.truth, "--image-folder",
                      os.path.join(self.truth, "air"), "-o", self.path("copy", "scene.mvs"),
                      "--normalize", "1")
        scene = read(self.path("copy", "scene.mvs"))
        # Header, one platform and its name, one camera and its names: then the resolution and K.
        at = 12 + 8
        for _ in range(3):
            at += 8 + struct.unpack_from("<Q", scene, at)[0]
            at += 8 if _ == 0 else 0
        self.assertEqual(struct.unpack_from("<II", scene, at), (0, 0))
        k = struct.unpack_from("<9d", scene, at + 8)
        lens = [float(x) for x in read(os.path.join(self.truth, "sparse", "cameras.txt")).decode()
                .splitlines()[-1].split()[4:]]
        for found, pixels in ((k[0], lens[0]), (k[4], lens[1]), (k[2] + 0.5, lens[2]),
                              (k[5] + 0.5, lens[3])):
            self.assertAlmostEqual(found, pixels / 320, 9)
        said = self.succeeds(*self.command(self.path("copy"))).stdout
        self.assertIn("stored without a resolution", said)
        self.assertAlmostEqual(cloud_size(self.cloud(self.path("copy"))) /
                               cloud_size(read(self.densified("air", "scene_dense.ply"))), 1, 1)


class Export(Scene):
    """A scene back to COLMAP."""

    def model(self, folder):
        """Cameras by id, images by name, points by position; no program of ours reads them here."""
        lines = lambda name: [line.split() for line in read(os.path.join(folder, name)).decode()
                              .splitlines() if not line.startswith("#")]
        cameras = {line[0]: line[1:] for line in lines("cameras.txt")}
        text = lines("images.txt")
        images = {head[9]: (head[0], [float(x) for x in head[1:8]], head[8],
                            [tuple(map(float, points[i:i + 2])) for i in range(0, len(points), 3)])
                  for head, points in zip(text[::2], text[1::2])}
        names = {image[0]: name for name, image in images.items()}
        points = []
        for line in lines("points3D.txt"):
            track = [(names[line[i]], int(line[i + 1])) for i in range(8, len(line), 2)]
            points.append(([float(x) for x in line[1:4]], line[4:7], track))
        return cameras, images, points

    def check_round_trip(self, medium, cameras_too):
        folder = self.copy(medium)
        self.succeeds("InterfaceCOLMAP", "-i", "scene.mvs", "-w", folder, "-o", "back")
        cameras, images, points = self.model(os.path.join(self.truth, "sparse"))
        again = self.model(os.path.join(folder, "back", "sparse"))
        self.assertEqual(len(again[0]), len(cameras))
        self.assertEqual(again[1].keys(), images.keys())
        for name, (_, pose, camera, pixels) in images.items():
            found_id, found, found_camera, _ = again[1][name]
            sign = 1 if pose[0] * found[0] + pose[1] * found[1] + pose[2] * found[2] \
                + pose[3] * found[3] > 0 else -1
            for i in range(4):
                self.assertAlmostEqual(sign * found[i], pose[i], 12)
            for i in range(4, 7):
                self.assertAlmostEqual(found[i], pose[i], 12)
            if cameras_too:
                self.assertEqual([float(x) for x in again[0][found_camera][1:]],
                                 [float(x) for x in cameras[camera][1:]])
        self.assertEqual(len(again[2]), len(points))
        largest = 0
        for (xyz, color, track), (found, found_color, found_track) in zip(points, again[2]):
            for a, b in zip(xyz, found):
                self.assertAlmostEqual(a, b, 5)  # a scene's points are float32
            self.assertEqual(found_color, color)
            self.assertEqual(sorted({name for name, _ in found_track}),
                             sorted({name for name, _ in track}))
            pixel = {name: again[1][name][3][index] for name, index in found_track}
            for name, index in track:
                there = images[name][3][index]
                largest = max(largest, abs(there[0] - pixel[name][0]),
                              abs(there[1] - pixel[name][1]))
        return largest

    def test_in_air(self):
        # Observations of the truth have noise of about a pixel at most, ours none.
        self.assertLess(self.check_round_trip("air", True), 3)

    def test_only_an_export_is_overwritten(self):
        folder = self.copy("air")
        command = ("InterfaceCOLMAP", "-i", "scene.mvs", "-w", folder)
        for part in ("cameras.txt", "points3D.bin", "frames.txt"):
            mine = os.path.join(folder, "sparse", part)
            write(mine, "mine")
            self.refuses(part, *command)
            self.assertEqual(os.listdir(os.path.dirname(mine)), [part])
            os.remove(mine)
        self.succeeds(*command)
        first = self.model(os.path.join(folder, "sparse"))
        self.succeeds(*command)
        self.assertEqual(self.model(os.path.join(folder, "sparse")), first)
        write(os.path.join(folder, "sparse", "images.bin"), "COLMAP would read it")
        self.refuses("images.bin", *command)

    def test_behind_a_port(self):
        folder = self.copy("water")
        said = self.succeeds("InterfaceCOLMAP", "-i", "scene.mvs", "-w", folder).stdout
        self.assertIn("5 of 5 images are behind ports", said)
        self.assertIn("FLATPORT", read(os.path.join(folder, "sparse", "cameras.txt")).decode())
        # And in again: the ports are those of the housing.
        os.remove(os.path.join(folder, "scene.housing.json"))
        self.succeeds("InterfaceCOLMAP", "-i", folder, "-o", os.path.join(folder, "scene.mvs"),
                      "--image-folder", os.path.join(self.truth, "water"))
        self.succeeds(*self.command(folder, "--refractive"))
        self.assertAlmostEqual(cloud_size(self.cloud(folder)) /
                               cloud_size(read(self.densified("water", "scene_dense.ply"))), 1, 1)


if __name__ == "__main__":
    main()
