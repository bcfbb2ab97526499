// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/sweep/lane_matcher.h"

#include <limits>
#include <map>
#include <utility>

#include "base/error.h"
#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"
#include "refractive/lens_camera.h"

namespace axial::depth {
namespace {

using lanes::kLanes;
using refractive::DomePortCamera;
using refractive::FlatPortCamera;
using refractive::LensDomePortCamera;
using refractive::LensFlatPortCamera;
using refractive::LensPinholeCamera;
using refractive::PinholeCamera;

template <class Camera>
using Sources = std::span<const SourceView<Camera>* const>;

template <class Camera>
lanes::CameraFields projector_of(const Camera& camera) {
  return visit_kind(camera, [](const auto& kind) { return fields_of(kind.projector()); });
}

template <class Camera>
void add_view(lanes::SceneTables& tables, const SourceView<Camera>& source, std::size_t view,
              bool with_depths) {
  const lanes::CameraFields fields = projector_of(source.camera);
  const refractive::RigidTransform<float> to_projector =
      visit_kind(source.camera, [](const auto& kind) { return kind.projector_frame(); });
  const Eigen::Matrix3f rotation = to_projector.rotation * source.from_reference.rotation;
  const Eigen::Vector3f translation =
      to_projector.rotation * source.from_reference.translation + to_projector.translation;
  for (std::size_t k = 0; k < fields.value.size(); ++k) tables.projector[k][view] = fields.value[k];
  tables.steps = std::max(tables.steps, fields.steps);
  for (std::size_t k = 0; k < 9; ++k)
    tables.rotation[k][view] = rotation(static_cast<int>(k / 3), static_cast<int>(k % 3));
  for (std::size_t k = 0; k < 3; ++k)
    tables.translation[k][view] = translation(static_cast<int>(k));

  const QuadImage& image = *source.image;
  if (std::max(image.width(), image.height()) > lanes::kLargestSide)
    fail("a source image is {}x{}, but matching supports at most {} pixels along a side",
         image.width(), image.height(), lanes::kLargestSide);
  const auto pixels =
      static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
  if (tables.words.size() + pixels > std::numeric_limits<std::int32_t>::max())
    fail("the source images of one view have more than 2^31 pixels together");
  tables.image_begin[view] = static_cast<std::int32_t>(tables.words.size());
  tables.width[view] = static_cast<float>(image.width());
  tables.height[view] = static_cast<float>(image.height());
  tables.words.insert(tables.words.end(), image.words(), image.words() + pixels);
  if (!with_depths) return;
  tables.has_depth[view] = source.depth ? 1.0f : 0.0f;
  tables.depths.resize(tables.words.size(), 0.0f);
  if (!source.depth) return;
  const cv::Mat1f& depth = *source.depth;
  float* to = tables.depths.data() + (tables.depths.size() - pixels);
  for (int y = 0; y < depth.rows; ++y, to += depth.cols) std::copy_n(depth[y], depth.cols, to);
}

// Precondition: all `sources` have the same kind of camera.
template <class Camera>
std::unique_ptr<lanes::SceneTables> make_tables(Sources<Camera> sources,
                                                const PatchMatchOptions& options) {
  auto tables = std::make_unique<lanes::SceneTables>();
  tables->kind = kind_of(sources[0]->camera);
  tables->smoothness = options.smoothness;
  tables->geometric_weight = options.geometric_weight;
  tables->geometric_limit = options.geometric_limit;
  // Reserved at once, because a growing vector would need twice the memory.
  std::size_t pixels = 0;
  for (const auto* source : sources)
    pixels += static_cast<std::size_t>(source->image->width()) *
              static_cast<std::size_t>(source->image->height());
  tables->words.reserve(pixels);
  const bool with_depths = std::any_of(sources.begin(), sources.end(),
                                       [](const auto* source) { return source->depth != nullptr; });
  if (with_depths) tables->depths.reserve(pixels);
  for (std::size_t view = 0; view < sources.size(); ++view)
    add_view(*tables, *sources[view], view, with_depths);
  const lanes::CameraFields first = projector_of(sources[0]->camera);
  tables->same_projector = std::all_of(sources.begin(), sources.end(), [&](const auto* source) {
    return projector_of(source->camera) == first;
  });
  return tables;
}

// The indices of the views, grouped by kind of camera.
template <class Camera>
std::map<lanes::CameraKind, std::vector<std::size_t>> views_by_kind(
    std::span<const SourceView<Camera>> sources) {
  std::map<lanes::CameraKind, std::vector<std::size_t>> views;
  for (std::size_t i = 0; i < sources.size(); ++i) views[kind_of(sources[i].camera)].push_back(i);
  return views;
}

std::array<float, 3> floats(const Eigen::Vector3f& v) {
  return {v.x(), v.y(), v.z()};
}

lanes::LanePixel lane_pixel(const ReferencePixel& pixel) {
  const auto& jacobian = pixel.jacobian;
  return {floats(pixel.ray.origin),
          floats(pixel.ray.direction),
          floats(jacobian.origin.col(0)),
          floats(jacobian.origin.col(1)),
          floats(jacobian.direction.col(0)),
          floats(jacobian.direction.col(1)),
          pixel.prior_depth,
          pixel.prior_weight,
          &pixel.patch};
}

lanes::LanePlanes lane_planes(std::span<const PlaneHypothesis> from) {
  lanes::LanePlanes planes;
  for (std::size_t k = 0; k < from.size(); ++k) {
    planes.depth[k] = from[k].depth;
    planes.nx[k] = from[k].normal.x();
    planes.ny[k] = from[k].normal.y();
    planes.nz[k] = from[k].normal.z();
  }
  return planes;
}

}  // namespace

template <InLanes Camera>
LaneMatcher<Camera>::LaneMatcher(const cv::Mat1b& image, Camera camera,
                                 std::span<const SourceView<Camera>> sources,
                                 const PatchMatchOptions& options, lanes::InstructionSet set)
    : pixels_(image, camera, options), caster_(camera, set), views_(sources.size()) {
  for (const auto& [kind, views] : views_by_kind(sources)) {
    for (std::size_t first = 0; first < views.size(); first += kLanes) {
      std::vector<const SourceView<Camera>*> members;
      for (std::size_t k = first; k < std::min(first + kLanes, views.size()); ++k) {
        lane_of_view_.at(views[k]) = {static_cast<std::uint8_t>(groups_.size()),
                                      static_cast<std::uint8_t>(k - first)};
        members.push_back(&sources[views[k]]);
      }
      Group group;
      group.tables = make_tables<Camera>(members, options);
      group.scorer = lanes::make_scorer(*group.tables, set);
      groups_.push_back(std::move(group));
    }
  }
}

template <InLanes Camera>
void LaneMatcher<Camera>::score(const ReferencePixel& pixel,
                                std::span<const PlaneHypothesis> planes,
                                std::span<const ScorePair> pairs,
                                std::span<const SurfacePoint> neighbours,
                                std::span<PlaneScore> scores) const {
  const lanes::LanePixel lane = lane_pixel(pixel);
  const lanes::LanePlanes all = lane_planes(planes);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    lanes::LanePairs batch;
    std::array<std::size_t, kLanes> target;
    std::size_t count = 0;
    const auto run = [&] {
      for (std::size_t k = count; k < kLanes; ++k) {
        batch.plane[k] = batch.plane[0];
        batch.view[k] = batch.view[0];
      }
      batch.count = std::exchange(count, 0);
      lanes::LaneScores result;
      groups_[g].scorer->score(lane, all, batch, neighbours, result);
      for (std::size_t k = 0; k < batch.count; ++k)
        scores[target[k]] = {result.cost[k], result.motion[k], result.smoothness[k]};
    };
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const LaneOfView of_view = lane_of_view_[pairs[i].view];
      if (of_view.group != g) continue;
      batch.plane[count] = pairs[i].plane;
      batch.view[count] = of_view.lane;
      target[count++] = i;
      if (count == kLanes) run();
    }
    if (count > 0) run();
  }
}

template class LaneMatcher<PinholeCamera<float>>;
template class LaneMatcher<FlatPortCamera<float>>;
template class LaneMatcher<DomePortCamera<float>>;
template class LaneMatcher<LensPinholeCamera<float>>;
template class LaneMatcher<LensFlatPortCamera<float>>;
template class LaneMatcher<LensDomePortCamera<float>>;
template class LaneMatcher<AnyCamera<float>>;

}  // namespace axial::depth
