// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/patch_error.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "experiments/scaled_virtual_camera.h"
#include "refractive/affine_warp.h"

namespace axial::experiments {
namespace {

using refractive::AxialRay;
using refractive::Matrix3;

// The cameras' axes are parallel.
Matrix3<double> no_rotation() {
  return Matrix3<double>::Identity();
}

Vector2<double> texel(const Vector2<double>& centre, std::size_t k) {
  const auto side = static_cast<std::size_t>(kPatchSide);
  const Vector2<double> offset(static_cast<double>(k % side), static_cast<double>(k / side));
  return centre + kPatchStep * offset - Vector2<double>(kPatchReach, kPatchReach);
}

// The number of centres in one direction.
std::size_t centres_along(int size, int border = kPatchReach) {
  return static_cast<std::size_t>(std::max(0, size - 2 * border));
}

Vector2<double> centre_at(std::size_t column, std::size_t row, int border = kPatchReach) {
  return {static_cast<double>(column) + border, static_cast<double>(row) + border};
}

}  // namespace

double mean_error(const TexelErrors& errors) {
  return std::accumulate(errors.begin(), errors.end(), 0.0) / kPatchTexels;
}

struct WarpStudy::Warps {
  std::array<Matrix3<double>, 5> homographies;  // kPapers to kScaled
  refractive::AffineWarp<double> first_order;
};

WarpStudy::WarpStudy(const StereoSetup& setup, int size, int fov_size)
    : size_(size),
      papers_(make_lens(setup.camera, size, size, fov_size), make_port(setup.camera), size, size),
      camera_(papers_.exact()),
      single_(papers_.lens().cast<float>(), papers_.port().cast<float>(), size, size),
      source_(source_centre(setup)),
      plane_point_(plane_point(setup)),
      plane_normal_(plane_normal(setup)) {}

std::optional<Vector2<double>> WarpStudy::true_image(const Vector2<double>& q) const {
  const AxialRay<double> ray = camera_.ray(q);
  const double lambda = refractive::plane_intersection(ray, plane_point_, plane_normal_);
  if (!(lambda > 0)) return std::nullopt;
  const auto image = camera_.project(ray.at(lambda) - source_);
  if (!image.visible || image.pixel.minCoeff() < 0 || image.pixel.maxCoeff() > size_ - 1)
    return std::nullopt;
  return image.pixel;
}

Vector2<double> WarpStudy::single_image(const Vector2<double>& q) const {
  const Vector3<float> X = plane_point_.cast<float>(), n = plane_normal_.cast<float>();
  const AxialRay<float> ray = single_.ray(q.cast<float>());
  const Vector3<float> seen = ray.at(refractive::plane_intersection(ray, X, n));
  return single_.project(Vector3<float>(seen - source_.cast<float>())).pixel.cast<double>();
}

std::optional<WarpStudy::Warps> WarpStudy::make_warps(const Vector2<double>& p) const {
  const AxialRay<double> ray = camera_.ray(p);
  const Vector3<double>& n = plane_normal_;
  const double lambda = refractive::plane_intersection(ray, plane_point_, n);
  if (!(lambda > 0)) return std::nullopt;
  const Vector3<double> X = ray.at(lambda);
  const Matrix3<double> R = no_rotation();
  Warps warps;
  warps.first_order = refractive::affine_warp(camera_, camera_, R, source_, p, lambda, n);
  const auto searched = papers_.project(X - source_);
  if (!warps.first_order.visible || !searched.visible) return std::nullopt;

  const Vector2<double>& exact = warps.first_order.to;
  const Vector2<double> nearest = exact.array().round();
  const auto reference = refractive::virtual_camera(camera_, p);
  const auto homography = [&](const refractive::VirtualCamera<double>& source) {
    return refractive::virtual_homography(reference, source, R, source_, X, n);
  };
  const auto scaled_reference = scaled_virtual_camera(camera_, p);
  const auto scaled = [&](const Vector2<double>& x) {
    return scaled_homography(scaled_reference, scaled_virtual_camera(camera_, x), R, source_, X, n);
  };
  warps.homographies = {homography(papers_.lookup().virtual_camera(searched.pixel)),
                        homography(refractive::virtual_camera(camera_, nearest)),
                        homography(refractive::virtual_camera(camera_, exact)), scaled(nearest),
                        scaled(exact)};
  return warps;
}

std::optional<PatchErrors> WarpStudy::errors(const Vector2<double>& centre) const {
  const std::optional<Warps> warps = make_warps(centre);
  if (!warps) return std::nullopt;
  PatchErrors errors;
  for (std::size_t k = 0; k < kPatchTexels; ++k) {
    const Vector2<double> q = texel(centre, k);
    const std::optional<Vector2<double>> truth = true_image(q);
    if (!truth) return std::nullopt;
    const auto set = [&](Warp warp, const Vector2<double>& image) {
      errors.warps[static_cast<std::size_t>(warp)][k] = (image - *truth).norm();
    };
    for (std::size_t w = 0; w < warps->homographies.size(); ++w)
      set(static_cast<Warp>(w), refractive::apply_homography(warps->homographies[w], q));
    set(Warp::kFirstOrder, warps->first_order(q));
    set(Warp::kPerTexel, single_image(q));
  }
  return errors;
}

namespace {

// Sums over some centres. Shares are counts until study_statistics() divides them.
void add(StudyStatistics& sum, const PatchErrors& patch) {
  ++sum.centres;
  for (std::size_t w = 0; w < kWarps; ++w) {
    const double mean = mean_error(patch.warps[w]);
    sum.warps[w].mean += mean;
    sum.warps[w].largest = std::max(sum.warps[w].largest, mean);
    sum.warps[w].mean_at_centre += patch.warps[w][kPatchCentre];
  }
  const TexelErrors& papers = patch[Warp::kPapers];
  const double warp_alone = mean_error(patch[Warp::kExactCentre]);
  sum.rounding_over_warp += patch[Warp::kRounded][kPatchCentre] > warp_alone ? 1 : 0;
  sum.papers_rounding_over_warp += papers[kPatchCentre] > warp_alone ? 1 : 0;
  const double least = *std::min_element(papers.begin(), papers.end());
  sum.middle_not_least += least < papers[kPatchCentre] ? 1 : 0;
}

void add(StudyStatistics& sum, const StudyStatistics& other) {
  sum.centres += other.centres;
  for (std::size_t w = 0; w < kWarps; ++w) {
    sum.warps[w].mean += other.warps[w].mean;
    sum.warps[w].largest = std::max(sum.warps[w].largest, other.warps[w].largest);
    sum.warps[w].mean_at_centre += other.warps[w].mean_at_centre;
  }
  sum.rounding_over_warp += other.rounding_over_warp;
  sum.papers_rounding_over_warp += other.papers_rounding_over_warp;
  sum.middle_not_least += other.middle_not_least;
}

}  // namespace

StudyStatistics study_statistics(const WarpStudy& study, int step) {
  const auto stride = static_cast<std::size_t>(step);
  const std::size_t count = (centres_along(study.size()) + stride - 1) / stride;
  std::vector<StudyStatistics> rows(count);
  parallel_for(count, [&](std::size_t row) {
    for (std::size_t column = 0; column < count; ++column)
      if (const auto patch = study.errors(centre_at(column * stride, row * stride)))
        add(rows[row], *patch);
  });
  StudyStatistics all;
  for (const StudyStatistics& row : rows) add(all, row);
  if (all.centres == 0) return all;
  const double share = 1.0 / static_cast<double>(all.centres);
  for (WarpStatistics& warp : all.warps) warp.mean *= share, warp.mean_at_centre *= share;
  all.rounding_over_warp *= share;
  all.papers_rounding_over_warp *= share;
  all.middle_not_least *= share;
  return all;
}

std::vector<double> patch_error_map(const WarpStudy& study, Warp warp) {
  const std::size_t side = centres_along(study.size());
  std::vector<double> map(side * side, -1);
  parallel_for(side, [&](std::size_t row) {
    for (std::size_t column = 0; column < side; ++column)
      if (const auto patch = study.errors(centre_at(column, row)))
        map[row * side + column] = mean_error((*patch)[warp]);
  });
  return map;
}

std::vector<double> exploded_error_map(const WarpStudy& study, Warp warp, int border) {
  const std::size_t side = centres_along(study.size(), border);
  const auto cell = static_cast<std::size_t>(kPatchSide);
  std::vector<double> map(side * side * kPatchTexels, -1);
  parallel_for(side, [&](std::size_t row) {
    for (std::size_t column = 0; column < side; ++column) {
      const auto patch = study.errors(centre_at(column, row, border));
      for (std::size_t k = 0; patch && k < kPatchTexels; ++k)
        map[(row * cell + k / cell) * side * cell + column * cell + k % cell] = (*patch)[warp][k];
    }
  });
  return map;
}

}  // namespace axial::experiments
