#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Run by conda-build in the folder of the unpacked archive.
set -euo pipefail
for folder in bin lib share; do
  mkdir -p "$PREFIX/$folder"
  cp -a "$folder/." "$PREFIX/$folder/"
done
