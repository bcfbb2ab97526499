// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/hypotheses.h"

#include <algorithm>
#include <utility>

namespace axial::diagnosis {
namespace {

using pose::HousingNumber;
using pose::Quantity;

constexpr double kSmall = 1e-5;  // step to each side, in metres, radians or as a relative change
constexpr double kPixels = 1e-2;

class List {
 public:
  explicit List(const CameraModel& camera) : camera_(camera) {}

  // Adds a number and, with `alone`, a hypothesis of this number. `change(model, by)` changes the
  // number of `model` by `by`, in the unit divided by the number's scale.
  template <class Change>
  std::size_t add(HousingNumber number, double step, const Change& change, bool alone = true) {
    NumberStep added{std::move(number), camera_, camera_, 0};
    added.step = 2 * step * added.number.scale;
    change(added.low, -step);
    change(added.high, step);
    all_.numbers.push_back(std::move(added));
    const std::size_t index = all_.numbers.size() - 1;
    if (alone) together(all_.numbers[index].number.title, {index});
    return index;
  }

  void together(std::string name, std::vector<std::size_t> numbers) {
    all_.hypotheses.push_back({std::move(name), std::move(numbers)});
  }

  Hypotheses take() { return std::move(all_); }

 private:
  const CameraModel& camera_;
  Hypotheses all_;
};

// A number that housing_change.h does not have.
HousingNumber other_number(Quantity quantity, const char* title, const char* unit, double scale,
                           double value) {
  return {0, quantity, title, title, unit, scale, 0, value, 0, value, 0, 0};
}

// The numbers of a group. The tilts of a normal are not wrong alone.
void add_group(const pose::NumberGroup& group, const std::vector<HousingNumber>& numbers,
               List& list) {
  std::vector<std::size_t> members;
  for (const HousingNumber& number : numbers) {
    if (number.number < group.first || number.number >= group.first + group.count) continue;
    members.push_back(list.add(
        number, kSmall,
        [&](CameraModel& model, double by) {
          pose::HousingChange<double> change = pose::HousingChange<double>::Zero();
          change(static_cast<Eigen::Index>(number.number)) = by;
          std::visit([&](auto& port) { port = pose::with_change(port, change); }, *model.port);
        },
        number.quantity != Quantity::angle));
  }
  if (members.size() > 1) list.together(std::string(group.title), members);
}

void add_radius(double radius, List& list) {
  using Dome = refractive::DomePort<double>;
  list.add(other_number(Quantity::radius, "radius of the dome", "mm", 1e3, radius * 1e3), kSmall,
           [](CameraModel& model, double by) { std::get<Dome>(*model.port).inner_radius += by; });
}

void add_port(const refractive::Port<double>& port, List& list) {
  const std::vector<HousingNumber> numbers = pose::port_numbers(port);
  for (const pose::NumberGroup& group : pose::number_groups()) {
    if (group.of_air || !group.applies(pose::kind_of(port))) continue;
    add_group(group, numbers, list);
    const auto* const dome = std::get_if<refractive::DomePort<double>>(&port);
    if (dome && group.first == 0) add_radius(dome->inner_radius, list);
  }
}

// Returns the index of the focal length.
std::size_t add_lens(const refractive::PinholeLens<double>& lens, List& list) {
  const auto focal = list.add(other_number(Quantity::focal, "focal length", "px", 1, lens.fx),
                              kSmall * lens.fx, [](CameraModel& model, double by) {
                                const double factor = 1 + by / model.lens.fx;
                                model.lens.fx *= factor;
                                model.lens.fy *= factor;
                              });
  const auto x = list.add(
      other_number(Quantity::point, "principal point x", "px", 1, lens.cx), kPixels,
      [](CameraModel& model, double by) { model.lens.cx += by; }, false);
  const auto y = list.add(
      other_number(Quantity::point, "principal point y", "px", 1, lens.cy), kPixels,
      [](CameraModel& model, double by) { model.lens.cy += by; }, false);
  list.together("principal point", {x, y});
  return focal;
}

// A flat port at the lens, of no thickness. It has no effect if the index is 1, the lowest value.
void add_missing_port(std::size_t focal, List& list) {
  const auto index = list.add(
      other_number(Quantity::index, "index of the water", "", 1, 1), kSmall,
      [](CameraModel& model, double by) {
        model.port = refractive::FlatPort<double>{{0, 0, 1}, 1e-9, 0, 1, 1, 1 + kSmall + by};
      },
      false);
  list.together("a port that is not modelled", {index, focal});
}

}  // namespace

std::vector<pose::NumberGroup> groups_to_free(pose::PortKind kind) {
  std::vector<pose::NumberGroup> groups;
  std::ranges::copy_if(pose::number_groups(), std::back_inserter(groups),
                       [&](const pose::NumberGroup& group) {
                         return group.applies(kind) && group.first != pose::kThicknessNumber;
                       });
  return groups;
}

Hypotheses hypotheses_of(const CameraModel& camera) {
  List list(camera);
  if (camera.port) add_port(*camera.port, list);
  const std::size_t focal = add_lens(camera.lens, list);
  if (!camera.port) add_missing_port(focal, list);
  return list.take();
}

}  // namespace axial::diagnosis
