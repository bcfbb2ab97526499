#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes an archive of the programs with all libraries and data that they need: axialmvs-VERSION-linux-x86_64.tar.xz.
It runs from any folder of any Linux system whose glibc is at least as new as that of the system that makes it. It needs
Debian with patchelf. The same build gives the same bytes.

    python3 packaging/archive.py BUILD_FOLDER [-o FOLDER]
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# The libraries of glibc, and the loader. They stay those of the system, because they belong to its kernel, its names of
# users and hosts, and its loader.
GLIBC = re.compile(r"ld-linux|(libc|libm|libmvec|libdl|libpthread|librt|libresolv|libutil|libanl|libnsl|"
                   r"libnss_\w+|libBrokenLocale|libthread_db|libc_malloc_debug)\.so")
# The library that the programs load when they first need it (libs/io/images/opencv_codecs.cpp).
LOADED_LATER = re.compile(rb"\0(libopencv_imgcodecs\.so\.\d+)\0")
LIBRARIES = "lib/axialmvs"
NOTICES = "share/doc/axialmvs/libraries"
DATA = {"gdal": pathlib.Path("/usr/share/gdal"), "proj": pathlib.Path("/usr/share/proj")}
EPOCH = "315532800"  # 1980: the time of all files, unless SOURCE_DATE_EPOCH states another


def output_of(*command):
    """Standard output of a command. Ends this script with the command's words if the command fails."""
    try:
        result = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    except FileNotFoundError:
        sys.exit(f"archive.py: {command[0]}: is not installed")
    if result.returncode != 0:
        sys.exit(f"archive.py: {command[0]} failed: {(result.stderr or result.stdout).strip()}")
    return result.stdout


def is_elf(file):
    with open(file, "rb") as opened:
        return opened.read(4) == b"\x7fELF"


def programs_of(prefix):
    return sorted(file for file in (prefix / "bin").iterdir() if is_elf(file))


def loaded_by(program):
    """The libraries that the loader of this system gives the program, without glibc: {name: path}. Libraries that the
    program loads later are among them: LD_PRELOAD makes the loader find them, too."""
    later = sorted({name.decode() for name in LOADED_LATER.findall(program.read_bytes())})
    preload = f"LD_PRELOAD={' '.join(later)}"
    libraries = {}
    for line in output_of("env", "-u", "LD_LIBRARY_PATH", preload, "ldd", program).splitlines():
        name, arrow, path = line.strip().partition(" => ")
        if not arrow or GLIBC.match(pathlib.Path(name).name):
            continue
        if path.startswith("not found"):
            sys.exit(f"archive.py: {program}: {name} is not installed")
        libraries[name] = pathlib.Path(path.rsplit(" (", 1)[0])
    return libraries


def add_libraries(prefix):
    """Copies all libraries into the tree, and makes the programs find them there. Returns their files in the system."""
    programs, libraries = programs_of(prefix), {}
    for program in programs:
        libraries |= loaded_by(program)
    folder = prefix / LIBRARIES
    folder.mkdir(parents=True)
    for name, path in sorted(libraries.items()):
        shutil.copyfile(path, folder / name)
    # RPATH of a program also serves the libraries of its libraries, and comes before LD_LIBRARY_PATH of the user. A
    # library with a RUNPATH of its own does not use it, and the user's folders come before a RUNPATH.
    for file in re.findall(r"^File: (.*)\n(?:(?!File: ).*\n)*?.*\(RUNPATH\)",
                           output_of("readelf", "-d", *folder.iterdir()), re.M):
        output_of("patchelf", "--force-rpath", "--set-rpath", "$ORIGIN", file)
    for program in programs:
        output_of("patchelf", "--force-rpath", "--set-rpath", f"$ORIGIN/../{LIBRARIES}", program)
    return [path.resolve() for path in libraries.values()]


def loaded_from_outside(prefix):
    """The libraries besides glibc that programs of the tree would take from elsewhere, as sorted pairs of program and
    path."""
    inside = (prefix / LIBRARIES).resolve()
    return sorted((program.name, str(path)) for program in programs_of(prefix)
                  for path in loaded_by(program).values() if path.resolve().parent != inside)


def newest_glibc(prefix):
    """The newest version of glibc whose functions a file of the tree needs, such as (2, 36)."""
    files = [*programs_of(prefix), *(prefix / LIBRARIES).iterdir()]
    versions = re.findall(r"Name: GLIBC_(\d+)\.(\d+)", output_of("readelf", "-V", *files))
    return max((int(major), int(minor)) for major, minor in versions)


