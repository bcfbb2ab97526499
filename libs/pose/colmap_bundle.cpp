// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/colmap_bundle.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "io/colmap/colmap_lens.h"
#include "io/colmap/colmap_scene.h"
#include "lens/lens.h"
#include "pose/tracks.h"

namespace axial::pose {
namespace {

const io::ColmapCamera& lens_of(const io::ColmapCamera& camera,
                                std::span<const io::ColmapCamera> lenses) {
  const auto found = std::find_if(lenses.begin(), lenses.end(), [&](const io::ColmapCamera& lens) {
    return lenses.size() == 1 || lens.id == camera.id;
  });
  if (found == lenses.end()) fail("camera {} has no lens calibrated in air", camera.id);
  if (found->width != camera.width || found->height != camera.height)
    fail("camera {} is {} x {}, but its lens calibrated in air is {} x {}", camera.id, camera.width,
         camera.height, found->width, found->height);
  return *found;
}

// The lens of `camera` without distortion, with a focal length so short that its image holds
// everything that `camera` images.
refractive::PinholeLens<double> holding(const io::ColmapCamera& camera) {
  const lens::Lens in_air = io::lens_of(camera);
  refractive::PinholeLens<double> lens = in_air.pinhole;
  const double right = static_cast<double>(camera.width) - 1;
  const double bottom = static_cast<double>(camera.height) - 1;
  double zoom = 1;
  const auto hold = [&](const Eigen::Vector2d& pixel) {
    const auto imaged = direction_at(in_air, pixel);
    if (!imaged) return;
    const double u = lens.fx * imaged->direction.x(), v = lens.fy * imaged->direction.y();
    const double room_u = u > 0 ? right - lens.cx : lens.cx;
    const double room_v = v > 0 ? bottom - lens.cy : lens.cy;
    zoom = std::min(
        {zoom, room_u / std::max(std::abs(u), room_u), room_v / std::max(std::abs(v), room_v)});
  };
  constexpr int kSamples = 32;
  for (int i = 0; i <= kSamples; ++i) {
    const double x = right * i / kSamples, y = bottom * i / kSamples;
    for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(x, 0), Eigen::Vector2d(x, bottom),
                                         Eigen::Vector2d(0, y), Eigen::Vector2d(right, y)})
      hold(pixel);
  }
  lens.fx *= zoom;
  lens.fy *= zoom;
  return lens;
}

// Makes the bundle's cameras: one for each pair of lens and port that occurs.
class CameraMaker {
 public:
  CameraMaker(ColmapBundle& result, const io::Housing& housing)
      : result_(result), housing_(housing) {}

  std::size_t index(const io::ColmapCamera& lens, const std::string& port) {
    const auto [found, added] =
        indices_.try_emplace({lens.id, port}, result_.bundle.cameras.size());
    if (added) add(lens, port);
    return found->second;
  }

 private:
  void add(const io::ColmapCamera& lens, const std::string& port) {
    result_.bundle.cameras.push_back({{static_cast<int>(lens.width), static_cast<int>(lens.height),
                                       holding(lens), housing_.carried_port(port)},
                                      HousingChange<double>::Zero()});
    result_.lenses.push_back(lens);
    result_.lenses.back().id = static_cast<std::uint32_t>(result_.lenses.size());
    result_.ports.push_back(port);
  }

  ColmapBundle& result_;
  const io::Housing& housing_;
  std::map<std::pair<std::uint32_t, std::string>, std::size_t> indices_;
};

// Computes the observation's pixel on the lens without distortion, and its derivatives. Returns
// false where the lens has no direction for the pixel.
bool place(const io::ColmapCamera& lens, const refractive::PinholeLens<double>& pinhole,
           const io::ColmapPoint2D& point, Observation& observation) {
  const lens::Lens in_air = io::lens_of(lens);
  const auto imaged = direction_at(in_air, {point.x - 0.5, point.y - 0.5});
  if (!imaged) return false;
  observation.pixel = {pinhole.fx * imaged->direction.x() + pinhole.cx,
                       pinhole.fy * imaged->direction.y() + pinhole.cy};
  observation.to_photograph.col(0) = imaged->derivative.col(0) / pinhole.fx;
  observation.to_photograph.col(1) = imaged->derivative.col(1) / pinhole.fy;
  // If the focal length f changes, the pixel of the photograph stays the same and its direction d
  // changes: d(d)/d(log f) = -(d(pixel)/d(d))^-1 (pixel - principal point). The focal length of the
  // pinhole has the same factor, which adds d.
  const refractive::PinholeLens<double> bare = in_air.pinhole;
  const Eigen::Vector2d from_centre(point.x - 0.5 - bare.cx, point.y - 0.5 - bare.cy);
  const Eigen::Vector2d by_focal = imaged->direction - imaged->derivative.inverse() * from_centre;
  observation.pixel_by_focal = {pinhole.fx * by_focal.x(), pinhole.fy * by_focal.y()};
  return true;
}

template <class Item>
std::map<std::uint64_t, std::size_t> indices_by_id(const std::vector<Item>& items) {
  std::map<std::uint64_t, std::size_t> indices;
  for (std::size_t i = 0; i < items.size(); ++i) indices[items[i].id] = i;
  return indices;
}

void scale_focal_lengths(io::ColmapCamera& lens, double factor) {
  const auto focal_lengths = static_cast<std::size_t>(io::colmap_focal_count(lens.model));
  for (std::size_t k = 0; k < focal_lengths; ++k) lens.params[k] *= factor;
}

