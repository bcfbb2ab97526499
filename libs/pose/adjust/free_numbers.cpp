// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust/free_numbers.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

#include "base/error.h"

namespace axial::pose {
namespace {

using Words = std::set<std::string>;

// In the functions below, `asked` is the list with its name, for messages.

Words words_of(const std::string& list, const std::string& asked) {
  Words words;
  std::istringstream in(list);
  for (std::string word; std::getline(in, word, ',');) {
    if (word == "center") word = "centre";
    if (std::ranges::find(number_groups(), word, &NumberGroup::word) == number_groups().end())
      fail("{}: '{}' is not one of normal, distance, centre, thickness, index, focal", asked, word);
    words.insert(word);
  }
  return words;
}

// Whether the bundle has a camera with a port of this kind.
bool has(const Bundle& bundle, PortKind kind) {
  return std::ranges::any_of(bundle.cameras, [&](const BundleCamera& camera) {
    return kind_of(camera.measured.port) == kind;
  });
}

void check_ports(const std::string& asked, const Words& words, const Bundle& bundle) {
  if (has(bundle, PortKind::none) && words.size() > words.count("focal"))
    fail("{}: there are images in air, which have no port", asked);
  const bool of_flat = words.contains("normal") || words.contains("distance");
  if (of_flat && !has(bundle, PortKind::flat))
    fail("{}: there is a dome, which has a centre instead, and no flat port", asked);
  if (words.contains("centre") && !has(bundle, PortKind::dome))
    fail("{}: there is a flat port, which has a normal and a distance instead, and no dome", asked);
}

// Whether the standard deviation of the group is known: from `sigmas`, or from a camera's file.
bool is_measured(const NumberGroup& group, const Sigmas& sigmas, const Bundle& bundle) {
  return sigmas.*group.sigma > 0 ||
         std::ranges::any_of(bundle.cameras, [&](const BundleCamera& camera) {
           return group.applies(kind_of(camera.measured.port)) &&
                  camera.stated_sigma(static_cast<int>(group.first)) > 0;
         });
}

const NumberGroup& group_named(std::string_view word) {
  return *std::ranges::find(number_groups(), word, &NumberGroup::word);
}

void check_known(const std::string& asked, const Words& words, const Sigmas& sigmas,
                 const Bundle& bundle, const AdjustOptions& adjust) {
  const bool metric = adjust.points_known || adjust.poses_known || adjust.know_lengths();
  if (words.contains("distance") && !is_measured(group_named("distance"), sigmas, bundle) &&
      !metric)
    fail(
        "{}: the distance needs {}, {} or {}, because the photographs show only its ratio to other "
        "lengths",
        asked, setting("distance_sigma"), setting("distances"), setting("poses_known"));
  if (words.contains("thickness") && !is_measured(group_named("thickness"), sigmas, bundle))
    fail("{}: the thickness needs {}, because photographs hardly distinguish it from the distance",
         asked, setting("thickness_sigma"));
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
void check_sigmas(const Words& words, const Sigmas& sigmas, const std::string& refine) {
  for (const NumberGroup& group : number_groups())
    check_sigma(words, std::string(group.word), sigmas.*group.sigma, setting(group.setting),
                refine);
}

// The standard deviations of all numbers: `stated`, and where nothing is stated, `if_free` for free
// and `if_fixed` for fixed numbers.
struct AllSigmas {
  Sigmas stated, if_free, if_fixed;
};

// The unknowns of a camera with a port of this kind.
Unknowns unknowns_of(PortKind kind, const Words& words, const AllSigmas& sigmas) {
  Unknowns unknowns;
  for (const NumberGroup& group : number_groups()) {
    if (!group.applies(kind)) continue;
    const bool free = words.contains(std::string(group.word));
    const Sigmas& otherwise = free ? sigmas.if_free : sigmas.if_fixed;
    for (std::size_t k = group.first; k < group.first + group.count; ++k) {
      unknowns.free[k] = free;
      unknowns.prior_sigma[k] = sigmas.stated.*group.sigma * group.scale;
      unknowns.default_sigma[k] = otherwise.*group.sigma * group.scale;
    }
  }
  return unknowns;
}

// Sets the unknowns of `adjust` for the cameras of `bundle`.
void set_unknowns(const Words& words, const AllSigmas& sigmas, const Bundle& bundle,
                  AdjustOptions& adjust) {
  const bool domes = has(bundle, PortKind::dome), flats = has(bundle, PortKind::flat);
  const Unknowns dome = unknowns_of(PortKind::dome, words, sigmas);
  static_cast<Unknowns&>(adjust) =
      flats || !domes ? unknowns_of(PortKind::flat, words, sigmas) : dome;
  adjust.of_domes.reset();
  if (domes && flats) adjust.of_domes = dome;
  adjust.of_air.reset();
  if (has(bundle, PortKind::none)) adjust.of_air = unknowns_of(PortKind::none, words, sigmas);
}

// All words that apply to the cameras. The thickness is among them if it was measured.
Words all_words(const Sigmas& sigmas, const Bundle& bundle) {
  Words words;
  for (const NumberGroup& group : number_groups())
    if (std::ranges::any_of(bundle.cameras, [&](const BundleCamera& camera) {
          return group.applies(kind_of(camera.measured.port));
        }))
      words.insert(std::string(group.word));
  if (!is_measured(group_named("thickness"), sigmas, bundle)) words.erase("thickness");
  return words;
}

// The words of a list, after all checks.
Words listed_words(const std::string& refine, const Sigmas& sigmas, const Bundle& bundle,
                   const AdjustOptions& adjust) {
  const std::string asked = setting("refine") + " " + refine;
  const Words words = words_of(refine, asked);
  check_ports(asked, words, bundle);
  check_sigmas(words, sigmas, setting("refine"));
  check_known(asked, words, sigmas, bundle, adjust);
  return words;
}

// All numbers of a camera, without their standard deviations.
std::vector<HousingNumber> numbers_of(const BundleCamera& camera) {
  std::vector<HousingNumber> values;
  if (camera.measured.port) {
    values = port_numbers(*camera.now().port);
    const std::vector<HousingNumber> measured = port_numbers(*camera.measured.port);
    for (std::size_t i = 0; i < values.size(); ++i) values[i].before = measured[i].before;
  }
  const double factor = std::exp(camera.change(kFocalNumber));
  values.push_back({kFocalNumber, Quantity::focal, "focal length, factor", "focal length", "",
                    factor, 0, factor, 0, 1, 0});
  return values;
}

}  // namespace

std::string place_words(const refractive::Port<double>& port) {
  return kind_of(port) == PortKind::dome ? "centre" : "normal,distance";
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
                      AdjustOptions& adjust) {
  const Words words = listed_words(refine, sigmas, bundle, adjust);
  set_unknowns(words, {sigmas, {}, {}}, bundle, adjust);
}

Unknowns unknowns_with(PortKind kind, const Sigmas& measured) {
  Words words;
  for (const NumberGroup& group : number_groups())
    if (measured.*group.sigma > 0) words.insert(std::string(group.word));
  return unknowns_of(kind, words, {measured, {}, {}});
}

void set_estimated_numbers(const std::string& refine, const Sigmas& sigmas, const Bundle& bundle,
                           AdjustOptions& adjust) {
  Sigmas if_fixed = ruler_sigmas();
  if_fixed.thickness = 0;
  const bool automatic = refine == "auto";
  Words words;
  if (automatic && !adjust.poses_known) words = all_words(sigmas, bundle);
  if (automatic || refine == "none")
    check_sigmas(words, sigmas, setting("refine") + " " + refine);
  else
    words = listed_words(refine, sigmas, bundle, adjust);
  set_unknowns(words, {sigmas, automatic ? ruler_sigmas() : Sigmas{}, if_fixed}, bundle, adjust);
}

std::vector<HousingNumber> free_values(const Bundle& bundle,
                                       std::span<const HousingChange<double>> sigmas,
                                       const AdjustOptions& options) {
  std::vector<HousingNumber> values;
  for (std::size_t camera = 0; camera < bundle.cameras.size(); ++camera) {
    const BundleCamera& one = bundle.cameras[camera];
    for (HousingNumber& value : numbers_of(one)) {
      if (!options.unknowns(one).free[value.number]) continue;
      const auto number = static_cast<int>(value.number);
      value.camera = camera;
      value.change = value.now - value.before;
      if (!sigmas.empty()) value.sigma = sigmas[camera](number) * value.scale;
      // The measured focal length is 1 in the unit of its value.
      value.sigma_before =
          options.sigma_before(one, number) * (value.quantity == Quantity::focal ? 1 : value.scale);
      values.push_back(std::move(value));
    }
  }
  return values;
}

}  // namespace axial::pose
