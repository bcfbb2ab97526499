// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/depth_stage.h"

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <mutex>

#include "base/log.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/shared_cache.h"
#include "densify/agreement_check.h"
#include "depth/border.h"
#include "depth/filters.h"
#include "depth/patch_match.h"
#include "depth/weak_texture.h"
#include "io/dmap.h"
#include "io/dmap_pictures.h"

namespace axial::densify {
namespace fs = std::filesystem;
using axial::DepthMap;

namespace {

// One round over all images. The files of a stage that is not the last have the stage's name in
// their names, and are removed when the next stage is complete.
struct Stage {
  std::string name;
  std::string title;
  std::function<DepthMap(std::size_t image)> make;
  bool matches = true;  // reads only the depths of its source views' maps; else whole maps
};

// Maps of the previous stage, always read from their files and never handed over in memory, because
// a resumed run must see the same bytes.
using MapCache = SharedCache<DepthMap>;

// The data for matching one image. They must live while it runs.
struct Task {
  std::vector<std::shared_ptr<const WorkImage>> pixels;  // of the reference, then of the sources
  std::vector<depth::MatchImage> views;                  // in the order of `pixels`
  std::vector<const depth::MatchImage*> sources;
  std::vector<Eigen::Vector3f> points;
  depth::MatchInput input;
};

class DepthMapRun {
 public:
  DepthMapRun(const Project& project, const Settings& settings, const MemoryPlan& plan,
              const ExistingMaps& existing, ImageStore& images)
      : project_(project), settings_(settings), plan_(plan), existing_(existing), images_(images) {
    add_stages();
  }

  void run() {
    const std::size_t first = first_incomplete_stage();
    if (first == stages_.size())
      log_info("All {} depth maps exist already", project_.references.size());
    if (first > 0) compare(first - 1);
    for (std::size_t s = first; s < stages_.size(); ++s) {
      // Matching often frees and allocates large blocks but holds few of them; later stages hold
      // many.
      if (!stages_[s].matches) map_large_blocks();
      run_stage(s);
      if (s == 0) compare(s);
      if (s > 0) remove_stage(s - 1);
      if (s + 1 < stages_.size() && settings_.pictures == Pictures::maps_of_every_stage) draw(s);
    }
    if (settings_.pictures != Pictures::none) draw(stages_.size() - 1);
  }

 private:
  fs::path path(std::size_t stage, std::size_t image) const {
    fs::path file = depth_map_path(project_, settings_, image);
    if (stage + 1 < stages_.size()) file.replace_extension("." + stages_[stage].name + ".dmap");
    return file;
  }

  std::string made_from(std::size_t stage) const {
    return project_.fingerprint + " " + stages_[stage].name;
  }

  // Whether the file existed before this run: a stage asks before it writes.
  bool finished(std::size_t stage, std::size_t image) const {
    if (stage + 1 == stages_.size())
      return existing_[image].origin == io::DmapOrigin::ours &&
             existing_[image].made_from == made_from(stage);
    return io::dmap_made_from(path(stage, image)) == made_from(stage);
  }

  std::size_t first_incomplete_stage() const {
    for (std::size_t s = stages_.size(); s > 0; --s) {
      bool complete = true;
      for (const std::size_t image : project_.references) complete &= finished(s - 1, image);
      if (complete) return s;
    }
    return 0;
  }

  void run_stage(std::size_t stage) {
    const bool depths = stages_[stage].matches;
    stage_ = stage;
    previous_ = std::make_unique<MapCache>(
        [this, stage, depths](std::size_t image) {
          DepthMap map = read_map(stage - 1, image);
          if (depths) {
            map.normal.release();
            map.confidence.release();
          }
          return map;
        },
        depths ? plan_.cached_depths : plan_.cached_maps);
    const ProgressSink progress = console_progress(stages_[stage].title);
    std::mutex mutex;
    std::size_t done = 0;
    std::size_t reused = 0;
    const std::vector<std::size_t>& references = project_.references;
    for_each_in_flight(references.size(), plan_.in_flight, [&](std::size_t i) {
      const std::size_t image = references[i];
      const bool there = finished(stage, image);
      if (!there) io::write_dmap(path(stage, image), stages_[stage].make(image), made_from(stage));
      const std::lock_guard lock(mutex);
      if (there) ++reused;
      progress(++done, references.size());
    });
    if (reused > 0) log_info("{}: {} maps existed already", stages_[stage].title, reused);
    previous_.reset();
    return_freed_memory();
  }

  DepthMap read_map(std::size_t stage, std::size_t image) const {
    return io::read_dmap(path(stage, image)).map;
  }

