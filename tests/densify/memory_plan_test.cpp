// SPDX-License-Identifier: GPL-3.0-or-later
// The memory plan against what each stage says that it needs.
#include "densify/memory_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "cloud/fuse.h"
#include "densify/pinhole_export.h"
#include "densify/pinhole_model.h"
#include "depth/filters.h"
#include "depth/patch_match.h"
#include "io/openmvs/dmap.h"
#include "io/openmvs/mvs_counts.h"
#include "support/error_of.h"
#include "survey/image_store.h"

namespace axial::densify {
namespace {

constexpr std::uint64_t kPixels = 1200 * 900;
constexpr std::size_t kImages = 60, kSources = 6, kNeighbours = 9, kAdjusting = 8;

// 60 images of 1200 x 900 pixels. The first is smaller, and the last has the longest lists.
Project sixty_images() {
  Project project;
  project.scene.images.resize(kImages);
  project.scene.points.assign(50000, {{}, {{0, 0}, {1, 0}, {2, 0}}});
  project.sources.assign(kImages, std::vector<ViewScore>(kSources - 1));
  project.neighbours.assign(kImages, std::vector<ViewScore>(kNeighbours - 1));
  project.sources.back().resize(kSources);
  project.neighbours.back().resize(kNeighbours);
  for (std::size_t i = 0; i < kImages; ++i) {
    View view;
    view.camera.width = i == 0 ? 600 : 1200;
    view.camera.height = i == 0 ? 450 : 900;
    view.header.size = {2 * view.camera.width, 2 * view.camera.height};
    project.views.push_back(view);
    project.references.push_back(i);
  }
  return project;
}

Options with_everything() {
  Options options;
  options.matching.postprocess = kSpeckles | kGaps | kAdjust;
  options.output.pinhole_export = "folder";
  return options;
}

struct Case {
  Project project = sixty_images();
  Options options = with_everything();

  ListLengths lists() const { return longest_lists(project, options.matching, options.fusion); }
  StageBytes bytes() const { return bytes_of_stages(project, options, lists()); }
};

// What the stages hold in memory besides the scene, if they work as planned.
class Held {
 public:
  Held(const Case& from, const MemoryPlan& plan)
      : plan_(plan),
        colors_(from.options.fusion.needs_colors()),
        adjusts_((from.options.matching.postprocess & kAdjust) != 0),
        masks_(std::ranges::any_of(from.project.views, &View::masked)),
        shown_(bytes_of_pinhole_points(from.project.scene)),
        model_(bytes_needed_for_pinhole_model(from.project.scene)),
        view_(from.project.views.back()) {}

  std::uint64_t images() const {
    return plan_.cached_images * survey::bytes_needed(survey::PixelsSize{kPixels, masks_, colors_});
  }
  // All depths that a geometric pass reads are in the cache, unless it is smaller than that.
  std::uint64_t matching() const {
    return images() + plan_.cached_depths * bytes_of_depths(kPixels) +
           plan_.in_flight * (depth::bytes_needed(depth::MatchSize{kPixels, kSources}) +
                              bytes_of_map(kPixels) + io::dmap_bytes_needed(kPixels));
  }
  std::uint64_t adjusting() const {
    return images() + plan_.cached_maps * bytes_of_map(kPixels) +
           plan_.in_flight * (depth::bytes_needed(depth::AdjustSize{kPixels, kAdjusting}) +
                              io::dmap_bytes_needed(kPixels));
  }
  std::uint64_t comparing() const {
    return images() + plan_.cached_maps * bytes_of_map(kPixels) +
           plan_.in_flight * io::dmap_bytes_needed(kPixels);
  }
  std::uint64_t decoding() const {
    return images() + plan_.decodes * (decode() + survey::bytes_needed({kPixels, masks_, colors_}));
  }
  std::uint64_t fusing() const {
    return images() +
           plan_.fusion_loads *
               (decode() + bytes_of_map(kPixels) + io::dmap_bytes_needed(kPixels)) +
           cloud::bytes_needed({kPixels, kImages, plan_.fused_maps, colors_});
  }
  std::uint64_t exporting() const {
    return shown_ + std::max(plan_.exports * bytes_needed_to_resample(view_), model_);
  }

