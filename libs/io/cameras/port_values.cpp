// SPDX-License-Identifier: GPL-3.0-or-later
#include "cameras/private/port_values.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace axial::io {
namespace {

using refractive::DomePort;
using refractive::FlatPort;

// From fresh water in red light to the saltiest sea in blue light: 1.33 to 1.36.
constexpr double kLeastWater = 1.30, kMostWater = 1.40;
// Fused silica has 1.46, acrylic 1.49, sapphire 1.77, the densest optical glass 2.0.
constexpr double kLeastGlass = 1.30, kMostGlass = 2.00;
constexpr double kMostDegrees = 30;
// In the clearest water divers see dark objects at 40 m and more, but photographs for matching are
// taken from much nearer.
constexpr double kFarthest = 25;

void check_range(double value, const char* field, double least, double most,
                 const std::string& where, const char* of, const Context& context) {
  if (!(value >= least && value <= most))
    context.warning("{}.{} is {}, but {} has {:.2f} to {:.2f}", where, field, value, of, least,
                    most);
}

template <class Port>
bool does_nothing(const Port& port) {
  return port.n_air == 1 && port.n_glass == 1 && port.n_water == 1;
}

template <class Port>
void check_indices(const Port& port, const std::string& where, const Context& context) {
  check_range(port.n_glass, "n_glass", kLeastGlass, kMostGlass, where, "the glass of ports",
              context);
  check_range(port.n_water, "n_water", kLeastWater, kMostWater, where, "water", context);
}

struct Values {
  const std::string& where;
  const Context& context;

  void operator()(const FlatPort<double>& port) const {
    if (does_nothing(port)) return;
    check_indices(port, where, context);
    const double degrees =
        std::acos(std::clamp(port.normal.z(), -1.0, 1.0)) * 180 / std::numbers::pi;
    if (degrees > kMostDegrees)
      context.warning(
          "{}.normal is [{}, {}, {}], {:.0f} degrees from the optical axis, but ports are "
          "mounted within {:.0f}",
          where, port.normal.x(), port.normal.y(), port.normal.z(), degrees, kMostDegrees);
  }
  void operator()(const DomePort<double>& port) const {
    if (!does_nothing(port)) check_indices(port, where, context);
  }
  void operator()(const WaterSurface& surface) const {
    check_range(surface.n_water, "n_water", kLeastWater, kMostWater, where, "water", context);
  }
};

// Distances of one observed point and of the port, along the port's normal or from the dome's
// centre [m].
struct Reach {
  double point = 0;  // distance of the point
  double inner = 0;  // inner and outer face of the glass
  double outer = 0;
};

Reach reach(const FlatPort<double>& port, const Eigen::Vector3d& x) {
  return {port.normal.dot(x), port.distance, port.distance + port.thickness};
}

Reach reach(const DomePort<double>& port, const Eigen::Vector3d& x) {
  // Points behind the camera would also count as far from the centre; the caller leaves them out.
  return {(x - port.centre).norm(), port.inner_radius, port.inner_radius + port.thickness};
}

// Counts of the observations through one port.
struct Observed {
  std::size_t all = 0, before_glass = 0, before_water = 0, far = 0;

  void add(const Reach& reach) {
    ++all;
    before_glass += reach.point <= reach.inner ? 1 : 0;
    before_water += reach.point <= reach.outer ? 1 : 0;
    far += reach.point - reach.outer > kFarthest ? 1 : 0;
  }
  bool is_half(std::size_t part) const { return all > 0 && 2 * part > all; }
};

struct SceneCheck {
  const Observed& seen;
  const std::string& where;
  const Context& context;

  void operator()(const FlatPort<double>& port) const {
    glass("distance_m", port.distance, port.thickness);
  }
  void operator()(const DomePort<double>& port) const {
    glass("inner_radius_m", port.inner_radius, port.thickness);
  }
  // Does not print the point, because it may be in the scene's local frame and not as in the file.
  void operator()(const WaterSurface&) const {
    if (seen.is_half(seen.before_water))
      context.warning(
          "{}.point_m or normal is wrong: {} of {} observations are of sparse points above that "
          "water surface",
          where, seen.before_water, seen.all);
    far(where + ".point_m or the scale is wrong:");
  }

  void glass(const char* field, double length, double thickness) const {
    const char* const hint = "check that port and poses are in metres";
    if (seen.is_half(seen.before_glass))
      context.warning(
          "{}.{} is {}, but {} of {} observations are of sparse points before the glass: {}", where,
          field, length, seen.before_glass, seen.all, hint);
    else if (seen.is_half(seen.before_water))
      context.warning(
          "{}.thickness_m is {}, but {} of {} observations are of sparse points inside or before "
          "the glass: {}",
          where, thickness, seen.before_water, seen.all, hint);
    far(fmt::format("{}.{} is {}, but", where, field, length));
  }

  void far(const std::string& what) const {
    if (seen.is_half(seen.far))
      context.warning(
          "{} {} of {} observations are of sparse points more than {:.0f} m of water away: check "
          "that the poses are in metres",
          what, seen.far, seen.all, kFarthest);
  }
};

}  // namespace

void warn_of_port_values(const HousingPort& port, const std::string& where,
                         const Context& context) {
  std::visit(Values{where, context}, port);
}

void warn_of_ports_in_scene(const Scene& scene, const Housing& housing, const std::string& file,
                            const Context& context) {
  std::map<std::string, Observed> ports;
  std::vector<Observed*> of_image(scene.images.size(), nullptr);
  for (std::size_t i = 0; i < scene.images.size(); ++i)
    if (scene.images[i].camera.port) of_image[i] = &ports[scene.images[i].port_name];
  for (const SparsePoint& point : scene.points) {
    if (!point.position.allFinite()) continue;
    for (const SparseView& view : point.views) {
      if (view.image >= of_image.size() || !of_image[view.image]) continue;
      const SceneImage& image = scene.images[view.image];
      const Eigen::Vector3d x = image.pose.to_camera(point.position.cast<double>());
      if (x.z() > 0)
        of_image[view.image]->add(
            std::visit([&](const auto& port) { return reach(port, x); }, *image.camera.port));
    }
  }
  for (const auto& [name, seen] : ports)
    if (const auto port = housing.ports.find(name); port != housing.ports.end()) {
      const std::string where = fmt::format("{}: housing.ports.{}", file, name);
      std::visit(SceneCheck{seen, where, context}, port->second);
    }
}

}  // namespace axial::io
