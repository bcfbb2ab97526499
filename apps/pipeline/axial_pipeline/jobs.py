# SPDX-License-Identifier: GPL-3.0-or-later
"""The jobs of the workflow apps/pipeline/Snakefile: the steps of `reconstruct`, jobs that compute the
depth maps of a part of the images, and jobs that make a tile of the cloud or of the mesh. A job of
Slurm is one call of one_step.py."""

import argparse
import hashlib
import math
import pathlib
import re
import shlex
import sys

from . import cameras, files
from .failure import Failure
from .option_files import without_options
from .step_kinds import KINDS, NEEDS_OF_PLAN
from .steps import Records, Step, chain_to, digest, read_record, record_file, step_of

PACKAGE = pathlib.Path(__file__).resolve().parent
OPTIONS = pathlib.Path("steps") / "options.json"  # below the folder of the output files
PLAN = pathlib.Path("steps") / "plan.json"
WHOLE = "whole"  # in the place of a part, for all images
MOST_CPUS = 16  # of a job

PAIR_CPU_SECONDS = 0.9  # of COLMAP's matcher, for photographs of 6 megapixels
SECONDS_TO_READ = 0.2  # an image and its depth map
TILED = ("densify", "mesh")


def code_of(out):
    """The last part of the names that Slurm's jobs of a run in the folder `out` have."""
    return hashlib.sha256(str(out).encode()).hexdigest()[:8]


def records_of_parts(name, out):
    """The records of all jobs that made parts of the step `name`."""
    return [path for pattern in KINDS[name].parts for path in sorted(out.glob(record_file(pattern)))]


def parts_of(name, todo, out):
    """The records of the jobs that made parts of the step `name` of `todo` with its chain, by their names."""
    found = {path: read_record(path) for path in records_of_parts(name, out)}
    chain = digest(chain_to(name, todo)) if found else ""
    return {step_of(path)[0]: record for path, record in found.items()
            if record.get("chain") == chain}


def seconds_of(step, todo, out):
    """The time of a step that is done, with that of its jobs, one after another."""
    records = (Records(out).read(step), *parts_of(step.name, todo, out).values())
    return round(sum(one.get("seconds", 0) for one in records), 1)


def read_plan(out):
    """The plan of DensifyPointCloud; empty if there is none or if it is damaged."""
    plan = files.read_object(out / PLAN)
    is_work = lambda work: (isinstance(work, dict)
                            and all(is_number(work.get(key)) for key in ("memory_mb", "cpu_seconds")))
    stages, works = plan.get("stages"), plan.get("per_part")
    is_whole = (isinstance(stages, list) and stages and isinstance(works, dict)
                and all(isinstance(stage, str) and is_work(works.get(stage)) for stage in stages)
                and is_work(plan.get("fusion")) and is_number(plan.get("threads"))
                and plan["threads"] > 0 and isinstance(plan.get("parts"), int) and plan["parts"] > 0)
    return plan if is_whole else {}


def is_number(value):
    return isinstance(value, (int, float)) and math.isfinite(value)


class Job:
    """What a rule says about its jobs. `name`: with the names of wildcards in braces. `needs`: the
    records of other jobs. `node`: the largest machine, whose processors and memory no job exceeds.
    `asked`: a function of the wildcards that returns megabytes and minutes; every further attempt
    asks for twice as much."""

    def __init__(self, out, name, node, needs, asked):
        self.needs = needs
        self.threads = min(MOST_CPUS, node["cpus"])
        # A run that was killed may have left jobs in the queue. The dependency "singleton" lets a job
        # wait for the end of jobs of the same name.
        run = code_of(out)

        def command(wildcards):
            words = ["env", f"PYTHONPATH={PACKAGE.parent}", sys.executable, "-B", "-m",
                     "axial_pipeline.one_step", out / OPTIONS, name.format(**wildcards)]
            return shlex.join(map(str, words))

        def memory(wildcards, attempt):
            return min(math.ceil(asked(wildcards)[0] * 2 ** (attempt - 1)), node["memory_mb"])

        def minutes(wildcards, attempt):
            return math.ceil(asked(wildcards)[1] * 2 ** (attempt - 1))

        def slurm_extra(wildcards):
            return f"--job-name {name.format(**wildcards)}-{run} --dependency singleton"

        self.command = command
        self.resources = {"mem_mb": memory, "runtime": minutes, "slurm_extra": slurm_extra}


