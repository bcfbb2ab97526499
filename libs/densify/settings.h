// SPDX-License-Identifier: GPL-3.0-or-later
// The settings of one run of densify().
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/setting_names.h"
#include "cloud/fuse.h"
#include "depth/filters.h"
#include "depth/options.h"
#include "scene/camera_list.h"
#include "scene/region.h"
#include "scene/resolution.h"
#include "scene/view_selection.h"

namespace axial::densify {

enum class CameraChoice { automatic, pinhole, flat_port };

// Selects the depth maps of which pictures are written. The pictures lie beside the maps.
enum class Pictures { none, final_maps, maps_of_every_stage };

// Bits of Settings::postprocess.
inline constexpr unsigned kSpeckles = 1, kGaps = 2, kAdjust = 4;

// Paths are absolute. An empty path means "none", unless its comment says otherwise.
struct Settings {
  std::filesystem::path input;           // scene (.mvs)
  std::filesystem::path output;          // scene to write (.mvs); its cloud has the extension .ply
  std::filesystem::path working_folder;  // for depth maps; base of relative paths in the scene
  std::filesystem::path housing;         // empty: beside the scene, if there is one
  std::filesystem::path point_cloud;     // empty: the scene's own points
  std::filesystem::path mask_folder;     // empty: the masks that the scene names
  std::filesystem::path neighbour_lists;
  // If not empty, the run only writes the lists of neighbours to this file.
  std::filesystem::path neighbour_lists_output;
  std::filesystem::path report;                     // results of the agreement check (.json)
  std::filesystem::path pinhole_export;             // folder; needs `fuse`
  std::vector<std::filesystem::path> other_inputs;  // the caller's files: never overwritten

  int ignore_mask_label = -1;  // below 0: no masks
  int bit_depth = 0;           // bits that 16-bit images use: 8 to 16; 0: detected

  CameraChoice camera = CameraChoice::automatic;
  bool refractive = false;     // true: the run needs a housing
  bool allow_missing = false;  // no error if the housing gives no image a port
  ProjectionMethod projection = ProjectionMethod::exact;

  ResolutionOptions resolution;
  ViewSelectionOptions selection;
  depth::PatchMatchOptions matching;
  depth::SpeckleOptions speckles;
  depth::GapOptions gaps;
  unsigned number_views = 0;  // source views of an image, at most 32; 0: all suitable views
  int geometric_iterations = 2;
  unsigned postprocess = kSpeckles | kGaps;

  // densify() sets the field `normals` by estimate_normals, and max_maps and max_loads by the
  // memory plan.
  cloud::FuseOptions fusion;
  bool make_maps = true;          // false: existing maps in the working folder are used unchanged
  bool fuse = true;               // false: the sparse points become the cloud
  bool overwrite_dmaps = false;   // true: maps of other programs may be overwritten
  unsigned estimate_colors = 2;   // 0: no, 1: from the nearest view, 2: from all views of a point
  unsigned estimate_normals = 2;  // 0: no, 1: from the cloud, 2: from the depth maps
  RegionMode region = RegionMode::adaptive;
  double roi_border = 0;  // see with_border()
  bool crop_to_roi = true;
  bool remove_dmaps = false;      // remove the depth maps after fusion
  bool double_precision = false;  // write the cloud as double, in world coordinates

  // The next three ask for an export of the scene's points instead of densifying. For their values
  // see export_cloud() (cloud_exports.h). 0: no export.
  int filter_point_cloud = 0;
  int export_number_views = 0;
  double estimate_scale = 0;

  Pictures pictures = Pictures::none;
  std::uint64_t max_memory = 0;  // [MB of 10^6 bytes]; 0: 70 % of the free memory
  unsigned max_threads = 0;      // 0: as many as cores

  // How errors and warnings name the fields of this struct.
  SettingNames name_of = own_name;
};

// Whether the cloud takes colours from the images.
inline bool needs_colors(const Settings& settings) {
  return settings.fuse && settings.estimate_colors > 0;
}

// Whether the settings ask for an export of the scene's points instead of densifying.
inline bool only_exports(const Settings& settings) {
  return settings.filter_point_cloud < 0 || settings.export_number_views != 0 ||
         settings.estimate_scale > 0;
}

}  // namespace axial::densify
