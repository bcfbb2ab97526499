// SPDX-License-Identifier: GPL-3.0-or-later
#include "project.h"

#include <algorithm>
#include <set>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/first_error.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/unused_input.h"
#include "io/bit_depth.h"
#include "io/geo_offset.h"
#include "io/housing.h"
#include "io/image.h"
#include "io/mvs.h"
#include "io/point_source.h"
#include "io/rival_ports.h"
#include "masks.h"
#include "memory_plan.h"
#include "neighbour_lists.h"
#include "without_effect.h"

namespace densify {
namespace fs = std::filesystem;
using axial::fail;

namespace {

// Image paths in a scene count from the working folder. If a scene was moved with its images, they
// are found relative to its file.
void find_images(axial::Scene& scene, const Options& options) {
  const auto find = [&](std::string& path) {
    std::error_code error;
    if (path.empty() || fs::exists(path, error)) return;
    const fs::path relative =
        fs::path(path).lexically_relative(options.parsed.common.working_folder);
    const fs::path beside = options.input.parent_path() / relative;
    if (fs::exists(beside, error)) path = beside.string();
  };
  for (axial::SceneImage& image : scene.images) {
    find(image.path);
    find(image.mask_path);
  }
}

std::optional<axial::io::Housing> attach_housing(axial::Scene& scene,
                                                 const axial::LocalFrame& frame,
                                                 const Options& options) {
  if (options.camera == CameraChoice::pinhole) return {};
  const bool demanded = options.refractive || options.camera == CameraChoice::flat_port;
  const fs::path file = housing_file(options);
  std::error_code error;
  if (!fs::exists(file, error)) {
    if (demanded || !options.housing.empty())
      fail("{}: housing file not found; --refractive needs a housing file (see --housing)",
           file.string());
    return {};
  }
  const axial::io::Housing housing = axial::io::read_housing(file);
  axial::io::warn_of_housing_beside(scene, options.input, housing, file);
  axial::io::attach_ports(scene, axial::io::in_frame(frame, housing), file.string());
  std::size_t images = 0, wet = 0, flat = 0;
  for (const axial::SceneImage& image : scene.images) {
    const auto& port = image.camera.port;
    images += image.calibrated ? 1 : 0;
    wet += port ? 1 : 0;
    flat += port && std::holds_alternative<axial::refractive::FlatPort<double>>(*port) ? 1 : 0;
  }
  if (wet == 0 && demanded) fail("{}: gives no image a port", file.string());
  if (flat < images && options.camera == CameraChoice::flat_port)
    fail("{}: only {} of {} images have a flat port, but --camera-model is flatport", file.string(),
         flat, images);
  axial::log_info("Housing {}: {} of {} images behind a port", file.filename().string(), wet,
                  images);
  if (wet > 0) return housing;
  if (!options.housing.empty() && !housing.ports.empty())
    axial::UnusedInput(options.allow_missing)
        .report(fmt::format("--housing {}: gives no image a port", file.string()));
  return {};
}

cv::Size size_to_work_on(const axial::SceneImage& image, const cv::Size& file_size,
                         const Options& options) {
  if (!axial::same_shape(file_size, {image.camera.width, image.camera.height}))
    fail("{}: is {}x{}, but its camera is {}x{}", image.path, file_size.width, file_size.height,
         image.camera.width, image.camera.height);
  return axial::working_size(file_size.width, file_size.height, options.resolution);
}

View load_view(const axial::SceneImage& image, std::size_t index, const Options& options) {
  View view;
  view.id = image.id == axial::kNoId ? static_cast<std::uint32_t>(index) : image.id;
  view.file = axial::io::read_image_header(image.path);
  const cv::Size size = size_to_work_on(image, view.file.size, options);
  view.camera = image.camera.resized(size.width, size.height);
  view.pose = image.pose;
  return view;
}

void find_bit_depth(Project& project, const Options& options) {
  std::vector<fs::path> photographs;
  std::vector<axial::io::ImageHeader> headers;
  for (std::size_t i = 0; i < project.views.size(); ++i) {
    if (!project.scene.images[i].calibrated) continue;
    photographs.emplace_back(project.scene.images[i].path);
    headers.push_back(project.views[i].file);
  }
  project.bit_depth = axial::io::common_bit_depth(photographs, headers, options.bit_depth);
}

void load_views(Project& project, const Options& options) {
  const std::size_t count = project.scene.images.size();
  project.views.resize(count);
  axial::FirstError error;
  axial::parallel_for(count, [&](std::size_t i) {
    if (project.scene.images[i].calibrated)
      error.run(i, [&] { project.views[i] = load_view(project.scene.images[i], i, options); });
  });
  error.rethrow();
  choose_masks(project, options);
  find_bit_depth(project, options);
}

void check_ids(const Project& project) {
  std::set<std::uint32_t> seen;
  for (std::size_t i = 0; i < project.views.size(); ++i)
    if (project.scene.images[i].calibrated && !seen.insert(project.views[i].id).second)
      fail("image {}: ID {} is used twice, depth maps would overwrite each other",
           project.scene.images[i].path, project.views[i].id);
}

// Images with given neighbours need points of their own only for their depth range.
void use_neighbour_lists(Project& project, const Options& options) {
  const std::vector<bool> named = read_neighbour_lists(options.neighbour_lists, project.scene);
  for (std::size_t i = 0; i < named.size(); ++i) {
    axial::ViewPreparation& preparation = project.preparations[i];
    if (named[i] && preparation.init_points.size() >= options.selection.min_init_points)
      preparation.problem.clear();
  }
}

void select_views(Project& project, const Options& options) {
  axial::Scene& scene = project.scene;
  if (scene.region) warn_of_region_of_scene(options);
  if (!scene.region) scene.region = axial::estimate_region(scene, options.region);
  if (scene.region) scene.region = axial::with_border(*scene.region, options.roi_border);
  require_memory_to_score(scene, options);
  project.preparations = axial::score_neighbours(scene, options.selection,
                                                 axial::console_progress("Scored neighbours"));
  if (!options.neighbour_lists.empty()) use_neighbour_lists(project, options);
  project.neighbours.resize(scene.images.size());
  project.sources.resize(scene.images.size());
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    if (!scene.images[i].calibrated) continue;
    if (!project.preparations[i].usable()) {
      axial::log_warning("{}: left out: {}", scene.images[i].path, project.preparations[i].problem);
      continue;
    }
    project.neighbours[i] = axial::filter_neighbours(scene.images[i].neighbours, options.selection);
    project.sources[i] =
        axial::choose_source_views(project.neighbours[i], options.number_views, options.selection);
    if (project.sources[i].empty())
      axial::log_warning("{}: left out: {}", scene.images[i].path,
                         axial::why_no_source_view(scene.images[i].neighbours, options.selection));
    else
      project.references.push_back(i);
  }
  if (project.references.empty())
    fail("{}: no image has neighbours to be matched with", options.input.string());
}

void add_numbers(axial::Fingerprint& print, std::initializer_list<double> values) {
  for (const double value : values) print.add(value);
}

void add_port(axial::Fingerprint& print, const axial::refractive::FlatPort<double>& port) {
  add_numbers(print, {port.normal.x(), port.normal.y(), port.normal.z(), port.distance,
                      port.thickness, port.n_air, port.n_glass, port.n_water});
}

void add_port(axial::Fingerprint& print, const axial::refractive::DomePort<double>& port) {
  print.add("dome");
  add_numbers(print, {port.centre.x(), port.centre.y(), port.centre.z(), port.inner_radius,
                      port.thickness, port.n_air, port.n_glass, port.n_water});
}

void add_distortion(axial::Fingerprint& print,
                    axial::refractive::LensDistortion<double> distortion) {
  print.add("distortion");
  distortion.each_field([&](double number) { print.add(number); });
}

void add_camera(axial::Fingerprint& print, const axial::CameraModel& camera) {
  print.add(static_cast<std::uint64_t>(camera.width))
      .add(static_cast<std::uint64_t>(camera.height));
  print.add(camera.lens.fx).add(camera.lens.fy).add(camera.lens.cx).add(camera.lens.cy);
  if (camera.distortion) add_distortion(print, *camera.distortion);
  print.add(std::uint64_t{camera.port.has_value()});
  if (!camera.port) return;
  std::visit([&](const auto& port) { add_port(print, port); }, *camera.port);
}

void add_options(axial::Fingerprint& print, const Options& options) {
  const axial::depth::PatchMatchOptions& matching = options.matching;
  for (const std::uint64_t value :
       {static_cast<std::uint64_t>(matching.warp), static_cast<std::uint64_t>(options.projection),
        static_cast<std::uint64_t>(matching.sub_resolution_levels),
        static_cast<std::uint64_t>(matching.iterations),
        static_cast<std::uint64_t>(options.geometric_iterations),
        static_cast<std::uint64_t>(options.postprocess),
        static_cast<std::uint64_t>(options.ignore_mask_label)})
    print.add(value);
}

// Fingerprints of the files that each view's pixels and mask come from.
std::vector<std::string> content_of_files(const Project& project) {
  std::vector<std::string> prints(project.views.size());
  axial::parallel_for(prints.size(), [&](std::size_t i) {
    if (!project.scene.images[i].calibrated) return;
    axial::Fingerprint print;
    print.add(axial::read_file(project.scene.images[i].path));
    if (!project.views[i].mask.empty()) print.add(axial::read_file(project.views[i].mask));
    prints[i] = print.hex();
  });
  return prints;
}

// A fingerprint of everything that the depth maps depend on. Options that only fusion uses, and the
// number of threads, are not part of it.
std::string fingerprint(const Project& project, const Options& options) {
  axial::Fingerprint print;
  print.add("AxialMVS depth maps 11");  // the number is the version of the matching method
  add_options(print, options);
  if (!options.map_settings.empty()) print.add(options.map_settings);
  const std::vector<std::string> contents = content_of_files(project);
  for (std::size_t i = 0; i < project.views.size(); ++i) {
    const View& view = project.views[i];
    print.add(std::uint64_t{view.id});
    add_camera(print, view.camera);
    for (const double value : view.pose.rotation.reshaped()) print.add(value);
    for (const double value : view.pose.centre) print.add(value);
    print.add(contents[i]);
    if (view.file.bits > 8) print.add(static_cast<std::uint64_t>(project.bit_depth));
    if (view.file.alpha) print.add("transparent pixels are masked");
    for (const auto* list : {&project.neighbours[i], &project.sources[i]}) {
      print.add(static_cast<std::uint64_t>(list->size()));
      for (const axial::ViewScore& neighbour : *list) print.add(std::uint64_t{neighbour.image});
    }
    for (const std::uint32_t point : project.preparations[i].init_points)
      for (const float value : project.scene.points[point].position)
        print.add(static_cast<double>(value));
  }
  return print.hex();
}

void attach_lenses(axial::Scene& scene, const Options& options) {
  if (axial::io::attach_lenses_beside(scene, options.input))
    axial::log_info("{}: {} images have distorted lenses and are matched without resampling",
                    axial::io::lenses_beside(options.input).filename().string(),
                    std::ranges::count_if(scene.images, [](const axial::SceneImage& image) {
                      return image.camera.distortion.has_value();
                    }));
}

void warn_of_missing_lenses(const Options& options) {
  const fs::path file = axial::io::lenses_beside(options.input);
  std::error_code error;
  if (!fs::exists(file, error))
    axial::log_warning("{}: file not found: the images count as undistorted", file.string());
}

}  // namespace

