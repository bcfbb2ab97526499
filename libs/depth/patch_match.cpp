// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/patch_match.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/huge_pages.h"
#include "depth/plane_map.h"
#include "depth/sparse_init.h"
#include "depth/sweep/lane_matcher.h"
#include "depth/sweep/matcher.h"
#include "depth/sweep/sweep.h"
#include "depth/views/ray_caster.h"
#include "scene/camera_list.h"

namespace axial::depth {
namespace {

// The views at one resolution level.
struct Level {
  std::vector<CameraModel> cameras;  // reference first
  std::vector<cv::Mat1b> images;
  std::vector<QuadImage> quads;  // of the sources
};

struct DepthRange {
  float min = 0, max = 0;
};

// The inputs of one resolution level.
struct LevelState {
  PlaneMap planes;  // initial hypotheses
  cv::Mat1f prior;  // depths of the coarser level; empty: none
  cv::Mat1b mask;   // empty: all pixels
};

Level make_level(const MatchInput& input, int halvings) {
  Level level;
  const auto add = [&](const MatchImage& view) {
    check_stop(input.stop);
    const int width = std::max(1, view.grey.cols >> halvings);
    const int height = std::max(1, view.grey.rows >> halvings);
    cv::Mat1b image = view.grey;
    if (halvings > 0) cv::resize(view.grey, image, {width, height}, 0, 0, cv::INTER_AREA);
    level.cameras.push_back(view.camera.resized(width, height));
    level.images.push_back(image);
  };
  add(*input.reference);
  for (const MatchImage* source : input.sources) add(*source);
  for (std::size_t i = 1; i < level.images.size(); ++i) {
    check_stop(input.stop);
    level.quads.emplace_back(level.images[i]);
  }
  return level;
}

template <class Camera>
std::vector<SourceView<Camera>> make_sources(const MatchInput& input, const Level& level,
                                             const std::vector<Camera>& cameras,
                                             std::span<const DepthMap* const> maps) {
  std::vector<SourceView<Camera>> sources;
  for (std::size_t i = 0; i < input.sources.size(); ++i) {
    const DepthMap* map = i < maps.size() ? maps[i] : nullptr;
    sources.push_back({cameras[i + 1], RelativePose(input.reference->pose, input.sources[i]->pose),
                       &level.quads[i], map ? &map->depth : nullptr});
  }
  return sources;
}

template <class Warp, class Camera>
void run_sweeps_with(const MatchInput& input, const Level& level,
                     const std::vector<Camera>& cameras, std::span<const DepthMap* const> maps,
                     const PatchMatchOptions& options, SweepInput sweep, int sweeps,
                     PlaneMap& planes) {
  const auto sources = make_sources(input, level, cameras, maps);
  sweep.stop = input.stop;
  const auto run_all = [&](const auto& matcher) {
    for (int i = 0; i < sweeps; ++i, ++sweep.sweep) {
      const std::uint64_t scores = Sweep(matcher, planes, options, sweep).run();
      if (input.scores) *input.scores += scores;
      sweep.first = false;
      sweep.trial_pairs = options.later_pairs;
    }
  };
  if constexpr (std::is_same_v<Warp, AffineWarp> && InLanes<Camera>)
    run_all(LaneMatcher<Camera>(level.images[0], cameras[0], sources, options));
  else
    run_all(Matcher<Camera, Warp>(level.images[0], cameras[0], sources, options));
}

// Runs `sweeps` sweeps of one level. Camera type and warp are selected once, outside the loops.
void run_sweeps(const MatchInput& input, const Level& level, std::span<const DepthMap* const> maps,
                const PatchMatchOptions& options, const SweepInput& first, int sweeps,
                PlaneMap& planes) {
  std::visit(
      [&](const auto& cameras) {
        if (options.warp == Warp::affine)
          run_sweeps_with<AffineWarp>(input, level, cameras, maps, options, first, sweeps, planes);
        else if constexpr (requires { cameras[0].lens(); })
          // NOLINTNEXTLINE(bugprone-branch-clone): both branches are empty in other templates.
          run_sweeps_with<HomographyWarp>(input, level, cameras, maps, options, first, sweeps,
                                          planes);
        else if constexpr (std::is_same_v<decltype(cameras[0]), const AnyCamera<float>&>)
          fail(
              "the warp homography is only for one kind of port: use the warp affine for images "
              "behind flat ports and domes");
        else
          fail(
              "the warp homography is only for lenses without distortion: undistort the images "
              "first, with InterfaceCOLMAP");
      },
      make_camera_list<float>(level.cameras, input.projection));
}

std::vector<Eigen::Vector3f> points_in_camera(const MatchInput& input) {
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3f& point : input.sparse_points)
    points.emplace_back(input.reference->pose.to_camera(point.cast<double>()).cast<float>());
  return points;
}

DepthRange depth_range(const CameraModel& model, std::span<const Eigen::Vector3f> points) {
  DepthRange range{std::numeric_limits<float>::max(), 0};
  std::visit(
      [&](const auto& camera) {
        for (const Eigen::Vector3f& point : points) {
          const auto image = camera.project(point);
          if (!image.visible) continue;
          const float depth = (point - camera.ray(image.pixel).origin).norm();
          range.min = std::min(range.min, depth);
          range.max = std::max(range.max, depth);
        }
      },
      make_camera<float>(model));
  if (!(range.max > 0)) fail("none of the sparse points is visible in the reference view");
  return {0.9f * range.min, 1.1f * range.max};
}

// The state of the next finer level. Each pixel gets the plane of the coarse pixel in which it
// lies; its depth is where its own ray meets this plane (eq. 8).
LevelState refine_level(const PlaneMap& coarse, const CameraModel& fine, const DepthRange& range,
                        float keep_cost) {
  LevelState state{PlaneMap(fine.width, fine.height), cv::Mat1f(fine.height, fine.width, 0.0f), {}};
  std::visit(
      [&](const auto& camera) {
        each_ray(camera, fine.width, fine.height, [&](int x, int y, const auto& ray) {
          const PlanePixel& from =
              coarse.at(std::min(x / 2, coarse.width - 1), std::min(y / 2, coarse.height - 1));
          if (!(from.plane.depth > 0) || !(from.cost < keep_cost)) return;
          const float along = from.plane.normal.dot(ray.direction);
          float depth = from.plane.depth;
          if (along < -0.1f) depth = from.plane.normal.dot(from.point - ray.origin) / along;
          depth = std::clamp(depth, range.min, range.max);
          PlanePixel& to = state.planes.at(x, y);
          to.plane = {depth, from.plane.normal};
          to.point = ray.at(depth);
          to.cost = from.cost;
          to.views = from.views;
          state.prior(y, x) = depth;
        });
      },
      make_camera<float>(fine));
  return state;
}

DepthMap to_depth_map(const MatchInput& input, const PlaneMap& planes, const DepthRange& range,
                      float keep_cost) {
  DepthMap map;
  map.camera = input.reference->camera;
  map.pose = input.reference->pose;
  map.ids.push_back(input.reference->id);
  for (const MatchImage* source : input.sources) map.ids.push_back(source->id);
  map.min_depth = range.min;
  map.max_depth = range.max;
  map.depth = cv::Mat1f(planes.height, planes.width, 0.0f);
  map.normal = cv::Mat3f(planes.height, planes.width, cv::Vec3f::all(0));
  map.confidence = cv::Mat1f(planes.height, planes.width, 0.0f);
  for (int y = 0; y < planes.height; ++y) {
    for (int x = 0; x < planes.width; ++x) {
      const PlanePixel& pixel = planes.at(x, y);
      if (!(pixel.plane.depth > 0) || !(pixel.cost < keep_cost)) continue;
      map.depth(y, x) = pixel.plane.depth;
      map.normal(y, x) = {pixel.plane.normal.x(), pixel.plane.normal.y(), pixel.plane.normal.z()};
      map.confidence(y, x) = std::max(0.0f, 1.0f - pixel.cost);
    }
  }
  return map;
}

PlaneMap to_planes(const DepthMap& map) {
  PlaneMap planes(map.width(), map.height());
  std::visit(
      [&](const auto& camera) {
        each_ray(camera, planes.width, planes.height, [&](int x, int y, const auto& ray) {
          const float depth = map.depth(y, x);
          if (!(depth > 0)) return;
          const cv::Vec3f& n = map.normal(y, x);
          PlanePixel& pixel = planes.at(x, y);
          pixel.plane = {depth, {n[0], n[1], n[2]}};
          pixel.point = ray.at(depth);
          pixel.cost = 1.0f - map.confidence(y, x);
        });
      },
      make_camera<float>(map.camera));
  return planes;
}

int usable_levels(const MatchInput& input, const PatchMatchOptions& options) {
  const int side = std::min(input.reference->grey.cols, input.reference->grey.rows);
  int levels = options.sub_resolution_levels;
  while (levels > 0 && (side >> levels) < options.coarsest_side) --levels;
  return levels;
}

// Clears the pixels at which the distorted lens shows no direction.
void clear_unseen(const CameraModel& camera, cv::Mat1b& mask) {
  const auto lens = distorted_lens<float>(camera);
  if (lens.shows_all(camera.width, camera.height)) return;
  if (mask.empty()) mask = cv::Mat1b(camera.height, camera.width, std::uint8_t{255});
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x)
      if (!lens.shows({static_cast<float>(x), static_cast<float>(y)})) mask(y, x) = 0;
}

