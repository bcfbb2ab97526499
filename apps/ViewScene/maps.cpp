// SPDX-License-Identifier: GPL-3.0-or-later
#include "maps.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "change_report.h"
#include "folder.h"
#include "io/images/image.h"
#include "map/map_place.h"
#include "map/reduced_map.h"
#include "map/stated_kind.h"
#include "scene/resolution.h"
#include "view/color_scale.h"
#include "view/map_pictures.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using map::MapKind;
namespace kinds = map::kinds;
using map::ReducedMap;

constexpr int kMapQuality = 90;          // of JPEG files
constexpr int kLongestOfHeights = 2048;  // of the heights for the cursor: 8 MB
// The shares of the values that are below the lowest and below the highest colour.
constexpr double kLowShare = 0.01, kHighShare = 0.99;

Json place_of(const ReducedMap& map) {
  const map::MapGrid& grid = map.grid;
  return {grid.left, grid.top, grid.columns * grid.pixel, grid.rows * grid.pixel};
}

Json legend(const view::ColorScale& scale, const char* unit) {
  Json colors = Json::array();
  for (const cv::Vec3b& color : scale.colors) colors.push_back(view::css_color(color));
  return {{"colors", colors}, {"low", scale.low}, {"high", scale.high}, {"unit", unit}};
}

// Reads the maps of one run and writes their pictures.
class Layers {
 public:
  Layers(const MapOptions& options, fs::path staging)
      : options_(options), staging_(std::move(staging)) {}

  // States the world of the files that are read next: `motion` moves points from the world of the
  // page to it.
  void use_motion(const Eigen::Isometry3d& motion) { motion_ = motion; }

  // Reads the map PREFIX.`end`. Error if it does not state the kind `stated`, if it does not lie on
  // the same plane as those before, or, with the same prefix, if it has another grid.
  ReducedMap read(const std::string& prefix, const char* end, MapKind kind, const char* stated) {
    const fs::path file = prefix + end;
    ReducedMap map = map::read_reduced_map(file, kind, options_.longest_side, stated);
    if (prefix != prefix_) {
      prefix_ = prefix;
      grid_ = map.grid;
      first_ = file;
    }
    if (map.grid.columns != grid_.columns || map.grid.rows != grid_.rows ||
        map.grid.left != grid_.left || map.grid.top != grid_.top || map.grid.pixel != grid_.pixel)
      fail_in(file, "does not have the pixels of {}", first_.string());
    check_axes(map, file);
    return map;
  }

  // Adds a picture (B G R), and a legend unless it is null.
  void add(const char* id, const char* title, const ReducedMap& map, const cv::Mat3b& picture,
           const Json& legend_of_it = {}) {
    const bool has_classes = legend_of_it.contains("classes");  // JPEG would blur their borders
    const std::string name = std::string("maps/") + id + (has_classes ? ".png" : ".jpg");
    if (has_classes)
      io::write_png(staging_ / name, picture);
    else
      io::write_jpeg(staging_ / name, picture, kMapQuality);
    layers_.push_back({{"id", id},
                       {"title", title},
                       {"file", name},
                       {"size", {picture.cols, picture.rows}},
                       {"place", place_of(map)}});
    if (!legend_of_it.is_null()) layers_.back()["legend"] = legend_of_it;
  }

  Json data() const {
    Json result{{"layers", layers_}, {"axes", nullptr}, {"offset", nullptr}};
    if (!axes_) return result;
    result["axes"] = Json::array();
    for (int k = 0; k < 9; ++k) result["axes"].push_back(axes_->axes(k / 3, k % 3));
    result["offset"] = {axes_->offset.x(), axes_->offset.y(), axes_->offset.z()};
    return result;
  }

 private:
  void check_axes(const ReducedMap& map, const fs::path& file) {
    if (!map.axes) return;
    const map::WorldAxes axes = map::after(motion_, *map.axes);
    if (!axes_) {
      axes_ = axes;
      of_axes_ = file;
    }
    // The later survey may have been mapped where it was before it was aligned.
    if (!is_same_plane(axes) && !is_same_plane(*map.axes))
      fail_in(file,
              "has other axes than {}; give MapSurface and CompareSurveys the same --up, or --like",
              of_axes_.string());
  }

  bool is_same_plane(const map::WorldAxes& axes) const {
    constexpr double kTolerance = 1e-6;
    // Their heights need not have the same origin: only horizontal places must agree.
    const Eigen::Vector3d shift = axes.offset - axes_->offset;
    return axes.axes.isApprox(axes_->axes, kTolerance) && shift.head<2>().norm() <= kTolerance;
  }

  const MapOptions& options_;
  fs::path staging_;
  std::string prefix_;  // of the map before
  map::MapGrid grid_;   // of the maps with this prefix
  fs::path first_, of_axes_;
  Eigen::Isometry3d motion_ = Eigen::Isometry3d::Identity();
  std::optional<map::WorldAxes> axes_;
  Json layers_ = Json::array();
};

Json write_heights(const ReducedMap& dem, const fs::path& staging) {
  const cv::Size size = working_size(dem.pixels.cols, dem.pixels.rows, {0, 1, kLongestOfHeights});
  const view::HeightData data = view::height_data(view::reduced_values(dem.pixels, size));
  return {{"file", DataFiles(staging, "heights").add(data.bytes)},
          {"size", {size.width, size.height}},
          {"place", place_of(dem)},
          {"low", data.low},
          {"step", data.step}};
}