class Survey:
    """All jobs of a run. `config`: what cluster.py wrote to OPTIONS. `steps`: reconstruct_steps.steps."""

    def __init__(self, config, steps):
        given = argparse.Namespace(**config["given"])
        given.cameras = cameras.from_json(given.cameras)
        self.out = pathlib.Path(given.output)
        self.steps = list(steps(given, self.out))
        self.names = [step.name for step in self.steps]
        self.images, self.node = config["images"], config["node"]
        self.matcher, self.tiles = given.matcher, given.tiles
        # The steps of which jobs make the tiles.
        self.tiled = [name for name in TILED if name in self.names] if given.tiles > 1 else []

    def job(self, name):
        number = self.names.index(name)
        before = [record_file(self.names[number - 1])] if number else []
        return Job(self.out, name, self.node, before, lambda wildcards: self.asked(name))

    @property
    def plan(self):
        return Job(self.out, "plan", self.node, [record_file("import")],
                   lambda wildcards: self.asked("plan"))

    @property
    def depth(self):
        return Job(self.out, "depth-{stage}-{part}", self.node, [],
                   lambda wildcards: self.asked_for_depth(wildcards.stage, wildcards.part))

    def tile(self, name):
        return Job(self.out, name + "-tile-{part}", self.node, [],
                   lambda wildcards: self.asked(name, 1 if name == "densify" else min(1, 2 / self.tiles)))

    def tiles_of(self, name):
        """The records of the tiles of the step `name`."""
        if name not in self.tiled:
            return []
        return [record_file(f"{name}-tile-{tile}of{self.tiles}") for tile in range(1, self.tiles + 1)]

    def before_tile_of_mesh(self, part):
        """The first tile of the mesh divides the cloud for the others."""
        first = self.tiles_of("mesh")[0]
        return [record_file("densify") if first == record_file(f"mesh-tile-{part}") else first]

    def asked(self, name, share=1):
        """Megabytes and minutes to ask for. `share`: the part of the images of which a job makes a tile, which has a
        margin: a tile is counted as twice its share."""
        if name in ("densify", "restored-cloud") and (self.out / PLAN).exists():
            return self.with_margin(self.planned()["fusion"])
        memory, memory_of_image, minutes, minutes_of_image = NEEDS_OF_PLAN if name == "plan" else KINDS[name].needs
        images, more_minutes = share * self.images, minutes_of_image * share * self.images
        if name == "matches" and self.matcher == "exhaustive":
            pairs = self.images * (self.images - 1) / 2
            # Twice, because processors differ in speed.
            more_minutes = 2 * PAIR_CPU_SECONDS * pairs / min(MOST_CPUS, self.node["cpus"]) / 60
        return memory + memory_of_image * images, minutes + more_minutes

    def planned(self):
        plan = read_plan(self.out)
        if not plan:
            raise Failure(f"{self.out / PLAN}: is damaged; the same command makes it again")
        return plan

    def asked_for_depth(self, stage, part):
        memory, minutes = self.with_margin(self.planned()["per_part"][stage])
        if part == WHOLE:
            minutes += SECONDS_TO_READ * self.images / 60
        return memory, minutes

    def with_margin(self, work):
        """Megabytes and minutes to ask for. Processors differ in speed, and a job that is stopped at
        its limit begins anew."""
        minutes = work["cpu_seconds"] / self.planned()["threads"] / 60
        return 1.2 * work["memory_mb"] + 200, 10 + 4 * minutes

    def parts(self, stage):
        count = self.planned()["parts"]
        return [f"depth-{stage}-{part}of{count}" for part in range(1, count + 1)]

    def before_maps(self, stage, part):
        """The jobs whose maps a job of the stage needs. After the first stage, a job without a part
        checks whether the maps agree. Pass None for what comes after the last stage."""
        stages = self.planned()["stages"]
        number = stages.index(stage) if stage else len(stages)
        if part == WHOLE:
            return self.parts(stage)
        if number == 0:
            return ["plan"]
        return [f"depth-{stages[0]}-{WHOLE}"] if number == 1 else self.parts(stages[number - 1])

    def step(self, name):
        """The step of this name, and its chain. The steps of the depth maps have the chain of the
        step "densify", and tiles have the chain of their step."""
        if name in self.names:
            return self.steps[self.names.index(name)], chain_to(name, self.steps)
        tile = re.fullmatch(r"(\w+)-tile-(\d+of\d+)", name)
        if tile:
            whole, chain = self.step(tile[1])
            command = [*without_export(whole.command), "--tile", tile[2].replace("of", "/")]
            return Step(name, command, makes=self.out, reads=whole.reads), chain
        densify = self.steps[self.names.index("densify")]
        more = ["--plan", self.out / PLAN] if name == "plan" else part_options(name)
        return (Step(name, [*without_export(densify.command), *more], makes=self.out, reads=densify.reads),
                chain_to("densify", self.steps))


def without_export(command):
    """The words of `command` without --pinhole-export: this option needs the cloud, which only the step "densify"
    makes."""
    return without_options(command, ["--pinhole-export"])


def part_options(name):
    stage, part = re.fullmatch(r"depth-(\w+)-(\w+)", name).groups()
    return ["--until", stage, *([] if part == WHOLE else ["--part", part.replace("of", "/")])]
