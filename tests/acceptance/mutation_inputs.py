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

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1] / folder) for folder in (".", "apps")]
from small_clip import moving_clip  # noqa: E402
from support import colmap_text  # noqa: E402

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
BOARDS = tuple(f"board/photos/{i:02}.png" for i in range(0, 12, 2))  # the whole board

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
                            "--export-type", "glb", "--boundary", "areas.geojson", "--boundary-map", "map.dem.tif"),
            (*DENSE, "mesh.ply", PHOTOGRAPHS[0], "areas.geojson", "map.dem.tif"), PHOTOGRAPHS),
    Program("MapSurface", ("-i", "scene_dense.mvs", "-m", "textured.ply", "-o", "out",
                           "--ground-sample-distance", "0.02", "--boundary", "areas.geojson", "--like",
                           "first.change.json", "--profiles", "lines.geojson", "--preset", "archive", "--widths",
                           "8,4"),
            (*DENSE, "textured.ply", "textured0.png", "areas.geojson", "first.change.json", "lines.geojson"),
            PHOTOGRAPHS),
    Program("CompareSurveys", ("-i", "mesh.ply", "--other", "textured.ply", "--scene",
                               "scene_dense.mvs", "-o", "out", "--gsd", "0.02", "--like", "map.dem.tif"),
            ("mesh.ply", "textured.ply", *DENSE, "map.dem.tif"), ("textured0.png", *PHOTOGRAPHS)),
    Program("MeasureSurface", ("-i", "mesh.ply", "--areas", "areas.geojson", "--map", "map.dem.tif", "-o", "out"),
            ("mesh.ply", "areas.geojson", "map.dem.tif"), ()),
    Program("ProjectLabels", ("-i", "scene_dense.mvs", "-m", "mesh.ply", "--from-photographs", "drawn.json", "--map",
                              "map.dem.tif", "-o", "out"),
            (*DENSE, "mesh.ply", "drawn.json", "map.dem.tif"), PHOTOGRAPHS),
    Program("ViewScene", ("-i", "scene_dense.mvs", "-p", "scene_dense.ply", "-m", "textured.ply",
                          "--report", "out", "--max-points", "2000", "--map", "map", "--raw-map", "raw",
                          "--earlier-map", "old", "--sfm-model", "sim/sparse", "--photograph-size",
                          "40", "--depth-map-size", "40"),
            (*DENSE, "scene_dense.ply", "textured.ply", "textured0.png", "map.dem.tif", "raw.ortho.tif",
             "old.ortho.tif", MAPS[0], *MODEL, PHOTOGRAPHS[0]),
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
                            "--scale-from", "positions:positions.csv", "--targets", "targets.json", "--bars",
                            "lengths.csv", "--control", "places.json", "-o", "out"),
            ("few/cameras.txt", "few/images.txt", "few/points3D.txt", "sim/housing.json",
             "positions.csv", "lens.yaml", "targets.json", "lengths.csv", "places.json")),
    Program("CalibrateHousing", ("-i", "board/photos", "--lens", "board/lens.txt", "--housing",
                                 "board/start.json", "--board", "checkerboard:8x7:0.03", "--refine",
                                 "distance", "--distance-sigma", "0.0005", "-o", "out.json"),
            (*BOARDS[:2], "board/lens.txt", "board/start.json"), BOARDS,
            may_name=("board",)),
    Program("ExtractFrames", ("-i", "clip.avi", "-o", "out", "--json", "out.json"), ("clip.avi",)),
    Program("FindTargets", ("-i", "board/photos", "-o", "out.xml", "--families", "circular12,4X4_50", "--control",
                            "control.json", "--control", "plates.csv", "--control", "bars.txt"),
            (*BOARDS[:1], "control.json", "plates.csv", "bars.txt"), may_name=("board",)),
    Program("RestoreColors", ("-i", "wet.mvs", "-m", "wet/mesh.ply", "--light", "sun", "--points", "1000", "-o", "out"),
            ("wet.mvs", "wet.housing.json", "wet.lenses.json", "wet/mesh.ply", "wet/water/0000.jpg"),
            tuple(f"wet/water/000{i}.jpg" for i in range(1, 6)), kept_on_error=r"out/unfinished/.*"),
    Program("ReproducePaper", ("figure3", "--quick", "-o", "paper"),
            ("paper/quick/figure3.json", "ReproducePaper.cfg"), kept_on_error=r"paper/.*",
            may_name=("figure3",)),
)}


def write_few(folder):
    """A part of the model's points, so that RefinePoses takes little time."""
    colmap_text.copy(folder / "sim" / "sparse", folder / "few", lambda number: number % 8 == 0)
    words = (folder / MODEL[0]).read_text().splitlines()[-1].split()
    (folder / "lens.yaml").write_text(
        f"model: {words[1]}\nwidth: {words[2]}\nheight: {words[3]}\n"
        f"parameters: [{', '.join(words[4:])}]\n")