// From 0 to the value that nearly all values do not exceed.
view::ColorScale from_0(std::span<const cv::Vec3b> colors, const cv::Mat1f& values, double share) {
  return view::scale_of(colors, 0, view::quantiles(values, 0, share).second);
}

// Returns what write_heights() returns.
Json add_maps(Layers& layers, const MapOptions& options, const fs::path& staging) {
  const ReducedMap dem = layers.read(options.maps, ".dem.tif", MapKind::heights, kinds::kHeights);
  const ReducedMap ortho = layers.read(options.maps, ".ortho.tif", MapKind::colors, kinds::kColors);
  const ReducedMap views = layers.read(options.maps, ".views.tif", MapKind::counts, kinds::kCounts);
  layers.add("ortho", "Orthomosaic", ortho, view::opaque(ortho.pixels));
  const auto [low, high] = view::quantiles(dem.pixels, kLowShare, kHighShare);
  const view::ColorScale heights = view::scale_of(view::violet_to_yellow(), low, high);
  const cv::Mat1b shades = view::relief(dem.pixels, dem.pixel_width(), dem.pixel_height());
  layers.add("height", "Height", dem, view::painted(dem.pixels, heights, shades),
             legend(heights, "m"));
  const view::ColorScale counts = from_0(view::dark_to_green(), views.pixels, 1);
  layers.add("views", "Views", views, view::painted(views.pixels, counts),
             legend(counts, "photographs"));
  if (fs::exists(options.maps.string() + ".sigma.tif")) {
    const ReducedMap sigma =
        layers.read(options.maps, ".sigma.tif", MapKind::heights, kinds::kErrors);
    const view::ColorScale errors = from_0(view::dark_to_light(), sigma.pixels, kHighShare);
    layers.add("sigma", "Expected error", sigma, view::painted(sigma.pixels, errors),
               legend(errors, "m"));
  }
  return write_heights(dem, staging);
}

void add_orthomosaic(Layers& layers, const fs::path& prefix, const char* id, const char* title) {
  if (prefix.empty()) return;
  const ReducedMap map = layers.read(prefix, ".ortho.tif", MapKind::colors, kinds::kColors);
  layers.add(id, title, map, view::opaque(map.pixels));
}

// The picture of the classes of CompareSurveys.
cv::Mat3b painted_classes(const cv::Mat1f& classes) {
  static const cv::Vec3b kColors[] = {{110, 116, 124}, {230, 120, 50}, {66, 130, 190}};  // R G B
  cv::Mat3b picture(classes.size());
  for (int y = 0; y < classes.rows; ++y)
    for (int x = 0; x < classes.cols; ++x) {
      const float value = classes(y, x);  // NaN where nothing was compared
      const cv::Vec3b& color =
          value >= 0 && value <= 2 ? kColors[static_cast<int>(value)] : view::kNothing;
      picture(y, x) = {color[2], color[1], color[0]};
    }
  return picture;
}

Json add_changes(Layers& layers, const MapOptions& options) {
  const std::string prefix =
      options.changes.string() + ".change";  // --map may have the same PREFIX
  const Json report = change_report(prefix + ".json");
  const ReducedMap difference =
      layers.read(prefix, ".difference.tif", MapKind::heights, kinds::kDifference);
  const ReducedMap classes =
      layers.read(prefix, ".significant.tif", MapKind::classes, kinds::kSignificant);
  const ReducedMap sigma = layers.read(prefix, ".sigma.tif", MapKind::heights, kinds::kSigma);
  const cv::Mat sizes = cv::abs(difference.pixels);
  const double most = view::quantiles(sizes, 0, 0.995).second;
  const view::ColorScale scale = view::scale_of(view::orange_to_blue(), -most, most);
  layers.add("difference", "Difference", difference, view::painted(difference.pixels, scale),
             legend(scale, "m"));
  layers.add("significant", "Significant change", classes, painted_classes(classes.pixels),
             {{"classes", Json::array({{{"color", "#4282be"}, {"text", "came"}},
                                       {{"color", "#e67832"}, {"text", "gone"}},
                                       {{"color", "#6e747c"}, {"text", "not changed"}}})}});
  const view::ColorScale errors = from_0(view::dark_to_light(), sigma.pixels, kHighShare);
  layers.add("difference-sigma", "Error of difference", sigma, view::painted(sigma.pixels, errors),
             legend(errors, "m"));
  return report;
}

}  // namespace

Json write_maps(const MapOptions& options, const fs::path& staging) {
  if (options.is_empty()) return {};
  make_folder(staging / "maps");
  Layers layers(options, staging);
  Json heights, change;
  if (!options.maps.empty()) heights = add_maps(layers, options, staging);
  add_orthomosaic(layers, options.raw, "raw-ortho", "Orthomosaic with water");
  if (!options.changes.empty()) {
    layers.use_motion(map::motion_of_comparison(options.changes.string() + ".change.json"));
    change = add_changes(layers, options);
  }
  add_orthomosaic(layers, options.earlier, "earlier-ortho", "Orthomosaic of the earlier survey");
  Json data = layers.data();
  data["heights"] = heights;
  data["change"] = change;
  return data;
}

}  // namespace axial::apps
