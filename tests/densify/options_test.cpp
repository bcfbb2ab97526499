// SPDX-License-Identifier: GPL-3.0-or-later
// Options that contradict each other or the job of the run.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "axial/densify.h"
#include "support/error_of.h"

namespace axial::densify {
namespace {

std::string refusal(const std::function<void(Options&)>& change) {
  Options options;
  change(options);
  return test::bracketed_error_of([&] { check(options); });
}

TEST(CheckOptions, RefusesContradictions) {
  const std::string cloud = ": needs a cloud, which this run does not make";
  const std::string fusion = ": needs fusion, which this run does not make";
  const auto tiled = [](Options& to, const Job& job = WholeRun()) {
    to.fusion.tiles = 4;
    to.job = job;
  };
  const auto pinholes = [](Options& to) { to.output.pinhole_export = "/folder"; };
  const std::pair<std::string, std::function<void(Options&)>> cases[] = {
      {"<until> fast: must be one of photometric, geometric1, geometric2, maps",
       [](Options& to) { to.job = StageJob{"fast"}; }},
      {"<until> adjusted: must be one of photometric, maps",
       [](Options& to) {
         to.matching.geometric_iterations = 0;
         to.job = StageJob{"adjusted"};
       }},
      {"<part> 1/2: needs <until>",
       [](Options& to) {
         to.job = StageJob{"", 1, 2};
       }},
      {"<part> 0/2: must be from 1/2 to 2/2",
       [](Options& to) {
         to.job = StageJob{"maps", 0, 2};
       }},
      {"<part> 3/2: must be from 1/2 to 2/2",
       [](Options& to) {
         to.job = StageJob{"maps", 3, 2};
       }},
      {"<until> maps: this run makes no depth maps",
       [](Options& to) {
         to.matching.make_maps = false;
         to.job = StageJob{"maps"};
       }},
      {"<plan> /p.json: plans only runs that make all depth maps",
       [](Options& to) {
         to.matching.make_maps = false;
         to.job = PlanJob{"/p.json"};
       }},
      {"<pinhole_export> /folder" + cloud,
       [&](Options& to) { pinholes(to), to.fusion.fuse = false; }},
      {"<pinhole_export> /folder" + cloud, [&](Options& to) { pinholes(to), to.job = PlanJob(); }},
      {"<pinhole_export> /folder" + cloud,
       [&](Options& to) { pinholes(to), to.job = StageJob{"maps"}; }},
      {"<pinhole_export> /folder" + cloud,
       [&](Options& to) { pinholes(to), to.job = ExportJob(); }},
      {"<tile> 2/4: contradicts <pinhole_export>, which needs the whole cloud",
       [&](Options& to) { pinholes(to), tiled(to, TileJob{2}); }},
      {"<tile> 5/4: must be from 1 to 4", [&](Options& to) { tiled(to, TileJob{5}); }},
      {"<tile> 0/4: must be from 1 to 4", [&](Options& to) { tiled(to, TileJob{0}); }},
      {"<tiles> 0: must be from 1 to 1000", [](Options& to) { to.fusion.tiles = 0; }},
      {"<tiles> 1001: must be from 1 to 1000", [](Options& to) { to.fusion.tiles = 1001; }},
      {"<tiles> 4" + fusion, [&](Options& to) { tiled(to), to.fusion.fuse = false; }},
      {"<tiles> 4" + fusion, [&](Options& to) { tiled(to, ExportJob()); }},
      {"<tiles> 4" + fusion, [&](Options& to) { tiled(to, NeighbourListsJob()); }},
      {"<tile> 1/4" + fusion, [&](Options& to) { tiled(to, TileJob()), to.fusion.fuse = false; }},
      {"<tiles> 4: contradicts <estimate_colors 1>, which needs the whole cloud",
       [&](Options& to) { tiled(to), to.fusion.estimate_colors = 1; }},
      {"<tile> 3/4: contradicts <estimate_normals 1>, which needs the whole cloud",
       [&](Options& to) { tiled(to, TileJob{3}), to.fusion.estimate_normals = 1; }}};
  for (const auto& [words, change] : cases) EXPECT_EQ(refusal(change), words);
}

TEST(CheckOptions, AllowsEachJob) {
  Options options;
  for (const Job& job : std::vector<Job>{WholeRun(), StageJob{"geometric2"}, StageJob{"maps", 2, 2},
                                         TileJob(), PlanJob{"/p.json"}, NeighbourListsJob{"/lists"},
                                         ExportJob{.estimate_scale = 1}}) {
    options.job = job;
    EXPECT_NO_THROW(check(options));
  }
}

}  // namespace
}  // namespace axial::densify
