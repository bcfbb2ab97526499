// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/distribution.h"
#include "experiments/tables.h"

namespace axial {
namespace {

using experiments::result_of;

const Json& maps_of(const Json& results, int seed, const std::string& method) {
  return result_of(results, true_part(seed)).at("maps").at(method);
}

constexpr std::size_t kFewest = 5000;  // pixels of a ring that counts

const Json& ring_of(const Json& results, int seed, const std::string& method, std::size_t k) {
  return maps_of(results, seed, method).at("rings").at(k);
}

bool counts(const Json& results, const Seeds& seeds, std::size_t k) {
  for (const int seed : seeds)
    for (const char* method : {"air", "ours", "papers"})
      if (ring_of(results, seed, method, k).at("count").get<std::size_t>() < kFewest) return false;
  return true;
}

double ring_median(const Json& results, int seed, const std::string& method, std::size_t k) {
  return ring_of(results, seed, method, k).at("median").get<double>();
}

// What refraction adds to the error in air.
double ring_difference(const Json& results, int seed, const std::string& method, std::size_t k) {
  return ring_median(results, seed, method, k) - ring_median(results, seed, "air", k);
}

std::size_t ring_count(const Json& results, const Seeds& seeds) {
  return maps_of(results, seeds.front(), "air").at("rings").size();
}

std::string ring_title(const Json& ring) {
  return fmt::format("{:.3f} to {:.3f}", ring.at("inner").get<double>(),
                     ring.at("outer").get<double>());
}

}  // namespace

double median_over(const Seeds& seeds, const std::function<double(int seed)>& value) {
  std::vector<double> values;
  for (const int seed : seeds) values.push_back(value(seed));
  return experiments::median_of(values);
}

std::string joined(const Seeds& seeds, const std::function<std::string(int seed)>& text) {
  std::string all;
  for (const int seed : seeds) all += (all.empty() ? "" : ", ") + text(seed);
  return all;
}

std::string maps_table(const Json& results, const Seeds& seeds) {
  std::vector<Words> rows{{"depth maps", "pixels compared", "mean error [mm]", "median error [mm]",
                           "within 5 mm [%]", "completeness [%]"}};
  for (const Method& method : reconstruction_methods()) {
    if (!method.maps_judged) continue;
    const auto middle = [&](const char* field) {
      return median_over(
          seeds, [&](int s) { return maps_of(results, s, method.name).at(field).get<double>(); });
    };
    rows.push_back({method.title, fmt::format("{:.0f}", middle("pixels")),
                    millimetres(middle("mean")), millimetres(middle("median")),
                    percent(middle("within")), percent(middle("completeness"))});
  }
  return experiments::markdown_table(rows);
}

std::string rings_table(const Json& results, const Seeds& seeds) {
  std::vector<Words> rows{{"ring [half diagonals]", "in air [1e-4]", "ours [1e-4]", "ours - in air",
                           "of each seed", "the paper's [1e-4]", "the paper's - in air",
                           "of each seed"}};
  const auto scaled = [](double fraction) { return fmt::format("{:+.2f}", 1e4 * fraction); };
  for (std::size_t k = 0; k < ring_count(results, seeds); ++k) {
    Words row{ring_title(ring_of(results, seeds.front(), "air", k))};
    const auto middle = [&](const std::string& method) {
      return scaled(median_over(seeds, [&](int s) { return ring_median(results, s, method, k); }));
    };
    row.push_back(counts(results, seeds, k) ? middle("air")
                                            : fmt::format("fewer than {} pixels", kFewest));
    for (const char* method : {"ours", "papers"}) {
      const auto difference = [&](int s) { return ring_difference(results, s, method, k); };
      const auto each = [&](int s) { return scaled(difference(s)); };
      if (counts(results, seeds, k))
        row.insert(row.end(),
                   {middle(method), scaled(median_over(seeds, difference)), joined(seeds, each)});
      else
        row.insert(row.end(), {"-", "-", "-"});
    }
    rows.push_back(row);
  }
  return experiments::markdown_table(rows);
}

double largest_ring_difference(const Json& results, const Seeds& seeds) {
  double largest = 0;
  for (std::size_t k = 0; k < ring_count(results, seeds); ++k)
    if (counts(results, seeds, k))
      largest = std::max(largest, std::abs(median_over(seeds, [&](int s) {
                           return ring_difference(results, s, "ours", k);
                         })));
  return largest;
}

}  // namespace axial
