// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's figures 5 and 6: a scene reconstructed in air and through a port, by its method, by
// ours, and by each with one half of the other.
#include <fmt/format.h>

#include <array>
#include <functional>

#include "base/error.h"
#include "chained.h"
#include "experiments/distribution.h"
#include "experiments/tables.h"
#include "io/svg.h"

namespace axial {
namespace {

using experiments::Document;
using experiments::Experiment;
using experiments::Part;
using experiments::result_of;

struct Method {
  const char* name;
  const char* title;
  bool in_water;
  Words options;  // of DensifyPointCloud
};

const std::array<Method, 5>& methods() {
  static const std::array<Method, 5> all{
      {{"air", "in air", false, {}},
       {"ours", "refracted, our method", true, {}},
       {"line_search", "with the paper's projection", true, {"--projection", "line-search"}},
       {"homography", "with the paper's warp", true, {"--warp", "homography"}},
       {"papers",
        "refracted, the paper's method",
        true,
        {"--projection", "line-search", "--warp", "homography"}}}};
  return all;
}

struct Study {
  SceneOptions scene;
  EvaluationOptions evaluation;
  std::vector<int> seeds;
  std::vector<Method> on_true_poses;
};

Study study(bool quick) {
  Study all;
  all.scene.width = quick ? 320 : 2048;
  all.scene.height = quick ? 240 : 1536;
  all.scene.views = quick ? 4 : 10;
  all.scene.coarseness = quick ? 4 : 1;
  for (const Method& method : methods())
    if (!quick || method.name == std::string_view("air") || method.name == std::string_view("ours"))
      all.on_true_poses.push_back(method);
  all.evaluation.samples = quick ? 20000 : 200000;
  all.evaluation.picture_width = quick ? 160 : 480;
  all.seeds = quick ? std::vector{1} : std::vector{1, 2, 3};
  return all;
}

std::string colmap_part(int seed) {
  return fmt::format("seed{}_colmap_poses", seed);
}

std::string true_part(int seed) {
  return fmt::format("seed{}_true_poses", seed);
}

std::string dense_name(const std::string& poses, const Method& method) {
  return poses + "-" + method.name;
}

// What a finished part needs no more; until then an interrupted run finds its clouds again.
void remove_clouds(const std::string& poses, const SimulatedScene& scene) {
  for (const Method& method : methods())
    std::filesystem::remove_all(scene.folder / dense_name(poses, method));
}

std::filesystem::path dense_of(const Chain& chain, const std::string& poses,
                               const SimulatedScene& scene, const std::filesystem::path& model,
                               const Method& method) {
  DenseOptions options;
  if (method.in_water) options.housing = scene.housing();
  options.more = method.options;
  return densified(chain, dense_name(poses, method), scene, model,
                   method.in_water ? "water" : "air", options);
}

Json clouds_on_colmap_poses(const Chain& chain, const Study& study) {
  const SimulatedScene scene = simulated(chain, study.scene);
  const ColmapPoses poses = colmap_poses(chain, "colmap", scene, "air", true_lens(scene));
  if (poses.model.empty()) fail("{}: COLMAP found no poses", scene.images("air").string());
  Json result{{"images", poses.images}, {"clouds", Json::object()}};
  for (const Method& method : methods()) {
    const auto dense = dense_of(chain, "colmap", scene, poses.model, method);
    result["clouds"][method.name] = evaluated(chain, dense, scene, study.evaluation);
  }
  remove_clouds("colmap", scene);
  return result;
}

void judge_maps(const Chain& chain, const Study& study, const SimulatedScene& scene,
                const Method& method, const std::filesystem::path& dense, Json& result) {
  const char* medium = method.in_water ? "water" : "air";
  result["rings"][method.name] = ring_errors(dense, scene, medium);
  result["pictures"][method.name] =
      depth_picture(chain, dense, scene, medium, study.evaluation.tolerance);
}

Json maps_on_true_poses(const Chain& chain, const Study& study) {
  const SimulatedScene scene = simulated(chain, study.scene);
  const SceneDistances distances = scene_distances(scene, "water");
  Json result{{"scene_distance", distances.median}, {"range_ratio", distances.range_ratio}};
  for (const Method& method : study.on_true_poses) {
    const auto dense = dense_of(chain, "true", scene, scene.model(), method);
    result["clouds"][method.name] = evaluated(chain, dense, scene, study.evaluation);
    if (method.options.empty()) judge_maps(chain, study, scene, method, dense, result);
  }
  remove_clouds("true", scene);
  return result;
}

std::vector<Part> parts(const Chain& chain, bool quick) {
  std::vector<Part> all;
  Study one = study(quick);
  for (const int seed : one.seeds) {
    one.scene.seed = seed;
    const Json inputs{
        {"version", 1}, {"scene", to_json(one.scene)}, {"evaluation", to_json(one.evaluation)}};
    all.push_back({colmap_part(seed), inputs, [=] { return clouds_on_colmap_poses(chain, one); }});
    all.push_back({true_part(seed), inputs, [=] { return maps_on_true_poses(chain, one); }});
  }
  return all;
}

// Medians over the seeds.

using Seeds = std::vector<int>;

double median_over(const Seeds& seeds, const std::function<double(int seed)>& value) {
  std::vector<double> values;
  for (const int seed : seeds) values.push_back(value(seed));
  return experiments::median_of(values);
}

// The clouds on one kind of poses.
struct Clouds {
  const Json& results;
  std::string (*part)(int seed);

