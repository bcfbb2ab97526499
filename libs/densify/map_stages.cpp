// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/map_stages.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/first_error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "io/artifacts/artifact.h"
#include "picture/dmap_pictures.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

ReadMap for_cache(ReadMap read, bool whole) {
  if (whole) return read;
  return [read = std::move(read)](std::size_t image) {
    DepthMap map = read(image);
    map.normal.release();
    map.confidence.release();
    return map;
  };
}

class Runner {
 public:
  Runner(std::span<const Stage> stages, const StageRun& run, const Context& context)
      : stages_(stages), run_(run), context_(context) {}

  void run() const {
    const std::size_t first = first_incomplete_stage();
    const std::size_t end = std::min(run_.most_stages, stages_.size());
    if (first == end) context_.info("All {} depth maps exist already", run_.images.size());
    if (first > end)
      context_.info("All {} depth maps exist already, of the later stage {}", run_.images.size(),
                    stages_[first - 1].name);
    for (std::size_t s = 0; s + 1 < first; ++s) remove_stage(s);
    if (first > 0) check(first - 1);
    for (std::size_t s = first; s < end; ++s) {
      // Matching often frees and allocates large blocks but holds few of them; later stages hold
      // many.
      if (stages_[s].whole_maps) map_large_blocks();
      run_stage(s);
      if (s == 0) check(s);
      if (s > 0) remove_stage(s - 1);
      if (!is_last(s) && run_.pictures == Pictures::maps_of_every_stage) draw(s);
    }
    if (run_.pictures != Pictures::none && end == stages_.size()) draw(end - 1);
  }

  void run_part(std::size_t stage) const {
    if (is_superseded(stage)) return;
    if (stage > 0) require_previous(stage);
    if (stages_[stage].whole_maps) map_large_blocks();
    run_stage(stage);
    const bool drawn = run_.pictures == Pictures::maps_of_every_stage || is_last(stage);
    if (run_.pictures != Pictures::none && drawn) draw(stage);
  }

 private:
  bool is_last(std::size_t stage) const { return stage + 1 == stages_.size(); }

  fs::path path(std::size_t stage, std::size_t image) const {
    fs::path file = run_.final_file(image);
    if (!is_last(stage)) file.replace_extension("." + stages_[stage].name + ".dmap");
    return file;
  }

  std::string made_from(std::size_t stage) const {
    return mark_of_stage(run_.fingerprint, stages_[stage].name);
  }

  // Whether the file existed before this run: a stage asks before it writes.
  bool finished(std::size_t stage, std::size_t image) const {
    const io::DmapStatus status =
        is_last(stage) ? run_.existing[image] : io::dmap_status(path(stage, image), context_);
    return status.is_ours_from(made_from(stage));
  }

  // Whether a later stage is complete. In a first run, the first file that is looked up is missing.
  bool is_superseded(std::size_t stage) const {
    for (std::size_t later = stage + 1; later < stages_.size(); ++later) {
      const auto there = [&](std::size_t image) {
        return io::dmap_status(path(later, image), context_).is_ours_from(made_from(later));
      };
      if (run_.all_images.empty() || !std::ranges::all_of(run_.all_images, there)) continue;
      context_.info("All {} depth maps exist already, of the later stage {}",
                    run_.all_images.size(), stages_[later].name);
      return true;
    }
    return false;
  }

  // Error unless the maps that the stage needs for the missing maps are there. Each map is read
  // once.
  void require_previous(std::size_t stage) const {
    std::set<std::size_t> needed;
    for (const std::size_t image : missing_of(stage))
      for (const std::size_t other : stages_[stage].needs(image)) needed.insert(other);
    const std::vector<std::size_t> images(needed.begin(), needed.end());
    FirstError error;
    for_each_in_flight(images.size(), run_.in_flight, [&](std::size_t i) {
      error.run(i, [&] {
        if (!finished(stage - 1, images[i]))
          fail_in(path(stage - 1, images[i]),
                  "is missing, or was made from other input or settings: first make the stage {} "
                  "of all parts",
                  stages_[stage - 1].name);
      });
    });
    error.rethrow();
  }

  // The images whose maps of the stage are not finished.
  std::vector<std::size_t> missing_of(std::size_t stage) const {
    std::vector<char> there(run_.images.size());
    for_each_in_flight(there.size(), run_.in_flight,
                       [&](std::size_t i) { there[i] = finished(stage, run_.images[i]); });
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < there.size(); ++i)
      if (!there[i]) missing.push_back(run_.images[i]);
    return missing;
  }

  std::size_t first_incomplete_stage() const {
    for (std::size_t s = stages_.size(); s > 0; --s) {
      const auto there = [&](std::size_t image) { return finished(s - 1, image); };
      if (std::ranges::all_of(run_.images, there)) return s;
    }
    return 0;
  }

  ReadMap reader(std::size_t stage) const {
    return [this, stage](std::size_t image) {
      return io::read_dmap(path(stage, image), io::DmapSide::used, context_).map;
    };
  }

  PreviousMaps previous_of(std::size_t stage) const {
    const bool whole = stages_[stage].whole_maps;
    return {stage > 0 ? reader(stage - 1) : ReadMap(), whole,
            whole ? run_.cached_maps : run_.cached_depths};
  }

  void run_stage(std::size_t stage) const {
    {
      PreviousMaps previous = previous_of(stage);
      make_maps(stage, previous);
    }
    return_freed_memory();
  }

  void make_maps(std::size_t stage, PreviousMaps& previous) const {
    const std::vector<std::size_t> missing = missing_of(stage);
    if (const std::size_t reused = run_.images.size() - missing.size(); reused > 0)
      context_.info("{}: {} maps existed already", stages_[stage].title, reused);
    ProgressCounter counter(context_.stage(stages_[stage].title), missing.size());
    for_each_in_flight(missing.size(), run_.in_flight, [&](std::size_t i) {
      const std::size_t image = missing[i];
      io::write_dmap(path(stage, image), stages_[stage].make(image, previous), made_from(stage));
      counter.add();
    });
  }

  void check(std::size_t stage) const {
    if (run_.check) run_.check(stage == 0, reader(stage));
  }

  void draw(std::size_t stage) const {
    for_each_in_flight(run_.images.size(), run_.in_flight, [&](std::size_t i) {
      const fs::path file = path(stage, run_.images[i]);
      picture::write_dmap_pictures(file, io::read_dmap(file, io::DmapSide::used, context_).map);
    });
  }

  void remove_stage(std::size_t stage) const {
    for (const std::size_t image : run_.images) io::remove_with_side_file(path(stage, image));
  }

  std::span<const Stage> stages_;
  const StageRun& run_;
  const Context& context_;
};

}  // namespace

PreviousMaps::PreviousMaps(ReadMap read, bool whole, std::size_t capacity)
    : read_(std::move(read)), cache_(for_cache(read_, whole), capacity) {}

std::string mark_of_stage(const std::string& fingerprint, const std::string& stage) {
  return fingerprint + " " + stage;
}

void run_stages(std::span<const Stage> stages, const StageRun& run, const Context& context) {
  Runner(stages, run, context).run();
}

void run_part(std::span<const Stage> stages, std::size_t stage, const StageRun& run,
              const Context& context) {
  Runner(stages, run, context).run_part(stage);
}

}  // namespace axial::densify
