// SPDX-License-Identifier: GPL-3.0-or-later
#include "control.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "base/error.h"
#include "base/log.h"
#include "control/labels.h"
#include "control/read_control.h"
#include "io/cameras/image_positions.h"
#include "io/cameras/position_file.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;
using Between = pose::KnownDistance::Between;

// The photographs by the names that files give them.
class Photographs {
 public:
  explicit Photographs(const pose::Bundle& bundle) : labels_(names_of(bundle)) {}

  std::optional<std::size_t> find(const std::string& name, const std::string& where) const {
    const io::ImageLabels::Match match = labels_.find(name);
    if (match.images.empty()) return {};
    if (match.images.size() > 1)
      fail_in(where, "'{}' is the name of {} photographs of the model", name, match.images.size());
    return match.images.front();
  }

 private:
  static std::vector<std::string> names_of(const pose::Bundle& bundle) {
    std::vector<std::string> names;
    for (const pose::BundleImage& image : bundle.images) names.push_back(image.name);
    return names;
  }

  io::ImageLabels labels_;
};

pose::TargetImage measured(const control::TargetImage& image, std::size_t index) {
  // COLMAP's pixels have their centres at 0.5, those of the bundle at integers.
  const Eigen::Vector2d half(0.5, 0.5);
  pose::TargetImage result{index, image.pixel - half, image.sigma, image.dot, {}};
  if (image.corners) {
    result.corners.emplace();
    std::ranges::transform(*image.corners, result.corners->begin(),
                           [&](const Eigen::Vector2d& corner) { return corner - half; });
  }
  return result;
}

// The targets of all photographs of the bundle, in the order of their labels' keys.
class TargetTable {
 public:
  TargetTable(const control::Control& control, const Photographs& photographs,
              std::vector<std::string>& unused) {
    std::set<std::string> strange;
    for (const control::TargetImage& image : control.images) {
      const auto index = photographs.find(image.image, image.where);
      if (!index)
        strange.insert(image.image);
      else
        add(image, *index, unused);
    }
    if (!strange.empty())
      unused.push_back(fmt::format("{} photographs with targets have no pose, first {}",
                                   strange.size(), *strange.begin()));
  }

  std::vector<pose::Target> take() {
    std::vector<pose::Target> targets;
    for (auto& [key, target] : by_key_) {
      std::erase_if(target.images, [&, &key = key](const auto& image) {
        return repeated_.contains({key, image.image});
      });
      targets.push_back(std::move(target));
    }
    return targets;
  }

 private:
  void add(const control::TargetImage& image, std::size_t index, std::vector<std::string>& unused) {
    const std::string key = control::label_key(image.label);
    pose::Target& target = by_key_[key];
    if (target.label.empty()) target.label = image.label;
    const bool again =
        std::ranges::find(target.images, index, &pose::TargetImage::image) != target.images.end();
    if (again && repeated_.insert({key, index}).second)
      unused.push_back(
          fmt::format("{}: {} shows {} more than once", image.where, image.image, image.label));
    target.images.push_back(measured(image, index));
  }

  std::map<std::string, pose::Target> by_key_;
  std::set<std::pair<std::string, std::size_t>> repeated_;
};

// Finds what labels of bars and control points name.
class Labels {
 public:
  Labels(const std::vector<pose::Target>& targets, const Photographs& photographs)
      : photographs_(photographs) {
    for (const pose::Target& target : targets) by_key_[control::label_key(target.label)] = &target;
  }

  // The target, or why it cannot be used.
  const pose::Target* target(const std::string& label, std::string& why) const {
    const auto found = by_key_.find(control::label_key(label));
    if (found == by_key_.end()) {
      why = fmt::format("no photograph with a pose shows {}", label);
      return nullptr;
    }
    if (found->second->source > 0) return found->second;
    why = fmt::format("{} photograph with a pose shows {}, of at least 2",
                      found->second->images.size(), label);
    return nullptr;
  }

  std::optional<std::size_t> image(const std::string& label, const std::string& where) const {
    return photographs_.find(label, where);
  }

 private:
  const Photographs& photographs_;
  std::map<std::string, const pose::Target*> by_key_;
};

