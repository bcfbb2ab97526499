// SPDX-License-Identifier: GPL-3.0-or-later
// Prints the number of points of a cloud.
#include <cstdio>

#include "axial/io.h"

int main(int, char** argv) {
  std::printf("%zu\n", axial::io::read_cloud_ply(argv[1]).size());
}
