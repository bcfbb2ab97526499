# SPDX-License-Identifier: GPL-3.0-or-later
"""A cluster on this machine for tests: munge, Slurm's controller, and two nodes. Every node is in a
process namespace of its own, so that all of its processes end when the node is killed."""

import ctypes
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
import time

NODES = ("node1", "node2")
ISOLATED = ["unshare", "--pid", "--fork", "--kill-child", "--mount-proc"]
LIBC = ctypes.CDLL(None)
PR_SET_PDEATHSIG = 1  # of <sys/prctl.h>

CONFIGURATION = """
ClusterName=axial
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=2,batch_sched_delay=0,bf_interval=2
MpiDefault=none
SlurmdTimeout=5
NodeName=node1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=2 RealMemory=64000
NodeName=node2 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=2 RealMemory=64000
PartitionName=all Nodes=node1,node2 Default=YES MaxTime=INFINITE State=UP
"""


def reason_to_skip():
    """Why no cluster can be started here; empty if one can."""
    if os.geteuid() != 0:
        return "Slurm's nodes need root"
    missing = [program for program in ("munged", "slurmctld", "slurmd", "sbatch", "snakemake")
               if not shutil.which(program)]
    if missing:
        return f"not installed: {', '.join(missing)}"
    if subprocess.run([*ISOLATED, "true"], capture_output=True).returncode != 0:
        return "process namespaces are not allowed here"
    return ""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class Cluster:
    """Runs from start() to stop(), or to the end of this process."""

    def __init__(self):
        self.keeper = tempfile.TemporaryDirectory(prefix="axial_slurm_", dir="/tmp")
        self.folder = pathlib.Path(self.keeper.name)  # short: it is part of a socket's name
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}
        self.processes = {}

    def run(self, name, *command):
        def die_with_the_test():
            LIBC.prctl(PR_SET_PDEATHSIG, ctypes.c_ulong(signal.SIGKILL))

        with open(self.folder / f"{name}.log", "w") as log:
            self.processes[name] = subprocess.Popen(
                [str(word) for word in command], stdin=subprocess.DEVNULL, stdout=log,
                stderr=subprocess.STDOUT, env=self.environment, preexec_fn=die_with_the_test)

    def ask(self, *command):
        return subprocess.run(command, env=self.environment, capture_output=True, text=True).stdout

    def log(self, name):
        return (self.folder / f"{name}.log").read_text()

    def start(self):
        (self.folder / "state").mkdir()
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=socket.gethostname(), folder=self.folder, ports=free_ports(3)))
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        self.run("munged", "munged", "--foreground", "--force", f"--key-file={key}",
                 *(f"--{kind}={self.folder}/munge.{kind.split('-')[0]}"
                   for kind in ("socket", "pid-file", "seed-file")))
        self.wait_for(lambda: (self.folder / "munge.socket").exists())
        self.run("slurmctld", "slurmctld", "-D")
        for node in NODES:
            self.run(node, *ISOLATED, "slurmd", "-D", "-N", node)
        self.wait_for(lambda: self.ask("sinfo", "-h", "-N", "-o", "%t").split() == ["idle"] * 2)

    def wait_for(self, condition, seconds=60):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                raise RuntimeError("".join(f"{name}:\n{self.log(name)}" for name in self.processes))
            time.sleep(0.05)

    def kill(self, name):
        """Ends a node or a service like a machine without power."""
        process = self.processes.pop(name)
        process.kill()
        process.wait()

    def stop(self):
        for name in reversed(list(self.processes)):
            self.kill(name)
        self.keeper.cleanup()
