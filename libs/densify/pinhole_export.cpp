// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/pinhole_export.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/file_extension.h"
#include "base/first_error.h"
#include "base/order_statistics.h"
#include "base/parallel.h"
#include "cloud/pinhole_resampling.h"
#include "densify/cloud_exports.h"
#include "densify/pinhole_folder.h"
#include "densify/pinhole_model.h"
#include "io/artifacts/written_files.h"
#include "io/bytes/json.h"
#include "io/cameras/geo_offset.h"
#include "io/colmap/colmap_export.h"
#include "io/images/image.h"
#include "io/images/masks.h"
#include "io/openmvs/dmap.h"
#include "io/openmvs/mvs.h"
#include "io/ply/ply.h"
#include "scene/resolution.h"
#include "survey/photographs.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

struct Exported {
  cloud::PinholeView view;  // at the resolution of the photograph
  double exact = 0;         // share of pixels with the label kExact
};

class Export {
 public:
  Export(Project& project, const OutputOptions& output, const ExistingMaps& maps,
         std::size_t at_once, const Context& context)
      : project_(project),
        output_(output),
        maps_(maps),
        at_once_(at_once),
        context_(context),
        photographs_(io::common_image_folder(project.scene)),
        points_(project.scene, project.references),
        exported_(project.scene.images.size()),
        is_exported_(project.scene.images.size(), false) {
    for (const std::size_t image : project.references) is_exported_[image] = true;
    find_range();
  }

  void run() {
    write_folder(output_.pinhole_export, [&](const fs::path& folder) {
      folder_ = fs::absolute(folder);
      export_images();
      export_cloud();
      export_model();
      export_scene();
      export_marker();
      remove_earlier_export(output_.pinhole_export, folder_, context_);
    });
    report();
  }

 private:
  // Takes the range of the median image, so that the same lens and port give the same pinhole.
  void find_range() {
    std::vector<float> near, far;
    for (const std::size_t image : project_.references) {
      near.push_back(project_.preparations[image].min_depth);
      far.push_back(project_.preparations[image].max_depth);
    }
    near_ = upper_median(std::move(near)), far_ = upper_median(std::move(far));
  }

  fs::path image_file(std::size_t image) const {
    return folder_ / "images" / exported_name(project_.scene.images[image], photographs_);
  }

  DepthMap load_map(std::size_t image, const cv::Mat1b& opaque) const {
    cv::Mat1b mask;
    if (maps_.are_final)
      mask =
          survey::working_mask(project_.views[image], opaque, project_.options.ignore_mask_label);
    return read_final_map(project_, maps_, image, mask, context_);
  }

  // The mask of a photograph in its full size; empty: none. `camera`: of this size.
  cv::Mat1b full_mask(std::size_t image, const CameraModel& camera) const {
    View full = project_.views[image];
    full.camera = camera;
    return survey::working_mask(full, {}, project_.options.ignore_mask_label);
  }

  // The resolution at which OpenMVS, with this run's options, would work on the pinhole image.
  cv::Size map_size(const CameraModel& pinhole, std::size_t image) const {
    if (!maps_.are_final)
      return working_size(pinhole.width, pinhole.height, project_.options.resolution);
    const View& view = project_.views[image];
    const double scale = static_cast<double>(view.camera.width) / view.header.size.width;
    return {std::max(1, cvRound(scale * pinhole.width)),
            std::max(1, cvRound(scale * pinhole.height))};
  }

  void export_map(std::size_t image, DepthMap map, const cloud::PinholeView& view,
                  const cv::Mat1f& surface) const {
    map = cloud::resampled(map, view, surface);
    map.image_path = image_file(image).string();
    io::write_dmap(folder_ / depth_map_path(project_, image).filename(), map, made_from());
  }

  std::string made_from() const { return project_.fingerprint + " as a pinhole's"; }

