# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs one step of a run of `reconstruct`: what a job of the workflow does."""

import argparse
import json
import os
import pathlib

from . import reconstruct_steps
from .failure import run_main
from .jobs import Survey
from .option_files import has_option
from .running import die_with
from .step_kinds import KINDS
from .steps import Records, is_done, perform

WITH_LIMITS = [kind.program for kind in KINDS.values() if kind.has_limits]


def limits_of(command, cpus, memory):
    """Options that keep a command within its job: `memory` [MB], with some of it left to this
    process. None of them changes the result. Options that the user gave are kept."""
    if pathlib.Path(command[0]).name not in WITH_LIMITS:
        return []
    options = {"--max-threads": cpus, "--max-memory": int(0.9 * memory) - 100}
    return [word for option, value in options.items()
            if not has_option(command, option)
            for word in (option, str(value))]


def run(options):
    config = json.loads(pathlib.Path(options.config).read_text())
    os.chdir(config["folder"])
    survey = Survey(config, reconstruct_steps.steps)
    step, chain = survey.step(options.name)
    records = Records(survey.out)
    if not is_done(step, chain, records):
        perform(step, chain, records, survey.out / "logs",
                limits_of(step.command, options.cpus, options.memory))


def main():
    die_with(os.getppid())  # when a run is killed, no step goes on
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("config", help="the options of the run (jobs.OPTIONS)")
    parser.add_argument("name", help="name of the step")
    parser.add_argument("--cpus", type=int, required=True, help="processors of the job")
    parser.add_argument("--memory", type=int, required=True, help="memory of the job [MB]")
    options = parser.parse_args()
    run_main(f"reconstruct: {options.name}", lambda: run(options), "stopped")


if __name__ == "__main__":
    main()
