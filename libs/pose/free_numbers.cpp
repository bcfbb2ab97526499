// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/free_numbers.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

#include "base/error.h"

namespace axial::pose {
namespace {

using Words = std::set<std::string>;
using Flat = refractive::FlatPort<double>;
using Dome = refractive::DomePort<double>;

// In the functions below, `asked` is the list with its name, for messages.

Words words_of(const std::string& list, const std::string& asked) {
  const Words known{"normal", "distance", "centre", "thickness", "index", "focal"};
  Words words;
  std::istringstream in(list);
  for (std::string word; std::getline(in, word, ',');) {
    if (word == "center") word = "centre";
    if (!known.contains(word))
      fail("{}: '{}' is not one of normal, distance, centre, thickness, index, focal", asked, word);
    words.insert(word);
  }
  return words;
}

template <class Kind>
bool any_behind(const Bundle& bundle) {
  return std::ranges::any_of(bundle.cameras, [](const BundleCamera& camera) {
    return camera.measured.port && std::holds_alternative<Kind>(*camera.measured.port);
  });
}

bool all_behind_domes(const Bundle& bundle) {
  return std::ranges::all_of(bundle.cameras, [](const BundleCamera& camera) {
    return camera.measured.port && std::holds_alternative<Dome>(*camera.measured.port);
  });
}

void check_ports(const std::string& asked, const Words& words, const Bundle& bundle) {
  const bool in_air = std::ranges::any_of(
      bundle.cameras, [](const BundleCamera& camera) { return !camera.measured.port; });
  if (in_air && words.size() > words.count("focal"))
    fail("{}: there are images in air, which have no port", asked);
  const bool of_flat = words.contains("normal") || words.contains("distance");
  if (of_flat && !any_behind<Flat>(bundle))
    fail("{}: there is a dome, which has a centre instead, and no flat port", asked);
  if (words.contains("centre") && !any_behind<Dome>(bundle))
    fail("{}: there is a flat port, which has a normal and a distance instead, and no dome", asked);
}

void check_known(const std::string& asked, const Words& words, const Sigmas& sigmas,
                 const AdjustOptions& adjust, SettingNames name_of) {
  const bool metric = adjust.points_known || adjust.poses_known || !adjust.distances.empty() ||
                      !adjust.positions.empty();
  if (words.contains("distance") && !(sigmas.distance > 0) && !metric)
    fail(
        "{}: the distance needs {}, {} or {}, because the photographs show only its ratio to other "
        "lengths",
        asked, name_of("distance_sigma"), name_of("distances"), name_of("poses_known"));
  if (words.contains("thickness") && !(sigmas.thickness > 0))
    fail("{}: the thickness needs {}, because photographs hardly distinguish it from the distance",
         asked, name_of("thickness_sigma"));
}

// `setting` and `refine` are the names of the settings in messages.
void check_sigma(const Words& words, const std::string& word, double sigma,
                 const std::string& setting, const std::string& refine) {
  constexpr double kLeast = 1e-12;  // far below any measurement; its inverse square is finite
  if (!(sigma >= 0 && std::isfinite(sigma))) fail("{} {}: must be 0 or more", setting, sigma);
  if (sigma > 0 && sigma < kLeast) fail("{} {}: must be 0, or {} or more", setting, sigma, kLeast);
  if (sigma > 0 && !words.contains(word))
    fail("{} {}: {} does not name {}", setting, sigma, refine, word);
}

void check_sigmas(const Words& words, const Sigmas& sigmas, SettingNames name_of) {
  const std::string refine = name_of("refine");
  check_sigma(words, "normal", sigmas.normal_degrees, name_of("normal_sigma"), refine);
  check_sigma(words, "distance", sigmas.distance, name_of("distance_sigma"), refine);
  check_sigma(words, "centre", sigmas.centre, name_of("centre_sigma"), refine);
  check_sigma(words, "thickness", sigmas.thickness, name_of("thickness_sigma"), refine);
  check_sigma(words, "index", sigmas.index, name_of("index_sigma"), refine);
  check_sigma(words, "focal", sigmas.focal, name_of("focal_sigma"), refine);
}

void set(const Words& words, const std::string& word, double sigma, double scale,
         std::initializer_list<std::size_t> numbers, Unknowns& unknowns) {
  if (!words.contains(word)) return;
  for (const std::size_t number : numbers) {
    unknowns.free[number] = true;
    unknowns.prior_sigma[number] = sigma * scale;
  }
}

constexpr double kDegrees = 180 / std::numbers::pi;

struct PlaceWords {
  const char* operator()(const Flat&) const { return "normal,distance"; }
  const char* operator()(const Dome&) const { return "centre"; }
};

struct ValuesOfPort {
  std::vector<FreeValue> operator()(const Flat& port) const {
    const double tilt_x = std::atan2(port.normal.x(), port.normal.z()) * kDegrees;
    const double tilt_y = std::atan2(port.normal.y(), port.normal.z()) * kDegrees;
    return {
        {0, Quantity::angle, "normal to the right", "degrees", tilt_x, 0, kDegrees},
        {1, Quantity::angle, "normal downwards", "degrees", tilt_y, 0, kDegrees},
        {2, Quantity::place, "distance", "mm", port.distance * 1e3, 0, 1e3},
        {kIndexNumber, Quantity::index, "index of water", "", port.n_water, 0, 1},
        {kThicknessNumber, Quantity::thickness, "thickness", "mm", port.thickness * 1e3, 0, 1e3}};
  }
  std::vector<FreeValue> operator()(const Dome& port) const {
    return {
        {0, Quantity::place, "centre x", "mm", port.centre.x() * 1e3, 0, 1e3},
        {1, Quantity::place, "centre y", "mm", port.centre.y() * 1e3, 0, 1e3},
        {2, Quantity::place, "centre z", "mm", port.centre.z() * 1e3, 0, 1e3},
        {kIndexNumber, Quantity::index, "index of water", "", port.n_water, 0, 1},
        {kThicknessNumber, Quantity::thickness, "thickness", "mm", port.thickness * 1e3, 0, 1e3}};
  }
};

}  // namespace

std::string place_words(const refractive::Port<double>& port) {
  return std::visit(PlaceWords{}, port);
}

void declare_sigmas(OptionList& list, Sigmas& sigmas) {
  list.add_with_default("normal-sigma", &sigmas.normal_degrees,
                        "standard deviation of the measured normal [degrees]; 0: not measured")
      .add_with_default("distance-sigma", &sigmas.distance,
                        "standard deviation of the distance [m]")
      .add_with_default("centre-sigma", &sigmas.centre, "standard deviation of a dome's centre [m]")
      .add_with_default("thickness-sigma", &sigmas.thickness,
                        "standard deviation of the thickness of the glass [m]")
      .add_with_default("index-sigma", &sigmas.index, "standard deviation of the water's index");
}

void set_free_numbers(const std::string& refine, const Sigmas& sigmas, const Bundle& bundle,
                      AdjustOptions& adjust, SettingNames name_of) {
  const std::string asked = name_of("refine") + " " + refine;
  const Words words = words_of(refine, asked);
  check_ports(asked, words, bundle);
  check_sigmas(words, sigmas, name_of);
  Unknowns flat, dome;
  set(words, "normal", sigmas.normal_degrees, 1 / kDegrees, {0, 1}, flat);
  set(words, "distance", sigmas.distance, 1, {2}, flat);
  set(words, "centre", sigmas.centre, 1, {0, 1, 2}, dome);
  for (Unknowns* const unknowns : {&flat, &dome}) {
    set(words, "thickness", sigmas.thickness, 1, {kThicknessNumber}, *unknowns);
    set(words, "index", sigmas.index, 1, {kIndexNumber}, *unknowns);
    set(words, "focal", sigmas.focal, 1, {kFocalNumber}, *unknowns);
  }
  const bool domes = any_behind<Dome>(bundle), others = !all_behind_domes(bundle);
  static_cast<Unknowns&>(adjust) = others ? flat : dome;
  adjust.of_domes.reset();
  if (domes && others) adjust.of_domes = dome;
  check_known(asked, words, sigmas, adjust, name_of);
}

std::vector<FreeValue> free_values(const BundleCamera& camera, const HousingChange<double>& sigmas,
                                   const AdjustOptions& options) {
  const HousedCamera now = camera.now();
  std::vector<FreeValue> values;
  if (now.port) values = std::visit(ValuesOfPort{}, *now.port);
  const double factor = std::exp(camera.change(kFocalNumber));
  values.push_back({kFocalNumber, Quantity::focal, "focal length, factor", "", factor, 0, factor});
  const auto& free = options.unknowns(camera).free;
  std::erase_if(values, [&](const FreeValue& value) { return !free[value.number]; });
  for (FreeValue& value : values)
    value.sigma = sigmas(static_cast<Eigen::Index>(value.number)) * value.scale;
  return values;
}

}  // namespace axial::pose
