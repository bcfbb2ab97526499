// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/view_fusion.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"

namespace axial::cloud {
namespace {

// Pixels of one collect(): few enough for the answers to stay in the processor's cache.
constexpr std::size_t kPixels = std::size_t{1} << 16;

// The weighted mean of the pixels that support one point.
class Mean {
 public:
  void add(const FusionMap& map, std::uint32_t pixel, const Eigen::Vector3f& point) {
    const auto weight = static_cast<double>(map.weight_at(pixel));
    total_ += weight;
    position_ += weight * point.cast<double>();
    normal_ += weight * map.normal_at(pixel).cast<double>();
    if (map.color.empty()) return;
    const cv::Vec3b bgr = map.color_at(pixel);
    color_ += weight * Eigen::Vector3d(bgr[2], bgr[1], bgr[0]);
  }

  Eigen::Vector3f position() const { return (position_ / total_).cast<float>(); }

  // The direction to `camera` if no pixel has a normal.
  Eigen::Vector3f normal(const Eigen::Vector3d& camera) const {
    if (normal_.norm() > 1e-6 * total_) return normal_.stableNormalized().cast<float>();
    return (camera - position_ / total_).stableNormalized().cast<float>();
  }

  Rgb color() const {
    Rgb rgb;
    for (int c = 0; c < 3; ++c)
      rgb[static_cast<std::size_t>(c)] =
          static_cast<std::uint8_t>(std::clamp(color_(c) / total_ + 0.5, 0.0, 255.0));
    return rgb;
  }

 private:
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d color_ = Eigen::Vector3d::Zero();
  double total_ = 0;
};

// Inserts a view into the sorted views [begin, end) of a point. A point has only few views.
void insert_view(PointCloud& cloud, std::size_t begin, std::size_t end, std::uint32_t image,
                 float weight) {
  std::size_t k = end;
  for (; k > begin && cloud.view_images[k - 1] > image; --k) {
    cloud.view_images[k] = cloud.view_images[k - 1];
    cloud.view_weights[k] = cloud.view_weights[k - 1];
  }
  cloud.view_images[k] = image;
  cloud.view_weights[k] = weight;
}

}  // namespace

ViewFusion::ViewFusion(std::span<const WorkingView> views)
    : views_(views.begin(), views.end()), where_(views.size()), answers_(views.size() - 1) {}

std::size_t ViewFusion::collect(std::size_t pixel) {
  for (PixelPoints& where : where_) where.pixels.clear();
  supports_.clear();
  begin_.assign(1, 0);
  const auto& [image, map, taken, reduction] = views_[0];
  std::vector<std::uint32_t>& asking = where_[0].pixels;
  for (; pixel < map->pixels() && asking.size() < kPixels; ++pixel)
    if (map->depth_at(pixel) > 0 && !(*taken)[pixel])
      asking.push_back(static_cast<std::uint32_t>(pixel));
  back_project(*map, where_[0]);
  return pixel;
}

void ViewFusion::keep_collected_in(const Tile& box) {
  auto& [pixels, points] = where_[0];
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!box.contains(points[i].cast<double>())) continue;
    pixels[kept] = pixels[i];
    points[kept++] = points[i];
  }
  pixels.resize(kept);
  points.resize(kept);
}

void ViewFusion::compare(const FuseOptions& options) {
  if (options.errors && cameras_.empty())
    for (const WorkingView& view : views_) cameras_.emplace_back(view.map->camera, view.map->pose);
  for (std::size_t n = 0; n < answers_.size(); ++n) {
    answers_[n].resize(where_[0].pixels.size());
    ask_neighbour(*views_[0].map, *views_[n + 1].map, where_[0], options, answers_[n]);
  }
  proved_by_two_.clear();
  if (options.two_if_undisputed && options.min_views > 2) find_proved_by_two(options);
}

void ViewFusion::find_proved_by_two(const FuseOptions& options) {
  proved_by_two_.resize(where_[0].pixels.size());
  const auto max_distance = static_cast<float>(0.5 * options.depth_threshold);
  std::vector<SurfacePieces> pieces;
  for (const WorkingView& view : views_) pieces.emplace_back(*view.map, max_distance);
  parallel_for(
      proved_by_two_.size(),
      [&](std::size_t i) {
        const std::optional<std::size_t> n = undisputed_witness(answers_, i);
        proved_by_two_[i] = n && pieces[0].around(where_[0].pixels[i]) &&
                            pieces[*n + 1].around(answers_[*n][i].pixel());
      },
      kPointGrain);
}