  std::uint64_t most() const {
    return std::max(
        {matching(), adjusts_ ? adjusting() : 0, comparing(), decoding(), fusing(), exporting()});
  }

 private:
  std::uint64_t decode() const {
    return survey::bytes_needed_to_load(io::bytes_needed(view_.header), kPixels);
  }

  MemoryPlan plan_;
  bool colors_, adjusts_, masks_;
  std::uint64_t shown_, model_;
  View view_;
};

TEST(StageBytes, AreThoseOfTheStagesForTheLargestImageAndTheLongestLists) {
  const Case all;
  const StageBytes bytes = all.bytes();
  EXPECT_EQ(bytes.match, depth::bytes_needed(depth::MatchSize{kPixels, kSources}));
  EXPECT_EQ(bytes.adjust, depth::bytes_needed(depth::AdjustSize{kPixels, kAdjusting}));
  EXPECT_EQ(bytes.image, survey::bytes_needed(survey::PixelsSize{kPixels, false, true}));
  EXPECT_EQ(bytes.decode,
            survey::bytes_needed_to_load(16 * kPixels, kPixels));  // 2 x 2 of 4 bytes each
  EXPECT_EQ(bytes.exported, bytes_needed_to_resample(all.project.views.back()));
  EXPECT_EQ(bytes.shown, bytes_of_pinhole_points(all.project.scene));
  EXPECT_EQ(bytes.model, bytes_needed_for_pinhole_model(all.project.scene));
  EXPECT_EQ(bytes.write_scene, io::count_scene(all.project.scene).writing_bytes());
  EXPECT_EQ(bytes.taken + 7 * bytes.fused, cloud::bytes_needed({kPixels, kImages, 7, true}));
  const ListLengths lists = all.lists();
  EXPECT_EQ(lists.matched, 1 + kSources);
  EXPECT_EQ(lists.adjusted, 1 + kAdjusting);
  EXPECT_EQ(lists.fused, 1 + kNeighbours);
}

TEST(StageBytes, DependOnWhatTheOptionsAskFor) {
  Case few;
  few.options.matching.postprocess = kSpeckles;
  few.options.fusion.estimate_colors = 0;
  few.options.output.pinhole_export.clear();
  few.project.views[3].mask = "mask.png";
  EXPECT_EQ(few.bytes().adjust, 0u);
  EXPECT_EQ(few.bytes().exported, 0u);
  EXPECT_EQ(few.bytes().shown, 0u);
  EXPECT_EQ(few.bytes().model, 0u);
  EXPECT_EQ(few.bytes().image, survey::bytes_needed(survey::PixelsSize{kPixels, true, false}));
  EXPECT_EQ(few.bytes().fused, cloud::bytes_needed({kPixels, 0, 1, false}));
  // Fewer maps than neighbours.
  few.project.references = {0, 4, 5};
  EXPECT_EQ(few.lists().fused, 3u);
}

// Rooms from the least to enough for everything.
std::vector<std::uint64_t> rooms(const Case& from) {
  std::vector<std::uint64_t> rooms;
  const std::uint64_t least = least_bytes(from.bytes(), from.lists(), 1);
  for (std::uint64_t room = least; room < 60 * least; room += room / 10) rooms.push_back(room);
  return rooms;
}

TEST(MemoryPlan, NoStageNeedsMoreThanTheRoom) {
  Case without_adjusting;
  without_adjusting.options.matching.postprocess = kSpeckles;
  Case with_masks;
  with_masks.project.views[3].mask = "mask.png";
  for (const Case& from : {Case(), without_adjusting, with_masks})
    for (const std::uint64_t room : rooms(from))
      for (const std::size_t threads : {1u, 2u, 16u}) {
        const MemoryPlan plan = share_out(from.bytes(), from.lists(), room, threads);
        EXPECT_LE(Held(from, plan).most(), room) << threads;
      }
}

// With fewer entries, images in flight would wait for each other or read the same file many times.
TEST(MemoryPlan, CachesHoldWhatTheImagesInFlightUse) {
  const Case from;
  for (const std::uint64_t room : rooms(from)) {
    const MemoryPlan plan = share_out(from.bytes(), from.lists(), room, 16);
    EXPECT_GE(plan.cached_images, plan.in_flight * (1 + kSources));
    EXPECT_GE(plan.cached_depths, plan.in_flight * kSources);
    EXPECT_GE(plan.cached_maps, plan.in_flight * (1 + kAdjusting));
    EXPECT_GE(plan.cached_maps, plan.in_flight * kMapsCompared);
    EXPECT_GE(plan.fused_maps, 1 + kNeighbours);
  }
}

// `more` makes a plan larger by one; false: the plan is as large as it may be.
template <class More>
void expect_full(const Case& from, const More& more) {
  for (const std::uint64_t room : rooms(from)) {
    MemoryPlan plan = share_out(from.bytes(), from.lists(), room, 16);
    if (!more(plan)) continue;
    EXPECT_GT(Held(from, plan).most(), room);
  }
}

TEST(MemoryPlan, LeavesNoRoomForOneMore) {
  const Case from;
  constexpr std::size_t kMostCached = 48;
  expect_full(from, [](MemoryPlan& plan) { return ++plan.decodes <= 16; });
  expect_full(from, [](MemoryPlan& plan) { return ++plan.exports <= 16; });
  expect_full(from, [](MemoryPlan& plan) { return ++plan.fused_maps <= kMostCached; });
  for (const std::uint64_t room : rooms(from)) {
    const std::size_t more = 1 + share_out(from.bytes(), from.lists(), room, 16).in_flight;
    if (more > 16) continue;
    EXPECT_GT(least_bytes(from.bytes(), from.lists(), more), room);
  }
}

TEST(MemoryPlan, MoreRoomAndThreadsHaveLimits) {
  const Case from;
  const std::uint64_t plenty = std::uint64_t{1} << 50;
  const MemoryPlan plan = share_out(from.bytes(), from.lists(), plenty, 3);
  EXPECT_EQ(plan.in_flight, 3u);
  EXPECT_EQ(plan.decodes, 3u);
  EXPECT_EQ(plan.exports, 3u);
  EXPECT_EQ(plan.fusion_loads, 3u);
  for (const std::size_t entries :
       {plan.cached_images, plan.cached_depths, plan.cached_maps, plan.fused_maps})
    EXPECT_EQ(entries, 48u);
  // Not more images in flight than there are.
  Case two;
  two.project.references = {0, 1};
  EXPECT_EQ(share_out(two.bytes(), two.lists(), plenty, 3).in_flight, 2u);
}

TEST(MemoryPlan, RefusesLessThanTheLeastAndNamesIt) {
  Case from;
  const ThreadLimit one(1);
  const auto plan = [&](std::uint64_t megabytes) {
    return plan_memory(from.project, from.options,
                       Context({}, {}, {MemoryBudget::of_program(megabytes)}));
  };
  const std::string error = test::error_of([&] { plan(100); });
  EXPECT_THAT(error,
              testing::StartsWith("max_memory 100: 100 MB are too little, this scene needs "));
  const std::uint64_t needed = std::stoull(error.substr(error.find("needs ") + 6));
  // The need contains what the process has allocated, which may differ a little at the next call.
  EXPECT_EQ(plan(needed + 1).in_flight, 1u);
  EXPECT_THAT(test::error_of([&] { plan(needed - 2); }), testing::HasSubstr("are too little"));
}

}  // namespace
}  // namespace axial::densify
