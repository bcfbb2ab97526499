// SPDX-License-Identifier: GPL-3.0-or-later
// Makes depth maps and a cloud of a scene: densify_scene SCENE.mvs FOLDER. Prints the number of
// points.
#include <cstdio>
#include <exception>
#include <filesystem>

#include "densify/densify.h"

int main(int, char** argv) try {
  axial::densify::Options options;
  options.survey.files.scene = std::filesystem::absolute(argv[1]);
  options.survey.files.working_folder = std::filesystem::absolute(argv[2]);
  options.output.scene = options.survey.files.working_folder / "dense.mvs";
  const axial::densify::Report report = axial::densify::densify(options);
  std::printf("%zu points in %s\n", report.points, report.cloud.c_str());
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
