# SPDX-License-Identifier: GPL-3.0-or-later
"""The worlds that the program tests share: ports and meshes that are written by hand, the plane of
tiny_scene.py with a mesh (Wall), and the simulated close-up scene (Simulated, CloseUp), also densified in air
and under water (Densified)."""

import inspect
import json
import os
import shutil
import struct

import scenes
from programs import BIN, ProgramTest, files_below, must, new_folder, read, read_json, write
from readers import with_paths
from tiny_scene import DISTANCE, TinyScene

FLAT = {"type": "flat", "distance_m": 0.02, "thickness_m": 0.01, "normal": [0, 0, 1], "n_air": 1, "n_glass": 1.5,
        "n_water": 1.33}


def flat(**changes):
    return {**FLAT, **changes}


def lake(point, normal=(0, 0, 1), n_water=1.333):
    """A water surface."""
    return {"type": "water-surface", "normal": list(normal), "point_m": list(point), "n_water": n_water}


def housing(port=None, default="main", **more):
    """The text of a housing file with the port `main`."""
    return json.dumps({"version": 1, "ports": {"main": port or FLAT}, "default": default, **more})


def geo_offset(*offset):
    """The text of a .geo.json file."""
    return json.dumps({"version": 1, "geo_offset": offset})


def ply(vertices, faces=None, *, kind="float", more="", face_more="", face_values=(), comments=""):
    """An ascii PLY. `more` and `face_more` declare properties behind the coordinates and the corners, and
    `face_values` are the values of `face_more`, the same for all faces."""
    rows = [*vertices, *((len(face), *face, *face_values) for face in faces or ())]
    corners = f"element face {len(faces)}\nproperty list uchar int vertex_indices\n{face_more}" \
        if faces is not None else ""
    axes = "".join(f"property {kind} {axis}\n" for axis in "xyz")
    return (f"ply\nformat ascii 1.0\n{comments}element vertex {len(vertices)}\n{axes}{more}{corners}end_header\n"
            + "".join(" ".join(map(str, row)) + "\n" for row in rows))


def cloud(points, comments=""):
    """An ascii PLY of pairs of (x, y, z) and [image indices]."""
    return ply([(*xyz, len(views), *views) for xyz, views in points], comments=comments,
               more="property list uchar uint view_indices\n")


def binary_mesh(vertices, faces, kind="float"):
    """A binary PLY of triangles."""
    vertices = list(vertices)
    axes = "".join(f"property {kind} {axis}\n" for axis in "xyz")
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n{axes}"
            f"element face {len(faces)}\nproperty list uchar uint vertex_indices\nend_header\n")
    return (head.encode() + b"".join(struct.pack("<3" + kind[0], *v) for v in vertices)
            + b"".join(struct.pack("<B3I", 3, *f) for f in faces))


def obj(vertices, faces):
    return ("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices)
            + "".join("f " + " ".join(str(i + 1) for i in face) + "\n" for face in faces))


def grid(columns, rows, place):
    """A mesh of 2 * columns * rows faces with the vertices place(i, j), whose outside looks to smaller z
    if i goes to x and j to y."""
    vertices = [place(i, j) for j in range(rows + 1) for i in range(columns + 1)]
    faces = []
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            faces += [(a, a + columns + 1, a + columns + 2), (a, a + columns + 2, a + 1)]
    return vertices, faces


def wall(z=DISTANCE, cells=12, half=0.3):
    """A grid on the wall. Its outside looks at the cameras, to smaller z."""
    at = lambda i: -half + 2 * half * i / cells
    return grid(cells, cells, lambda i, j: (at(i), at(j), z))


def turned(faces):
    """The same faces with their outside on the other side."""
    return [face[::-1] for face in faces]


TURN = ((0.36, 0.48, -0.8), (-0.8, 0.60, 0.0), (0.48, 0.64, 0.60))  # a rotation in exact decimals
SHIFT = (1.5, -2.25, 0.75)


def times(matrix, x):
    return tuple(sum(a * b for a, b in zip(row, x)) for row in matrix)


def moved(x, scale=1, shift=SHIFT):
    return tuple(scale * a + b for a, b in zip(times(TURN, x), shift))


def matrix_text(scale=1, shift=SHIFT, turn=TURN):
    return "".join(" ".join(repr(scale * a) for a in row) + f" {b!r}\n" for row, b in zip(turn, shift))


TRIANGLE = ply([(-1, -1, 1), (1, -1, 1), (0, 1, 1)], [(0, 1, 2)])


class Wall(TinyScene):
    """The scene work/scene.mvs with a mesh of the wall."""
    MESH = "scene.ply"

    def setUp(self):
        super().setUp()
        self.mesh = self.path("work", self.MESH)
        self.put(*wall())

    def put(self, vertices, faces, **more):
        """Replaces the mesh."""
        write(self.mesh, ply(vertices, faces, **more))


SMALL = ("--coarseness", 4, "--views", 5, "--width", 320, "--height", 240)
ROUGH = (*SMALL, "--samples", 1)
CLOSEUP = ("--preset", "closeup", *SMALL, "--samples", 2, "--truth", 0)
QUICK = ("--resolution-level", "1", "--min-resolution", "100", "--iters", "1", "--number-views-fuse", "2")