std::optional<pose::KnownDistance> known_distance(const control::Bar& bar, const Labels& labels,
                                                  std::vector<std::string>& unused) {
  std::string why;
  const pose::Target* const first = labels.target(bar.first, why);
  const pose::Target* const second = first ? labels.target(bar.second, why) : nullptr;
  if (second)
    return pose::KnownDistance{Between::points, first->source, second->source,
                               bar.metres,      bar.sigma,     "bar " + name_of(bar)};
  unused.push_back(fmt::format("{}: bar {}: {}", bar.where, name_of(bar), why));
  return {};
}

std::optional<pose::KnownPlace> known_place(const control::ControlPoint& point,
                                            const Labels& labels,
                                            std::vector<std::string>& unused) {
  pose::KnownPlace place{Between::points, 0, point.metres, point.sigma, point.label};
  std::string why;
  if (const pose::Target* const target = labels.target(point.label, why)) {
    place.index = target->source;
    return place;
  }
  // A number is the label of a target, and never the name of a photograph.
  const auto image = control::is_number(point.label) ? std::optional<std::size_t>()
                                                     : labels.image(point.label, point.where);
  if (image) {
    place.of = Between::images;
    place.index = *image;
    return place;
  }
  unused.push_back(fmt::format("{}: {}", point.where, why));
  return {};
}

}  // namespace

void check(const ControlOptions& options) {
  const auto needs_targets = [&](const char* option, const std::string& value) {
    fail("--{} {}: is for targets, and --targets is missing", option, value);
  };
  if (options.find && options.images.empty())
    fail("--targets find: needs --images, the folder of the photographs");
  if (!options.find && !options.images.empty())
    fail("--images {}: is for --targets find", options.images.string());
  if (options.any()) return;
  if (!options.bars.empty()) needs_targets("bars", options.bars.string());
  if (!options.control.empty()) needs_targets("control", options.control.string());
  if (!options.checks.empty()) needs_targets("checks", options.checks);
  if (options.epsg > 0) needs_targets("epsg", std::to_string(options.epsg));
}

control::Control read_control(const ControlOptions& options) {
  control::Control all;
  const auto add = [&](const fs::path& file, control::Role role) {
    if (file.empty()) return;
    control::ControlReading reading;
    reading.role = role;
    reading.epsg = options.epsg;
    control::append(all, control::read_control(file, reading));
  };
  add(options.targets, control::Role::images);
  // The file of targets may contain bars and control points, too.
  if (options.bars != options.targets) add(options.bars, control::Role::bars);
  if (options.control != options.targets && options.control != options.bars)
    add(options.control, control::Role::points);
  if (options.epsg > 0 && all.points.empty())
    fail("--epsg {}: is for control points, and there are none", options.epsg);
  for (const std::string& note : all.notes) log_info("{}", note);
  if (!options.checks.empty())
    control::mark_checks(all, io::split_list(options.checks, "--checks " + options.checks));
  control::set_map_scale(all);
  return all;
}

AddedControl add_control(const control::Control& control, pose::Bundle& bundle,
                         pose::RefineOptions& refine) {
  AddedControl added;
  const Photographs photographs(bundle);
  refine.targets = TargetTable(control, photographs, added.unused).take();
  pose::add_targets(bundle, refine.targets);
  const Labels labels(refine.targets, photographs);
  for (const control::Bar& bar : control.bars)
    if (auto known = known_distance(bar, labels, added.unused))
      (bar.check ? added.checks.distances : refine.adjust.distances).push_back(*std::move(known));
  for (const control::ControlPoint& point : control.points)
    if (auto known = known_place(point, labels, added.unused))
      (point.check ? added.checks.places : refine.adjust.places).push_back(*std::move(known));
  // One place does not scale the model.
  if (places_in_plan(refine.adjust.places).size() < 2) return added;
  added.map_scale = control.map_scale;
  for (std::vector<pose::KnownDistance>* distances :
       {&refine.adjust.distances, &added.checks.distances})
    for (pose::KnownDistance& known : *distances) {
      known.metres *= added.map_scale;
      known.sigma *= added.map_scale;
    }
  return added;
}

std::vector<Eigen::Vector3d> places_in_plan(const std::vector<pose::KnownPlace>& places) {
  std::vector<Eigen::Vector3d> result;
  for (const pose::KnownPlace& place : places)
    if (place.knows(0) && place.knows(1)) result.push_back(place.metres);
  return result;
}

void enter(const LocalFrame& frame, std::vector<pose::KnownPlace>& places) {
  for (pose::KnownPlace& place : places) place.metres = frame.to_local(place.metres);
}

}  // namespace axial::apps
