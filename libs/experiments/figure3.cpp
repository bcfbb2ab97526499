// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's figure 3: the errors of all texels of all patches of a tiny image.
#include <fmt/format.h>

#include <algorithm>

#include "experiments/charts.h"
#include "experiments/experiment.h"
#include "experiments/patch_error.h"
#include "experiments/tables.h"

namespace axial::experiments {
namespace {

constexpr int kSize = 10;
constexpr int kBorder = 12;  // of both images: so wide that most patches lie in the second image
constexpr std::array kShown{Warp::kPapers, Warp::kExactCentre, Warp::kScaled, Warp::kFirstOrder};
constexpr std::array<const char*, 4> kTitles{"the paper's", "f_v = f, exact centre",
                                             "local virtual scale", "first-order exact"};

const char* warp_name(Warp warp) {
  return kWarpNames[static_cast<std::size_t>(warp)];
}

std::string part_name(int setup) {
  return fmt::format("setup{}", setup);
}

Json measure(const StereoSetup& setup) {
  const WarpStudy study(setup, kSize + 2 * kBorder, kSize);
  Json maps = Json::object();
  for (const Warp warp : kShown) maps[warp_name(warp)] = exploded_error_map(study, warp, kBorder);
  return {{"texels_across", kSize * kPatchSide}, {"errors", maps}};
}

Part make_part(int number) {
  const StereoSetup setup{number, {}, 0};
  return {part_name(number),
          {{"version", 2}, {"setup", to_json(setup)}, {"size", kSize}, {"border", kBorder}},
          [setup] { return measure(setup); }};
}

double largest(const Json& result) {
  double most = 0;
  for (const Json& map : result.at("errors"))
    for (const Json& value : map) most = std::max(most, value.get<double>());
  return most;
}

std::string figure(const Json& results, int number) {
  const Json& result = result_of(results, part_name(number));
  std::vector<MapPanel> panels;
  for (std::size_t k = 0; k < kShown.size(); ++k)
    panels.push_back({kTitles[k], result.at("texels_across").get<std::size_t>(),
                      result.at("errors").at(warp_name(kShown[k])).get<std::vector<double>>()});
  return draw_maps(
      fmt::format("Error of every texel of every patch, 10 x 10 image, setup {}", number), panels,
      4, largest(result), "px");
}

std::string table(const Json& results) {
  std::vector<std::vector<std::string>> rows{{"setup", "warp", "mean [px]", "largest [px]"}};
  for (const int number : {1, 2}) {
    const Json& result = result_of(results, part_name(number));
    for (std::size_t k = 0; k < kShown.size(); ++k) {
      double sum = 0, most = 0;
      int count = 0;
      for (const double e :
           result.at("errors").at(warp_name(kShown[k])).get<std::vector<double>>()) {
        if (e < 0) continue;
        sum += e, ++count, most = std::max(most, e);
      }
      rows.push_back({fmt::format("{}", number), kTitles[k], significant(sum / std::max(1, count)),
                      significant(most)});
    }
  }
  return markdown_table(rows);
}

std::vector<Document> documents(const Json& results) {
  return {{"figure3_setup1.svg", figure(results, 1)},
          {"figure3_setup2.svg", figure(results, 2)},
          {"figure3.md", table(results)}};
}

}  // namespace

// `quick` changes nothing: there are only 200 patches.
Experiment figure3(bool) {
  return {"figure3", {make_part(1), make_part(2)}, documents};
}

}  // namespace axial::experiments
