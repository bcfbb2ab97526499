#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the Debian 12 packages that the build, the tests and the demo need. With --build, only those to build the
# programs and their packages. Does nothing and prints nothing if all of them are installed.
set -euo pipefail

packages=(
  # to build
  clang g++ lld cmake ninja-build git help2man python3
  libeigen3-dev libopencv-dev libjpeg-dev libpng-dev libtiff-dev libtbb-dev libfmt-dev libspdlog-dev nlohmann-json3-dev
  libnanoflann-dev libembree-dev libcgal-dev libmaxflow-dev libxxhash-dev libboost-dev libboost-program-options-dev
  libstb-dev libtinygltf-dev libceres-dev libsuitesparse-dev libgdal-dev libpugixml-dev libsqlite3-dev
  libyaml-cpp-dev
  # to build the page of ViewScene without npm
  esbuild libjs-three
  # for the Debian packages and the archive (packaging)
  dpkg-dev file patchelf
)
# without --build
others=(
  # to test
  clang-format doxygen libgtest-dev libgmock-dev librapidcheck-dev
  libclang-rt-dev
  # for the Python package (AXIAL_PYTHON)
  pybind11-dev python3-dev python3-numpy
  # for the laboratory (AXIAL_SCIENCE): benchmarks, and figures of docs/paper
  libbenchmark-dev python3-matplotlib
  # to test the page of ViewScene
  chromium nodejs
  # to test the pipeline on a cluster
  slurmctld slurmd slurm-client munge
  # to run the pipeline
  colmap snakemake
)

[[ ${1:-} == --build ]] || packages+=("${others[@]}")

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $EUID -ne 0 ]]; then
  command -v sudo >/dev/null || {
    echo "install-deps.sh: cannot install packages: not root, and sudo not found; run as root: apt-get install ${missing[*]}" >&2
    exit 1
  }
  as_root=(sudo)
fi

echo "Installing ${#missing[@]} Debian packages: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
quietly() {
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive "$@" </dev/null >"$log" 2>&1; then
    cat "$log" >&2
    echo "install-deps.sh: failed: $*" >&2
    exit 1
  fi
}
quietly apt-get update -qq
quietly apt-get install -y -qq --no-install-recommends "${missing[@]}"
