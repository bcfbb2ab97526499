// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/colmap_bundle.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/error.h"
#include "io/colmap/colmap_lens.h"
#include "io/colmap/colmap_scene.h"
#include "lens/lens.h"
#include "pose/adjust/uncertainty.h"
#include "pose/bundle/tracks.h"

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

constexpr double kDegree = std::numbers::pi / 180;

// Whether photographs of two sizes have the same focal length in mm: one is a reduced or a cropped
// copy of the other.
bool is_same_lens(const io::ColmapCamera& a, const io::ColmapCamera& b) {
  constexpr double kAlike = 1e-3;
  const double ratio = a.params[0] / b.params[0];
  const auto is_one = [](double value) { return std::abs(value - 1) < kAlike; };
  return (a.width != b.width || a.height != b.height) &&
         (is_one(ratio) ||
          is_one(ratio * static_cast<double>(b.width) / static_cast<double>(a.width)));
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
    result_.bundle.cameras.push_back({{io::lens_of(lens), housing_.carried_port(port)},
                                      HousingChange<double>::Zero(),
                                      stated_sigma(lens, housing_, port),
                                      same_as(lens, port)});
    result_.lenses.push_back(lens);
    result_.lenses.back().id = static_cast<std::uint32_t>(result_.lenses.size());
    result_.ports.push_back(port);
  }

  // The first camera with this lens, at another size of the photographs, and this port.
  std::optional<std::size_t> same_as(const io::ColmapCamera& lens, const std::string& port) const {
    for (std::size_t i = 0; i < result_.ports.size(); ++i)
      if (result_.ports[i] == port && is_same_lens(result_.lenses[i], lens)) return i;
    return {};
  }

  ColmapBundle& result_;
  const io::Housing& housing_;
  std::map<std::pair<std::uint32_t, std::string>, std::size_t> indices_;
};

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

HousingChange<double> stated_sigma(const io::ColmapCamera& lens, const io::Housing& housing,
                                   const std::string& port) {
  HousingChange<double> sigma = HousingChange<double>::Zero();
  sigma(kFocalNumber) = lens.focal_sigma.value_or(0);
  const auto found = housing.sigmas.find(port);
  if (found == housing.sigmas.end()) return sigma;
  const io::PortSigmas& stated = found->second;
  if (stated.normal_degrees) sigma.head<2>() = kDegree * *stated.normal_degrees;
  if (stated.distance) sigma(2) = *stated.distance;
  if (stated.centre) sigma.head<3>() = *stated.centre;
  sigma(kIndexNumber) = stated.index.value_or(0);
  sigma(kThicknessNumber) = stated.thickness.value_or(0);
  return sigma;
}

io::PortSigmas port_sigmas(const refractive::Port<double>& port,
                           const HousingChange<double>& sigma) {
  io::PortSigmas stated;
  const auto positive = [&](int number) {
    return sigma(number) > 0 ? std::optional(sigma(number)) : std::nullopt;
  };
  if (std::holds_alternative<refractive::DomePort<double>>(port)) {
    if ((sigma.head<3>().array() > 0).all()) stated.centre = sigma.head<3>();
  } else {
    if ((sigma.head<2>().array() > 0).all()) stated.normal_degrees = sigma.head<2>() / kDegree;
    stated.distance = positive(2);
  }
  stated.index = positive(kIndexNumber);
  stated.thickness = positive(kThicknessNumber);
  return stated;
}

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
      const io::ColmapPoint2D& seen = model.images[observation.image].points.at(element.point2d);
      observation.pixel = {seen.x - 0.5, seen.y - 0.5};
      observation.size = seen.size;
      const BundleCamera& camera = bundle.cameras[bundle.images[observation.image].camera];
      if (direction_at(camera.measured.lens, observation.pixel))
        bundle.observations.push_back(observation);
      else
        ++result.unseen;
    }
    bundle.points.push_back({point.position, point.id});
  }
  return result;
}

PortFit port_fit(const io::ColmapModel& model) {
  const auto rms = [&](const io::Housing& housing) {
    Bundle bundle = to_bundle(model, model.cameras, housing).bundle;
    drop_repeated(bundle);
    return root_mean_square(reprojection_errors(bundle));
  };
  return {rms(io::housing_of(model.cameras)), rms({})};
}

std::vector<io::ColmapCamera> refined_cameras(const ColmapBundle& refined,
                                              std::span<const HousingChange<double>> sigmas) {
  std::vector<io::ColmapCamera> cameras;
  for (std::size_t i = 0; i < refined.lenses.size(); ++i) {
    io::ColmapCamera camera = lens_now(refined, i);
    camera.port = refined.bundle.cameras[i].now().port;
    camera.focal_sigma.reset();
    if (!sigmas.empty() && sigmas[i](kFocalNumber) > 0)
      camera.focal_sigma = sigmas[i](kFocalNumber);
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

io::ColmapModel to_model(const ColmapBundle& refined, const io::ColmapModel& model,
                         std::span<const HousingChange<double>> sigmas) {
  const Bundle& bundle = refined.bundle;
  io::ColmapModel result;
  result.cameras = refined_cameras(refined, sigmas);
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

io::Housing to_housing(const ColmapBundle& refined, const io::Housing& measured,
                       std::span<const HousingChange<double>> sigmas) {
  io::Housing housing;
  std::map<std::string, int> uses;  // cameras with changes of their own
  for (std::size_t i = 0; i < refined.ports.size(); ++i)
    uses[refined.ports[i]] += refined.bundle.cameras[i].same_as ? 0 : 1;
  for (std::size_t i = 0; i < refined.ports.size(); ++i) {
    const std::string& port = refined.ports[i];
    if (port == "none") continue;
    const BundleCamera& camera = refined.bundle.cameras[i];
    const bool own = uses[port] > 1 && !camera.change.isZero(0);
    const std::size_t owner = camera.same_as.value_or(i);
    const std::string name = own ? fmt::format("{}_{}", port, refined.lenses[owner].id) : port;
    housing.ports[name] = io::to_housing_port(*camera.now().port);
    housing.cameras[refined.lenses[i].id] = name;
    const io::PortSigmas stated =
        sigmas.empty() ? io::PortSigmas{} : port_sigmas(*camera.now().port, sigmas[i]);
    if (!stated.empty()) housing.sigmas[name] = stated;
  }
  if (uses.size() == 1 && housing.ports.size() == 1 && measured.images.empty()) {
    housing.default_port = housing.ports.begin()->first;
    housing.cameras.clear();
  }
  return housing;
}

std::vector<HousingChange<double>> present_sigmas(const Bundle& bundle,
                                                  const AdjustOptions& options,
                                                  const Uncertainty* known) {
  constexpr double kLeast = 1e-12, kLargest = 1;  // that files may state
  std::vector<HousingChange<double>> sigmas;
  for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
    HousingChange<double> sigma = bundle.cameras[i].stated_sigma;
    const auto& free = options.unknowns(bundle.cameras[i]).free;
    for (int k = 0; k < kHousingNumbers; ++k) {
      if (!free[static_cast<std::size_t>(k)]) continue;
      const double found = known && k != kIndexNumber ? known->camera_sigmas[i](k) : 0;
      sigma(k) = found >= kLeast && found <= kLargest ? found : 0;
    }
    sigmas.push_back(sigma);
  }
  return sigmas;
}

}  // namespace axial::pose
