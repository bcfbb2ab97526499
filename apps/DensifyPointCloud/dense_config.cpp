// SPDX-License-Identifier: GPL-3.0-or-later
#include "dense_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/atomic_file.h"
#include "base/byte_order_mark.h"
#include "base/error.h"
#include "base/log.h"
#include "base/parse_number.h"
#include "base/split.h"

namespace axial::apps {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// A title that has an effect here.
struct Setting {
  const char* title;
  double low, high;
  std::function<double()> get;
  std::function<void(double)> set;
};

template <class T>
Setting setting(const char* title, T& target, double low, double high, double unit = 1) {
  return {title, low, high, [&target, unit] { return static_cast<double>(target) / unit; },
          [&target, unit](double value) { target = static_cast<T>(value * unit); }};
}

// A standard deviation of grey levels in [0, 1]. The target holds its square.
Setting min_texture(float& target) {
  return {"Descriptor Min Magnitude Threshold", 0, 1,
          [&target] { return std::sqrt(static_cast<double>(target)); },
          [&target](double value) { target = static_cast<float>(value * value); }};
}

// 0: the region has no effect; 1: points outside the region have less weight.
Setting point_inside_region(double& weight) {
  constexpr double kOutside = 0.7;
  return {"Point Inside ROI", 0, 1, [&weight] { return weight < 1 ? 1.0 : 0.0; },
          [&weight](double value) { weight = value < 0.5 ? 1.0 : kOutside; }};
}

std::vector<Setting> entries(densify::Options& options) {
  ViewSelectionOptions& views = options.views.selection;
  densify::MatchOptions& matching = options.matching;
  return {setting("Min Views", views.min_views, 1, 1000),
          setting("Max Views", views.max_views, 1, 1000),
          setting("Min Views Trust Point", views.min_trusted_views, 1, 1000),
          point_inside_region(views.weight_outside_region),
          setting("View Min Score", views.min_score, 0, 1e9),
          setting("View Min Score Ratio", views.min_score_ratio, 0, 1),
          setting("Min Area", views.min_area, 0, 1),
          setting("Min Angle", views.min_angle, 0, 180, kDegree),
          setting("Optim Angle", views.optimal_angle, 0.1, 180, kDegree),
          setting("Max Angle", views.max_angle, 0, 180, kDegree),
          setting("Depth Diff Threshold", options.fusion.depth_threshold, 1e-6, 1),
          setting("Normal Diff Threshold", options.fusion.normal_threshold, 0, 180, kDegree),
          min_texture(matching.min_texture),
          setting("NCC Threshold Keep", matching.keep_cost, 0, 2),
          setting("Estimation Geometric Weight", matching.geometric_weight, 0, 100),
          setting("Speckle Size", matching.speckles.min_pixels, 0, 1e9),
          setting("Interpolate Gap Size", matching.gaps.max_gap, 0, 1e6)};
}

std::string shown(double value) {
  return fmt::format("{:.6g}", value);
}

// Titles of OpenMVS whose values are replaced by its options, even by their defaults.
constexpr std::array kTitlesOfOptions{"Resolution Level",
                                      "Max Resolution",
                                      "Min Resolution",
                                      "SubResolution levels",
                                      "Min Views Fuse",
                                      "Num Views",
                                      "Remove Dmaps",
                                      "Ignore Mask Label",
                                      "Optimize",
                                      "Estimate Colors",
                                      "Estimate Normals",
                                      "Estimation Iters",
                                      "Estimation Geometric Iters"};

// Titles of OpenMVS that have no counterpart here.
constexpr std::array kTitlesWithoutEffect{"Min Views Filter",     "Min Views Filter Adjust",
                                          "Filter Adjust",        "Add Corners",
                                          "Init Sparse",          "Pairwise Mul",
                                          "Optimizer Eps",        "Optimizer Max Iters",
                                          "Random Iters",         "Random Max Scale",
                                          "Random Depth Ratio",   "Random Angle1 Range",
                                          "Random Angle2 Range",  "Random Smooth Depth",
                                          "Random Smooth Normal", "Random Smooth Bonus"};

bool contains(std::span<const char* const> titles, std::string_view title) {
  return std::ranges::find(titles, title) != titles.end();
}

// Whether the line sets nothing.
bool is_decoration(std::string_view line) {
  return line.empty() || line.front() == '[' || line == "{" || line == "}";
}

class ConfigFile {
 public:
  ConfigFile(std::string name, densify::Options& options)
      : name_(std::move(name)), entries_(entries(options)) {}

  void read(std::string_view text) {
    std::istringstream lines{std::string(without_byte_order_mark(text))};
    for (std::string line; std::getline(lines, line);) {
      ++number_;
      read_line(line);
    }
    warn();
  }

 private:
  void read_line(std::string_view line) {
    line = trimmed(line.substr(0, line.find_first_of("#;")));
    if (is_decoration(line)) return;
    const std::size_t sign = line.find('=');
    if (sign == std::string_view::npos)
      fail_in(name_, "line {} is not 'title = value': {}", number_, line);
    set(std::string(title_of(line.substr(0, sign))), trimmed(line.substr(sign + 1)));
  }

  // OpenMVS's titles of angles have no unit, but its documentation adds one: "Min Angle (deg)".
  static std::string_view title_of(std::string_view text) {
    text = trimmed(text);
    constexpr std::string_view kUnit = "(deg)";
    if (text.ends_with(kUnit)) text.remove_suffix(kUnit.size());
    return trimmed(text);
  }

  void set(const std::string& title, std::string_view text) {
    if (contains(kTitlesOfOptions, title)) return list(of_options_, title);
    if (contains(kTitlesWithoutEffect, title)) return list(without_effect_, title);
    for (const Setting& setting : entries_) {
      if (title != setting.title) continue;
      const std::optional<double> value = parse_finite<double>(text);
      if (!value) fail_in(name_, "line {}: {} is '{}', expected a number", number_, title, text);
      if (!(*value >= setting.low && *value <= setting.high))
        fail_in(name_, "line {}: {} is {}: must be from {} to {}", number_, title, *value,
                setting.low, setting.high);
      // A value written by this program is rounded: it must not change the last bits of the current
      // value.
      if (shown(*value) != shown(setting.get())) setting.set(*value);
      return;
    }
    list(unknown_, title);
  }

  static void list(std::string& titles, const std::string& title) {
    titles += (titles.empty() ? "" : ", ") + title;
  }

  void warn() const {
    if (!unknown_.empty()) log_warning("{}: unknown settings, ignored: {}", name_, unknown_);
    if (!without_effect_.empty())
      log_info("{}: settings without effect here: {}", name_, without_effect_);
    if (!of_options_.empty())
      log_info("{}: ignored, because only options set these values, as in OpenMVS: {}", name_,
               of_options_);
  }

  std::string name_;
  std::vector<Setting> entries_;
  std::size_t number_ = 0;
  std::string unknown_, without_effect_, of_options_;
};

}  // namespace

void apply_dense_config(const std::filesystem::path& file, densify::Options& options) {
  std::error_code error;
  if (std::filesystem::exists(file, error))
    return ConfigFile(file.string(), options).read(read_file(file, 1 << 20));
  std::string text;
  for (const Setting& setting : entries(options))
    text += fmt::format("{} = {}\n", setting.title, shown(setting.get()));
  write_atomically(file, text);
  log_info("{}: did not exist, written with the values in use", file.string());
}

}  // namespace axial::apps
