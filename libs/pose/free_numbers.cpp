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

bool any_in_air(const Bundle& bundle) {
  return std::ranges::any_of(bundle.cameras,
                             [](const BundleCamera& camera) { return !camera.measured.port; });
}

void check_ports(const std::string& asked, const Words& words, const Bundle& bundle) {
  if (any_in_air(bundle) && words.size() > words.count("focal"))
    fail("{}: there are images in air, which have no port", asked);
  const bool of_flat = words.contains("normal") || words.contains("distance");
  if (of_flat && !any_behind<Flat>(bundle))
    fail("{}: there is a dome, which has a centre instead, and no flat port", asked);
  if (words.contains("centre") && !any_behind<Dome>(bundle))
    fail("{}: there is a flat port, which has a normal and a distance instead, and no dome", asked);
}

// Whether a camera's file states the standard deviation of this number of this kind of port.
template <class Kind>
bool any_states(const Bundle& bundle, int number) {
  return std::ranges::any_of(bundle.cameras, [&](const BundleCamera& camera) {
    return camera.measured.port && std::holds_alternative<Kind>(*camera.measured.port) &&
           camera.stated_sigma(number) > 0;
  });
}

bool is_distance_measured(const Sigmas& sigmas, const Bundle& bundle) {
  constexpr int kDistance = 2;
  return sigmas.distance > 0 || any_states<Flat>(bundle, kDistance);
}

bool is_thickness_measured(const Sigmas& sigmas, const Bundle& bundle) {
  return sigmas.thickness > 0 || any_states<Flat>(bundle, kThicknessNumber) ||
         any_states<Dome>(bundle, kThicknessNumber);
}

void check_known(const std::string& asked, const Words& words, const Sigmas& sigmas,
                 const Bundle& bundle, const AdjustOptions& adjust, SettingNames name_of) {
  const bool metric = adjust.points_known || adjust.poses_known || !adjust.distances.empty() ||
                      !adjust.positions.empty();
  if (words.contains("distance") && !is_distance_measured(sigmas, bundle) && !metric)
    fail(
        "{}: the distance needs {}, {} or {}, because the photographs show only its ratio to other "
        "lengths",
        asked, name_of("distance_sigma"), name_of("distances"), name_of("poses_known"));
  if (words.contains("thickness") && !is_thickness_measured(sigmas, bundle))
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

// `refine`: the setting that names or implies the words.
void check_sigmas(const Words& words, const Sigmas& sigmas, const std::string& refine,
                  SettingNames name_of) {
  check_sigma(words, "normal", sigmas.normal_degrees, name_of("normal_sigma"), refine);
  check_sigma(words, "distance", sigmas.distance, name_of("distance_sigma"), refine);
  check_sigma(words, "centre", sigmas.centre, name_of("centre_sigma"), refine);
  check_sigma(words, "thickness", sigmas.thickness, name_of("thickness_sigma"), refine);
  check_sigma(words, "index", sigmas.index, name_of("index_sigma"), refine);
  check_sigma(words, "focal", sigmas.focal, name_of("focal_sigma"), refine);
}

constexpr double kDegrees = 180 / std::numbers::pi;

// The standard deviations of one group of numbers in different cases.
struct GroupSigmas {
  double stated, if_free, if_fixed;
};

// The standard deviations of all numbers: `stated`, and where nothing is stated, `if_free` for free
// and `if_fixed` for fixed numbers.
struct AllSigmas {
  Sigmas stated, if_free, if_fixed;

  GroupSigmas of(double Sigmas::*group) const {
    return {stated.*group, if_free.*group, if_fixed.*group};
  }
};

// `scale`: factor from the unit of `sigmas` to that of housing_change.h.
void set(bool free, const GroupSigmas& sigmas, double scale,
         std::initializer_list<std::size_t> numbers, Unknowns& unknowns) {
  for (const std::size_t number : numbers) {
    unknowns.free[number] = free;
    unknowns.prior_sigma[number] = sigmas.stated * scale;
    unknowns.default_sigma[number] = (free ? sigmas.if_free : sigmas.if_fixed) * scale;
  }
}

// Sets the unknowns of `adjust` for the cameras of `bundle`.
void set_unknowns(const Words& words, const AllSigmas& sigmas, const Bundle& bundle,
                  AdjustOptions& adjust) {
  Unknowns flat, dome;
  const auto set_group = [&](const char* word, double Sigmas::*group, double scale,
                             std::initializer_list<std::size_t> numbers, Unknowns& unknowns) {
    set(words.contains(word), sigmas.of(group), scale, numbers, unknowns);
  };
  set_group("normal", &Sigmas::normal_degrees, 1 / kDegrees, {0, 1}, flat);
  set_group("distance", &Sigmas::distance, 1, {2}, flat);
  set_group("centre", &Sigmas::centre, 1, {0, 1, 2}, dome);
  for (Unknowns* const unknowns : {&flat, &dome}) {
    set_group("thickness", &Sigmas::thickness, 1, {kThicknessNumber}, *unknowns);
    set_group("index", &Sigmas::index, 1, {kIndexNumber}, *unknowns);
    set_group("focal", &Sigmas::focal, 1, {kFocalNumber}, *unknowns);
  }
  const bool domes = any_behind<Dome>(bundle), flats = any_behind<Flat>(bundle);
  static_cast<Unknowns&>(adjust) = flats || !domes ? flat : dome;
  adjust.of_domes.reset();
  if (domes && flats) adjust.of_domes = dome;
  adjust.of_air.reset();
  if (!any_in_air(bundle)) return;
  adjust.of_air.emplace();
  set_group("focal", &Sigmas::focal, 1, {kFocalNumber}, *adjust.of_air);
}

// All words that apply to the cameras. The thickness is among them if it was measured.
Words all_words(const Sigmas& sigmas, const Bundle& bundle) {
  Words words{"focal"};
  const bool flats = any_behind<Flat>(bundle), domes = any_behind<Dome>(bundle);
  if (flats || domes) words.insert("index");
  if (flats) words.insert({"normal", "distance"});
  if (domes) words.insert("centre");
  if (is_thickness_measured(sigmas, bundle)) words.insert("thickness");
  return words;
}

// The words of a list, after all checks.
Words listed_words(const std::string& refine, const Sigmas& sigmas, const Bundle& bundle,
                   const AdjustOptions& adjust, SettingNames name_of) {
  const std::string asked = name_of("refine") + " " + refine;
  const Words words = words_of(refine, asked);
  check_ports(asked, words, bundle);
  check_sigmas(words, sigmas, name_of("refine"), name_of);
  check_known(asked, words, sigmas, bundle, adjust, name_of);
  return words;
}

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
                        "standard deviation of the measured normal [degrees]; 0, here and in the "
                        "options below: not stated")
      .add_with_default("distance-sigma", &sigmas.distance,
                        "standard deviation of the distance [m]")
      .add_with_default("centre-sigma", &sigmas.centre, "standard deviation of a dome's centre [m]")
      .add_with_default("thickness-sigma", &sigmas.thickness,
                        "standard deviation of the thickness of the glass [m]")
      .add_with_default("index-sigma", &sigmas.index, "standard deviation of the water's index");
}