// The lens with the focal length that the camera has now.
io::ColmapCamera lens_now(const ColmapBundle& bundle, std::size_t camera) {
  io::ColmapCamera lens = bundle.lenses[camera];
  scale_focal_lengths(lens, std::exp(bundle.bundle.cameras[camera].change(kFocalNumber)));
  return lens;
}

}  // namespace

ColmapBundle to_bundle(const io::ColmapModel& model, std::span<const io::ColmapCamera> lenses,
                       const io::Housing& housing) {
  ColmapBundle result;
  Bundle& bundle = result.bundle;
  CameraMaker cameras(result, housing);
  const auto camera_indices = indices_by_id(model.cameras);
  for (const io::ColmapImage& image : model.images) {
    const io::ColmapCamera& camera = model.cameras[camera_indices.at(image.camera)];
    bundle.images.push_back(
        {image.name,
         cameras.index(lens_of(camera, lenses), housing.port_of(image.name, image.camera)),
         image.pose});
  }
  const auto image_indices = indices_by_id(model.images);
  for (const io::ColmapPoint3D& point : model.points) {
    for (const io::ColmapTrackElement& element : point.track) {
      Observation observation;
      observation.image = image_indices.at(element.image);
      observation.point = bundle.points.size();
      observation.source = element.point2d;
      const std::size_t camera = bundle.images[observation.image].camera;
      const io::ColmapPoint2D& seen = model.images[observation.image].points.at(element.point2d);
      if (place(result.lenses[camera], bundle.cameras[camera].measured.lens, seen, observation))
        bundle.observations.push_back(observation);
      else
        ++result.unseen;
    }
    bundle.points.push_back({point.position, point.id});
  }
  return result;
}

void place_again(ColmapBundle& refined, const io::ColmapModel& model) {
  Bundle& bundle = refined.bundle;
  std::vector<io::ColmapCamera> lenses;
  std::vector<refractive::PinholeLens<double>> pinholes;
  for (std::size_t i = 0; i < refined.lenses.size(); ++i) {
    lenses.push_back(lens_now(refined, i));
    pinholes.push_back(bundle.cameras[i].now().lens);
  }
  for (Observation& observation : bundle.observations) {
    const std::size_t camera = bundle.images[observation.image].camera;
    const io::ColmapPoint2D& seen = model.images[observation.image].points[observation.source];
    if (place(lenses[camera], pinholes[camera], seen, observation))
      observation.pixel -= observation.pixel_by_focal * bundle.cameras[camera].change(kFocalNumber);
  }
}

PortFit port_fit(const io::ColmapModel& model) {
  const auto rms = [&](const io::Housing& housing) {
    Bundle bundle = to_bundle(model, model.cameras, housing).bundle;
    drop_repeated(bundle);
    return root_mean_square(reprojection_errors(bundle));
  };
  return {rms(io::housing_of(model.cameras)), rms({})};
}

io::ColmapModel to_model(const ColmapBundle& refined, const io::ColmapModel& model) {
  const Bundle& bundle = refined.bundle;
  io::ColmapModel result;
  for (std::size_t i = 0; i < refined.lenses.size(); ++i) {
    result.cameras.push_back(lens_now(refined, i));
    result.cameras[i].port = bundle.cameras[i].now().port;
  }
  result.images = model.images;
  for (std::size_t i = 0; i < result.images.size(); ++i) {
    result.images[i].pose = bundle.images[i].pose;
    result.images[i].camera = result.cameras[bundle.images[i].camera].id;
    for (io::ColmapPoint2D& point : result.images[i].points) point.point3d = io::kNoPoint3D;
  }
  const auto sources = indices_by_id(model.points);
  for (const BundlePoint& point : bundle.points) {
    io::ColmapPoint3D copy = model.points[sources.at(point.source)];
    copy.position = point.position;
    copy.track.clear();
    copy.error = 0;
    result.points.push_back(std::move(copy));
  }
  const std::vector<double> errors = reprojection_errors(bundle);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const Observation& observation = bundle.observations[i];
    io::ColmapPoint3D& point = result.points[observation.point];
    io::ColmapImage& image = result.images[observation.image];
    point.track.push_back({image.id, static_cast<std::uint32_t>(observation.source)});
    point.error += errors[i];
    image.points[observation.source].point3d = point.id;
  }
  for (io::ColmapPoint3D& point : result.points)
    if (!point.track.empty()) point.error /= static_cast<double>(point.track.size());
  const std::vector<std::size_t> seen = observations_by_image(bundle);
  std::size_t image = 0;
  std::erase_if(result.images, [&](const io::ColmapImage&) { return seen[image++] == 0; });
  return result;
}

io::Housing to_housing(const ColmapBundle& refined, const io::Housing& measured) {
  io::Housing housing;
  std::map<std::string, int> uses;
  for (const std::string& port : refined.ports) ++uses[port];
  for (std::size_t i = 0; i < refined.ports.size(); ++i) {
    const std::string& port = refined.ports[i];
    if (port == "none") continue;
    const BundleCamera& camera = refined.bundle.cameras[i];
    const bool own = uses[port] > 1 && !camera.change.isZero(0);
    const std::string name = own ? fmt::format("{}_{}", port, refined.lenses[i].id) : port;
    housing.ports[name] = io::to_housing_port(*camera.now().port);
    housing.cameras[refined.lenses[i].id] = name;
  }
  if (uses.size() == 1 && housing.ports.size() == 1 && measured.images.empty()) {
    housing.default_port = housing.ports.begin()->first;
    housing.cameras.clear();
  }
  return housing;
}

}  // namespace axial::pose
