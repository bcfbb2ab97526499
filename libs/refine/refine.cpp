// SPDX-License-Identifier: GPL-3.0-or-later
#include "axial/refine.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/order_statistics.h"
#include "geometry/posed_camera.h"
#include "refine/anchor.h"
#include "refine/choose_pairs.h"
#include "refine/data_term.h"
#include "refine/displace.h"
#include "refine/memory.h"
#include "refine/scaled_views.h"
#include "refine/split.h"
#include "refine/system.h"
#include "scene/check_mesh.h"

namespace axial::refine {
namespace {

constexpr unsigned kLeastSteps = 2, kMostSteps = 6;  // at each resolution
// Steps end when they become smaller than this part of the first step at the resolution.
constexpr double kLastStep = 0.3;
constexpr unsigned kMostSplits = 6;  // each divides the area of a face by four

// Turns the work that is done into numbers that never fall. A resolution has kMostSteps steps or
// fewer, and the work of a step is in proportion to the pixels of its resolution.
class Work {
 public:
  // `done`: the number of resolutions that were done before.
  Work(const Options& options, unsigned done, ProgressSink progress)
      : progress_(std::move(progress)) {
    double work = 0;
    for (unsigned k = 0; k < options.scales; ++k) {
      before_.push_back(work);
      if (k >= done) work += std::pow(options.scale_step, 2 * (options.scales - 1 - k));
    }
    before_.push_back(work);
  }

  // `part` (0 to 1) of a step is done. `step`: its number at the resolution with number `k`.
  void tell_step(unsigned k, unsigned step, double part) const {
    const double of_step = (before_[k + 1] - before_[k]) / kMostSteps;
    tell(std::min(before_[k] + of_step * (step + part), kNearEnd * before_.back()));
  }
  // `done` resolutions are done.
  void tell_end(unsigned done) const { tell(before_[done]); }

 private:
  static constexpr std::size_t kTotal = 1000;
  static constexpr double kNearEnd = 0.999;  // the end itself is told once

  void tell(double work) const {
    progress_(static_cast<std::size_t>(std::floor(work / before_.back() * kTotal + 1e-6)), kTotal);
  }

  ProgressSink progress_;
  std::vector<double> before_;  // the work before each resolution, and all work
};

class Refinement {
 public:
  Refinement(State& state, std::span<const PosedCamera> views, const Pictures& pictures,
             const Options& options, const Context& context)
      : state_(state),
        mesh_(state.mesh),
        report_(state.report),
        views_(views),
        pictures_(pictures),
        options_(options),
        context_(context),
        budget_(context.memory().share()),
        work_(options, state.done, context.stage("Refined")) {}

  void run(const Checkpoint& checkpoint) {
    if (state_.done == 0)
      begin();
    else
      go_on();
    while (state_.done < options_.scales) {
      refine_at(std::pow(options_.scale_step, options_.scales - 1 - state_.done));
      report_.moved = upper_median(distances_of_measured());
      work_.tell_end(++state_.done);
      if (checkpoint) checkpoint(state_);
    }
  }

 private:
  void begin() {
    prepare(ScaledViews(views_, pictures_, 1));
    flatten_folds(mesh_, topology_);
    state_.first = mesh_.vertices;
  }

  void go_on() {
    plan_memory();
    topology_ = topology_of(mesh_);
  }

  Sizes sizes() const {
    return {mesh_.vertices.size(), mesh_.faces.size(), views_.size(),
            geometry::most_pixels(views_)};
  }

  void plan_memory() { kept_ = views_to_keep(sizes(), options_, budget_); }

  // Splits large faces, and chooses the pairs of views.
  void prepare(const ScaledViews& views) {
    for (unsigned k = 0;; ++k) {
      plan_memory();
      topology_ = topology_of(mesh_);
      const std::vector<bool> large = large_faces(views, k < kMostSplits);
      const auto marked = static_cast<std::uint64_t>(std::ranges::count(large, true));
      if (marked == 0) break;
      budget_.require(bytes_to_split(sizes(), marked),
                      fmt::format("splitting {} of {} faces", marked, mesh_.faces.size()));
      report_.split_faces += split_faces(mesh_, large);
    }
    if (state_.pairs.empty()) fail("no two views see the same part of the mesh");
    report_.pairs = state_.pairs.size();
    context_.info("{} vertices, {} faces ({} added by splitting), {} pairs of views",
                  mesh_.vertices.size(), mesh_.faces.size(), report_.split_faces,
                  state_.pairs.size());
  }