cv::Mat1b mask_at(const MatchInput& input, const CameraModel& camera) {
  cv::Mat1b mask;
  if (input.mask)
    cv::resize(*input.mask, mask, {camera.width, camera.height}, 0, 0, cv::INTER_NEAREST);
  if (camera.distortion) clear_unseen(camera, mask);
  return mask;
}

void check(const MatchInput& input, const PatchMatchOptions& options) {
  if (input.sources.empty() || input.sources.size() > kMaxSources)
    fail("a reference view needs 1 to {} source views, not {}", kMaxSources, input.sources.size());
  const int pairs = std::max({options.coarse_pairs, options.first_pairs, options.later_pairs,
                              options.last_pairs, options.search_pairs});
  constexpr int kMost = kMaxCandidates;
  if (2 * pairs > kMost || options.restart_trials > kMost || 3 + options.search_planes > kMost)
    fail(
        "{} pairs of trials, {} restarts and {} random plane hypotheses besides three at a pixel: "
        "at most {} plane hypotheses are scored at once",
        pairs, options.restart_trials, options.search_planes, kMost);
}

constexpr std::uint32_t kSweepsPerLevel = 64;  // even, so that every level starts forwards

}  // namespace

DepthMap estimate_depth_map(const MatchInput& input, const PatchMatchOptions& options) {
  check(input, options);
  const std::vector<Eigen::Vector3f> points = points_in_camera(input);
  const DepthRange range = depth_range(input.reference->camera, points);
  std::optional<PlaneMap> coarser;
  for (int halvings = usable_levels(input, options); halvings >= 0; --halvings) {
    const Level level = make_level(input, halvings);
    LevelState state =
        coarser ? refine_level(*coarser, level.cameras[0], range, options.keep_cost)
                : LevelState{
                      planes_from_points(level.cameras[0], points, range.min, range.max), {}, {}};
    state.mask = mask_at(input, level.cameras[0]);
    SweepInput sweep;
    sweep.image_id = input.reference->id;
    sweep.sweep = static_cast<std::uint32_t>(halvings) * kSweepsPerLevel;
    sweep.min_depth = range.min;
    sweep.max_depth = range.max;
    sweep.prior = state.prior.empty() ? nullptr : &state.prior;
    sweep.mask = state.mask.empty() ? nullptr : &state.mask;
    sweep.first = true;
    sweep.many_views = halvings > 0;
    sweep.trial_pairs = halvings > 0 ? options.coarse_pairs : options.first_pairs;
    run_sweeps(input, level, {}, options, sweep, options.iterations, state.planes);
    coarser = std::move(state.planes);
  }
  return to_depth_map(input, *coarser, range, options.keep_cost);
}

