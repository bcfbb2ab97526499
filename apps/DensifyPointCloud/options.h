// SPDX-License-Identifier: GPL-3.0-or-later
// DensifyPointCloud's options: OpenMVS's, of the same names and defaults but for --iters (2, there
// 3), --postprocess-dmaps (3, there 7) and --tower-mode (0, there 4), and the refractive ones.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/program.h"
#include "cloud/fuse.h"
#include "depth/options.h"
#include "scene/camera_list.h"
#include "scene/region.h"
#include "scene/resolution.h"
#include "scene/view_selection.h"

namespace densify {

enum class CameraChoice { automatic, pinhole, flat_port };

// Bits of --postprocess-dmaps.
inline constexpr unsigned kSpeckles = 1, kGaps = 2, kAdjust = 4;

struct Options {
  axial::ParsedOptions parsed;
  std::filesystem::path input, output;  // scene files
  std::filesystem::path housing;        // empty: beside the scene
  std::filesystem::path mask_folder;
  int ignore_mask_label = -1;  // below 0: no masks

  CameraChoice camera = CameraChoice::automatic;
  bool refractive = false;  // demand a housing
  axial::ProjectionMethod projection = axial::ProjectionMethod::exact;

  axial::ResolutionOptions resolution;
  axial::ViewSelectionOptions selection;
  axial::depth::PatchMatchOptions matching;
  unsigned number_views = 5;
  int geometric_iterations = 2;
  unsigned postprocess = kSpeckles | kGaps;

  axial::cloud::FuseOptions fusion;
  bool fuse = true;  // --fusion-mode 0
  unsigned estimate_colors = 2;
  unsigned estimate_normals = 2;
  axial::RegionMode region = axial::RegionMode::adaptive;
  double roi_border = 0;
  bool crop_to_roi = true;
  bool remove_dmaps = false;
  bool double_precision = false;  // of the cloud, which is then in world coordinates
  std::uint64_t max_memory = 0;   // [MB of 10^6 bytes]; 0: 70 % of what is free
};

// Whether the cloud takes colours from the images.
inline bool needs_colors(const Options& options) {
  return options.fuse && options.estimate_colors > 0;
}

// Error for an unknown option, a value out of range, or an OpenMVS option that is not built yet and
// has another than its default or "off" value.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace densify
