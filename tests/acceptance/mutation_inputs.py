# SPDX-License-Identifier: GPL-3.0-or-later
"""The small valid inputs of each program for mutations.py: one scene of four photographs, and what
the programs make of it in sequence."""

import dataclasses
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "apps"))
from programs import grey_png  # noqa: E402
from small_clip import moving_clip  # noqa: E402

THREADS = ("--max-threads", "1")
NOT_CHANGED = {"help", "version", "log-file"}


@dataclasses.dataclass
class Program:
    name: str
    options: tuple  # of the valid run, in the folder of the inputs
    inputs: tuple  # files that are damaged
    # More files that the run reads, and files that appear although it fails: finished depth maps.
    more: tuple = ()
    kept_on_error: str = "(?!)"
    may_name: tuple = ()  # more words of an error that name what is wrong
    outputs: tuple = ()  # set by make_inputs()
    option_names: tuple = ()

    def outputs_in(self, files):
        return [file for file in files if file in self.outputs]


MODEL = tuple(f"sim/sparse/{name}.txt" for name in ("cameras", "images", "points3D"))
PHOTOGRAPHS = tuple(f"sim/water/000{i}.jpg" for i in range(4))
SCENE = ("scene.mvs", "scene.housing.json", "scene.lenses.json")
DENSE = ("scene_dense.mvs", "scene_dense.housing.json", "scene_dense.lenses.json")
MAPS = tuple(f"depth000{i}.dmap{end}" for i in range(4) for end in ("", ".json"))
BOARDS = tuple(f"board/{i}.png" for i in range(6))

PROGRAMS = {program.name: program for program in (
    Program("SimulateUnderwater",
            ("--preset", "closeup", "--coarseness", "8", "--views", "2", "--width", "16", "--height",
             "12", "--samples", "1", "-o", "out"), ("SimulateUnderwater.cfg",)),
    Program("InterfaceCOLMAP", ("-i", "sim", "--image-folder", "sim/water", "--housing",
                                "sim/housing.json", "-o", "out.mvs"),
            (*MODEL, "sim/housing.json", PHOTOGRAPHS[0]), PHOTOGRAPHS),
    Program("DensifyPointCloud",
            ("-i", "scene.mvs", "--refractive", "--resolution-level", "1", "--min-resolution", "16",
             "--iters", "1", "--geometric-iters", "0", "--number-views-fuse", "2", "-o", "out.mvs"),
            (*SCENE, PHOTOGRAPHS[0], MAPS[0], MAPS[1]), (*PHOTOGRAPHS, *MAPS),
            kept_on_error=r"depth\d+\.dmap(\.json)?"),
    Program("ReconstructMesh", ("-i", "scene_dense.mvs", "-o", "out.ply"),
            (*DENSE, "scene_dense.ply")),
    Program("RefineMesh", ("-i", "scene_dense.mvs", "-m", "mesh.ply", "-o", "out.ply", "--scales",
                           "1", "--resolution-level", "2", "--min-resolution", "16"),
            (*DENSE, "mesh.ply", PHOTOGRAPHS[0]), PHOTOGRAPHS, kept_on_error=r".*\.state"),
    Program("TextureMesh", ("-i", "scene_dense.mvs", "-m", "mesh.ply", "-o", "out.glb",
                            "--export-type", "glb"),
            (*DENSE, "mesh.ply", PHOTOGRAPHS[0]), PHOTOGRAPHS),
    Program("MapSurface", ("-i", "scene_dense.mvs", "-m", "textured.ply", "-o", "out",
                           "--ground-sample-distance", "0.02"),
            (*DENSE, "textured.ply", "textured0.png"), PHOTOGRAPHS),
    Program("CompareSurveys", ("-i", "mesh.ply", "--other", "textured.ply", "--scene",
                               "scene_dense.mvs", "-o", "out", "--gsd", "0.02"),
            ("mesh.ply", "textured.ply", *DENSE), ("textured0.png", *PHOTOGRAPHS)),
    Program("ViewScene", ("-i", "scene_dense.mvs", "-p", "scene_dense.ply", "-m", "textured.ply",
                          "--report", "out", "--max-points", "2000", "--map", "map", "--sfm-model",
                          "sim/sparse", "--photograph-size", "40", "--depth-map-size", "40"),
            (*DENSE, "scene_dense.ply", "textured.ply", "textured0.png", "map.dem.tif", MAPS[0],
             *MODEL, PHOTOGRAPHS[0]),
            (*PHOTOGRAPHS, *MAPS, "map.ortho.tif", "map.sigma.tif", "map.views.tif")),
    Program("TransformScene", ("-i", "scene.mvs", "-p", "scene_dense.ply", "-m", "textured.ply",
                               "--positions", "positions.csv", "--rigid", "-o", "out.mvs"),
            (*SCENE, "scene_dense.ply", "textured.ply", "positions.csv"),
            ("textured0.png", *PHOTOGRAPHS)),
    Program("EvaluateReconstruction", ("-i", "scene_dense.ply", "-m", "sim/mesh.ply", "--cameras",
                                       "sim/sparse", "--housing", "sim/housing.json", "--samples",
                                       "200", "--json", "out.json"),
            ("scene_dense.ply", "sim/mesh.ply", *MODEL, "sim/housing.json")),
    Program("AlignModel", ("-i", "sim/sparse", "--reference", "other", "-o", "out"),
            (*MODEL, "other/images.txt"), ("other/cameras.txt", "other/points3D.txt")),
    Program("RefinePoses", ("-i", "few", "--lens", "lens.yaml", "--housing", "sim/housing.json",
                            "--scale-from", "positions:positions.csv", "-o", "out"),
            ("few/cameras.txt", "few/images.txt", "few/points3D.txt", "sim/housing.json",
             "positions.csv", "lens.yaml")),
    Program("CalibrateHousing", ("-i", "board", "--lens", "board.cameras.txt", "--housing",
                                 "board.housing.json", "--board", "checkerboard:6x5:0.03", "--refine",
                                 "distance", "--distance-sigma", "0.0005", "-o", "out.json"),
            (*BOARDS[:2], "board.cameras.txt", "board.housing.json"), BOARDS,
            may_name=("board",)),
    Program("ExtractFrames", ("-i", "clip.avi", "-o", "out", "--json", "out.json"), ("clip.avi",)),
    Program("ReproducePaper", ("figure3", "--quick", "-o", "paper"),
            ("paper/quick/figure3.json", "ReproducePaper.cfg"), kept_on_error=r"paper/.*",
            may_name=("figure3",)),
)}