// The only serial pass: if two points need the same pixel, the first one gets it.
void ViewFusion::accept(std::size_t min_views) {
  std::vector<std::size_t> joining;
  std::vector<std::pair<std::size_t, std::uint32_t>> disproved;
  for (std::size_t i = 0; i < where_[0].pixels.size(); ++i) {
    joining.clear();
    disproved.clear();
    for (std::size_t v = 1; v < views_.size(); ++v) {
      const Answer answer = answers_[v - 1][i];
      if (!answer.names_pixel() || (*views_[v].taken)[answer.pixel()]) continue;
      if (answer.agrees())
        joining.push_back(v);
      else
        disproved.emplace_back(v, answer.pixel());
    }
    const bool by_two = !joining.empty() && !proved_by_two_.empty() && proved_by_two_[i];
    if (joining.size() + 1 < min_views && !by_two) continue;
    (*views_[0].taken)[where_[0].pixels[i]] = true;
    supports_.push_back({0, static_cast<std::uint32_t>(i)});
    for (const std::size_t v : joining) {
      std::vector<std::uint32_t>& pixels = where_[v].pixels;
      supports_.push_back(
          {static_cast<std::uint32_t>(v), static_cast<std::uint32_t>(pixels.size())});
      pixels.push_back(answers_[v - 1][i].pixel());
      (*views_[v].taken)[pixels.back()] = true;
    }
    for (const auto& [v, pixel] : disproved) (*views_[v].taken)[pixel] = true;
    begin_.push_back(supports_.size());
  }
  for (std::size_t v = 1; v < views_.size(); ++v) back_project(*views_[v].map, where_[v]);
}

PointCloud ViewFusion::points(const FuseOptions& options) const {
  PointCloud cloud;
  cloud.positions.resize(size());
  if (options.normals || options.errors) cloud.normals.resize(size());
  if (!views_[0].map->color.empty()) cloud.colors.resize(size());
  cloud.view_begin = begin_;
  cloud.view_images.resize(supports_.size());
  cloud.view_weights.resize(supports_.size());
  parallel_for(
      size(), [&](std::size_t i) { average(i, cloud); }, kPointGrain);
  if (options.errors) estimate_errors(cloud);
  if (!options.normals) cloud.normals.clear();
  return cloud;
}

void ViewFusion::average(std::size_t point, PointCloud& cloud) const {
  Mean mean;
  for (std::size_t k = begin_[point]; k < begin_[point + 1]; ++k) {
    const auto [v, index] = supports_[k];
    const FusionMap& map = *views_[v].map;
    const std::uint32_t pixel = where_[v].pixels[index];
    mean.add(map, pixel, where_[v].points[index]);
    insert_view(cloud, begin_[point], k, views_[v].image, map.weight_at(pixel));
  }
  cloud.positions[point] = mean.position();
  if (!cloud.normals.empty()) cloud.normals[point] = mean.normal(views_[0].map->pose.centre);
  if (!cloud.colors.empty()) cloud.colors[point] = mean.color();
}

void ViewFusion::estimate_errors(PointCloud& cloud) const {
  cloud.errors.resize(size());
  cloud.confidences.resize(size());
  parallel_for(
      size(),
      [&](std::size_t i) {
        thread_local std::vector<PointSupport> memory;  // is reused for the next point
        std::vector<PointSupport>& supports = memory;
        supports.clear();
        for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) {
          const auto [v, index] = supports_[k];
          const FusionMap& map = *views_[v].map;
          const std::uint32_t pixel = where_[v].pixels[index];
          const auto depth = static_cast<double>(map.depth_at(pixel));
          supports.push_back(cameras_[v].support(pixel, depth, map.cost_at(pixel),
                                                 where_[v].points[index].cast<double>()));
        }
        const std::uint32_t asking = where_[0].pixels[supports_[begin_[i]].index];
        const PointError error =
            expected_error(supports, cloud.normals[i].cast<double>(),
                           surroundings(*views_[0].map, asking, views_[0].reduction));
        cloud.errors[i] = error.error;
        cloud.confidences[i] = error.confidence;
      },
      kPointGrain);
}

}  // namespace axial::cloud