bool all_pinholes(const Project& project) {
  return std::ranges::none_of(
      project.views, [](const View& view) { return view.camera.port || view.camera.distortion; });
}

fs::path housing_file(const Options& options) {
  return options.housing.empty() ? axial::io::housing_beside(options.input) : options.housing;
}

Project load_scene(const Options& options) {
  require_memory_to_read(options);
  Project project;
  project.scene = axial::io::read_mvs(options.input, options.parsed.common.working_folder);
  project.frame = axial::io::enter_local_frame(project.scene, options.input);
  find_images(project.scene, options);
  attach_lenses(project.scene, options);
  project.lenses = axial::io::lenses_of(project.scene, options.output);
  project.housing = attach_housing(project.scene, project.frame, options);
  if (project.housing) warn_of_missing_lenses(options);
  axial::log_info("Scene {}: {} images, {} points", options.input.filename().string(),
                  project.scene.images.size(), project.scene.points.size());
  if (!options.point_cloud.empty())
    axial::io::use_point_cloud(project.scene, project.frame, options.point_cloud);
  return project;
}

Project load_project(const Options& options) {
  Project project = load_scene(options);
  load_views(project, options);
  check_ids(project);
  select_views(project, options);
  warn_of_options_without_effect(project, options);
  project.fingerprint = fingerprint(project, options);
  return project;
}

void write_cameras_beside_output(const Project& project, const Options& options) {
  if (!project.frame.is_world() || options.output != options.input)
    axial::io::write_geo_offset_beside(options.output, project.frame);
  axial::io::write_lenses_beside(options.output, project.lenses, project.housing.has_value());
  const fs::path file = axial::io::housing_beside(options.output);
  std::error_code error;
  if (fs::equivalent(file, housing_file(options), error)) return;
  if (project.housing) return axial::io::write_housing(file, *project.housing);
  if (fs::remove(file, error)) axial::log_info("{} removed: the scene has no ports", file.string());
}

}  // namespace densify
