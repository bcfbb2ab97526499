// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/pixel_width.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/order_statistics.h"
#include "base/parallel.h"
#include "geometry/faces.h"
#include "geometry/posed_camera.h"
#include "scene/any_camera.h"

namespace axial::map {
namespace {

struct Place {
  Eigen::Vector3d point, normal;
};

// Points at equal steps of the summed area of the faces. Inside a face, a point lies at the golden
// ratio's multiples, which spread evenly.
std::vector<Place> places_on(const Mesh& mesh, int count) {
  std::vector<double> until;  // area of the faces up to and with this one
  until.reserve(mesh.faces.size());
  double area = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    until.push_back(area += 0.5 * geometry::area_vector(mesh, f).norm());
  std::vector<Place> places;
  if (!(area > 0)) return places;
  for (int i = 0; i < count; ++i) {
    const auto at = std::ranges::upper_bound(until, (i + 0.5) / count * area);
    const auto f = static_cast<std::size_t>(std::min(at - until.begin(), std::ssize(until) - 1));
    double s = std::fmod(0.7548776662466927 * i, 1), t = std::fmod(0.5698402909980532 * i, 1);
    if (s + t > 1) s = 1 - s, t = 1 - t;
    const auto [a, b, c] = geometry::corners_of(mesh, f);
    const Eigen::Vector3d u = b - a, v = c - a;
    places.push_back({a + s * u + t * v, u.cross(v).normalized()});
  }
  return places;
}

struct Look {
  double quality = 0, area = 0;  // `area`: of the image of a unit of surface [px^2/m^2]
};

Look look_at(const Place& place, const PosedCamera& photo, const AnyCamera<double>& camera) {
  refractive::Matrix23<double> jacobian;
  Eigen::Vector3d origin;
  const Eigen::Vector3d x = photo.pose.to_camera(place.point);
  const auto image = camera.project(x, &jacobian, &origin);
  if (!image.visible || !geometry::is_in_image(photo.camera, image.pixel, 0)) return {};
  const Eigen::Vector3d normal = photo.pose.rotation * place.normal;
  const double cosine = normal.dot((origin - x).normalized());
  if (!(cosine > 0)) return {};
  const Eigen::Vector3d u = normal.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> surface;
  surface << u, normal.cross(u);
  const double area = std::abs((jacobian * surface).determinant());
  return {area * cosine * cosine, area};
}

}  // namespace

double median_pixel_width(const Mesh& mesh, std::span<const PosedCamera> photos, int places) {
  std::vector<AnyCamera<double>> cameras;
  for (const PosedCamera& photo : photos) cameras.emplace_back(make_camera<double>(photo.camera));
  const std::vector<Place> all = places_on(mesh, places);
  std::vector<double> areas(all.size());
  parallel_for(all.size(), [&](std::size_t i) {
    Look best;
    for (std::size_t v = 0; v < photos.size(); ++v) {
      const Look look = look_at(all[i], photos[v], cameras[v]);
      if (look.quality > best.quality) best = look;
    }
    areas[i] = best.area;
  });
  std::erase_if(areas, [](double area) { return !(area > 0); });
  if (areas.empty()) fail("no photograph shows the mesh");
  return 1 / std::sqrt(upper_median(std::move(areas)));
}

std::uint64_t bytes_of_pixel_width(const Mesh& mesh) {
  return mesh.faces.size() * sizeof(double);
}

double rounded_width(double width) {
  const int digits = 1 - static_cast<int>(std::floor(std::log10(width)));  // behind the point
  const double power = std::pow(10.0, std::abs(digits));
  return digits >= 0 ? std::round(width * power) / power : std::round(width / power) * power;
}

}  // namespace axial::map
