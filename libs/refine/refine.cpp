// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/refine.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/log.h"
#include "refine/anchor.h"
#include "refine/choose_pairs.h"
#include "refine/data_term.h"
#include "refine/displace.h"
#include "refine/memory.h"
#include "refine/scaled_views.h"
#include "refine/split.h"
#include "refine/system.h"
#include "refine/visible_area.h"
#include "scene/check_mesh.h"

namespace axial::refine {
namespace {

constexpr unsigned kLeastSteps = 2, kMostSteps = 6;  // at each resolution
// Steps end when they become smaller than this part of the first step at the resolution.
constexpr double kLastStep = 0.3;
constexpr unsigned kMostSplits = 6;  // each divides the area of a face by four

double median_of(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class Refinement {
 public:
  Refinement(Mesh& mesh, std::span<const View> views, const Pictures& pictures,
             const Options& options, const ProgressSink& progress)
      : mesh_(mesh), views_(views), pictures_(pictures), options_(options), progress_(progress) {}

  Report run() {
    prepare(ScaledViews(views_, pictures_, 1));
    flatten_folds(mesh_, topology_);
    first_ = mesh_.vertices;
    for (unsigned scale = options_.scales; scale-- > 0;)
      refine_at(std::pow(options_.scale_step, scale), options_.scales - 1 - scale);
    report_.moved = median_of(distances_of_measured());
    return report_;
  }

 private:
  void plan_memory() {
    Sizes sizes{mesh_.vertices.size(), mesh_.faces.size(), views_.size()};
    for (const View& view : views_)
      sizes.pixels = std::max(sizes.pixels, static_cast<std::uint64_t>(view.camera.width) *
                                                static_cast<std::uint64_t>(view.camera.height));
    kept_ = views_to_keep(sizes, options_);
  }

  // Splits large faces, and chooses the pairs of views.
  void prepare(const ScaledViews& views) {
    for (unsigned k = 0;; ++k) {
      plan_memory();
      topology_ = topology_of(mesh_);
      MeshImages images(mesh_, views, kept_);
      const Visibility visibility =
          find_visibility(mesh_, shape_of(mesh_, topology_), views, images);
      if (k < kMostSplits && options_.max_face_area > 0) {
        const std::size_t added = split_faces(
            mesh_, larger_than(options_.max_face_area, mesh_, views, visibility, images));
        report_.split_faces += added;
        if (added > 0) continue;
      }
      pairs_ = choose_pairs(mesh_, views, visibility, options_.max_views);
      break;
    }
    if (pairs_.empty()) fail("no two views see the same part of the mesh");
    report_.pairs = pairs_.size();
    log_info("{} vertices, {} faces ({} added by splitting), {} pairs of views",
             mesh_.vertices.size(), mesh_.faces.size(), report_.split_faces, pairs_.size());
  }

  // `done`: the number of resolutions before this one.
  void refine_at(double factor, unsigned done) {
    const ScaledViews views(views_, pictures_, factor);
    std::optional<Visibility> visibility;
    double first_step = 0;
    for (unsigned k = 0; k < kMostSteps; ++k) {
      const Shape shape = shape_of(mesh_, topology_);
      MeshImages images(mesh_, views, kept_);
      if (!visibility) visibility = find_visibility(mesh_, shape, views, images);
      const std::vector<FaceEquations> equations =
          measure(views, shape, *visibility, images, kLeastSteps * done + std::min(k, kLeastSteps));
      const double moved = step(equations, shape, factor);
      log_details("Step {} at {} of the size: median displacement {}", k, factor, moved);
      ++report_.steps;
      if (k == 0) first_step = moved;
      if (k + 1 >= kLeastSteps && moved <= kLastStep * first_step) break;
    }
  }

  // The partners of view i for which it is the reference view.
  std::vector<std::size_t> partners_of(std::size_t i) const {
    std::vector<std::size_t> partners;
    for (const auto& [a, b] : pairs_) {
      if (i != a && i != b) continue;
      const bool is_first = i == a;
      const bool wanted =
          options_.references == References::both ||
          (options_.references == References::first && is_first) ||
          (options_.references == References::second && !is_first) ||
          (options_.references == References::alternating && is_first == (report_.steps % 2 == 0));
      if (wanted) partners.push_back(is_first ? b : a);
    }
    return partners;
  }

  // `steps_done`: before this step, of kLeastSteps at each resolution.
  std::vector<FaceEquations> measure(const ScaledViews& views, const Shape& shape,
                                     const Visibility& visibility, MeshImages& images,
                                     unsigned steps_done) const {
    std::vector<FaceEquations> equations(mesh_.faces.size());
    for (std::size_t i = 0; i < views.count(); ++i) {
      const std::vector<std::size_t> partners = partners_of(i);
      if (partners.empty()) continue;
      const auto own = images.get(i);
      const ScaledViews::Pixels pixels = views.pixels(i);
      ReferenceView reference(mesh_, shape, *own, draw(mesh_, *own, views.size(i)), pixels.grey,
                              pixels.mask);
      for (const std::size_t s : partners) {
        const auto other = images.get(s);
        const ScaledViews::Pixels source = views.pixels(s);
        reference.add({*other, source.grey, source.mask, s}, i, visibility);
      }
      reference.finish(equations);
      tell(steps_done, i + 1);
    }
    return equations;
  }

  // `views_done`: in the step after `steps_done`.
  void tell(unsigned steps_done, std::size_t views_done) const {
    const std::size_t total = options_.scales * kLeastSteps * views_.size();
    // Whether a resolution takes more steps than the least number is not known before.
    if (progress_) progress_(std::min(steps_done * views_.size() + views_done, total), total);
  }

  // Moves the vertices. Returns the median displacement of measured vertices.
  double step(std::span<const FaceEquations> equations, const Shape& shape, double factor) {
    System system(mesh_, topology_, shape, equations, options_.smoothness);
    information_ = system.information();
    if (options_.anchor > 0) {
      const std::vector<float> offset = offsets(mesh_.vertices, first_, shape);
      system.add_anchor(
          anchor_weights(information_, offset, system.solve(), {options_.anchor, factor}), offset);
    }
    const std::vector<float> displacement = system.solve();
    displace(mesh_, topology_, shape, displacement);
    std::vector<float> moved;
    for (std::size_t v = 0; v < displacement.size(); ++v)
      if (information_[v] > 0) moved.push_back(std::abs(displacement[v]));
    return median_of(std::move(moved));
  }

  std::vector<float> distances_of_measured() {
    std::vector<float> moved;
    for (std::size_t v = 0; v < first_.size(); ++v)
      if (information_[v] > 0) moved.push_back((mesh_.vertices[v] - first_[v]).norm());
    report_.measured = moved.size();
    return moved;
  }

  Mesh& mesh_;
  const std::span<const View> views_;
  const Pictures& pictures_;
  const Options& options_;
  const ProgressSink& progress_;
  Topology topology_;
  std::vector<Eigen::Vector3f> first_;  // positions before the first step
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
  std::vector<double> information_;  // of every vertex in the last step
  std::size_t kept_ = 2;             // views whose vertex images are kept
  Report report_;
};

}  // namespace

Report refine(Mesh& mesh, std::span<const View> views, const Pictures& pictures,
              const Options& options, const ProgressSink& progress) {
  check_mesh(mesh);
  return Refinement(mesh, views, pictures, options, progress).run();
}

}  // namespace axial::refine
