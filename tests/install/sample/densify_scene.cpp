// SPDX-License-Identifier: GPL-3.0-or-later
// Makes depth maps and a cloud of a scene, with its progress:
//   densify_scene SCENE.mvs FOLDER [MAPS [TILES]]
// Stops after about MAPS depth maps if MAPS is above 0; a second call goes on. TILES: the number of
// tiles of the cloud.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <stop_token>

#include "axial/densify.h"

namespace {

axial::densify::Options options_of(int argc, char** argv) {
  axial::densify::Options options;
  options.survey.files.scene = std::filesystem::absolute(argv[1]);
  options.survey.files.working_folder = std::filesystem::absolute(argv[2]);
  options.output.scene = options.survey.files.working_folder / "dense.mvs";
  if (argc > 4) options.fusion.tiles = static_cast<std::size_t>(std::atoi(argv[4]));
  return options;
}

// Prints progress and lines, and requests a stop after `maps` depth maps.
axial::EventSink printer(std::size_t maps, std::stop_source& source) {
  return [maps, &source](const axial::Event& event) {
    if (event.kind == axial::Event::Kind::line)
      std::printf("%s\n", event.text.c_str());
    else
      std::printf("%s: %zu of %zu\n", event.text.c_str(), event.done, event.total);
    if (maps > 0 && event.text == "Estimated depth maps" && event.done >= maps)
      source.request_stop();
  };
}

}  // namespace

int main(int argc, char** argv) try {
  std::stop_source source;
  const std::size_t maps = argc > 3 ? static_cast<std::size_t>(std::atoi(argv[3])) : 0;
  const axial::Context context(printer(maps, source), source.get_token());
  const axial::densify::Report report =
      axial::densify::densify(options_of(argc, argv), {}, context);
  std::printf("%zu points in %s\n", report.points, report.cloud.c_str());
} catch (const axial::Stopped&) {
  std::printf("stopped\n");
  return 2;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
