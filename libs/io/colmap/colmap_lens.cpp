// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/colmap_lens.h"

#include <string_view>
#include <vector>

#include "base/error.h"

namespace axial::io {
namespace {

// COLMAP-Underwater's own model, which COLMAP cannot undistort.
constexpr std::string_view kNotColmaps = "METASHAPE_FISHEYE";

}  // namespace

lens::Lens lens_of(const ColmapCamera& camera) {
  const lens::Model* const model = lens::find_model(camera.model);
  if (!model)
    fail("camera {}: model {} is not supported; undistort its images with {} first", camera.id,
         camera.model, camera.model == kNotColmaps ? "the program that calibrated it" : "COLMAP");
  const std::vector<double>& p = camera.params;
  if (static_cast<int>(p.size()) != colmap_parameter_count(camera.model))
    fail("camera {}: model {} has {} parameters, not {}", camera.id, camera.model,
         colmap_parameter_count(camera.model), p.size());
  const auto n = static_cast<std::size_t>(colmap_focal_count(camera.model));
  return {model,
          {p[0], p[n - 1], p[n] - 0.5, p[n + 1] - 0.5},
          {p.begin() + static_cast<std::ptrdiff_t>(n + 2), p.end()},
          static_cast<int>(camera.width),
          static_cast<int>(camera.height)};
}

refractive::PinholeLens<double> pinhole_inside(const ColmapCamera& camera,
                                               const std::string& name) {
  const auto pinhole = lens::pinhole_inside(lens_of(camera));
  if (!pinhole)
    fail(
        "{}: camera {} ({}) cannot be undistorted: its image covers less than a quarter of a "
        "pinhole image",
        name, camera.id, camera.model);
  return *pinhole;
}

}  // namespace axial::io
