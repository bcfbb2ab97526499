// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/order_statistics.h"
#include "evaluate/depth_evaluation.h"
#include "evaluate/pixel_classes.h"
#include "evaluate/statistics.h"
#include "experiments/steps.h"
#include "io/images/image.h"
#include "io/openmvs/dmap.h"
#include "picture/svg.h"

namespace axial::experiments {
namespace {

namespace fs = std::filesystem;

// The picture reduced to `width`, small enough to store with the numbers.
std::string small_picture(const fs::path& file, int width) {
  cv::Mat picture = io::read_color_image(file);
  const double factor = std::min(1.0, static_cast<double>(width) / picture.cols);
  cv::resize(picture, picture, {}, factor, factor, cv::INTER_AREA);
  return picture::png_in_base64(picture);
}

fs::path truth_of(const SimulatedScene& scene, const std::string& medium, const fs::path& image) {
  return scene.images(medium) / (image.stem().string() + ".distance.tiff");
}

// EvaluateReconstruction's messages for a cloud with nothing to measure.
Words nothing_to_measure() {
  return {"the cloud has no points", "no point lies in enough of the images",
          "too few to align a cloud", "the cloud has no extent to align by"};
}

Words evaluation_arguments(const fs::path& cloud, const SimulatedScene& scene,
                           const EvaluationOptions& options) {
  Words words{"-i", cloud.string(), "--framed-only"};
  words += {"-m", scene.mesh().string(), "--cameras", scene.model().string()};
  words += {"--housing", scene.housing().string()};
  words += {"--min-views", std::to_string(options.min_views)};
  words += {"--tolerance", fmt::format("{}", options.tolerance)};
  words += {"--samples", std::to_string(options.samples)};
  if (options.icp) words += {"--align", "icp"};
  return words;
}

// The view's photograph at the resolution of its depth map.
cv::Mat1b grey_of(const SimulatedScene& scene, const std::string& medium, const DepthMap& map) {
  const fs::path file = scene.images(medium) / fs::path(map.image_path).filename();
  cv::Mat1b grey = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  if (grey.empty()) fail_in(file, "cannot be read");
  cv::resize(grey, grey, map.depth.size(), 0, 0, cv::INTER_AREA);
  return grey;
}

std::string title_of(evaluate::PixelClass pixel_class) {
  switch (pixel_class) {
    case evaluate::PixelClass::edge:
      return "a depth edge within the window";
    case evaluate::PixelClass::plain:
      return "no texture";
    case evaluate::PixelClass::steep:
      return fmt::format("steeper than {:g} degrees", evaluate::PixelClassOptions{}.steep_degrees);
    default:
      return "all else";
  }
}

Json places_of(std::span<const evaluate::ClassifiedMap> maps) {
  Json places = Json::array();
  for (const evaluate::ClassErrors& errors : evaluate::errors_by_class(maps))
    places.push_back({{"place", title_of(errors.pixel_class)},
                      {"truths", errors.truth_pixels},
                      {"pixels", errors.compared_pixels},
                      {"gross", errors.gross_pixels},
                      {"mean", errors.mean},
                      {"median", errors.median}});
  return places;
}

Json phases_of(std::span<const evaluate::ClassifiedMap> maps) {
  constexpr std::size_t kBins = 8;
  Json phases = Json::array();
  for (const evaluate::PhaseErrors& errors : evaluate::errors_by_phase(maps, kBins))
    phases.push_back({{"begin", errors.begin},
                      {"end", errors.end},
                      {"count", errors.count},
                      {"shift", errors.shift}});
  return phases;
}

Json rings_of(std::span<const evaluate::DepthEvaluation> maps) {
  constexpr std::size_t kRings = 8;
  Json rings = Json::array();
  for (const evaluate::RelativeRing& ring : evaluate::relative_rings(maps, kRings))
    rings.push_back({{"inner", ring.inner},
                     {"outer", ring.outer},
                     {"count", ring.count},
                     {"median", ring.signed_median}});
  return rings;
}

// The errors of all pixels of all maps together.
Json errors_of(std::span<const evaluate::DepthEvaluation> maps, double tolerance) {
  evaluate::Magnitudes errors;
  std::size_t truths = 0;
  for (const evaluate::DepthEvaluation& map : maps) {
    truths += map.truth_pixels;
    for (auto [error, truth] = std::pair(map.error.begin(), map.truth.begin());
         error != map.error.end(); ++error, ++truth)
      errors.add(*error, *truth);
  }
  const std::size_t pixels = errors.all.size();
  const auto within = static_cast<std::size_t>(
      std::count_if(errors.all.begin(), errors.all.end(),
                    [&](float magnitude) { return magnitude <= tolerance; }));
  const auto part = [](std::size_t some, std::size_t all) {
    return static_cast<double>(some) / static_cast<double>(std::max<std::size_t>(1, all));
  };
  return {{"pixels", pixels},
          {"gross", part(errors.gross(), pixels)},
          {"mean", evaluate::summarise(errors.fine).mean},
          {"median", mean_median(errors.all)},
          {"within", part(within, pixels)},
          {"completeness", part(pixels, truths)}};
}

}  // namespace

Json to_json(const EvaluationOptions& options) {
  return {{"tolerance", options.tolerance},
          {"min_views", options.min_views},
          {"samples", options.samples},
          {"picture_width", options.picture_width},
          {"color_max", options.color_max}};
}

SceneDistances scene_distances(const SimulatedScene& scene, const std::string& medium) {
  std::vector<float> distances;
  for (const fs::path& file : files_ending_in(scene.images(medium), ".distance.tiff"))
    for (const float distance : cv::Mat1f(io::read_float_tiff(file)))
      if (distance > 0) distances.push_back(distance);
  std::sort(distances.begin(), distances.end());
  const auto percentile = [&](double p) {
    return interpolated_quantile<float>(distances, p / 100);
  };
  return {percentile(50), percentile(95) / percentile(5)};
}

std::string photograph(const SimulatedScene& scene, const std::string& medium, int width) {
  return small_picture(files_ending_in(scene.images(medium), ".jpg").at(0), width);
}

Json evaluated(const Chain& chain, const fs::path& dense, const SimulatedScene& scene,
               const EvaluationOptions& options) {
  const fs::path file = dense / "evaluation.json", picture = dense / "evaluation.png";
  Words arguments = evaluation_arguments(dense / "scene_dense.ply", scene, options);
  arguments += {"--json", file.string()};
  if (options.picture_width > 0) {
    arguments += {"--picture", picture.string()};
    arguments += {"--picture-width", std::to_string(options.picture_width)};
    arguments += {"--color-max", fmt::format("{}", options.color_max)};
  }
  if (!run_sibling(chain, "EvaluateReconstruction", arguments, dense / "evaluate.log",
                   options.or_nothing ? nothing_to_measure() : Words()))
    return nullptr;
  const Json all = io::json_from(read_file(file));
  const Json &accuracy = all.at("accuracy"), &score = all.at("scores").at(0);
  Json result{{"points", accuracy.at("count")},  {"mean", accuracy.at("mean")},
              {"median", accuracy.at("median")}, {"variance", accuracy.at("variance")},
              {"recall", score.at("recall")},    {"f_score", score.at("f_score")}};
  if (options.picture_width > 0) result["picture"] = small_picture(picture, options.picture_width);
  return result;
}

Json depth_errors(const fs::path& dense, const SimulatedScene& scene, const std::string& medium,
                  double tolerance) {
  const std::vector<fs::path> files = files_ending_in(dense, ".dmap");
  std::vector<DepthMap> maps;
  maps.reserve(files.size());
  for (const fs::path& file : files) maps.push_back(io::read_dmap(file).map);
  std::vector<evaluate::DepthEvaluation> evaluations;
  std::vector<evaluate::ClassifiedMap> classified;
  for (const DepthMap& map : maps) {
    const cv::Mat1f truth = io::read_float_tiff(truth_of(scene, medium, map.image_path));
    evaluations.push_back(evaluate::evaluate_depth(map.depth, truth, {}));
    const evaluate::DepthEvaluation& evaluation = evaluations.back();
    classified.push_back(
        {&map, evaluation,
         evaluate::classes_of(evaluation.truth, map.camera, grey_of(scene, medium, map))});
  }
  Json result = errors_of(evaluations, tolerance);
  result["rings"] = rings_of(evaluations);
  result["places"] = places_of(classified);
  result["phases"] = phases_of(classified);
  return result;
}

std::string depth_picture(const Chain& chain, const fs::path& dense, const SimulatedScene& scene,
                          const std::string& medium, double color_max) {
  constexpr int kWidth = 960;
  const fs::path file = files_ending_in(dense, ".dmap").at(0), picture = dense / "depth.png";
  const fs::path truth = truth_of(scene, medium, io::read_dmap(file).map.image_path);
  run_sibling(chain, "EvaluateReconstruction",
              {"-i", file.string(), "-m", truth.string(), "--color-max",
               fmt::format("{}", color_max), "--picture", picture.string()},
              dense / "depth.log");
  return small_picture(picture, kWidth);
}

}  // namespace axial::experiments