class Simulated(ProgramTest):
    """A scene that SimulateUnderwater rendered, shared by all cases of a class: truth/{air,water,sparse},
    truth/housing.json and truth/mesh.ply. SCENE holds the options; None: base class of other tests."""
    SCENE = None

    @classmethod
    def setUpClass(cls):
        if cls.SCENE is None:
            return
        cls.make(new_folder(cls.addClassCleanup))

    @classmethod
    def make(cls, folder):
        cls.shared = folder
        cls.truth = cls.at("truth")
        must("SimulateUnderwater", *cls.SCENE, "-o", cls.truth)

    @classmethod
    def at(cls, *names):
        return os.path.join(cls.shared, *names)

    @classmethod
    def port(cls, medium, folder=None):
        return ("--housing", os.path.join(folder or cls.truth, "housing.json")) if medium == "water" else ()

    @classmethod
    def imported(cls, scene, medium, *arguments, model=None, port=None):
        """Imports the photographs in air or under water to the file `scene`. Returns the output."""
        return must("InterfaceCOLMAP", "-i", model or cls.truth, "--image-folder", os.path.join(cls.truth, medium),
                    "-o", scene, *(cls.port(medium) if port is None else port), *arguments)

    def evaluated(self, medium, file, *arguments, samples=20000, seen_from=None):
        """The report on a cloud or mesh against the true surface. `seen_from`: the folder of the cameras (truth)."""
        report = self.path("report.json")
        self.succeeds("EvaluateReconstruction", "-i", file, "-m", os.path.join(self.truth, "mesh.ply"), "--cameras",
                      os.path.join(seen_from or self.truth, "sparse"), *self.port(medium, seen_from), "--samples",
                      samples, "--json", report, *arguments)
        result = read_json(report)
        os.remove(report)
        return result


FINE = ("--preset", "closeup", "--views", 4, "--width", 512, "--height", 384, "--seed", 1, "--samples", 2,
        "--coarseness", 3)
# The width of a pixel at the scene: the median distance (0.7 m) over the focal length (305 px).
GSD = 0.7 / 305
# Large enough to show differences in quality, small enough to run often.
LEVEL_1 = ("--resolution-level", "1", "--min-resolution", "200")
# Recall then has a standard deviation of 0.004. Errors use all points of the cloud.
RECALL_SAMPLES = 20000


class CloseUp(Simulated):
    """Four views of 512 x 384 of the close-up scene. The folders of a case are below self.folder."""

    def import_scene(self, medium, folder, *arguments, port=None):
        self.imported(self.path(folder, "scene.mvs"), medium, *arguments, port=port)

    def command(self, folder, *arguments, scene="scene.mvs"):
        return ("DensifyPointCloud", "-i", scene, "-w", self.path(folder), *arguments)

    def densify(self, folder, *arguments, scene="scene.mvs"):
        return self.succeeds(*self.command(folder, *arguments, scene=scene)).stdout

    def scores(self, medium, folder):
        return self.evaluated(medium, self.path(folder, "scene_dense.ply"), "--tolerance", "0.002",
                              samples=RECALL_SAMPLES)


class Densified(Simulated):
    """Five small views of the close-up scene, densified in air and under water. All paths are relative, so
    that the folder can be copied."""
    VIEWS = 5
    MEDIA = ("air", "water")
    SCENE = CLOSEUP
    FUSE = ("--fusion-mode", "-1")

    @classmethod
    def setUpClass(cls):
        folder = new_folder(cls.addClassCleanup)
        programs = [os.path.join(BIN, name) for name in ("SimulateUnderwater", "InterfaceCOLMAP", "DensifyPointCloud")]
        source = [inspect.getsource(one.make) for one in cls.__mro__ if "make" in vars(one)]
        scenes.made((*source, *cls.SCENE, *QUICK), programs, folder, cls.make)
        cls.shared = folder
        cls.truth = cls.at("truth")

    @classmethod
    def make(cls, folder):
        super().make(folder)
        for medium in cls.MEDIA:
            cls.imported(cls.at(medium, "scene.mvs"), medium)
            cls.make_relative(medium, "scene.mvs")
            must("DensifyPointCloud", "-i", "scene.mvs", "-w", cls.at(medium), *QUICK)
            cls.make_relative(medium, "scene_dense.mvs")

    @classmethod
    def make_relative(cls, folder, name):
        scene = cls.at(folder, name)
        write(scene, with_paths(read(scene), lambda path: os.path.relpath(path, cls.at(folder))))

    def copy(self, medium, *leave_out):
        """A copy of the densified folder without files whose names end in one of `leave_out`. It lies
        beside the shared folder, because maps hold relative image paths."""
        self.folder = self.shared
        folder = self.path("copy")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.at(medium), folder)
        for name in files_below(folder):
            if name.endswith(leave_out):
                os.remove(os.path.join(folder, name))
        return folder

    def command(self, folder, *arguments):
        quick = [word for i in range(0, len(QUICK), 2) if QUICK[i] not in arguments for word in QUICK[i:i + 2]]
        return ("DensifyPointCloud", "-i", "scene.mvs", "-w", folder, *quick, *arguments)

    def said(self, folder, *arguments):
        return self.succeeds(*self.command(folder, *arguments)).stdout

    def maps(self, folder):
        return {name: (read(os.path.join(folder, name)), os.stat(os.path.join(folder, name)).st_mtime_ns)
                for name in files_below(folder) if ".dmap" in name}

    def cloud(self, folder):
        return read(os.path.join(folder, "scene_dense.ply"))

    def whole(self, medium):
        """The cloud of the shared folder."""
        return self.cloud(self.at(medium))

    def fuse(self, folder, *arguments):
        """Fuses the existing maps, and checks that no map changes, appears or disappears. Returns
        the output."""
        before = self.maps(folder)
        said = self.said(folder, *self.FUSE, *arguments)
        self.assertEqual(self.maps(folder), before)
        return said


def dmap_names():
    return [f"depth{i:04}.dmap" for i in range(Densified.VIEWS)]
