// SPDX-License-Identifier: GPL-3.0-or-later
#include "residuals.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/log.h"
#include "diagnosis/residual_cause.h"
#include "tracked.h"

namespace axial::apps {
namespace {

using Data = nlohmann::ordered_json;
using Vectors = std::vector<Eigen::Vector2d>;

constexpr int kColumnsOfPhotograph = 8;
constexpr std::size_t kShownCauses = 5;

double rounded(double value) {
  return std::round(value * 1e4) / 1e4;
}

// Some observations with their errors.
struct Errors {
  Vectors pixels, freed, stated;
  std::size_t unseen = 0;

  void add(const Eigen::Vector2d& pixel, const Eigen::Vector2d& with_pose_freed,
           const Eigen::Vector2d& as_stated) {
    if (!as_stated.allFinite()) {
      ++unseen;
      return;
    }
    pixels.push_back(pixel);
    freed.push_back(with_pose_freed);
    stated.push_back(as_stated);
  }
};

// The RMS of those of `errors` that are finite.
double rms_of(const Vectors& errors) {
  double sum = 0;
  std::size_t count = 0;
  for (const Eigen::Vector2d& error : errors)
    if (error.allFinite()) sum += error.squaredNorm(), ++count;
  return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
}

Data grid_of(const diagnosis::ResidualPattern& pattern) {
  Data cells = Data::array();
  for (const diagnosis::PatternCell& cell : pattern.cells)
    cells.push_back({cell.count, rounded(cell.mean.x()), rounded(cell.mean.y()),
                     rounded(cell.standard_error.norm()), rounded(cell.rms)});
  return {{"columns", pattern.columns}, {"rows", pattern.rows}, {"cells", cells}};
}

// The RMS with the pose of each photograph free. A photograph with few observations keeps its pose.
double rms_with_free_poses(const Errors& errors) {
  Vectors best = errors.freed;
  for (std::size_t i = 0; i < best.size(); ++i)
    if (!best[i].allFinite()) best[i] = errors.stated[i];
  return rms_of(best);
}

Data errors_of(const Errors& errors) {
  return {{"observations", errors.pixels.size()},
          {"unseen", errors.unseen},
          {"rms", rounded(rms_of(errors.stated))},
          {"rms_freed", rounded(rms_with_free_poses(errors))}};
}

Data camera_of(const CameraModel& model, const Errors& errors,
               const diagnosis::ResidualPattern& pattern) {
  Data data = errors_of(errors);
  data["size"] = {model.width, model.height};
  data["noise"] = rounded(pattern.noise);
  data["systematic"] = rounded(pattern.systematic);
  data["chi_square"] = rounded(pattern.chi_square);
  data["degrees"] = pattern.degrees;
  data["deviations"] = rounded(pattern.deviations);
  data["tells"] = pattern.tells();
  data["found"] = pattern.found();
  data["grid"] = grid_of(pattern);
  return data;
}

Data cause_data(const diagnosis::Cause& cause) {
  Data data{{"name", cause.name}, {"share", rounded(cause.share)}, {"numbers", Data::array()}};
  if (cause.camera != diagnosis::kAllCameras) data["camera"] = cause.camera;
  for (const pose::HousingNumber& number : cause.numbers)
    data["numbers"].push_back({{"name", number.title},
                               {"unit", number.unit},
                               {"stated", number.before},
                               {"change", number.change},
                               {"sigma", number.sigma}});
  return data;
}

// The cameras, those whose patterns are largest first.
std::vector<std::size_t> suspects_of(const std::vector<diagnosis::ResidualPattern>& patterns) {
  std::vector<std::size_t> suspects(patterns.size());
  std::iota(suspects.begin(), suspects.end(), std::size_t{0});
  std::ranges::stable_sort(suspects, std::greater(), [&](std::size_t i) {
    const diagnosis::ResidualPattern& pattern = patterns[i];
    return (pattern.found() ? 1 : 1e-9) * static_cast<double>(pattern.count) * pattern.systematic *
           pattern.systematic;
  });
  return suspects;
}

std::vector<diagnosis::ResidualPattern> patterns_of(
    const diagnosis::TrackedPhotographs& photographs, const std::vector<Errors>& by_camera) {
  std::vector<diagnosis::ResidualPattern> patterns;
  for (std::size_t i = 0; i < by_camera.size(); ++i) {
    const CameraModel& model = photographs.cameras[i];
    patterns.push_back(diagnosis::residual_pattern(by_camera[i].pixels, by_camera[i].freed,
                                                   model.width, model.height));
  }
  return patterns;
}

// The number of each image in "cameras" of the scene, where only calibrated images are.
std::vector<std::size_t> numbers_of(const Scene& scene) {
  std::vector<std::size_t> numbers;
  std::size_t next = 0;
  for (const SceneImage& image : scene.images) numbers.push_back(image.calibrated ? next++ : next);
  return numbers;
}

Data photographs_of(const TrackedScene& tracked, const std::vector<std::size_t>& numbers,
                    const std::vector<Errors>& by_image) {
  Data all = Data::array();
  for (std::size_t i = 0; i < by_image.size(); ++i) {
    const std::size_t camera = tracked.photographs.images[i].camera;
    const CameraModel& model = tracked.photographs.cameras[camera];
    Data data = errors_of(by_image[i]);
    data["number"] = numbers[tracked.numbers[i]];
    data["camera"] = camera;
    data["grid"] = grid_of(diagnosis::residual_pattern(
        by_image[i].pixels, by_image[i].stated, model.width, model.height, kColumnsOfPhotograph));
    all.push_back(std::move(data));
  }
  return all;
}

void add_causes(const diagnosis::TrackedPhotographs& photographs, const Vectors& freed,
                const std::vector<diagnosis::ResidualPattern>& patterns, Data& data) {
  data["causes"] = Data::array();
  if (std::ranges::none_of(patterns, &diagnosis::ResidualPattern::found)) return;
  const auto causes = diagnosis::residual_causes(photographs, freed, suspects_of(patterns));
  for (std::size_t k = 0; k < std::min(causes.size(), kShownCauses); ++k)
    data["causes"].push_back(cause_data(causes[k]));
}

}  // namespace

Data residual_data(const io::SceneWithCameras& scene, const std::filesystem::path& folder,
                   const Context& context) {
  const TrackedScene tracked = read_tracks(scene, folder, context);
  const diagnosis::TrackedPhotographs& photographs = tracked.photographs;
  const diagnosis::ResidualVectors vectors = diagnosis::residual_vectors(photographs);
  std::vector<Errors> by_camera(photographs.cameras.size()), by_image(photographs.images.size());
  Errors all;
  for (std::size_t i = 0; i < photographs.observations.size(); ++i) {
    const pose::Observation& observation = photographs.observations[i];
    const std::size_t camera = photographs.images[observation.image].camera;
    for (Errors* const errors : {&by_camera[camera], &by_image[observation.image], &all})
      errors->add(observation.pixel, vectors.freed[i], vectors.stated[i]);
  }
  const std::vector<diagnosis::ResidualPattern> patterns = patterns_of(photographs, by_camera);
  Data data = errors_of(all);
  data["cameras"] = Data::array();
  for (std::size_t i = 0; i < patterns.size(); ++i)
    data["cameras"].push_back(camera_of(photographs.cameras[i], by_camera[i], patterns[i]));
  data["photographs"] = photographs_of(tracked, numbers_of(scene.scene), by_image);
  add_causes(photographs, vectors.freed, patterns, data);
  log_info("Reprojection errors: {:.3f} px (RMS); {} of {} cameras show a pattern",
           rms_of(all.stated), std::ranges::count_if(patterns, &diagnosis::ResidualPattern::found),
           patterns.size());
  return data;
}

}  // namespace axial::apps