void set_free_numbers(const std::string& refine, const Sigmas& sigmas, const Bundle& bundle,
                      AdjustOptions& adjust, SettingNames name_of) {
  const Words words = listed_words(refine, sigmas, bundle, adjust, name_of);
  set_unknowns(words, {sigmas, {}, {}}, bundle, adjust);
}

Sigmas ruler_sigmas() {
  return {.normal_degrees = 3,
          .distance = 0.005,
          .centre = 0.005,
          .thickness = 0.0005,
          .index = 0.004,
          .focal = 0.005};
}

void set_estimated_numbers(const std::string& refine, const Sigmas& sigmas, const Bundle& bundle,
                           AdjustOptions& adjust, SettingNames name_of) {
  Sigmas if_fixed = ruler_sigmas();
  if_fixed.thickness = 0;
  const bool automatic = refine == "auto";
  Words words;
  if (automatic && !adjust.poses_known) words = all_words(sigmas, bundle);
  if (automatic || refine == "none")
    check_sigmas(words, sigmas, name_of("refine") + " " + refine, name_of);
  else
    words = listed_words(refine, sigmas, bundle, adjust, name_of);
  set_unknowns(words, {sigmas, automatic ? ruler_sigmas() : Sigmas{}, if_fixed}, bundle, adjust);
}

std::vector<FreeValue> free_values(const BundleCamera& camera, const HousingChange<double>& sigmas,
                                   const AdjustOptions& options) {
  const HousedCamera now = camera.now();
  std::vector<FreeValue> values, measured;
  if (now.port) values = std::visit(ValuesOfPort{}, *now.port);
  if (now.port) measured = std::visit(ValuesOfPort{}, *camera.measured.port);
  const double factor = std::exp(camera.change(kFocalNumber));
  const FreeValue focal{kFocalNumber, Quantity::focal, "focal length, factor", "", 1, 0, 1, 1, 0};
  measured.push_back(focal);
  values.push_back(focal);
  values.back().now = values.back().scale = factor;
  for (std::size_t i = 0; i < values.size(); ++i) {
    FreeValue& value = values[i];
    const auto number = static_cast<int>(value.number);
    value.sigma = sigmas(number) * value.scale;
    value.before = measured[i].now;
    value.sigma_before = options.sigma_before(camera, number) * measured[i].scale;
  }
  const auto& free = options.unknowns(camera).free;
  std::erase_if(values, [&](const FreeValue& value) { return !free[value.number]; });
  return values;
}

}  // namespace axial::pose