def write_targets(folder):
    """Points of the model as targets, a bar between two of them, and their places."""
    records = colmap_text.records
    names = list(colmap_text.images_of(folder / "sim" / "sparse"))
    keypoints = [line.split() for line in list(records(folder / MODEL[1]))[1::2]]
    lines = map(str.split, filter(None, records(folder / MODEL[2])))
    points = {words[0]: tuple(map(float, words[1:4])) for words in lines}
    seen = {point: [(name, *line[line.index(point) - 2:line.index(point)]) for name, line in zip(names, keypoints)
                    if point in line[2::3]] for point in points}
    chosen = sorted(points, key=lambda point: (-len(seen[point]), int(point)))[:4]
    (folder / "targets.json").write_text(json.dumps({"targets": [
        {"label": f"target {point}", "image": name, "x": float(x), "y": float(y), "sigma": 0.1}
        for point in chosen for name, x, y in seen[point]]}))
    first, second = chosen[:2]
    (folder / "lengths.csv").write_text(
        f"target {first},target {second},{math.dist(points[first], points[second]):.6f},0.0001\n")
    (folder / "places.json").write_text(json.dumps({"points": [
        {"label": f"target {point}", **dict(zip("xyz", points[point])), "sigma": 0.01} for point in chosen]}))


def write_other(folder):
    (folder / "other").mkdir()
    for name in MODEL:
        shutil.copy(folder / name, folder / "other")
    known = colmap_text.centres(folder / "sim" / "sparse")
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
    run("SimulateUnderwater", "--preset", "reef", "--coarseness", "8", "--views", "6", "--width", "160", "--height",
        "120", "--samples", "1", "--sparse-points", "100", "--medium", "water", "--truth", "0", "--water",
        "0.9,0.5,0.3,0.8,0.4,0.3,0.05,0.15,0.2", "-o", "wet")
    run("InterfaceCOLMAP", "-i", "wet", "--image-folder", "wet/water", "--housing", "wet/housing.json", "-o", "wet.mvs")
    run("DensifyPointCloud", *PROGRAMS["DensifyPointCloud"].options[:-1], "scene_dense.mvs")
    run("ReconstructMesh", "-i", "scene_dense.mvs", "-o", "mesh.ply")
    run("TextureMesh", "-i", "scene_dense.mvs", "-m", "mesh.ply", "-o", "textured.ply")
    run("MapSurface", *PROGRAMS["MapSurface"].options[:5], "map", "--ground-sample-distance", "0.02")
    run("CompareSurveys", "-i", "mesh.ply", "--other", "textured.ply", "--scene", "scene_dense.mvs", "-o", "first",
        "--gsd", "0.02", "--like", "map.dem.tif")
    for name in ("raw.ortho.tif", "old.ortho.tif"):
        shutil.copy(folder / "map.ortho.tif", folder / name)
    (folder / "clip.avi").write_bytes(moving_clip())
    subprocess.run([binaries / "drawn_boards", "1", folder / "board"], check=True, stdout=subprocess.DEVNULL)
    write_few(folder)
    write_targets(folder)
    write_other(folder)
    (folder / "SimulateUnderwater.cfg").write_text("# A comment\nseed = 2\nrelief = 1.5\n")
    (folder / "control.json").write_text(
        '{"crs": "EPSG:32617", "points": [{"label": "target 1", "x": 500000, "y": 2500000, "z": -3, "sigma": 0.01}]}')
    (folder / "plates.csv").write_text("label,lat,lon,depth,xyAcc,zAcc\n2,22.6,-81.0,-3.5,0.02,0.03\n")
    (folder / "areas.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"name": "plot"}, "geometry": {"type": "Polygon", "coordinates": [
            [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, -0.1]]]}}]}))
    (folder / "lines.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"name": "line"}, "geometry": {
            "type": "LineString", "coordinates": [[-0.1, -0.05], [0.08, 0.02]]}}]}))
    (folder / "drawn.json").write_text(json.dumps({
        "images": [{"id": 1, "file_name": "0001.jpg", "width": 160, "height": 120}],
        "categories": [{"id": 1, "name": "coral"}],
        "annotations": [{"id": 1, "image_id": 1, "category_id": 1, "iscrowd": 0,
                         "segmentation": [[60, 40, 100, 40, 100, 80.5, 60, 80]], "bbox": [60, 40, 40, 40.5]},
                        {"id": 2, "image_id": 1, "category_id": 1, "keypoints": [70.25, 60, 2]}]}))
    (folder / "bars.txt").write_text("target 1,target 2,0.5,0.001\n")
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