  void write_image(std::size_t image, const cloud::PinholeImage& pinhole) {
    constexpr int kQuality = 98;  // the image is compressed a second time: little loss
    const fs::path file = image_file(image);
    make_folder(file.parent_path());
    if (is_jpeg_name(file))
      io::write_jpeg(file, pinhole.color, kQuality);
    else
      io::write_png(file, pinhole.color);
    io::write_png(io::mask_beside(file), pinhole.label);
    const int exact = cv::countNonZero(pinhole.label == cloud::kExact);
    exported_[image].exact = exact / static_cast<double>(pinhole.label.total());
    write_for_trainers(file, pinhole.usable);
  }

  // Trainers expect a folder of images without masks, and masks of two values in another folder.
  void write_for_trainers(const fs::path& file, const cv::Mat1b& usable) const {
    const fs::path name = file.lexically_relative(folder_ / "images");
    link_or_copy(file, folder_ / kPinholeModel / "images" / name);
    fs::path mask = folder_ / kPinholeModel / "masks" / name;
    make_folder(mask.parent_path());
    io::write_png(mask.replace_extension(".png"), usable);
  }

  void export_image(std::size_t image) {
    const survey::FullPhotograph photograph = survey::read_full_photograph(project_, image);
    const cv::Mat3b& color = photograph.color;
    const CameraModel camera = project_.scene.images[image].camera.resized(color.cols, color.rows);
    const cloud::PinholeView view = cloud::pinhole_for(camera, near_, far_);
    exported_[image].view = view;
    DepthMap map = load_map(image, photograph.opaque);
    const cv::Mat1f surface = cloud::render_surface(map, view);
    const cv::Size size = map_size(view.camera, image);
    const cloud::PinholeView small = view.resized(size.width, size.height);
    const cv::Mat1f coarse = cloud::render_surface(map, small);
    export_map(image, std::move(map), small, coarse);
    const cv::Mat1f guess = cloud::filled(coarse, static_cast<float>((1 / near_ + 1 / far_) / 2));
    const cloud::PinholeImage pinhole = cloud::resampled(color, photograph.opaque, camera, view,
                                                         surface, guess, full_mask(image, camera));
    points_.find(image, view, pinhole);
    write_image(image, pinhole);
  }

  void export_images() {
    const std::size_t count = project_.references.size();
    ProgressCounter counter(context_.stage("Exported pinhole images"), count);
    FirstError error;
    for_each_in_flight(count, at_once_, [&](std::size_t i) {
      error.run(i, [&] { export_image(project_.references[i]); });
      counter.add();
    });
    error.rethrow();
  }

  // Writes float positions in the scene's frame, in which its poses are.
  void export_cloud() const {
    const fs::path ply = fs::path(output_.scene).replace_extension(".ply");
    const fs::path file = folder_ / "scene.ply";
    if (output_.double_precision)
      io::write_cloud_ply(file, io::read_cloud_ply(ply, project_.frame), true,
                          {project_.frame, false});
    else
      fs::copy_file(ply, file);
  }

  SceneImage exported_scene_image(std::size_t image) const {
    SceneImage result = project_.scene.images[image];
    result.calibrated = is_exported_[image];
    result.neighbours.clear();
    result.mask_path.clear();
    result.port_name.clear();
    if (!result.calibrated) return result;
    const cloud::PinholeView& view = exported_[image].view;
    result.path = image_file(image).string();
    result.mask_path = io::mask_beside(result.path).string();
    result.camera = view.camera;
    result.pose = view.pose(result.pose);
    const auto nearer = static_cast<float>(view.centre.z());
    result.min_depth -= nearer, result.average_depth -= nearer, result.max_depth -= nearer;
    for (const ViewScore& neighbour : project_.scene.images[image].neighbours)
      if (is_exported_[neighbour.image]) result.neighbours.push_back(neighbour);
    return result;
  }

  std::vector<SceneImage> exported_scene_images() const {
    std::vector<SceneImage> images;
    for (std::size_t i = 0; i < exported_.size(); ++i) images.push_back(exported_scene_image(i));
    return images;
  }

  void export_model() {
    Scene exported;
    exported.images = exported_scene_images();
    points_.give_to(exported);
    model_ =
        write_pinhole_model(folder_ / kPinholeModel / "sparse" / "0", exported, folder_ / "images");
  }

