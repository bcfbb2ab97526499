# SPDX-License-Identifier: GPL-3.0-or-later
"""What `reconstruct --cluster` asks Slurm for, with stand-ins for Slurm's commands."""

import argparse
import os
import unittest.mock

from pipeline_folder import InFolder
from programs import main

from axial_pipeline import cluster, jobs


class SlurmCommands(InFolder):
    def setUp(self):
        super().setUp()
        path = unittest.mock.patch.dict(os.environ, PATH=f"{self.folder}:{os.environ['PATH']}")
        path.start()
        self.addCleanup(path.stop)

    def test_jobs_of_this_run_are_cancelled(self):
        mine, other = jobs.code_of("/out"), jobs.code_of("/other")
        self.put_script("squeue", f"echo 3 depth-photometric-1of2-{mine}; echo 4 mesh-{other}; "
                        f"echo 5 a name; echo 16 plan-{mine}")
        self.put_script("scancel", f"echo $* >> {self.folder / 'cancelled'}")
        cluster.cancel_jobs("/out")
        self.assertEqual((self.folder / "cancelled").read_text(), "3 16\n")
        self.put_script("squeue", f"echo 4 mesh-{other}")
        cluster.cancel_jobs("/out")
        self.assertEqual((self.folder / "cancelled").read_text(), "3 16\n")
        self.put_script("squeue", "echo no controller >&2; exit 1")
        self.assertIn("squeue: no controller: ", self.said_by(cluster.cancel_jobs, "/out"))

    def test_the_largest_node_is_one_node(self):
        given = argparse.Namespace(cluster="slurm")
        for listed, cpus, memory in (("128 256000+\n8 2000000", 128, 256000),
                                     ("16 64000\n64 32000+", 16, 64000),
                                     ("4 16000\n8+ 8000", 8, 8000)):
            self.put_script("sinfo", f"echo '{listed}'")
            self.assertEqual(cluster.largest_node(given), {"cpus": cpus, "memory_mb": memory})


if __name__ == "__main__":
    main()
