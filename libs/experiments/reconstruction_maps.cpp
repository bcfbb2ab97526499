// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/reconstruction_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/cells.h"
#include "experiments/distribution.h"
#include "experiments/steps.h"
#include "experiments/tables.h"

namespace axial::experiments {
namespace {

const Json& maps_of(const Json& results, int seed, const std::string& method) {
  return result_of(results, true_part(seed)).at("maps").at(method);
}

std::vector<const Method*> judged_methods() {
  std::vector<const Method*> judged;
  for (const Method& method : reconstruction_methods())
    if (method.judged_closely) judged.push_back(&method);
  return judged;
}

constexpr std::size_t kFewest = 5000;  // pixels of a ring or kind of place in the tables

// The sum of `value` over all kinds of places.
double sum_over_places(const Json& places, const std::function<double(const Json& place)>& value) {
  double sum = 0;
  for (const Json& place : places) sum += value(place);
  return sum;
}

double number(const Json& place, const char* field) {
  return place.at(field).get<double>();
}

double summed_error(const Json& place) {
  return (number(place, "pixels") - number(place, "gross")) * number(place, "mean");
}

const Json& places_of(const Json& results, int seed, const Method& method) {
  return maps_of(results, seed, method.name).at("places");
}

Words place_row(const Json& results, const Seeds& seeds, const Method& method, std::size_t k) {
  using Value = std::function<double(const Json& place, const Json& all)>;
  const auto middle = [&](const Value& value) {
    return median_over(seeds, [&](int s) {
      const Json& places = places_of(results, s, method);
      return value(places.at(k), places);
    });
  };
  const auto field = [&](const char* name) {
    return middle([=](const Json& place, const Json&) { return number(place, name); });
  };
  const auto truths = [](const Json& place) { return number(place, "truths"); };
  const bool enough = std::all_of(seeds.begin(), seeds.end(), [&](int s) {
    return number(places_of(results, s, method).at(k), "pixels") >= kFewest;
  });
  Words row{method.title,
            places_of(results, seeds.front(), method).at(k).at("place").get<std::string>(),
            percent(middle([&](const Json& place, const Json& all) {
              return truths(place) / sum_over_places(all, truths);
            }))};
  if (!enough) return row += {"-", "-", "-", "-", "-"};
  return row += {percent(middle([&](const Json& place, const Json&) {
                   return number(place, "pixels") / std::max(1.0, truths(place));
                 })),
                 millimetres(field("median")), percent(middle([](const Json& place, const Json&) {
                   return number(place, "gross") / number(place, "pixels");
                 })),
                 millimetres(field("mean")), percent(middle([](const Json& place, const Json& all) {
                   return summed_error(place) / sum_over_places(all, summed_error);
                 }))};
}

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

// The difference between the method's median error and the median error in air.
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
  return median_of(values);
}

std::string joined(const Seeds& seeds, const std::function<std::string(int seed)>& text) {
  std::string all;
  for (const int seed : seeds) all += (all.empty() ? "" : ", ") + text(seed);
  return all;
}

std::string maps_table(const Json& results, const Seeds& seeds) {
  std::vector<Words> rows{{"depth maps", "pixels compared", "median error [mm]", "within 5 mm [%]",
                           "gross errors [%]", "mean without them [mm]", "completeness [%]"}};
  for (const Method* method : judged_methods()) {
    const auto middle = [&](const char* field) {
      return median_over(
          seeds, [&](int s) { return maps_of(results, s, method->name).at(field).get<double>(); });
    };
    rows.push_back({method->title, fmt::format("{:.0f}", middle("pixels")),
                    millimetres(middle("median")), percent(middle("within")),
                    percent(middle("gross")), millimetres(middle("mean")),
                    percent(middle("completeness"))});
  }
  return markdown_table(rows);
}

std::string places_table(const Json& results, const Seeds& seeds) {
  std::vector<Words> rows{{"depth maps", "pixels with", "of all [%]", "completeness [%]",
                           "median error [mm]", "gross errors [%]", "mean without them [mm]",
                           "of the sum without them [%]"}};
  for (const Method* method : judged_methods())
    for (std::size_t k = 0; k < places_of(results, seeds.front(), *method).size(); ++k)
      rows.push_back(place_row(results, seeds, *method, k));
  return markdown_table(rows);
}

std::string phases_table(const Json& results, const Seeds& seeds) {
  std::vector<Words> rows{{"true position within the pixel"}};
  for (const Method* method : judged_methods())
    rows[0].push_back(fmt::format("{} [1/1000 px]", method->title));
  const Json& first = maps_of(results, seeds.front(), "air").at("phases");
  for (std::size_t k = 0; k < first.size(); ++k) {
    Words row{fmt::format("{:.3f} to {:.3f}", number(first[k], "begin"), number(first[k], "end"))};
    for (const Method* method : judged_methods())
      row.push_back(fmt::format(
          "{:+.1f}", 1e3 * median_over(seeds, [&](int s) {
                       return number(maps_of(results, s, method->name).at("phases").at(k), "shift");
                     })));
    rows.push_back(row);
  }
  return markdown_table(rows);
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
  return markdown_table(rows);
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

}  // namespace axial::experiments
