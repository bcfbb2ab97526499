# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the steps of `reconstruct` as a workflow of Snakemake, on a cluster with Slurm or on this
machine."""

import getpass
import json
import os
import shlex
import shutil
import signal
import subprocess

from . import cameras, files, jobs
from .failure import Failure
from .running import answer_of, die_with, ending
from .step_kinds import ORDER
from .steps import Records, is_done, names_from, record_file, step_of, with_chains


def check(given):
    """Checks what can be known before the workflow starts."""
    needed = {"local": ["snakemake"], "slurm": ["snakemake", "sbatch"]}[given.cluster]
    for program in needed:
        if not shutil.which(program):
            raise Failure(f"--cluster {given.cluster}: {program} is not installed (docs/cluster.md)")
    if given.cluster == "slurm" and shlex.quote(given.output) != given.output:
        raise Failure(f"--output {given.output}: with --cluster slurm, a path has only letters, "
                      "digits and /._-+@%:,=")


def forget_what_changed(todo, out):
    """Removes the records of the first step that is not done and of all later steps, and of depth
    maps and tiles that another command made."""
    records = Records(out)
    for number, (step, chain) in enumerate(with_chains(todo)):
        if not is_done(step, chain, records):
            records.forget(names_from(number, todo, ORDER))
            break
    for step in todo:
        valid = jobs.parts_of(step.name, todo, out)
        for record in jobs.records_of_parts(step.name, out):
            if step_of(record)[0] not in valid:
                files.clear(record)
    # The step "mesh" removes the files of its tiles.
    if not (out / record_file("mesh")).exists() and not any(out.glob("scene_dense_mesh.tiles*")):
        for record in out.glob(record_file("mesh-tile-*")):
            files.clear(record)


def forget_damaged_plan(out):
    """Lets the job "plan" run again if its result is damaged or missing."""
    plan, record = out / jobs.PLAN, out / record_file("plan")
    if jobs.read_plan(out) or not (plan.exists() or record.exists()):
        return
    print(f"{plan}: is damaged or missing, and is made again", flush=True)
    files.clear(plan)
    files.clear(record)


def largest_node(given):
    """Processors and memory [MB] of this machine, or of the node of Slurm with the most memory among
    those that have as many processors as a job can use."""
    if given.cluster == "local":
        memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") >> 20
        return {"cpus": len(os.sched_getaffinity(0)), "memory_mb": memory}
    listed = answer_of(["sinfo", "--noheader", "--format", "%c %m"])
    # A group of different nodes is shown with the smallest number and a plus sign.
    nodes = [[int(word.rstrip("+")) for word in line.split()] for line in listed.stdout.splitlines()]
    if listed.returncode != 0 or not nodes:
        raise Failure(f"--cluster slurm: sinfo shows no nodes: {listed.stderr.strip()}")
    enough = min(jobs.MOST_CPUS, max(cpus for cpus, _ in nodes))
    memory, cpus = max((memory, cpus) for cpus, memory in nodes if cpus >= enough)
    return {"cpus": cpus, "memory_mb": memory}


def command(given, out, node):
    here = jobs.PACKAGE.parent
    # Jobs on this machine share its memory.
    local = ["--resources", f"mem_mb={node['memory_mb']}"] if given.cluster == "local" else []
    return ["snakemake", "--snakefile", here / "Snakefile", "--profile",
            here / "profiles" / given.cluster, "--configfile", out / jobs.OPTIONS, *local,
            *shlex.split(given.snakemake)]


def cancel_jobs(out):
    """Cancels the jobs of Slurm of a run in the folder `out`. While snakemake asks for the states of
    its jobs, an interruption lets it end without cancelling them."""
    listed = answer_of(["squeue", "--noheader", "--user", getpass.getuser(), "--format", "%A %j"])
    jobs_left = [line.split(maxsplit=1) for line in listed.stdout.splitlines()]
    numbers = [number for number, name in jobs_left if name.endswith(f"-{jobs.code_of(out)}")]
    if numbers:
        subprocess.run(["scancel", *numbers])
    if listed.returncode != 0:
        print(f"squeue: {listed.stderr.strip()}: jobs may be left in the queue", flush=True)


def run_to_its_end(words, given, out, lock):
    """Runs snakemake in the folder `out`. It inherits the file `lock`. If something kills this
    process, the kernel interrupts snakemake, which cancels its jobs on a cluster. For jobs on this
    machine, it kills snakemake, and the jobs end with it."""
    parent, by = os.getpid(), signal.SIGINT if given.cluster == "slurm" else signal.SIGKILL
    process = subprocess.Popen(
        [str(word) for word in words], cwd=out, stdin=subprocess.DEVNULL, pass_fds=[lock.fileno()],
        env={"USER": getpass.getuser(), **os.environ},  # snakemake needs USER
        preexec_fn=lambda: die_with(parent, by))
    try:
        code = process.wait()
    except KeyboardInterrupt:  # snakemake has got the signal, too
        try:
            process.wait()
        finally:
            if given.cluster == "slurm":
                cancel_jobs(out)
        raise
    if code != 0:
        raise Failure(f"snakemake: {ending(code)}; the outputs of the steps are in {out / 'logs'}; "
                      "the same command continues from here")


def run_all(todo, given, out, lock):
    """Runs the steps that are not done, like steps.run_all(). `lock`: the open file that refuses other
    runs in the folder `out`. The times of the steps "densify" and "mesh" include the jobs of the
    depth maps and of the tiles, one after another."""
    node = largest_node(given)
    (out / "steps").mkdir(exist_ok=True)
    forget_what_changed(todo, out)
    forget_damaged_plan(out)
    plain = {**vars(given), "cameras": cameras.as_json(given.cameras)}
    config = {"given": plain, "folder": os.getcwd(), "images": files.count(given.images),
              "node": node}
    files.write(out / jobs.OPTIONS, json.dumps(config))
    run_to_its_end(command(given, out, node), given, out, lock)
    return {step.name: jobs.seconds_of(step, todo, out) for step in todo}
