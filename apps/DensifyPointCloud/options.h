// SPDX-License-Identifier: GPL-3.0-or-later
// DensifyPointCloud's options: OpenMVS's options with the same names and defaults, except --iters
// (2; OpenMVS: 3), --postprocess-dmaps (3; OpenMVS: 7) and --tower-mode (0; OpenMVS: 4), and the
// options for refraction.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/program.h"
#include "cloud/fuse.h"
#include "depth/filters.h"
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
  std::filesystem::path input, output;                            // scene files
  std::filesystem::path housing;                                  // empty: beside the scene
  std::filesystem::path point_cloud;                              // empty: the scene's own points
  std::filesystem::path neighbour_lists, neighbour_lists_output;  // empty: none
  std::filesystem::path dense_config;                             // empty: none
  std::filesystem::path mask_folder;
  std::filesystem::path report;  // JSON; empty: none
  int ignore_mask_label = -1;    // below 0: no masks
  int bit_depth = 0;             // of 16-bit images; 0: detected

  CameraChoice camera = CameraChoice::automatic;
  bool refractive = false;     // a housing is required
  bool allow_missing = false;  // go on if the housing gives no image a port
  axial::ProjectionMethod projection = axial::ProjectionMethod::exact;

  axial::ResolutionOptions resolution;
  axial::ViewSelectionOptions selection;
  axial::depth::PatchMatchOptions matching;
  axial::depth::SpeckleOptions speckles;
  axial::depth::GapOptions gaps;
  std::string map_settings;  // settings of --dense-config-file that change depth maps, as text
  unsigned number_views = 0;
  int geometric_iterations = 2;
  unsigned postprocess = kSpeckles | kGaps;

  axial::cloud::FuseOptions fusion;
  bool make_maps = true;  // --fusion-mode 0 and 1; otherwise existing maps are fused
  bool fuse = true;       // --fusion-mode 0 and -1
  bool overwrite_dmaps = false;
  unsigned estimate_colors = 2;
  unsigned estimate_normals = 2;
  axial::RegionMode region = axial::RegionMode::adaptive;
  double roi_border = 0;
  bool crop_to_roi = true;
  bool remove_dmaps = false;
  // Exports instead of densifying (cloud_exports.h).
  int filter_point_cloud = 0, export_number_views = 0;
  double estimate_scale = 0;
  std::filesystem::path pinhole_export;  // empty: none
  bool double_precision = false;         // cloud as double, in world coordinates
  std::uint64_t max_memory = 0;          // [MB of 10^6 bytes]; 0: 70 % of the free memory
};

// Whether the cloud takes colours from the images.
inline bool needs_colors(const Options& options) {
  return options.fuse && options.estimate_colors > 0;
}

// Parses and checks the command line. Error for an unknown option, for a value out of range, and
// for an OpenMVS option that is not implemented, unless it has its default or "off" value.
// `parsed.run` is false if nothing is left to do.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace densify
