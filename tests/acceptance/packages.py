# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on the archive, the Debian packages and the image of containers, in a system of Debian that has none of the
libraries that the programs need. They need root, the network, debootstrap and lintian."""

import os
import re
import shutil
import subprocess
import sys

from points import BASE, point
from support.runs import BIN, ROOT, Skipped, measured

sys.path.insert(0, str(ROOT / "packaging"))
import archive  # noqa: E402

BUILD = BIN.parent
MIRROR = "http://deb.debian.org/debian"
EPSG = 32633  # UTM zone 33N


def need(program):
    if os.geteuid() != 0:
        raise Skipped("needs root")
    if not shutil.which(program):
        raise Skipped(f"{program} is not installed")


class System:
    """A copy of a minimal Debian with python3, in which commands run as in a system of its own."""

    def __init__(self, folder):
        need("debootstrap")
        fresh = BASE / "debian"
        if not fresh.exists():
            partial = BASE / "debian.part"
            shutil.rmtree(partial, ignore_errors=True)
            measured(BASE / "debootstrap.log", "debootstrap", "--variant=minbase", "--include=python3", "bookworm",
                     partial, MIRROR)
            partial.rename(fresh)
        self.root = folder / "root"
        self.log = folder / "system.log"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        subprocess.run(["cp", "-a", fresh, self.root], check=True)
        # dpkg need not wait for the disk.
        (self.root / "etc/dpkg/dpkg.cfg.d/fast").write_text("force-unsafe-io\n")

    def run(self, *command):
        """Runs a command in the system, without the variables of this one. Returns what it printed. RuntimeError if it
        fails."""
        inside = ["unshare", "--mount", "--pid", "--fork", f"--mount-proc={self.root}/proc", "chroot", self.root, "env",
                  "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "HOME=/root", "DEBIAN_FRONTEND=noninteractive",
                  "QT_QPA_PLATFORM=offscreen", *command]
        result = subprocess.run([str(word) for word in inside], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                text=True, stdin=subprocess.DEVNULL)
        with open(self.log, "a") as log:
            log.write(f"$ {' '.join(map(str, command))}\n{result.stdout}")
        if result.returncode != 0:
            raise RuntimeError(f"{' '.join(map(str, command[:3]))} failed, see {self.log}")
        return result.stdout

    def size(self):
        """The size of the files of the system [MB]."""
        used = subprocess.run(["du", "-sm", self.root], check=True, capture_output=True, text=True)
        return int(used.stdout.split()[0])


def packed(folder):
    """The archive, made twice. RuntimeError if its bytes differ."""
    contents = []
    for name in "once", "again":
        measured(folder / f"archive-{name}.log", sys.executable, "-B", ROOT / "packaging/archive.py", BUILD, "-o",
                 folder / name)
        file, = (folder / name).iterdir()
        contents.append(file.read_bytes())
    if contents[0] != contents[1]:
        raise RuntimeError("the archive of the same build has other bytes")
    return file


def check_versions(system, programs):
    """Runs each program with --version. Returns their number."""
    version = archive.version_of(BUILD)
    names = sorted(path.name for path in archive.programs_of(BUILD) if re.match(r"[A-Z]", path.name))
    for name in names:
        said = system.run(f"{programs}/{name}", "--version")
        if not said.startswith(f"{name} {version},"):
            raise RuntimeError(f"{name} --version: {said}")
    return len(names)


def check_dive(system, programs):
    """A simulated dive, from photographs to a map with a coordinate system and a page."""
    def run(program, *options):
        return system.run(f"{programs}/{program}", "-w", "/dive", *options)

    system.run("mkdir", "/dive")
    run("SimulateUnderwater", "--preset", "closeup", "--views", 4, "--width", 240, "--height", 180, "--coarseness", 4,
        "--medium", "water", "-o", "simulated")
    run("InterfaceCOLMAP", "-i", "simulated/sparse", "--image-folder", "simulated/water", "--housing",
        "simulated/housing.json", "-o", "scene.mvs")
    run("DensifyPointCloud", "-i", "scene.mvs", "--refractive", "-o", "dense.mvs")
    run("ReconstructMesh", "-i", "dense.mvs", "--refractive", "-o", "mesh.ply")
    mesh = ("-i", "dense.mvs", "-m", "mesh.ply")
    run("TextureMesh", *mesh, "--refractive", "-o", "textured.glb", "--export-type", "glb")
    run("MapSurface", *mesh, "--refractive", "--up", "0,0,1", "--epsg", EPSG, "-o", "map")
    run("ViewScene", *mesh, "--report", "page")
    results = [system.root / "dive" / name for name in ("textured.glb", "map.ortho.tif", "page/index.html")]
    missing = [str(path) for path in results if not path.is_file()]
    if missing:
        raise RuntimeError(f"{missing[0]} is missing")
    if b"UTM zone 33N" not in results[1].read_bytes():
        raise RuntimeError("the orthomosaic does not state its coordinate system")


def reconstructed(system, program):
    """axial-reconstruct on the simulated dive, up to the cloud."""
    system.run(program, "--images", "/dive/simulated/water", "--lens", "/dive/simulated/sparse/cameras.txt",
               "--housing", "/dive/simulated/housing.json", "-o", "/dive/out", "--until", "cloud")
    if not (system.root / "dive/out/scene_dense.ply").is_file():
        raise RuntimeError("axial-reconstruct wrote no cloud")


@point("the archive on a Debian that has only python3: same bytes twice, every program starts, a dive from photographs "
       f"to a mesh, a map with --epsg {EPSG} and a page; with COLMAP axial-reconstruct makes a cloud")
def archive_elsewhere(work):
    folder = work / "archive"
    system = System(folder)
    file = packed(folder)
    subprocess.run(["tar", "-xf", file, "-C", system.root / "opt"], check=True)
    programs = f"/opt/{file.name.removesuffix('.tar.xz')}/bin"
    count = check_versions(system, programs)
    check_dive(system, programs)
    system.run("apt-get", "update")
    system.run("apt-get", "install", "-y", "--no-install-recommends", "colmap")
    reconstructed(system, f"{programs}/axial-reconstruct")
    return f"{count} programs, {file.stat().st_size / 1e6:.0f} MB", True


@point("lintian finds no errors and no warnings in the Debian packages; on a Debian without libraries, the commands "
       "of packaging/Dockerfile install them, and axial-reconstruct makes a cloud")
def debian_packages(work):
    folder = work / "debian-packages"
    system = System(folder)
    need("lintian")
    measured(folder / "cpack.log", "cpack", "-G", "DEB", "--config", BUILD / "CPackConfig.cmake", "-B",
             system.root / "packages")
    packages = sorted((system.root / "packages").glob("*.deb"))
    found = subprocess.run(["lintian", "--allow-root", "--fail-on", "error,warning", *packages], text=True,
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if found.returncode != 0:
        return found.stdout or f"lintian ends with {found.returncode}", False
    before = system.size()
    last = (ROOT / "packaging/Dockerfile").read_text().replace("\\\n", " ").split("\nFROM ")[-1]
    for command in re.findall(r"^RUN (?:--\S+ )*(.*)", last, re.M):
        system.run("sh", "-c", command)
    image = system.size() - before
    check_versions(system, "/usr/bin")
    check_dive(system, "/usr/bin")
    reconstructed(system, "/usr/bin/axial-reconstruct")
    sizes = ", ".join(f"{path.name} {path.stat().st_size / 1e6:.0f} MB" for path in packages)
    return f"{sizes}; {image} MB with all that they need", True