  // Marks the faces to split, if any may be split. If there is none, chooses the pairs of views.
  std::vector<bool> large_faces(const ScaledViews& views, bool may_split) {
    MeshImages images(mesh_, views, kept_);
    const Visibility visibility = find_visibility(mesh_, shape_of(mesh_, topology_), views, images);
    if (may_split && options_.max_face_area > 0) {
      std::vector<bool> large =
          larger_than(options_.max_face_area, mesh_, views, visibility, images);
      if (std::ranges::count(large, true) > 0) return large;
    }
    state_.pairs = choose_pairs(mesh_, views, visibility, options_.max_views);
    return {};
  }

  void refine_at(double factor) {
    const ScaledViews views(views_, pictures_, factor);
    std::optional<Visibility> visibility;
    double first_step = 0;
    for (unsigned k = 0; k < kMostSteps; ++k) {
      const Shape shape = shape_of(mesh_, topology_);
      MeshImages images(mesh_, views, kept_);
      if (!visibility) visibility = find_visibility(mesh_, shape, views, images);
      const std::vector<FaceEquations> equations = measure(views, shape, *visibility, images, k);
      const double moved = step(equations, shape, factor);
      context_.details("Step {} at {} of the size: median displacement {}", k, factor, moved);
      ++report_.steps;
      if (k == 0) first_step = moved;
      if (k + 1 >= kLeastSteps && moved <= kLastStep * first_step) break;
    }
  }

  // The partners of view i for which it is the reference view.
  std::vector<std::size_t> partners_of(std::size_t i) const {
    std::vector<std::size_t> partners;
    for (const auto& [a, b] : state_.pairs) {
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

  // `number`: the number of the step at this resolution.
  std::vector<FaceEquations> measure(const ScaledViews& views, const Shape& shape,
                                     const Visibility& visibility, MeshImages& images,
                                     unsigned number) const {
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
      work_.tell_step(state_.done, number,
                      static_cast<double>(i + 1) / static_cast<double>(views.count()));
    }
    return equations;
  }

  // Moves the vertices. Returns the median displacement of measured vertices.
  double step(std::span<const FaceEquations> equations, const Shape& shape, double factor) {
    System system(mesh_, topology_, shape, equations, options_.smoothness);
    information_ = system.information();
    if (options_.anchor > 0) {
      const std::vector<float> offset = offsets(mesh_.vertices, state_.first, shape);
      system.add_anchor(
          anchor_weights(information_, offset, system.solve(), {options_.anchor, factor}), offset);
    }
    const std::vector<float> displacement = system.solve();
    displace(mesh_, topology_, shape, displacement);
    std::vector<float> moved;
    for (std::size_t v = 0; v < displacement.size(); ++v)
      if (information_[v] > 0) moved.push_back(std::abs(displacement[v]));
    return upper_median(std::move(moved));
  }

  std::vector<float> distances_of_measured() {
    std::vector<float> moved;
    for (std::size_t v = 0; v < state_.first.size(); ++v)
      if (information_[v] > 0) moved.push_back((mesh_.vertices[v] - state_.first[v]).norm());
    report_.measured = moved.size();
    return moved;
  }

  State& state_;
  Mesh& mesh_;      // of the state
  Report& report_;  // of the state
  const std::span<const PosedCamera> views_;
  const Pictures& pictures_;
  const Options& options_;
  const Context& context_;
  MemoryBudget budget_;
  const Work work_;
  Topology topology_;
  std::vector<double> information_;  // of every vertex in the last step
  std::size_t kept_ = 2;             // views whose vertex images are kept
};

}  // namespace

void refine(State& state, std::span<const PosedCamera> views, const Pictures& pictures,
            const Options& options, const Checkpoint& checkpoint, const Context& context) {
  check_mesh(state.mesh);
  Refinement(state, views, pictures, options, context).run(checkpoint);
}

Report refine(Mesh& mesh, std::span<const PosedCamera> views, const Pictures& pictures,
              const Options& options, const Context& context) {
  State state;
  std::swap(state.mesh, mesh);
  try {
    refine(state, views, pictures, options, {}, context);
  } catch (...) {
    std::swap(state.mesh, mesh);
    throw;
  }
  std::swap(state.mesh, mesh);
  return state.report;
}

}  // namespace axial::refine
