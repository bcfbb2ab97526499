// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracked.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/naming.h"
#include "base/order_statistics.h"
#include "io/colmap/colmap.h"
#include "io/colmap/colmap_lens.h"
#include "view/camera_data.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

constexpr double kSamePose = 2e-3;  // shift relative to the depth, and angle [rad]

// The calibrated images of a scene by the ends of their paths.
class ImagesByName {
 public:
  explicit ImagesByName(const Scene& scene) {
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
      if (!scene.images[i].calibrated) continue;
      const fs::path path = scene.images[i].path;
      by_file_[path.filename().string()].push_back({i, path.generic_string()});
    }
  }

  // The image whose path ends with `name`. Empty if there is none. All names begin in one folder,
  // so of a.jpg and b/a.jpg the shorter path belongs to the name a.jpg.
  std::optional<std::size_t> find(const std::string& name) const {
    const auto images = by_file_.find(fs::path(name).filename().string());
    if (images == by_file_.end()) return std::nullopt;
    const Entry* found = nullptr;
    std::size_t of_length = 0;  // the number of paths as short as that of `found`
    for (const Entry& image : images->second) {
      if (!image.path.ends_with(name)) continue;
      const std::size_t before = image.path.size() - name.size();
      if (before > 0 && image.path[before - 1] != '/') continue;
      if (!found || image.path.size() < found->path.size()) {
        found = &image;
        of_length = 0;
      }
      if (image.path.size() == found->path.size()) ++of_length;
    }
    if (of_length > 1) fail("image {}: the scene has several images of this name", name);
    return found ? std::optional(found->number) : std::nullopt;
  }

 private:
  struct Entry {
    std::size_t number;
    std::string path;
  };
  std::map<std::string, std::vector<Entry>> by_file_;
};

// Lens and port as text: equal for images that share them.
std::string camera_key(const SceneImage& image) {
  const nlohmann::ordered_json data = view::camera_data(image, {});
  std::string key = data["size"].dump() + data["lens"].dump();
  for (const char* part : {"distortion", "port"})
    if (data.contains(part)) key += data[part].dump();
  return key;
}

// Converts pixels of the model to pixels of the scene.
class PixelsOfScene {
 public:
  PixelsOfScene(const io::ColmapCamera& from, const CameraModel& to) : to_(to) {
    if (from.width != static_cast<std::uint64_t>(to.width) ||
        from.height != static_cast<std::uint64_t>(to.height))
      fail("camera {} is {}x{}, but the scene's images are {}x{}", from.id, from.width, from.height,
           to.width, to.height);
    if (to.distortion) return;
    const lens::Lens lens = io::lens_of(from);
    if (lens::pinhole_lens(lens)) return;
    lens_ = lens;
    field_ = field_of(lens);
  }

  // Empty if the pixel is the image of no direction.
  std::optional<Eigen::Vector2d> operator()(const Eigen::Vector2d& pixel) const {
    if (!lens_) return pixel;
    const auto seen = direction_at(*lens_, field_, pixel);
    if (!seen) return {};
    return Eigen::Vector2d(to_.lens.fx * seen->direction.x() + to_.lens.cx,
                           to_.lens.fy * seen->direction.y() + to_.lens.cy);
  }

 private:
  CameraModel to_;
  std::optional<lens::Lens> lens_;
  lens::Field field_{};
};

class Builder {
 public:
  Builder(const io::SceneWithCameras& scene, const io::ColmapModel& model) : scene_(scene) {
    for (const io::ColmapCamera& camera : model.cameras) lenses_[camera.id] = &camera;
    for (const io::ColmapPoint3D& point : model.points) {
      points_[point.id] = all_.photographs.points.size();
      all_.photographs.points.push_back(scene.frame.to_local(point.position));
    }
  }

  void add(const io::ColmapImage& image, std::size_t number) {
    const SceneImage& own = scene_.scene.images[number];
    const std::size_t index = all_.numbers.size();
    const std::size_t first = all_.photographs.observations.size();
    const PixelsOfScene convert(*lenses_.at(image.camera), own.camera);
    for (std::size_t k = 0; k < image.points.size(); ++k) {
      const auto point = points_.find(image.points[k].point3d);
      if (point == points_.end()) continue;
      const auto pixel = convert({image.points[k].x - 0.5, image.points[k].y - 0.5});
      if (pixel) all_.photographs.observations.push_back({index, point->second, *pixel, k});
    }
    require_same_pose(image, own, first);
    all_.numbers.push_back(number);
    all_.photographs.images.push_back({image.name, camera_of(own), own.pose});
  }

  TrackedScene take() { return std::move(all_); }

 private:
  std::size_t camera_of(const SceneImage& image) {
    auto& cameras = all_.photographs.cameras;
    const auto [at, added] = cameras_.try_emplace(camera_key(image), cameras.size());
    if (added) cameras.push_back(image.camera);
    return at->second;
  }

  // The observations of the image begin at `first`.
  void require_same_pose(const io::ColmapImage& image, const SceneImage& own,
                         std::size_t first) const {
    const auto& photographs = all_.photographs;
    std::vector<double> depths;
    for (std::size_t i = first; i < photographs.observations.size(); ++i)
      depths.push_back(
          own.pose.to_camera(photographs.points[photographs.observations[i].point]).norm());
    if (depths.empty()) return;
    const double middle = upper_median(std::move(depths));
    const double shift = (scene_.frame.to_local(image.pose.centre) - own.pose.centre).norm();
    const double turn = (image.pose.rotation - own.pose.rotation).norm();
    if (shift > kSamePose * middle || turn > 1.5 * kSamePose)
      fail(
          "image {}: its pose differs from that in the scene by {:.3g} units and {:.3g} rad: give "
          "the model from which the scene was made",
          image.name, shift, turn / 1.5);
  }

  const io::SceneWithCameras& scene_;
  std::map<std::uint32_t, const io::ColmapCamera*> lenses_;
  std::map<std::uint64_t, std::size_t> points_;
  std::map<std::string, std::size_t> cameras_;
  TrackedScene all_;
};

TrackedScene tracks_of(const io::SceneWithCameras& scene, const io::ColmapModel& model) {
  Builder builder(scene, model);
  const ImagesByName images(scene.scene);
  for (const io::ColmapImage& image : model.images)
    if (const auto number = images.find(image.name)) builder.add(image, *number);
  TrackedScene tracked = builder.take();
  if (tracked.numbers.empty()) fail("has no image of the scene");
  if (tracked.photographs.observations.empty()) fail("has no observations");
  return tracked;
}

}  // namespace

TrackedScene read_tracks(const io::SceneWithCameras& scene, const fs::path& folder,
                         const Context& context) {
  const io::ColmapModel model =
      io::read_colmap_model(io::find_colmap_model(folder, context), context);
  TrackedScene tracked =
      naming("--sfm-model " + folder.string(), [&] { return tracks_of(scene, model); });
  log_info("{}: {} observations in {} of {} images", folder.string(),
           tracked.photographs.observations.size(), tracked.numbers.size(),
           scene.scene.images.size());
  return tracked;
}

}  // namespace axial::apps