  void export_scene() {
    Scene& scene = project_.scene;
    Scene exported;
    exported.images = exported_scene_images();
    exported.region = scene.region;
    exported.points = std::move(scene.points);
    exported.point_normals = std::move(scene.point_normals);
    exported.point_colors = std::move(scene.point_colors);
    for (SparsePoint& point : exported.points)
      std::erase_if(point.views, [&](const SparseView& view) { return !is_exported_[view.image]; });
    keep_points(exported, [&](std::size_t i) { return !exported.points[i].views.empty(); });
    io::write_mvs(folder_ / "scene.mvs", exported, folder_);
    io::write_geo_offset_beside(folder_ / "scene.mvs", project_.frame, context_);
  }

  void export_marker() const {
    nlohmann::json images = nlohmann::json::array();
    for (const std::size_t image : project_.references) {
      const Exported& as = exported_[image];
      images.push_back(
          {{"image",
            "images/" + exported_name(project_.scene.images[image], photographs_).generic_string()},
           {"photograph", project_.scene.images[image].path},
           {"centre_in_camera_m", {as.view.centre.x(), as.view.centre.y(), as.view.centre.z()}},
           {"exact_share", as.exact}});
    }
    io::write_json(folder_ / kPinholeMarker, {{"version", 1},
                                              {"made_from", made_from()},
                                              {"scene", project_.file().string()},
                                              {"images", images},
                                              {"files", io::list_files(folder_)}});
  }

  void report() const {
    double exact = 0;
    std::size_t cut = 0;
    for (const std::size_t image : project_.references) {
      exact += exported_[image].exact;
      cut += exported_[image].view.whole ? 0 : 1;
    }
    const std::size_t count = project_.references.size();
    if (cut > 0)
      context_.warning(
          "{}: {} of {} images have a wider field of view than a pinhole can show: "
          "their edges are cut off",
          setting("pinhole_export"), cut, count);
    context_.info(
        "{}: {} pinhole images, {:.1f} % of their pixels on a known surface: OpenMVS's programs "
        "can use scene.mvs, scene.ply and the depth maps in this folder",
        output_.pinhole_export.string(), count, 100 * exact / static_cast<double>(count));
    context_.info("{}: COLMAP model of {} pinhole images and {} points, for trainers of splats",
                  (output_.pinhole_export / kPinholeModel).string(), model_.images, model_.points);
  }

  Project& project_;
  const OutputOptions& output_;
  const ExistingMaps& maps_;
  std::size_t at_once_;
  const Context& context_;
  fs::path photographs_, folder_;
  double near_ = 0, far_ = 0;  // lambda [m]
  PinholePoints points_;
  PinholeModelSize model_;
  std::vector<Exported> exported_;  // one for each image of the scene
  std::vector<bool> is_exported_;
};

}  // namespace

std::uint64_t bytes_needed_to_resample(const View& view) {
  const auto area = [](cv::Size size) { return static_cast<std::uint64_t>(size.area()); };
  const std::uint64_t photograph = area(view.header.size);
  // Photograph, opacity and mask; depth, colour, label, usable pixels and the encoded colour of a
  // pinhole at most 1.4 times as wide and as high. While the photograph or its colours are read,
  // the memory for reading; its mask needs less.
  const unsigned decode =
      std::max(view.header.decode_bytes, view.colors.empty() ? 0 : view.colors_header.decode_bytes);
  const std::uint64_t images =
      std::max<std::uint64_t>(decode + 4, 5 + 2 * (4 + 3 + 1 + 1 + 4)) * photograph;
  // The map, the map of the pinhole and the memory for writing it; two depth images, filled.
  const std::uint64_t pixels = area({view.camera.width, view.camera.height});
  const std::uint64_t pinhole = bytes_of_map(pixels) + io::dmap_bytes_needed(pixels) + 16 * pixels;
  return images + bytes_of_map(pixels) + 2 * pinhole;
}

void export_pinholes(Project& project, const OutputOptions& output, const ExistingMaps& maps,
                     std::size_t at_once, const Context& context) {
  Export(project, output, maps, at_once, context).run();
}

}  // namespace axial::densify
