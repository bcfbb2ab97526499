// SPDX-License-Identifier: GPL-3.0-or-later
// What a projection costs by each method, over the image's size.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "experiments/charts.h"
#include "experiments/experiment.h"
#include "experiments/projection_time.h"
#include "experiments/tables.h"

namespace axial::experiments {
namespace {

constexpr std::array kMegapixels{2, 4, 6, 8, 10};
constexpr std::array kOrders{Order::kScattered, Order::kReading};
constexpr std::array<const char*, 5> kMethods{"exact", "line_search_plain", "line_search_compact",
                                              "line_search_tight", "analytic"};
constexpr std::array<const char*, 5> kTitles{"exact projection", "line search, 8 numbers a pixel",
                                             "line search, 4 numbers (compact)",
                                             "line search, 2 numbers", "12th-degree polynomial"};

const char* order_name(Order order) {
  return order == Order::kScattered ? "scattered" : "reading";
}

std::string part_name(Order order, int megapixels) {
  return fmt::format("{}_{}mp", order_name(order), megapixels);
}

// 4:3.
int image_height(int megapixels) {
  return static_cast<int>(std::lround(std::sqrt(megapixels * 1e6 * 3 / 4)));
}

// "" where the system does not say.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
      return line.substr(std::min(line.find(':') + 2, line.size()));
  return "";
}

Json measure(int width, int height, Order order, const TimingOptions& options) {
  Json methods = Json::object();
  for (const MethodTime& time : time_projections({}, width, height, order, options))
    methods[time.method] = {{"nanoseconds", time.nanoseconds},
                            {"ratio_to_exact", time.ratio},
                            {"mean_error", time.mean_error},
                            {"points", time.points},
                            {"missed", time.missed}};
  methods["processor"] = processor();
  return methods;
}

Part make_part(Order order, int megapixels, const TimingOptions& options) {
  const int height = image_height(megapixels);
  const int width = static_cast<int>(std::lround(height * 4.0 / 3));
  return {part_name(order, megapixels),
          {{"version", 2},
           {"camera", to_json(CameraSetup{})},
           {"width", width},
           {"height", height},
           {"order", order_name(order)},
           {"points", options.points},
           {"analytic_points", options.analytic_points},
           {"repetitions", options.repetitions}},
          [=] { return measure(width, height, order, options); }};
}

LinePanel panel(const Json& results, Order order) {
  LinePanel panel{order == Order::kScattered ? "points scattered over the image"
                                             : "neighbouring points in turn",
                  "image size [megapixels]",
                  "time per projection [ns]",
                  {},
                  true,
                  true};
  for (std::size_t m = 0; m < kMethods.size(); ++m) {
    Line line{kTitles[m], {}, {}};
    for (const int megapixels : kMegapixels) {
      const Json& result = result_of(results, part_name(order, megapixels));
      line.x.push_back(megapixels);
      line.y.push_back(result.at(kMethods[m]).at("nanoseconds"));
    }
    panel.lines.push_back(line);
  }
  return panel;
}

std::string table(const Json& results) {
  std::vector<std::vector<std::string>> rows{{"points", "method"}};
  for (const int megapixels : kMegapixels) {
    rows[0].push_back(fmt::format("{} MP [ns]", megapixels));
    rows[0].push_back("of exact");
  }
  rows[0].push_back("mean error at 10 MP [px]");
  for (const Order order : kOrders) {
    for (std::size_t m = 0; m < kMethods.size(); ++m) {
      std::vector<std::string> row{order_name(order), kTitles[m]};
      for (const int megapixels : kMegapixels) {
        const Json& time = result_of(results, part_name(order, megapixels)).at(kMethods[m]);
        row.push_back(significant(time.at("nanoseconds")));
        row.push_back(significant(time.at("ratio_to_exact")));
      }
      const Json& largest = result_of(results, part_name(order, kMegapixels.back()));
      row.push_back(significant(largest.at(kMethods[m]).at("mean_error")));
      rows.push_back(row);
    }
  }
  const Json& any = result_of(results, part_name(kOrders[0], kMegapixels[0]));
  return markdown_table(rows) + "\nProcessor: " + any.at("processor").get<std::string>() + "\n";
}

std::vector<Document> documents(const Json& results) {
  std::vector<LinePanel> panels;
  for (const Order order : kOrders) panels.push_back(panel(results, order));
  return {{"runtime.svg", draw_lines("One forward projection, one thread, float", panels, 2)},
          {"runtime.md", table(results)}};
}

}  // namespace

Experiment runtime(bool quick) {
  TimingOptions options;
  if (quick) options = {3000, 100, 3};
  Experiment experiment{"runtime", {}, documents};
  for (const Order order : kOrders)
    for (const int megapixels : kMegapixels)
      experiment.parts.push_back(make_part(order, megapixels, options));
  return experiment;
}

}  // namespace axial::experiments