  const Json& of(int seed) const { return result_of(results, part(seed)).at("clouds"); }
  double value(int seed, const std::string& method, const char* field) const {
    return of(seed).at(method).at(field).get<double>();
  }
  double mean_beside(int seed, const std::string& method, const std::string& other) const {
    return value(seed, method, "mean") / value(seed, other, "mean");
  }
};

std::string clouds_table(const Clouds& clouds, const Seeds& seeds) {
  std::vector<Words> rows{{"cloud", "points", "mean [mm]", "median [mm]", "variance [mm²]",
                           "mean / in air", "of each seed", "completeness [%]"}};
  for (const Method& method : methods()) {
    if (!clouds.of(seeds.front()).contains(method.name)) continue;
    const auto middle = [&](const char* field) {
      return median_over(seeds, [&](int s) { return clouds.value(s, method.name, field); });
    };
    const auto ratio = [&](int s) { return clouds.mean_beside(s, method.name, "air"); };
    std::string ratios;
    for (const int seed : seeds)
      ratios += fmt::format("{}{:.3f}", ratios.empty() ? "" : ", ", ratio(seed));
    rows.push_back(
        {method.title, fmt::format("{:.0f}", middle("points")), millimetres(middle("mean")),
         millimetres(middle("median")), experiments::significant(1e6 * middle("variance")),
         fmt::format("{:.3f}", median_over(seeds, ratio)), ratios, percent(middle("recall"))});
  }
  return experiments::markdown_table(rows);
}

// How the mean distance changes from the paper's method to ours, by one half of it and by both.
std::string gains_table(const std::vector<Clouds>& kinds, const Seeds& seeds) {
  std::vector<Words> rows{
      {"poses", "ours in place of the paper's", "mean distance [%]", "of each seed"}};
  const std::pair<const char*, const char*> changes[] = {
      {"projection", "homography"}, {"warp", "line_search"}, {"projection and warp", "ours"}};
  for (const Clouds& clouds : kinds)
    for (const auto& [change, method] : changes) {
      if (!clouds.of(seeds.front()).contains(method)) continue;
      if (!clouds.of(seeds.front()).contains("papers")) continue;
      const auto gain = [&, name = method](int s) {
        return 100 * (clouds.mean_beside(s, name, "papers") - 1);
      };
      std::string gains;
      for (const int seed : seeds)
        gains += fmt::format("{}{:+.1f}", gains.empty() ? "" : ", ", gain(seed));
      rows.push_back({clouds.part == true_part ? "true" : "COLMAP's", change,
                      fmt::format("{:+.1f}", median_over(seeds, gain)), gains});
    }
  return experiments::markdown_table(rows);
}

// Rings.

constexpr std::size_t kFewest = 5000;  // pixels of a ring that counts

const Json& ring_of(const Json& results, int seed, const char* method, std::size_t k) {
  return result_of(results, true_part(seed)).at("rings").at(method).at(k);
}

bool counts(const Json& results, const Seeds& seeds, std::size_t k) {
  for (const int seed : seeds)
    for (const char* method : {"air", "ours"})
      if (ring_of(results, seed, method, k).at("count").get<std::size_t>() < kFewest) return false;
  return true;
}

double ring_median(const Json& results, const Seeds& seeds, const char* method, std::size_t k) {
  return median_over(
      seeds, [&](int s) { return ring_of(results, s, method, k).at("median").get<double>(); });
}

double ring_difference(const Json& results, int seed, std::size_t k) {
  return ring_of(results, seed, "ours", k).at("median").get<double>() -
         ring_of(results, seed, "air", k).at("median").get<double>();
}

std::size_t ring_count(const Json& results, const Seeds& seeds) {
  return result_of(results, true_part(seeds.front())).at("rings").at("air").size();
}

std::string rings_table(const Json& results, const Seeds& seeds) {
  std::vector<Words> rows{{"ring [half diagonals]", "in air [1e-4]", "refracted [1e-4]",
                           "refracted - in air [1e-4]", "of each seed"}};
  const auto scaled = [](double fraction) { return fmt::format("{:+.2f}", 1e4 * fraction); };
  for (std::size_t k = 0; k < ring_count(results, seeds); ++k) {
    const Json& ring = ring_of(results, seeds.front(), "air", k);
    const std::string name = fmt::format("{:.3f} to {:.3f}", ring.at("inner").get<double>(),
                                         ring.at("outer").get<double>());
    if (!counts(results, seeds, k)) {
      rows.push_back({name, "-", "-", "-", fmt::format("fewer than {} pixels", kFewest)});
      continue;
    }
    const auto difference = [&](int s) { return ring_difference(results, s, k); };
    std::string each;
    for (const int seed : seeds) each += (each.empty() ? "" : ", ") + scaled(difference(seed));
    rows.push_back({name, scaled(ring_median(results, seeds, "air", k)),
                    scaled(ring_median(results, seeds, "ours", k)),
                    scaled(median_over(seeds, difference)), each});
  }
  return experiments::markdown_table(rows);
}

// Pictures.

struct Panel {
  std::string title;
  const Json* picture;
};

std::string picture_sheet(const std::string& title, const std::vector<Panel>& panels,
                          std::size_t columns, double width, double height) {
  constexpr double kTitle = 34, kHead = 26, kGap = 14;
  const double step_x = width + kGap, step_y = height + kHead;
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  io::Svg svg(kGap + step_x * static_cast<double>(columns),
              kTitle + step_y * static_cast<double>(rows) + kGap);
  svg.text(kGap, 22, title, io::Anchor::kStart, "title");
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const double x = kGap + step_x * static_cast<double>(k % columns);
    const double y = kTitle + step_y * static_cast<double>(k / columns);
    svg.text(x, y + 18, panels[k].title, io::Anchor::kStart, "small");
    svg.picture({x, y + kHead, width, height}, panels[k].picture->get<std::string>());
  }
  return svg.str();
}

std::string cloud_pictures(const Json& results, int seed) {
  std::vector<Panel> panels;
  const Json& clouds = result_of(results, colmap_part(seed)).at("clouds");
  for (const char* name : {"air", "ours", "papers"})
    for (const Method& method : methods())
      if (method.name == std::string_view(name))
        panels.push_back({method.title, &clouds.at(name).at("picture")});
  return picture_sheet("Clouds on COLMAP's poses, coloured by their distance from the true surface",
                       panels, 3, 400, 336);
}

std::string depth_pictures(const Json& results, int seed) {
  const Json& pictures = result_of(results, true_part(seed)).at("pictures");
  return picture_sheet("Depth maps on true poses: estimate, truth, error",
                       {{"in air", &pictures.at("air")}, {"refracted", &pictures.at("ours")}}, 1,
                       960, 264);
}

std::vector<Document> documents(const Json& results, const Seeds& seeds) {
  const Clouds on_colmaps{results, colmap_part}, on_true{results, true_part};
  return {{"reconstruction.md", clouds_table(on_colmaps, seeds)},
          {"reconstruction_true.md", clouds_table(on_true, seeds)},
          {"reconstruction_gains.md", gains_table({on_colmaps, on_true}, seeds)},
          {"reconstruction_rings.md", rings_table(results, seeds)},
          {"reconstruction_clouds.svg", cloud_pictures(results, seeds.front())},
          {"reconstruction_depth.svg", depth_pictures(results, seeds.front())}};
}

}  // namespace

Experiment reconstruction(const Chain& chain, bool quick) {
  return {"reconstruction", parts(chain, quick),
          [seeds = study(quick).seeds](const Json& results) { return documents(results, seeds); }};
}

}  // namespace axial