DepthMap refine_depth_map(const MatchInput& input, const DepthMap& current,
                          std::span<const DepthMap* const> source_maps, int pass, bool last,
                          const PatchMatchOptions& options) {
  check(input, options);
  const Level level = make_level(input, 0);
  PlaneMap planes = to_planes(current);
  const cv::Mat1b mask = mask_at(input, level.cameras[0]);
  SweepInput sweep;
  sweep.image_id = input.reference->id;
  sweep.sweep = static_cast<std::uint32_t>(options.iterations + pass);
  sweep.min_depth = current.min_depth;
  sweep.max_depth = current.max_depth;
  sweep.textureless_prior = &current.depth;
  sweep.trial_pairs = last ? options.last_pairs : options.later_pairs;
  sweep.mask = mask.empty() ? nullptr : &mask;
  run_sweeps(input, level, source_maps, options, sweep, 1, planes);
  const DepthRange range{current.min_depth, current.max_depth};
  return to_depth_map(input, planes, range, options.keep_cost);
}

std::uint64_t bytes_needed(const MatchSize& size) {
  // Planes of this level and the previous one, priors, the result and its filtered copies.
  constexpr std::uint64_t kPlane = sizeof(PlanePixel);
  const std::uint64_t reference =
      (kPlane + kPlane / 4 + 8) * size.pixels + 3 * bytes_of_map(size.pixels);
  // Its pixels twice as words of 2 x 2 neighbours, and its depths.
  const std::uint64_t source = (2 * 4 + 4) * size.pixels + 2 * HugePageAllocator<int>::kPage;
  return reference + size.sources * source;
}

}  // namespace axial::depth