  // Called early, because later stages may take hours.
  void compare(std::size_t stage) const {
    check_agreement(project_, settings_, plan_, stage == 0,
                    [this, stage](std::size_t image) { return read_map(stage, image); });
  }

  void draw(std::size_t stage) const {
    const std::vector<std::size_t>& references = project_.references;
    for_each_in_flight(references.size(), plan_.in_flight, [&](std::size_t i) {
      const fs::path file = path(stage, references[i]);
      io::write_dmap_pictures(file, io::read_dmap(file).map);
    });
  }

  void remove_stage(std::size_t stage) const {
    for (const std::size_t image : project_.references) {
      const fs::path file = path(stage, image);
      std::error_code ignored;
      fs::remove(file, ignored);
      fs::remove(file.string() + ".json", ignored);
    }
  }

  // The images of `list` that have depth maps of their own.
  std::vector<std::size_t> with_maps(const std::vector<ViewScore>& list) const {
    std::vector<std::size_t> images;
    for (const ViewScore& neighbour : list)
      if (!project_.sources[neighbour.image].empty()) images.push_back(neighbour.image);
    return images;
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
                     mask.empty() ? nullptr : &mask, settings_.projection};
    return result;
  }

  DepthMap named(DepthMap map, std::size_t image) const {
    map.image_path = project_.scene.images[image].path;
    return map;
  }

  DepthMap estimate(std::size_t image) const {
    const std::unique_ptr<Task> work = task(image);
    const DepthMap map = depth::estimate_depth_map(work->input, settings_.matching);
    return named(settings_.geometric_iterations == 0 ? clean(map, *work, image) : map, image);
  }

  DepthMap refine(std::size_t image, int pass) const {
    const std::unique_ptr<Task> work = task(image);
    const bool last = pass + 1 == settings_.geometric_iterations;
    std::vector<std::shared_ptr<const DepthMap>> held;
    std::vector<const DepthMap*> maps;
    for (const ViewScore& source : project_.sources[image]) {
      const bool has_map = !project_.sources[source.image].empty();
      held.push_back(has_map ? previous_->get(source.image) : nullptr);
      maps.push_back(held.back().get());
    }
    const DepthMap map = depth::refine_depth_map(work->input, read_map(stage_ - 1, image), maps,
                                                 pass, last, settings_.matching);
    return named(last ? clean(map, *work, image) : map, image);
  }

  DepthMap clean(DepthMap map, const Task& task, std::size_t image) const {
    map = depth::remove_unconfirmed(map, task.views[0].grey, depth::border_pixels(task.input, map));
    if (settings_.postprocess & kSpeckles) map = depth::remove_speckles(map, settings_.speckles);
    if (settings_.postprocess & kGaps) {
      cv::Mat1b ignored;
      if (const cv::Mat1b mask = images_.mask(image); !mask.empty())
        cv::compare(mask, 0, ignored, cv::CMP_EQ);
      map = depth::fill_gaps(map, settings_.gaps, ignored);
    }
    return map;
  }

  DepthMap adjust(std::size_t image) const {
    std::vector<DepthMap> neighbours;
    for (const std::size_t neighbour : with_maps(project_.neighbours[image]))
      if (neighbours.size() < depth::AdjustOptions().max_neighbours)
        neighbours.push_back(*previous_->get(neighbour));
    return named(depth::adjust_with_neighbours(*previous_->get(image), neighbours), image);
  }

  void add_stages() {
    stages_.push_back({"photometric", "Estimated depth maps",
                       [this](std::size_t image) { return estimate(image); }});
    for (int pass = 0; pass < settings_.geometric_iterations; ++pass)
      stages_.push_back({fmt::format("geometric{}", pass + 1),
                         fmt::format("Geometric-consistency pass {}", pass + 1),
                         [this, pass](std::size_t image) { return refine(image, pass); }});
    if (settings_.postprocess & kAdjust)
      stages_.push_back({"adjusted", "Adjusted depth maps",
                         [this](std::size_t image) { return adjust(image); }, false});
  }

  const Project& project_;
  const Settings& settings_;
  const MemoryPlan& plan_;
  const ExistingMaps& existing_;
  ImageStore& images_;
  std::vector<Stage> stages_;
  std::size_t stage_ = 0;  // the current stage
  std::unique_ptr<MapCache> previous_;
};

}  // namespace

fs::path depth_map_path(const Project& project, const Settings& settings, std::size_t image) {
  return settings.working_folder / fmt::format("depth{:04}.dmap", project.views[image].id);
}

void make_depth_maps(const Project& project, const Settings& settings, const MemoryPlan& plan,
                     const ExistingMaps& existing, ImageStore& images) {
  DepthMapRun(project, settings, plan, existing, images).run();
}

}  // namespace axial::densify