N_WATER, PORT = 1.333, 0.06  # index of the water; distance of the port, with glass of the air's index


def board_picture(turn, tilt, centre, size=(320, 240), focal=280):
    """A checkerboard of 7 x 6 squares, seen through the port. `centre`: of the board [m]."""
    c, s, ct, st = math.cos(turn), math.sin(turn), math.cos(tilt), math.sin(tilt)
    rows = []
    for v in range(size[1]):
        row = bytearray()
        for u in range(size[0]):
            x, y = (u + 0.5 - size[0] / 2) / focal, (v + 0.5 - size[1] / 2) / focal
            radius = math.hypot(x, y)
            bent = math.tan(math.asin(math.sin(math.atan(radius)) / N_WATER)) / radius
            # The point PORT (x, y, 1) + t (bent x, bent y, 1) on the board, whose normal is
            # (0, -st, ct).
            dx, dy, dz = PORT * x - centre[0], PORT * y - centre[1], PORT - centre[2]
            t = (st * dy - ct * dz) / (ct - st * bent * y)
            px, py, pz = dx + t * bent * x, dy + t * bent * y, dz + t
            a, b = px * c + (py * ct + pz * st) * s, -px * s + (py * ct + pz * st) * c
            i, j = math.floor(a / 0.03 + 3.5), math.floor(b / 0.03 + 3)
            inside = 0 <= i < 7 and 0 <= j < 6
            row.append(20 if inside and (i + j) % 2 == 0 else 230)
        rows.append(bytes(row))
    return grey_png(rows)


def write_board(folder):
    (folder / "board").mkdir()
    for i, name in enumerate(BOARDS):
        side, low = 0.07 * (i % 3 - 1), 0.05 * (i % 2) - 0.025
        (folder / name).write_bytes(board_picture(0.3 * i, 0.3 * (i % 3 - 1),
                                                  (side, low, 0.3 + 0.04 * i)))
    (folder / "board.cameras.txt").write_text("1 PINHOLE 320 240 280 280 160 120\n")
    (folder / "board.housing.json").write_text(json.dumps(
        {"version": 1, "default": "main", "ports": {"main": {
            "type": "flat", "normal": [0, 0, 1], "distance_m": PORT, "thickness_m": 0.001,
            "n_air": 1.0, "n_glass": 1.001, "n_water": N_WATER}}}))