def add_data(prefix):
    """Copies the data of GDAL and PROJ to where the programs look for them (libs/base/program/bundled_data.h). Returns the
    folders in the system."""
    for name, folder in DATA.items():
        if not folder.is_dir():
            sys.exit(f"archive.py: {folder}: is no folder; the archive is made on Debian")
        shutil.copytree(folder, prefix / "share/axialmvs" / name)
    return list(DATA.values())


def add_notices(prefix, files):
    """Copies the licenses of the Debian packages that own the files, and writes the list of the packages, by whose
    versions Debian gives the sources."""
    # Debian installed some files in /lib before it became a link to /usr/lib.
    names = {str(file) for file in files} | {str(file).removeprefix("/usr") for file in files}
    found = subprocess.run(["dpkg-query", "--search", *sorted(names)], capture_output=True, text=True,
                           env={**os.environ, "LC_ALL": "C"}).stdout
    owners = {}
    for line in found.splitlines():
        packages, _, path = line.partition(": ")
        if packages.startswith("diversion by"):
            continue
        owners[pathlib.Path(path).resolve()] = packages.split(", ")[0].split(":")[0]
    unowned = sorted(str(file) for file in files if file not in owners)
    if unowned:
        sys.exit(f"archive.py: {unowned[0]}: belongs to no Debian package, so that its license is not known")
    folder = prefix / NOTICES
    folder.mkdir(parents=True)
    packages = sorted(set(owners.values()))
    for package in packages:
        shutil.copyfile(f"/usr/share/doc/{package}/copyright", folder / f"{package}.copyright")
    rows = output_of("dpkg-query", "--show", "--showformat",
                     "${Package} ${Version}, source ${source:Package} ${source:Version}\n", *packages)
    (folder / "packages.txt").write_text(
        "The libraries and data of this archive are from these packages of Debian, whose sources\n"
        "https://snapshot.debian.org keeps:\n\n" + rows, encoding="utf-8")


def complete(prefix):
    """Adds to installed programs all that they need. Ends this script if they would still load a library from
    elsewhere."""
    libraries = add_libraries(prefix)
    add_notices(prefix, libraries + add_data(prefix))
    outside = loaded_from_outside(prefix)
    if outside:
        sys.exit(f"archive.py: {outside[0][0]}: still loads {outside[0][1]}")


def pack(prefix, archive):
    """Writes the tree as tar.xz, without owners, times and the order of the file system. xz divides its work by the
    size of blocks, not by the number of threads."""
    partial = archive.with_name(archive.name + ".part")
    epoch = os.environ.get("SOURCE_DATE_EPOCH", EPOCH)
    tar = ["tar", "--create", "--sort=name", f"--mtime=@{epoch}", "--owner=0", "--group=0", "--numeric-owner",
           "--mode=u=rwX,go=rX", "--format=gnu", "-C", str(prefix.parent), prefix.name]
    try:
        with subprocess.Popen(tar, stdout=subprocess.PIPE) as packed, open(partial, "wb") as out:
            result = subprocess.run(["xz", "-6", "--threads=2", "--block-size=32MiB"], stdin=packed.stdout, stdout=out)
        if packed.returncode != 0 or result.returncode != 0:
            sys.exit(f"archive.py: {archive}: cannot be written")
        partial.rename(archive)
    finally:
        partial.unlink(missing_ok=True)


def version_of(build):
    return re.search(r"^CMAKE_PROJECT_VERSION:STATIC=(.+)$", (build / "CMakeCache.txt").read_text(), re.M)[1]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path, help="folder of the release build")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=".", help="folder of the archive (default: .)")
    options = parser.parse_args()
    if not (options.build / "CMakeCache.txt").is_file():
        sys.exit(f"archive.py: {options.build}: is no build folder of CMake")
    name = f"axialmvs-{version_of(options.build)}-linux-x86_64"
    archive = pathlib.Path(options.output, name + ".tar.xz")
    archive.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="axial-archive-", dir=archive.parent) as work:
        prefix = pathlib.Path(work, name)
        output_of("cmake", "--install", options.build, "--component", "programs", "--strip", "--prefix", prefix)
        complete(prefix)
        pack(prefix, archive)
        newest = newest_glibc(prefix)
    print(f"{archive}: {archive.stat().st_size / 1e6:.0f} MB, needs glibc {newest[0]}.{newest[1]} or newer")


if __name__ == "__main__":
    main()
