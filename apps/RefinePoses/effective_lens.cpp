// SPDX-License-Identifier: GPL-3.0-or-later
#include "effective_lens.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/atomic_file.h"
#include "base/log.h"
#include "base/naming.h"
#include "base/same_file.h"
#include "io/colmap/colmap_lens.h"
#include "pose/effective_lens.h"
#include "stages.h"

namespace axial::apps {
namespace {

constexpr double kCorner = 0.5;  // COLMAP's pixel centres are at 0.5

std::string line_of(std::uint32_t id, const lens::Lens& lens) {
  const auto& [fx, fy, cx, cy] = lens.pinhole;
  return fmt::format("{} {} {} {} {} {} {} {} {}\n", id, lens.model->name, lens.width, lens.height,
                     fx, fy, cx + kCorner, cy + kCorner, fmt::join(lens.distortion, " "));
}

}  // namespace

void write_effective_lenses(const Options& options, const Context& context) {
  const std::filesystem::path& file = options.effective_lens;
  const std::vector<std::filesystem::path> inputs{options.lens, options.housing};
  require_not_an_input(file, inputs, "--effective-lens");
  const std::vector<io::ColmapCamera> lenses = load_lenses(options, {}, context);
  const io::Housing housing = load_housing(options, {}, lenses, context);
  std::string text =
      "# The lenses in air behind their ports, as single lenses: a start for COLMAP\n"
      "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
  for (const io::ColmapCamera& camera : lenses) {
    const pose::EffectiveLens found = naming(options.lens, [&] {
      return pose::effective_lens(
          {io::lens_of(camera), housing.carried_port(housing.port_of("", camera.id))},
          options.scene_distance);
    });
    log_info(
        "Camera {}: {} with a focal length of {:.4g} px, RMS error {:.2g} px, largest {:.2g} px",
        camera.id, found.lens.model->name, found.lens.pinhole.fx, found.rms, found.largest);
    text += line_of(camera.id, found.lens);
  }
  write_atomically(file, text);
}

}  // namespace axial::apps
