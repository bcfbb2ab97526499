// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <algorithm>
#include <vector>

#include "base/error.h"

namespace densify {
namespace po = boost::program_options;
using axial::fail;

namespace {

// What the command line says, before it is checked and sorted into options structs.
struct Raw {
  std::string input, output, housing, mask_path, camera_model, projection, warp;
  int fusion_mode = 0, estimate_roi = 2;
};

// An OpenMVS option that scripts pass and that is not built: accepted at these values only.
struct NotBuilt {
  const char* name;
  const char* initial;
  std::vector<std::string> accepted;
};

const std::vector<NotBuilt>& not_built() {
  static const std::vector<NotBuilt> options = {{"pointcloud-file,p", "", {""}},
                                                {"view-neighbors-file", "", {""}},
                                                {"output-view-neighbors-file", "", {""}},
                                                {"estimate-scale", "0", {"0", "0.0"}},
                                                {"sub-scene-area", "0", {"0", "0.0"}},
                                                {"sample-mesh", "0", {"0", "0.0"}},
                                                {"filter-point-cloud", "0", {"0"}},
                                                {"export-number-views", "0", {"0"}},
                                                {"tower-mode", "0", {"0"}},
                                                {"cuda-device", "-1", {"-1", "-2"}}};
  return options;
}

const std::vector<NotBuilt>& not_built_hidden() {
  static const std::vector<NotBuilt> options = {{"mesh-file", "", {""}},
                                                {"export-roi-file", "", {""}},
                                                {"import-roi-file", "", {""}},
                                                {"dense-config-file", "", {""}},
                                                {"export-depth-maps-name", "", {""}}};
  return options;
}

void declare_io(po::options_description& add, Raw& raw, Options& options) {
  add.add_options()  //
      ("input-file,i", po::value(&raw.input), "scene with cameras and images")(
          "output-file,o", po::value(&raw.output), "scene and cloud to write (<input>_dense.mvs)")(
          "resolution-level", po::value(&options.resolution.level)->default_value(1),
          "halvings of the images before matching")(
          "max-resolution", po::value(&options.resolution.max)->default_value(2560),
          "cap on the longest side [px]")("min-resolution",
                                          po::value(&options.resolution.min)->default_value(640),
                                          "the longest side is not halved below this [px]")(
          "mask-path", po::value(&raw.mask_path), "folder with <image>.mask.png for every image")(
          "ignore-mask-label", po::value(&options.ignore_mask_label)->default_value(-1),
          "mask value to leave out; below 0: no masks")(
          "remove-dmaps", po::value(&options.remove_dmaps)->default_value(false),
          "remove the depth maps after fusion")(
          "max-memory", po::value(&options.max_memory)->default_value(0),
          "memory to use at most [MB] (0: 70 % of what is free); --estimate-colors 1 and "
          "--estimate-normals 1 keep the whole cloud on top of it");
}

void declare_matching(po::options_description& add, Options& options) {
  add.add_options()  //
      ("sub-resolution-levels",
       po::value(&options.matching.sub_resolution_levels)
           ->default_value(options.matching.sub_resolution_levels),
       "coarser levels matched first")("number-views",
                                       po::value(&options.number_views)->default_value(5),
                                       "source views per image (0: all, 1: the best one)")(
          "iters",
          po::value(&options.matching.iterations)->default_value(options.matching.iterations),
          "sweeps per resolution level")("geometric-iters",
                                         po::value(&options.geometric_iterations)->default_value(2),
                                         "sweeps with geometric consistency")(
          "postprocess-dmaps", po::value(&options.postprocess)->default_value(kSpeckles | kGaps),
          "depth map filters, added up: 1 speckles, 2 gaps, 4 adjust to the neighbours' maps "
          "(OpenMVS's default is 7)");
}

void declare_fusion(po::options_description& add, Raw& raw, Options& options) {
  add.add_options()  //
      ("fusion-mode", po::value(&raw.fusion_mode)->default_value(0),
       "0 depth maps and fusion, 1 depth maps only")(
          "number-views-fuse", po::value(&options.fusion.min_views)->default_value(3),
          "views that must agree on a point (below 2: merge without agreement)")(
          "estimate-colors", po::value(&options.estimate_colors)->default_value(2),
          "0 no, 1 from the nearest view, 2 from all views of a point")(
          "estimate-normals", po::value(&options.estimate_normals)->default_value(2),
          "0 no, 1 from the cloud, 2 from the depth maps")(
          "estimate-roi", po::value(&raw.estimate_roi)->default_value(2),
          "region of interest from cameras and points: 0 off, 1 on, 2 adaptive")(
          "roi-border", po::value(&options.roi_border)->default_value(0),
          "above 0 multiplies the region's size, below 0 adds to it [scene units]")(
          "crop-to-roi", po::value(&options.crop_to_roi)->default_value(true),
          "crop the cloud to the region of interest");
}

void declare_camera(po::options_description& add, Raw& raw, Options& options) {
  add.add_options()  //
      ("refractive", po::value(&options.refractive)->default_value(false)->implicit_value(true),
       "cameras look through ports: demand a housing file")("housing", po::value(&raw.housing),
                                                            "housing file (<scene>.housing.json)")(
          "camera-model", po::value(&raw.camera_model)->default_value("auto"),
          "auto: what the housing says, pinhole: ignore it, flatport: every image has a flat port")(
          "projection", po::value(&raw.projection)->default_value("exact"),
          "in matching: exact, or the published line-search")(
          "warp", po::value(&raw.warp)->default_value("affine"),
          "in matching: affine (exact to first order), or the published virtual homography");
}

void declare_not_built(po::options_description& add, const std::vector<NotBuilt>& options) {
  for (const NotBuilt& option : options)
    add.add_options()(option.name, po::value<std::string>()->default_value(option.initial),
                      "not built yet: only the default");
}

void refuse_not_built(const po::variables_map& values, const std::vector<NotBuilt>& options) {
  for (const NotBuilt& option : options) {
    const std::string full = option.name;
    const std::string name = full.substr(0, full.find(','));
    const std::string value = values[name].as<std::string>();
    if (std::find(option.accepted.begin(), option.accepted.end(), value) == option.accepted.end())
      fail("--{} {}: not built yet", name, value);
  }
}

template <class T>
T one_of(const std::string& name, const std::string& value,
         const std::vector<std::pair<std::string, T>>& choices) {
  std::string names;
  for (const auto& [key, meaning] : choices) {
    if (key == value) return meaning;
    names += (names.empty() ? "" : ", ") + key;
  }
  fail("--{} {}: must be one of {}", name, value, names);
}

template <class T>
void check_range(const std::string& name, T value, T low, T high) {
  if (!(value >= low && value <= high))
    fail("--{} {}: must be from {} to {}", name, value, low, high);
}

void check_values(const Options& options, const Raw& raw) {
  check_range("resolution-level", options.resolution.level, 0u, 16u);
  check_range("max-resolution", options.resolution.max, 16, 1 << 16);
  check_range("min-resolution", options.resolution.min, 1, 1 << 16);
  check_range("sub-resolution-levels", options.matching.sub_resolution_levels, 0, 8);
  check_range("number-views", options.number_views, 0u, 32u);
  check_range("iters", options.matching.iterations, 1, 60);
  check_range("geometric-iters", options.geometric_iterations, 0, 20);
  check_range("postprocess-dmaps", options.postprocess, 0u, 7u);
  check_range("number-views-fuse", options.fusion.min_views, std::size_t{0}, std::size_t{255});
  check_range("fusion-mode", raw.fusion_mode, 0, 1);
  check_range("estimate-colors", options.estimate_colors, 0u, 2u);
  check_range("estimate-normals", options.estimate_normals, 0u, 2u);
  check_range("estimate-roi", raw.estimate_roi, 0, 2);
  check_range("max-memory", options.max_memory, std::uint64_t{0}, std::uint64_t{1} << 40);
  check_range("roi-border", options.roi_border, -1e6, 1e6);
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  Raw raw;
  axial::ProgramOptions program{
      "DensifyPointCloud", "a dense point cloud from calibrated images, in air and under water",
      po::options_description("Densify options"), po::options_description("Hidden options"),
      ", and pictures of the depth maps beside them; 5 and above: also of every stage's"};
  declare_io(program.visible, raw, options);
  declare_camera(program.visible, raw, options);
  declare_matching(program.visible, options);
  declare_fusion(program.visible, raw, options);
  declare_not_built(program.visible, not_built());
  declare_not_built(program.hidden, not_built_hidden());
  options.parsed = axial::parse_options(argc, argv, program);
  if (!options.parsed.run) return options;

  const axial::CommonOptions& common = options.parsed.common;
  refuse_not_built(options.parsed.values, not_built());
  refuse_not_built(options.parsed.values, not_built_hidden());
  check_values(options, raw);
  options.input = axial::in_working_folder(common, raw.input);
  options.output = axial::in_working_folder(common, raw.output);
  if (options.output.empty())
    options.output = options.input.parent_path() / (options.input.stem().string() + "_dense.mvs");
  options.output.replace_extension(".mvs");
  options.housing = axial::in_working_folder(common, raw.housing);
  options.mask_folder = axial::in_working_folder(common, raw.mask_path);
  options.camera = one_of<CameraChoice>("camera-model", raw.camera_model,
                                        {{"auto", CameraChoice::automatic},
                                         {"pinhole", CameraChoice::pinhole},
                                         {"flatport", CameraChoice::flat_port}});
  options.projection =
      one_of<axial::ProjectionMethod>("projection", raw.projection,
                                      {{"exact", axial::ProjectionMethod::exact},
                                       {"line-search", axial::ProjectionMethod::line_search}});
  options.matching.warp = one_of<axial::depth::Warp>(
      "warp", raw.warp,
      {{"affine", axial::depth::Warp::affine}, {"homography", axial::depth::Warp::homography}});
  if (options.refractive && options.camera == CameraChoice::pinhole)
    fail("--refractive contradicts --camera-model pinhole");
  options.fuse = raw.fusion_mode == 0;
  options.region = static_cast<axial::RegionMode>(raw.estimate_roi);
  options.fusion.normals = options.estimate_normals == 2;
  return options;
}

}  // namespace densify
