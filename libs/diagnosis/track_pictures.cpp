// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/track_pictures.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <set>

#include "base/error.h"
#include "base/order_statistics.h"
#include "base/parallel.h"
#include "io/images/image.h"

namespace axial::diagnosis {
namespace {

constexpr std::size_t kPairs = 3, kLeastPoints = 30, kPointsOfPair = 150;
constexpr int kHalf = 6;           // patches have 13 x 13 samples
constexpr double kPicture = 1200;  // samples: pixels of the photograph reduced to this width [px]

// The image of a point, and its derivatives by the point along two directions across the line of
// sight.
struct Patch {
  Eigen::Vector2d centre;
  Eigen::Matrix2d along;
};

struct Tangents {
  Eigen::Vector3d point, u, v;
};

Tangents tangents_at(const Eigen::Vector3d& point, const Eigen::Vector3d& first,
                     const Eigen::Vector3d& second) {
  const Eigen::Vector3d sight =
      ((point - first).normalized() + (point - second).normalized()).normalized();
  const Eigen::Vector3d u = sight.unitOrthogonal();
  const double step = 2e-3 * (point - first).norm();  // a pixel or two
  return {point, step * u, step * sight.cross(u)};
}

// The patch of a photograph that the camera at `pose` sees at the tangents. Empty if the camera
// does not see them.
std::optional<Patch> patch_of(const pose::PhotographCamera& camera, const Pose& pose,
                              const Tangents& at) {
  const auto see = [&](const Eigen::Vector3d& x) { return camera.image(pose.to_camera(x)); };
  const pose::PhotographImage centre = see(at.point), u = see(at.point + at.u),
                              v = see(at.point + at.v);
  if (!centre.visible || !u.visible || !v.visible) return {};
  Patch result{centre.pixel, {}};
  result.along << u.pixel - centre.pixel, v.pixel - centre.pixel;
  return result;
}

cv::Mat1f grey_picture(const std::filesystem::path& file, cv::Size size) {
  try {
    const cv::Mat pixels = io::read_photograph(file).pixels;
    if (pixels.size() != size) return {};
    cv::Mat1f picture;
    cv::Mat single;
    cv::cvtColor(pixels, single, cv::COLOR_BGR2GRAY);
    single.convertTo(picture, CV_32F, pixels.depth() == CV_16U ? 1 / 257.0 : 1.0);
    const double sigma = std::max(1.0, picture.cols / kPicture) * 0.7;
    cv::GaussianBlur(picture, picture, {}, sigma);
    return picture;
  } catch (const Error&) {
    return {};  // programs that need the photograph report it
  }
}

std::optional<double> sample_at(const cv::Mat1f& picture, const Eigen::Vector2d& at) {
  const double x = std::floor(at.x()), y = std::floor(at.y());
  if (!(x >= 0 && y >= 0 && x < picture.cols - 1 && y < picture.rows - 1)) return {};
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const double a = at.x() - x, b = at.y() - y;
  return (1 - b) * ((1 - a) * picture(j, i) + a * picture(j, i + 1)) +
         b * ((1 - a) * picture(j + 1, i) + a * picture(j + 1, i + 1));
}

// Normalised cross-correlation of two patches. Empty where a patch leaves its photograph or has no
// texture.
std::optional<double> correlation(const cv::Mat1f& a, const Patch& in_a, const cv::Mat1f& b,
                                  const Patch& in_b) {
  if (!(std::abs(in_a.along.determinant()) > 1e-9)) return {};
  const Eigen::Matrix2d warp = in_b.along * in_a.along.inverse();
  const double step = std::max(1.0, a.cols / kPicture);
  double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (int y = -kHalf; y <= kHalf; ++y)
    for (int x = -kHalf; x <= kHalf; ++x) {
      const Eigen::Vector2d offset = step * Eigen::Vector2d(x, y);
      const auto va = sample_at(a, in_a.centre + offset);
      const auto vb = sample_at(b, in_b.centre + warp * offset);
      if (!va || !vb) return {};
      n += 1, sa += *va, sb += *vb, saa += *va * *va, sbb += *vb * *vb, sab += *va * *vb;
    }
  const double var_a = saa / n - sa * sa / (n * n), var_b = sbb / n - sb * sb / (n * n);
  constexpr double kLeastVariance = 4;  // of 8-bit grey
  if (!(var_a > kLeastVariance && var_b > kLeastVariance)) return {};
  return (sab / n - sa * sb / (n * n)) / std::sqrt(var_a * var_b);
}

// At most `most` of the items, evenly spaced: the first items may all lie in one part of the image.
template <class T>
std::vector<T> evenly(const std::vector<T>& all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<T> taken;
  for (std::size_t i = 0; i < most; ++i) taken.push_back(all[i * all.size() / most]);
  return taken;
}

}  // namespace

TrackPictures::TrackPictures(const io::ColmapModel& sample, const pose::Bundle& in_air,
                             const std::filesystem::path& image_folder)
    : sample_(sample), in_air_(in_air) {
  choose_pairs();
  read_pictures(image_folder);
}

// The pairs with the most points in common that are seen from sufficiently different directions.
// From nearly one place, all cameras predict the same.
void TrackPictures::choose_pairs() {
  const auto tracks =
      observations_of_each(in_air_.observations, &pose::Observation::point, in_air_.points.size());
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::array<std::size_t, 3>>> shared;
  constexpr double kLeastSine = 0.05;  // 3 degrees
  for (std::size_t point = 0; point < tracks.size(); ++point)
    for (const std::size_t i : tracks[point])
      for (const std::size_t j : tracks[point]) {
        const std::size_t a = in_air_.observations[i].image, b = in_air_.observations[j].image;
        if (a >= b) continue;
        const Eigen::Vector3d& x = in_air_.points[point].position;
        const Eigen::Vector3d to_a = (in_air_.images[a].pose.centre - x).normalized();
        const Eigen::Vector3d to_b = (in_air_.images[b].pose.centre - x).normalized();
        if (to_a.cross(to_b).norm() > kLeastSine && to_a.dot(to_b) > 0.8)
          shared[{a, b}].push_back({point, i, j});
      }
  std::vector<Pair> all;
  for (auto& [images, points] : shared)
    if (points.size() >= kLeastPoints / 2)
      all.push_back({images.first, images.second, std::move(points), {}});
  std::ranges::stable_sort(all, std::greater{},
                           [](const Pair& pair) { return pair.shared.size(); });
  std::set<std::size_t> taken;
  for (Pair& pair : all) {
    if (pairs_.size() == kPairs) break;
    if (taken.contains(pair.first) || taken.contains(pair.second)) continue;
    taken.insert({pair.first, pair.second});
    pair.shared = evenly(pair.shared, kPointsOfPair);
    pairs_.push_back(std::move(pair));
  }
}

void TrackPictures::read_pictures(const std::filesystem::path& image_folder) {
  std::map<std::uint32_t, cv::Size> sizes;
  for (const io::ColmapCamera& camera : sample_.cameras)
    sizes[camera.id] = {static_cast<int>(camera.width), static_cast<int>(camera.height)};
  parallel_for(2 * pairs_.size(), [&](std::size_t k) {
    Pair& pair = pairs_[k / 2];
    const io::ColmapImage& image = sample_.images[k % 2 == 0 ? pair.first : pair.second];
    pair.pictures[k % 2] = grey_picture(image_folder / image.name, sizes.at(image.camera));
  });
}

std::optional<double> TrackPictures::at_tracks() const {
  return agreement(in_air_, true);
}

std::optional<double> TrackPictures::behind(const pose::Bundle& bundle) const {
  return agreement(bundle, false);
}

std::optional<double> TrackPictures::agreement(const pose::Bundle& bundle,
                                               bool at_observations) const {
  const std::vector<pose::PhotographCamera> cameras = cameras_now(bundle);
  const auto patch = [&](std::size_t image, std::size_t observation, const Tangents& at) {
    const pose::BundleImage& from = bundle.images[image];
    std::optional<Patch> result = patch_of(cameras[from.camera], from.pose, at);
    if (result && at_observations) result->centre = in_air_.observations[observation].pixel;
    return result;
  };
  std::vector<double> values;
  for (const Pair& pair : pairs_) {
    if (pair.pictures[0].empty() || pair.pictures[1].empty()) continue;
    for (const auto& [point, i, j] : pair.shared) {
      const Tangents at =
          tangents_at(bundle.points[point].position, bundle.images[pair.first].pose.centre,
                      bundle.images[pair.second].pose.centre);
      const auto a = patch(pair.first, i, at), b = patch(pair.second, j, at);
      if (!a || !b) continue;
      if (const auto value = correlation(pair.pictures[0], *a, pair.pictures[1], *b))
        values.push_back(*value);
    }
  }
  if (values.size() < kLeastPoints) return {};
  return upper_median(std::move(values));
}

}  // namespace axial::diagnosis
