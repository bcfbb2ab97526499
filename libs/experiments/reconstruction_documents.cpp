// SPDX-License-Identifier: GPL-3.0-or-later
// Tables and figures for the paper's figures 5 and 6.
#include <fmt/format.h>

#include "experiments/cells.h"
#include "experiments/reconstruction_maps.h"
#include "experiments/steps.h"
#include "experiments/tables.h"
#include "experiments/verdicts.h"
#include "picture/svg.h"

namespace axial::experiments {
namespace {

// The clouds with one kind of poses.
struct Clouds {
  const Json& results;
  std::string (*part)(int seed);

  const Json& of(int seed) const { return result_of(results, part(seed)).at("clouds"); }
  // The field "moved" is the mean after the rigid motion.
  double value(int seed, const std::string& method, const std::string& field) const {
    const Json& cloud = of(seed).at(method);
    return (field == "moved" ? cloud.at("moved").at("mean") : cloud.at(field)).get<double>();
  }
  // A value of the cloud fused with --number-views-fuse 2.
  double of_two(int seed, const std::string& method, const std::string& field) const {
    return of(seed).at(method).at("two").at(field).get<double>();
  }
  double beside(int seed, const std::string& method, const std::string& other,
                const std::string& field = "mean") const {
    return value(seed, method, field) / value(seed, other, field);
  }
};

Words cloud_row(const Clouds& clouds, const Seeds& seeds, const Method& method) {
  const auto middle = [&](const char* field) {
    return median_over(seeds, [&](int s) { return clouds.value(s, method.name, field); });
  };
  const auto ratio = [&](const char* field) {
    return [&, field](int s) { return clouds.beside(s, method.name, "air", field); };
  };
  const auto each = [&](int s) { return fmt::format("{:.3f}", ratio("mean")(s)); };
  const auto beside_air = [&](const char* field) {
    return fmt::format("{:.3f}", median_over(seeds, ratio(field)));
  };
  return {method.title,
          fmt::format("{:.0f}", middle("points")),
          millimetres(middle("mean")),
          millimetres(middle("median")),
          beside_air("mean"),
          joined(seeds, each),
          percent(middle("recall")),
          significant(1e6 * middle("variance")),
          beside_air("variance")};
}

// Further columns: values after the best rigid motion.
Words moved_cells(const Clouds& clouds, const Seeds& seeds, const Method& method) {
  const auto moved = [&](int s) { return clouds.value(s, method.name, "moved"); };
  const auto ratio = [&](int s) { return clouds.beside(s, method.name, "air", "moved"); };
  return {millimetres(median_over(seeds, moved)), fmt::format("{:.3f}", median_over(seeds, ratio))};
}

// The paper's numbers (its section 4 and the caption of its figure 6). Their unit is assumed to be
// metres.
struct PapersCloud {
  const char* title;
  int points;
  double mean, variance;
};
constexpr PapersCloud kPapersAir{"the paper's own scene, in air", 4200659, 0.88e-3, 2.58e-6};
constexpr PapersCloud kPapersWater{"the paper's own scene, refracted", 4635708, 1.28e-3, 3.72e-6};

// The paper registered its clouds to the mesh, so its mean distances are comparable to distances
// after a rigid motion.
Words papers_row(const PapersCloud& cloud) {
  return {cloud.title,
          fmt::format("{}", cloud.points),
          "-",
          "-",
          "-",
          "-",
          "-",
          significant(1e6 * cloud.variance),
          fmt::format("{:.3f}", cloud.variance / kPapersAir.variance),
          millimetres(cloud.mean),
          fmt::format("{:.3f}", cloud.mean / kPapersAir.mean)};
}

std::vector<Words> cloud_rows(const Clouds& clouds, const Seeds& seeds) {
  std::vector<Words> rows{{"cloud", "points", "mean [mm]", "median [mm]", "mean / in air",
                           "of each seed", "completeness [%]", "variance [mm²]", "/ in air"}};
  for (const Method& method : reconstruction_methods())
    if (clouds.of(seeds.front()).contains(method.name))
      rows.push_back(cloud_row(clouds, seeds, method));
  return rows;
}

std::string colmap_poses_table(const Clouds& clouds, const Seeds& seeds) {
  std::vector<Words> rows = cloud_rows(clouds, seeds);
  rows[0] += {"mean after a rigid move [mm]", "/ in air"};
  for (std::size_t k = 0; k < reconstruction_methods().size(); ++k)
    rows.at(k + 1) += moved_cells(clouds, seeds, reconstruction_methods()[k]);
  rows.insert(rows.end(), {papers_row(kPapersAir), papers_row(kPapersWater)});
  return markdown_table(rows);
}

// The change of the mean distance from the paper's method to our method, for projection, warp and
// both.
std::string gains_table(const std::vector<Clouds>& kinds, const Seeds& seeds) {
  std::vector<Words> rows{
      {"poses", "ours in place of the paper's", "mean distance [%]", "of each seed"}};
  struct Change {
    const char *title, *from, *to;
  };
  constexpr Change kChanges[] = {{"projection", "papers", "homography"},
                                 {"warp", "papers", "line_search"},
                                 {"warp, after the projection", "homography", "ours"},
                                 {"projection and warp", "papers", "ours"}};
  for (const Clouds& clouds : kinds)
    for (const auto& [title, from, to] : kChanges) {
      const Json& known = clouds.of(seeds.front());
      if (!known.contains(from) || !known.contains(to)) continue;
      const auto gain = [&, before = from, after = to](int s) {
        return 100 * (clouds.beside(s, after, before) - 1);
      };
      rows.push_back({clouds.part == true_part ? "true" : "COLMAP's", title,
                      fmt::format("{:+.1f}", median_over(seeds, gain)),
                      joined(seeds, [&](int s) { return fmt::format("{:+.1f}", gain(s)); })});
    }
  return markdown_table(rows);
}

// Completeness of places that at least `views` cameras see; "-" if there are fewer cameras.
std::string completeness_cell(const Clouds& clouds, const Seeds& seeds, const Method& method,
                              std::size_t views) {
  const std::string key = std::to_string(views);
  const auto complete = [&](int s) -> const Json& {
    return clouds.of(s).at(method.name).at("complete");
  };
  if (!complete(seeds.front()).contains(key)) return "-";
  return percent(median_over(seeds, [&](int s) { return complete(s).at(key).get<double>(); }));
}

std::string completeness_table(const Clouds& clouds, const Seeds& seeds) {
  std::vector<Words> rows{{"seen by at least"}};
  for (const std::size_t views : kCompletenessViews)
    rows.push_back({fmt::format("{} cameras", views)});
  for (const Method& method : reconstruction_methods()) {
    if (!method.judged_closely) continue;
    rows[0].push_back(fmt::format("{} [%]", method.title));
    for (std::size_t k = 0; k < kCompletenessViews.size(); ++k)
      rows[k + 1].push_back(completeness_cell(clouds, seeds, method, kCompletenessViews[k]));
  }
  return markdown_table(rows);
}

// Results of clouds fused with --number-views-fuse 2.
std::string two_table(const Clouds& clouds, const Seeds& seeds) {
  std::vector<Words> rows{{"cloud", "points", "mean [mm]", "mean / in air", "of each seed",
                           "completeness [%]", "of each seed"}};
  for (const Method& method : reconstruction_methods()) {
    if (!method.judged_closely) continue;
    const auto value = [&](const char* field) {
      return [&, field](int s) { return clouds.of_two(s, method.name, field); };
    };
    const auto ratio = [&](int s) { return value("mean")(s) / clouds.of_two(s, "air", "mean"); };
    rows.push_back({method.title, fmt::format("{:.0f}", median_over(seeds, value("points"))),
                    millimetres(median_over(seeds, value("mean"))),
                    fmt::format("{:.3f}", median_over(seeds, ratio)),
                    joined(seeds, [&](int s) { return fmt::format("{:.3f}", ratio(s)); }),
                    percent(median_over(seeds, value("recall"))),
                    joined(seeds, [&](int s) { return percent(value("recall")(s)); })});
  }
  return markdown_table(rows);
}

struct Panel {
  std::string title;
  const Json* picture;
};

std::string picture_sheet(const std::string& title, const std::vector<Panel>& panels,
                          std::size_t columns, double width, double height) {
  constexpr double kTitle = 34, kHead = 26, kGap = 14;
  const double step_x = width + kGap, step_y = height + kHead;
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  picture::Svg svg(kGap + step_x * static_cast<double>(columns),
                   kTitle + step_y * static_cast<double>(rows) + kGap);
  svg.text(kGap, 22, title, picture::Anchor::kStart, "title");
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const double x = kGap + step_x * static_cast<double>(k % columns);
    const double y = kTitle + step_y * static_cast<double>(k / columns);
    svg.text(x, y + 18, panels[k].title, picture::Anchor::kStart, "small");
    svg.picture({x, y + kHead, width, height}, panels[k].picture->get<std::string>());
  }
  return svg.str();
}

// The largest error in the pictures' colour scale, which is the same in all parts.
double color_max(const Json& results) {
  return results.at("parts").front().at("inputs").at("evaluation").at("color_max").get<double>();
}

std::string cloud_pictures(const Json& results, int seed) {
  std::vector<Panel> panels;
  const Json& clouds = result_of(results, colmap_part(seed)).at("clouds");
  for (const char* name : {"air", "ours", "papers"})
    for (const Method& method : reconstruction_methods())
      if (method.name == std::string_view(name))
        panels.push_back({method.title, &clouds.at(name).at("picture")});
  return picture_sheet(fmt::format("Clouds on COLMAP's poses, coloured by their distance from the "
                                   "true surface, 0 to {:g} mm",
                                   1e3 * color_max(results)),
                       panels, 3, 400, 336);
}

std::string depth_pictures(const Json& results, int seed) {
  const Json& pictures = result_of(results, true_part(seed)).at("pictures");
  std::vector<Panel> panels;
  for (const Method& method : reconstruction_methods())
    if (method.judged_closely) panels.push_back({method.title, &pictures.at(method.name)});
  return picture_sheet(fmt::format("Depth maps on true poses: estimate, truth, error "
                                   "(0 to {:g} mm)",
                                   1e3 * color_max(results)),
                       panels, 1, 960, 264);
}

std::string photographs(const Json& results, int seed) {
  const Json& pictures = result_of(results, colmap_part(seed)).at("photographs");
  return picture_sheet(
      "The first of the views",
      {{"in air", &pictures.at("air")}, {"through the port", &pictures.at("water")}}, 2, 480, 360);
}

// The requirements on our method, and whether the results meet them.

std::string verdicts(const Json& results, const Clouds& clouds, const Seeds& seeds) {
  const double ratio = median_over(seeds, [&](int s) { return clouds.beside(s, "ours", "air"); });
  const auto more_complete = [&](const char* views) {
    return median_over(seeds, [&](int s) {
      const auto complete = [&](const char* method) {
        return clouds.of(s).at(method).at("complete").at(views).get<double>();
      };
      return complete("ours") - complete("air");
    });
  };
  const double of_two = more_complete("2"), of_three = more_complete("3");
  const double fused_for_two = median_over(seeds, [&](int s) {
    return clouds.of_two(s, "ours", "recall") - clouds.of_two(s, "air", "recall");
  });
  const double trend = largest_ring_difference(results, seeds);
  return verdict_table(
      {{"our method, COLMAP's poses: mean / in air at most 0.95", fmt::format("{:.3f}", ratio),
        ratio <= 0.95},
       {"the same: completeness, of what two cameras see, no lower than in air",
        fmt::format("{:+.1f} percentage points", 100 * of_two), of_two >= 0},
       {"the same, of what three cameras see",
        fmt::format("{:+.1f} percentage points", 100 * of_three), of_three >= 0},
       {"the same, of what two cameras see, where both clouds want two views "
        "(--number-views-fuse 2)",
        fmt::format("{:+.1f} percentage points", 100 * fused_for_two), fused_for_two >= 0},
       {"our method, true poses: every ring within 1e-4 of in air",
        fmt::format("{:.2f}e-4", 1e4 * trend), trend <= 1e-4}});
}

Document registered_images(const Json& results, const Seeds& seeds) {
  std::vector<Words> rows{{"seed", "images registered by COLMAP", "their centres' RMS [mm]"}};
  for (const int seed : seeds) {
    const Json& poses = result_of(results, colmap_part(seed));
    rows.push_back({fmt::format("{}", seed), fmt::format("{}", poses.at("images").get<int>()),
                    millimetres(poses.at("centre_rms"))});
  }
  return {"reconstruction_poses.md", markdown_table(rows)};
}

}  // namespace

std::vector<Document> reconstruction_documents(const Json& results, const Seeds& seeds) {
  const Clouds on_colmaps{results, colmap_part}, on_true{results, true_part};
  return {{"reconstruction.md", colmap_poses_table(on_colmaps, seeds)},
          {"reconstruction_complete.md", completeness_table(on_colmaps, seeds)},
          {"reconstruction_two.md", two_table(on_colmaps, seeds)},
          registered_images(results, seeds),
          {"reconstruction_true.md", markdown_table(cloud_rows(on_true, seeds))},
          {"reconstruction_gains.md", gains_table({on_colmaps, on_true}, seeds)},
          {"reconstruction_maps.md", maps_table(results, seeds)},
          {"reconstruction_rings.md", rings_table(results, seeds)},
          {"reconstruction_places.md", places_table(results, seeds)},
          {"reconstruction_phases.md", phases_table(results, seeds)},
          {"reconstruction_verdicts.md", verdicts(results, on_colmaps, seeds)},
          {"reconstruction_views.svg", photographs(results, seeds.front())},
          {"reconstruction_clouds.svg", cloud_pictures(results, seeds.front())},
          {"reconstruction_depth.svg", depth_pictures(results, seeds.front())}};
}

}  // namespace axial::experiments
