// SPDX-License-Identifier: GPL-3.0-or-later
// The time of a projection by each method, for several image sizes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "experiments/experiment.h"
#include "experiments/projection_time.h"

namespace axial::experiments {
namespace {

constexpr std::array kOrders{Order::kScattered, Order::kReading};
const char* order_name(Order order) {
  return order == Order::kScattered ? "scattered" : "reading";
}

// The sizes of the images [megapixels], in ascending order.
std::vector<int> megapixels(bool quick) {
  return quick ? std::vector{2, 4} : std::vector{2, 4, 6, 8, 10};
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

}  // namespace

Experiment runtime(bool quick) {
  TimingOptions options;
  if (quick) options = {3000, 100, 3};
  Experiment experiment{"runtime", {}};
  for (const Order order : kOrders)
    for (const int size : megapixels(quick))
      experiment.parts.push_back(make_part(order, size, options));
  return experiment;
}

}  // namespace axial::experiments
