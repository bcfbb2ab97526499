// SPDX-License-Identifier: GPL-3.0-or-later
// The time of a projection by each method, for several image sizes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>

#include "experiments/charts.h"
#include "experiments/experiment.h"
#include "experiments/projection_time.h"
#include "experiments/tables.h"
#include "experiments/verdicts.h"

namespace axial::experiments {
namespace {

constexpr std::array kOrders{Order::kScattered, Order::kReading};
constexpr std::array<const char*, 5> kMethods{"exact", "line_search_plain", "line_search_compact",
                                              "line_search_tight", "analytic"};
constexpr std::array<const char*, 5> kTitles{"exact projection", "line search, 8 numbers a pixel",
                                             "line search, 4 numbers (compact)",
                                             "line search, 2 numbers", "12th-degree polynomial"};

const char* order_name(Order order) {
  return order == Order::kScattered ? "scattered" : "reading";
}

// The sizes of the images [megapixels], in ascending order.
std::vector<int> megapixels(bool quick) {
  return quick ? std::vector{2, 4} : std::vector{2, 4, 6, 8, 10};
}

std::vector<int> megapixels_of(const Json& results) {
  return megapixels(results.at("quick").get<bool>());
}

std::string part_name(Order order, int size) {
  return fmt::format("{}_{}mp", order_name(order), size);
}

// The height of an image with aspect ratio 4:3.
int image_height(int size) {
  return static_cast<int>(std::lround(std::sqrt(size * 1e6 * 3 / 4)));
}

// The processor's name; "" if the system does not give it.
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

Part make_part(Order order, int size, const TimingOptions& options) {
  const int height = image_height(size);
  const int width = static_cast<int>(std::lround(height * 4.0 / 3));
  return {part_name(order, size),
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
    for (const int size : megapixels_of(results)) {
      const Json& result = result_of(results, part_name(order, size));
      line.x.push_back(size);
      line.y.push_back(result.at(kMethods[m]).at("nanoseconds"));
    }
    panel.lines.push_back(line);
  }
  return panel;
}

using Row = std::vector<std::string>;

// A table with one row for each method and order of points, and with `cells` for each image size.
std::string table(const Json& results, const Row& cell_titles,
                  const std::function<Row(const Json& time)>& cells) {
  std::vector<Row> rows{{"points", "method"}};
  for (const int size : megapixels_of(results))
    for (const std::string& title : cell_titles)
      rows[0].push_back(fmt::format("{} MP{}", size, title));
  for (const Order order : kOrders) {
    for (std::size_t m = 0; m < kMethods.size(); ++m) {
      Row row{order_name(order), kTitles[m]};
      for (const int size : megapixels_of(results)) {
        const Row more = cells(result_of(results, part_name(order, size)).at(kMethods[m]));
        row.insert(row.end(), more.begin(), more.end());
      }
      rows.push_back(row);
    }
  }
  return markdown_table(rows);
}

std::string times_table(const Json& results) {
  const Json& any = result_of(results, part_name(kOrders[0], megapixels_of(results).front()));
  return table(
             results, {" [ns]", ", of exact"},
             [](const Json& time) -> Row {
               return {significant(time.at("nanoseconds")), significant(time.at("ratio_to_exact"))};
             }) +
         "\nProcessor: " + any.at("processor").get<std::string>() + "\n";
}

std::string errors_table(const Json& results) {
  return table(results, {", mean error [px]", ", missed"}, [](const Json& time) -> Row {
    return {significant(time.at("mean_error")),
            fmt::format("{} of {}", time.at("missed").get<int>(), time.at("points").get<int>())};
  });
}

double ratio(const Json& results, Order order, int size, const char* method) {
  return result_of(results, part_name(order, size)).at(method).at("ratio_to_exact");
}

// The paper's measure of its method: how many times faster it is than a polynomial.
std::string analytic_table(const Json& results) {
  std::vector<Row> rows{{"points", "12th-degree polynomial / line search of"}};
  for (const int size : megapixels_of(results)) rows[0].push_back(fmt::format("{} MP", size));
  rows[0].push_back("the paper, 2 to 10 MP");
  for (const Order order : kOrders) {
    for (std::size_t m = 1; m + 1 < kMethods.size(); ++m) {
      Row row{order_name(order), std::string(kTitles[m]).substr(std::strlen("line search, "))};
      for (const int size : megapixels_of(results))
        row.push_back(significant(ratio(results, order, size, "analytic") /
                                  ratio(results, order, size, kMethods[m])));
      row.push_back("18 to 34");
      rows.push_back(row);
    }
  }
  return markdown_table(rows);
}

std::string verdicts(const Json& results) {
  std::vector<Verdict> all;
  const std::vector<int> sizes = megapixels_of(results);
  for (const int size : {sizes.front(), sizes.back()}) {
    const double faster = ratio(results, Order::kScattered, size, "line_search_compact");
    all.push_back({fmt::format("scattered points, {} MP: exact projection at least 10 times faster "
                               "than the compact line search",
                               size),
                   significant(faster), faster >= 10});
  }
  double least = HUGE_VAL;
  for (const Order order : kOrders)
    for (const int size : megapixels_of(results))
      least = std::min(least, ratio(results, order, size, "analytic"));
  all.push_back({"exact projection at least 300 times faster than the polynomial, every size",
                 significant(least), least >= 300});
  return verdict_table(all);
}

std::vector<Document> documents(const Json& results) {
  std::vector<LinePanel> panels;
  for (const Order order : kOrders) panels.push_back(panel(results, order));
  return {{"runtime.svg", draw_lines("One forward projection, one thread, float", panels, 2)},
          {"runtime.md", times_table(results)},
          {"runtime_errors.md", errors_table(results)},
          {"runtime_analytic.md", analytic_table(results)},
          {"runtime_verdicts.md", verdicts(results)}};
}

}  // namespace

Experiment runtime(bool quick) {
  TimingOptions options;
  if (quick) options = {3000, 100, 3};
  Experiment experiment{"runtime", {}, documents};
  for (const Order order : kOrders)
    for (const int size : megapixels(quick))
      experiment.parts.push_back(make_part(order, size, options));
  return experiment;
}

}  // namespace axial::experiments
