// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/depth_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stop_token>
#include <utility>
#include <vector>

#include "densify/agreement_check.h"
#include "densify/map_stages.h"
#include "depth/border.h"
#include "depth/filters.h"
#include "depth/patch_match.h"
#include "depth/weak_texture.h"

namespace axial::densify {
namespace {

// The data for matching one image. They must live while it runs.
struct Task {
  std::vector<std::shared_ptr<const survey::Pixels>>
      pixels;                            // of the reference, then of the sources
  std::vector<depth::MatchImage> views;  // in the order of `pixels`
  std::vector<const depth::MatchImage*> sources;
  std::vector<Eigen::Vector3f> points;
  depth::MatchInput input;
};

// Makes the maps of the stages. It must live while the stages run.
class MapMaker {
 public:
  MapMaker(const Project& project, const MatchOptions& options, survey::ImageStore& images,
           std::stop_token stop)
      : project_(project), options_(options), images_(images), stop_(std::move(stop)) {}

  std::vector<Stage> stages() const {
    const std::vector<std::string> names = stage_names(options_);
    std::vector<Stage> stages;
    stages.push_back({names[0], "Estimated depth maps",
                      [this](std::size_t image, PreviousMaps&) { return estimate(image); }});
    for (int pass = 0; pass < options_.geometric_iterations; ++pass)
      stages.push_back(
          {names[stages.size()], fmt::format("Geometric-consistency pass {}", pass + 1),
           [this, pass](std::size_t image, PreviousMaps& previous) {
             return refine(image, pass, previous);
           },
           false,
           [this](std::size_t image) { return with(image, with_maps(project_.sources[image])); }});
    if (options_.postprocess & kAdjust)
      stages.push_back(
          {names.back(), "Adjusted depth maps",
           [this](std::size_t image, PreviousMaps& previous) { return adjust(image, previous); },
           true, [this](std::size_t image) { return with(image, adjusting(image)); }});
    return stages;
  }

 private:
  // The images of `list` that have depth maps of their own.
  std::vector<std::size_t> with_maps(const std::vector<ViewScore>& list) const {
    std::vector<std::size_t> images;
    for (const ViewScore& neighbour : list)
      if (!project_.sources[neighbour.image].empty()) images.push_back(neighbour.image);
    return images;
  }

  // The images whose maps adjust the map of `image`.
  std::vector<std::size_t> adjusting(std::size_t image) const {
    std::vector<std::size_t> images = with_maps(project_.neighbours[image]);
    images.resize(std::min(images.size(), std::size_t{depth::AdjustOptions().max_neighbours}));
    return images;
  }

  static std::vector<std::size_t> with(std::size_t image, std::vector<std::size_t> others) {
    others.push_back(image);
    return others;
  }

  void add_view(Task& task, std::size_t image) const {
    const View& view = project_.views[image];
    task.pixels.push_back(images_.get(image));
    task.views.push_back({view.id, view.camera, view.pose, task.pixels.back()->grey});
  }

  std::unique_ptr<Task> task(std::size_t image) const {
    auto result = std::make_unique<Task>();
    add_view(*result, image);
    for (const ViewScore& source : project_.sources[image]) add_view(*result, source.image);
    for (std::size_t i = 1; i < result->views.size(); ++i)
      result->sources.push_back(&result->views[i]);
    for (const std::uint32_t point : project_.preparations[image].init_points)
      result->points.push_back(project_.scene.points[point].position);
    const cv::Mat1b& mask = result->pixels[0]->mask;
    result->input = {&result->views[0], result->sources, result->points,
                     mask.empty() ? nullptr : &mask, options_.projection};
    result->input.stop = stop_;
    return result;
  }

  DepthMap named(DepthMap map, std::size_t image) const {
    map.image_path = project_.scene.images[image].path;
    return map;
  }

  DepthMap estimate(std::size_t image) const {
    const std::unique_ptr<Task> work = task(image);
    const DepthMap map = depth::estimate_depth_map(work->input, options_);
    return named(options_.geometric_iterations == 0 ? clean(map, *work, image) : map, image);
  }

  DepthMap refine(std::size_t image, int pass, PreviousMaps& previous) const {
    const std::unique_ptr<Task> work = task(image);
    const bool last = pass + 1 == options_.geometric_iterations;
    std::vector<std::shared_ptr<const DepthMap>> held;
    std::vector<const DepthMap*> maps;
    for (const ViewScore& source : project_.sources[image]) {
      const bool has_map = !project_.sources[source.image].empty();
      held.push_back(has_map ? previous.get(source.image) : nullptr);
      maps.push_back(held.back().get());
    }
    const DepthMap map =
        depth::refine_depth_map(work->input, previous.read(image), maps, pass, last, options_);
    return named(last ? clean(map, *work, image) : map, image);
  }

  DepthMap clean(DepthMap map, const Task& task, std::size_t image) const {
    map = depth::remove_unconfirmed(map, task.views[0].grey, depth::border_pixels(task.input, map));
    if (options_.postprocess & kSpeckles) map = depth::remove_speckles(map, options_.speckles);
    if (options_.postprocess & kGaps) {
      cv::Mat1b ignored;
      if (const cv::Mat1b mask = images_.mask(image); !mask.empty())
        cv::compare(mask, 0, ignored, cv::CMP_EQ);
      map = depth::fill_gaps(map, options_.gaps, ignored);
    }
    return map;
  }

  DepthMap adjust(std::size_t image, PreviousMaps& previous) const {
    std::vector<DepthMap> neighbours;
    for (const std::size_t neighbour : adjusting(image))
      neighbours.push_back(*previous.get(neighbour));
    return named(depth::adjust_with_neighbours(*previous.get(image), neighbours), image);
  }

  const Project& project_;
  const MatchOptions& options_;
  survey::ImageStore& images_;
  std::stop_token stop_;
};

}  // namespace

void make_depth_maps(const Run& run, const MatchOptions& options, const StageJob* job,
                     const std::filesystem::path& report) {
  const Project& project = run.project;
  const MapMaker maker(project, options, run.images, run.context.stop_token());
  StageRun stages;
  stages.images = project.part;
  stages.all_images = project.references;
  stages.final_file = [&](std::size_t image) { return depth_map_path(project, image); };
  stages.fingerprint = project.fingerprint;
  stages.existing = run.existing.states;
  stages.in_flight = run.plan.in_flight;
  stages.cached_depths = run.plan.cached_depths;
  stages.cached_maps = run.plan.cached_maps;
  stages.pictures = options.pictures;
  stages.check = [&](bool first_stage, const ReadMap& read_map) {
    check_agreement(project, run.plan, first_stage, read_map, report, run.context);
  };
  if (job) stages.most_stages = stages_until(job->until, options);
  if (job && job->parts > 0)
    run_part(maker.stages(), stages.most_stages - 1, stages, run.context);
  else
    run_stages(maker.stages(), stages, run.context);
}

}  // namespace axial::densify