def centres(images):
    """The camera centres of COLMAP's images.txt, by name."""
    found = {}
    for line in images.splitlines():
        words = line.split()
        if line.startswith("#") or len(words) != 10 or not words[9].endswith(".jpg"):
            continue
        w, x, y, z, *t = map(float, words[1:8])
        rows = ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
                (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
                (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
        found[words[9]] = [-sum(rows[k][i] * t[k] for k in range(3)) for i in range(3)]
    return found


def write_few(folder, every=8):
    """A part of the model's points, so that RefinePoses takes little time."""
    (folder / "few").mkdir()
    shutil.copy(folder / MODEL[0], folder / "few")
    kept, lines = set(), []
    for line in (folder / MODEL[2]).read_text().splitlines():
        if not line.startswith("#") and int(line.split()[0]) % every == 0:
            kept.add(line.split()[0])
            words = line.split()
            lines.append(" ".join(words))
    poses = []
    places = {}
    text = [line for line in (folder / MODEL[1]).read_text().splitlines()
            if not line.startswith("#")]
    for pose, points in zip(text[::2], text[1::2]):
        words = points.split()
        triples = [(i // 3, words[i:i + 3]) for i in range(0, len(words), 3)]
        triples = [(old, triple) for old, triple in triples if triple[2] in kept]
        image = pose.split()[0]
        places.update({(image, str(old)): str(new) for new, (old, _) in enumerate(triples)})
        poses += [pose, " ".join(word for _, triple in triples for word in triple)]
    for k, line in enumerate(lines):
        words = line.split()
        track = words[8:]
        words[8:] = [word for i in range(0, len(track), 2)
                     for word in (track[i], places[track[i], track[i + 1]])]
        lines[k] = " ".join(words)
    (folder / "few" / "images.txt").write_text("\n".join(poses) + "\n")
    (folder / "few" / "points3D.txt").write_text("\n".join(lines) + "\n")
    words = (folder / MODEL[0]).read_text().splitlines()[-1].split()
    (folder / "lens.yaml").write_text(
        f"model: {words[1]}\nwidth: {words[2]}\nheight: {words[3]}\n"
        f"parameters: [{', '.join(words[4:])}]\n")


def write_other(folder):
    (folder / "other").mkdir()
    for name in MODEL:
        shutil.copy(folder / name, folder / "other")
    known = centres((folder / MODEL[1]).read_text())
    (folder / "positions.csv").write_text("#Label,X,Y,Z,Accuracy (m)\n" + "".join(
        f"{name},{','.join(map(repr, place))},0.01\n" for name, place in known.items()))


def make_all(binaries, folder):
    """All files, of which each program gets a part."""
    def run(program, *options):
        subprocess.run([binaries / program, *options, *THREADS], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
    run("SimulateUnderwater", "--preset", "closeup", "--coarseness", "8", "--views", "4", "--width",
        "160", "--height", "120", "--samples", "1", "--sparse-points", "100", "-o", "sim")
    shutil.rmtree(folder / "sim" / "air")
    for path in (folder / "sim").rglob("*.tiff"):
        path.unlink()
    run("InterfaceCOLMAP", *PROGRAMS["InterfaceCOLMAP"].options[:-1], "scene.mvs")
    run("DensifyPointCloud", *PROGRAMS["DensifyPointCloud"].options[:-1], "scene_dense.mvs")
    run("ReconstructMesh", "-i", "scene_dense.mvs", "-o", "mesh.ply")
    run("TextureMesh", "-i", "scene_dense.mvs", "-m", "mesh.ply", "-o", "textured.ply")
    run("MapSurface", *PROGRAMS["MapSurface"].options[:5], "map", "--ground-sample-distance", "0.02")
    (folder / "clip.avi").write_bytes(moving_clip())
    write_board(folder)
    write_few(folder)
    write_other(folder)
    (folder / "SimulateUnderwater.cfg").write_text("# A comment\nseed = 2\nrelief = 1.5\n")
    (folder / "ReproducePaper.cfg").write_text("# A comment\nquick = 1\n")
    (folder / "paper").mkdir()
    run("ReproducePaper", *PROGRAMS["ReproducePaper"].options)


def make_inputs(names, binaries, work):
    """Makes work/NAME, a folder with the inputs and the outputs of the valid run, and the names of
    the program's options in work/NAME.options.json. Sets Program.outputs."""
    shutil.rmtree(work, ignore_errors=True)
    whole = work / "all"
    whole.mkdir(parents=True)
    make_all(binaries, whole)
    for name in names:
        program, folder = PROGRAMS[name], work / name
        for file in dict.fromkeys((*program.inputs, *program.more)):
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(whole / file, folder / file)
        before = {path for path in folder.rglob("*")}
        program.options = (*program.options, *THREADS)
        done = subprocess.run([binaries / name, *program.options], cwd=folder, text=True,
                              capture_output=True)
        if done.returncode:
            sys.exit(f"{name}: the valid run fails: {done.stderr}")
        program.outputs = tuple(str(path.relative_to(folder))
                                for path in set(folder.rglob("*")) - before if path.is_file())
        help_text = subprocess.run([binaries / name, "-h"], text=True, capture_output=True).stdout
        options = sorted(set(re.findall(r"--([a-z][a-z0-9-]+)", help_text)) - NOT_CHANGED)
        (work / f"{name}.options.json").write_text(json.dumps(options))
