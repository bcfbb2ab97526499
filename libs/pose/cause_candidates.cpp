// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/cause_candidates.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "pose/housing_change.h"

namespace axial::pose {
namespace {

constexpr double kDegreesOfRadian = 180 / std::numbers::pi;
constexpr double kSmall = 1e-5;  // step to each side, in metres, radians or as a relative change
constexpr double kPixels = 1e-2;

using Flat = refractive::FlatPort<double>;
using Dome = refractive::DomePort<double>;

class List {
 public:
  explicit List(const CameraModel& camera) : camera_(camera) {}

  // Adds a number and, with `alone`, a candidate of this number. `change(model, by)` changes the
  // number of `model` by `by`, in the unit divided by `scale`.
  template <class Change>
  std::size_t add(const char* name, const char* unit, double stated, double scale, double step,
                  const Change& change, bool alone = true) {
    CandidateNumber number{name, unit, stated * scale, camera_, camera_, 2 * step * scale};
    change(number.low, -step);
    change(number.high, step);
    all_.numbers.push_back(std::move(number));
    if (alone) all_.candidates.push_back({name, {all_.numbers.size() - 1}});
    return all_.numbers.size() - 1;
  }

  // A number of the port, with its index in HousingChange.
  std::size_t add_housing(const char* name, const char* unit, double stated, double scale,
                          int number, bool alone = true) {
    return add(
        name, unit, stated, scale, kSmall,
        [&](CameraModel& model, double by) {
          HousingChange<double> change = HousingChange<double>::Zero();
          change(number) = by;
          std::visit([&](auto& port) { port = with_change(port, change); }, *model.port);
        },
        alone);
  }

  void together(const char* name, std::vector<std::size_t> numbers) {
    all_.candidates.push_back({name, std::move(numbers)});
  }

  Candidates take() { return std::move(all_); }

 private:
  const CameraModel& camera_;
  Candidates all_;
};

void add_port(const Flat& port, List& list) {
  const Eigen::Vector3d& n = port.normal;
  const auto x = list.add_housing("normal to the right", "degrees", std::atan2(n.x(), n.z()),
                                  kDegreesOfRadian, 0, false);
  const auto y = list.add_housing("normal downwards", "degrees", std::atan2(n.y(), n.z()),
                                  kDegreesOfRadian, 1, false);
  list.together("normal of the port", {x, y});
  list.add_housing(kDistanceName, "mm", port.distance, 1e3, 2);
  list.add_housing(kThicknessName, "mm", port.thickness, 1e3, kThicknessNumber);
  list.add_housing(kIndexName, "", port.n_water, 1, kIndexNumber);
}

void add_port(const Dome& port, List& list) {
  std::vector<std::size_t> centre;
  const char* const names[] = {"x of the dome's centre", "y of the dome's centre",
                               "z of the dome's centre"};
  for (int k = 0; k < 3; ++k)
    centre.push_back(list.add_housing(names[k], "mm", port.centre[k], 1e3, k));
  list.together("centre of the dome", centre);
  list.add(kRadiusName, "mm", port.inner_radius, 1e3, kSmall,
           [](CameraModel& model, double by) { std::get<Dome>(*model.port).inner_radius += by; });
  list.add_housing(kThicknessName, "mm", port.thickness, 1e3, kThicknessNumber);
  list.add_housing(kIndexName, "", port.n_water, 1, kIndexNumber);
}

// A flat port at the lens, of no thickness. It has no effect if the index is 1, the lowest value.
void add_missing_port(std::size_t focal, List& list) {
  const auto index = list.add(
      kIndexName, "", 1, 1, kSmall,
      [](CameraModel& model, double by) {
        model.port = Flat{{0, 0, 1}, 1e-9, 0, 1, 1, 1 + kSmall + by};
      },
      false);
  list.together("a port that is not modelled", {index, focal});
}

}  // namespace

Candidates candidates_of(const CameraModel& camera) {
  List list(camera);
  if (camera.port) std::visit([&](const auto& port) { add_port(port, list); }, *camera.port);
  const refractive::PinholeLens<double>& lens = camera.lens;
  const auto focal =
      list.add(kFocalName, "px", lens.fx, 1, kSmall * lens.fx, [](CameraModel& model, double by) {
        const double factor = 1 + by / model.lens.fx;
        model.lens.fx *= factor;
        model.lens.fy *= factor;
      });
  const auto x = list.add(
      "principal point x", "px", lens.cx, 1, kPixels,
      [](CameraModel& model, double by) { model.lens.cx += by; }, false);
  const auto y = list.add(
      "principal point y", "px", lens.cy, 1, kPixels,
      [](CameraModel& model, double by) { model.lens.cy += by; }, false);
  list.together("principal point", {x, y});
  if (!camera.port) add_missing_port(focal, list);
  return list.take();
}

}  // namespace axial::pose
