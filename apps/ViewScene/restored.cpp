// SPDX-License-Identifier: GPL-3.0-or-later
#include "restored.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "io/bytes/json.h"
#include "io/bytes/json_place.h"
#include "io/images/image.h"
#include "scene/resolution.h"
#include "survey/colors.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostCompared = 6;
constexpr int kComparedWidth = 800;   // of the pictures, at most [px]
constexpr int kComparedQuality = 88;  // of JPEG files
constexpr std::size_t kMostCharts = 1000;
constexpr std::size_t kMostWays = 1000;  // points of the chart

std::string choice_of(const io::JsonPlace& field, std::initializer_list<const char*> choices,
                      const std::string& wanted) {
  const std::string text = field.text();
  if (std::ranges::find(choices, text) == choices.end()) field.refuse(wanted);
  return text;
}

Json estimate_of(const io::JsonPlace& channel, const char* key, const char* name,
                 const char* unit) {
  const io::JsonPlace estimate = channel.at(key);
  return {{"name", name},
          {"unit", unit},
          {"value", estimate.number("value")},
          {"sigma", estimate.at("sigma").number_from_0()}};
}

Json values_of(const io::JsonPlace& channel, bool by_sun) {
  if (!by_sun)
    return Json::array({{{"name", "loss"},
                         {"unit", "/m"},
                         {"value", channel.number("loss_per_m")},
                         {"sigma", Json()}}});
  Json values = Json::array({estimate_of(channel, "a_per_m", "loss a", "/m"),
                             estimate_of(channel, "b_per_m", "rate of the veil b", "/m"),
                             estimate_of(channel, "veil", "veil B", "")});
  if (channel.has("daylight_per_m"))
    values.push_back(estimate_of(channel, "daylight_per_m", "loss of daylight by depth", "/m"));
  return values;
}

Json channels_of(const io::JsonPlace& channels, bool by_sun) {
  Json list = Json::array();
  for (const char* name : {"red", "green", "blue"}) {
    const io::JsonPlace channel = channels.at(name);
    const bool is_determined = channel.flag("determined");
    const bool is_assumed = channel.flag_or_false("assumed");
    const bool has_values = is_determined || is_assumed;
    list.push_back({{"name", name},
                    {"determined", is_determined},
                    {"assumed", is_assumed},
                    {"values", has_values ? values_of(channel, by_sun) : Json::array()}});
  }
  return list;
}

// Error if there are more than `most` elements.
std::vector<io::JsonPlace> few_elements(const io::JsonPlace& field, std::size_t most) {
  std::vector<io::JsonPlace> elements = field.elements();
  if (elements.size() > most) fail("{} has more than {} elements", field.where, most);
  return elements;
}

Json ways_of(const io::JsonPlace& field) {
  Json list = Json::array();
  for (const io::JsonPlace& row : few_elements(field, kMostWays))
    list.push_back({{"way_m", row.at("way_m").number_from_0()},
                    {"before", row.at("before").numbers(3)},
                    {"after", row.at("after").numbers(3)}});
  return list;
}

Json charts_of(const io::JsonPlace& field) {
  Json list = Json::array();
  for (const io::JsonPlace& chart : few_elements(field, kMostCharts))
    list.push_back({{"photograph", chart.text("photograph")},
                    {"ciede2000", chart.at("ciede2000").number_from_0()}});
  return list;
}

void add_findings(const fs::path& file, Json& data) {
  const nlohmann::json content = io::read_json(file);
  const io::JsonPlace whole = io::JsonPlace::of_file(content, file);
  data["light"] = choice_of(whole.at("light"), {"sun", "lamp"}, "sun or lamp");
  data["white"] = choice_of(whole.at("white"), {"grey patch", "grey seabed", "charts"},
                            "grey patch, grey seabed or charts");
  if (whole.has("charts")) data["charts"] = charts_of(whole.at("charts"));
  for (const char* key : {"spread_before", "spread_after"})
    data[key] = whole.at(key).number_from_0();
  if (whole.has("water_type")) data["water"] = whole.text("water_type");
  data["channels"] = channels_of(whole.at("channels"), data["light"] == "sun");
  if (whole.has("brightness_by_way")) data["by_way"] = ways_of(whole.at("brightness_by_way"));
}

void write_picture(const fs::path& file, const fs::path& from, int bits) {
  const cv::Mat3b pixels = io::in_8_bits(io::read_photograph(from).pixels, bits);
  const double scale = std::min(1.0, static_cast<double>(kComparedWidth) / pixels.cols);
  const cv::Size size(static_cast<int>(std::lround(scale * pixels.cols)),
                      std::max(1, static_cast<int>(std::lround(scale * pixels.rows))));
  io::write_jpeg(file, resized_image(pixels, size), kComparedQuality);
}

// The views whose photographs are compared.
std::vector<std::size_t> compared_views(std::size_t views) {
  const std::size_t count = std::min(views, kMostCompared);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(i * views / count);
  return chosen;
}

}  // namespace

Json restored_colors(const survey::Survey& survey, const fs::path& staging,
                     const Context& context) {
  Json data = Json::object();
  const fs::path file = survey.options.color_folder / "colors.json";
  std::error_code error;
  if (fs::exists(file, error))
    add_findings(file, data);
  else
    context.warning("{}: is not there: the page shows no numbers about water and light",
                    file.string());
  make_folder(staging / "colors");
  const std::vector<std::size_t> views = compared_views(survey.views.size());
  std::vector<Json> pictures(views.size());
  for_each_in_flight(views.size(), thread_count(), [&](std::size_t i) {
    const survey::View& view = survey.views[views[i]];
    const std::string before = fmt::format("colors/{:05}.before.jpg", views[i]);
    const std::string after = fmt::format("colors/{:05}.after.jpg", views[i]);
    write_picture(staging / before, view.file, survey.bit_depth);
    write_picture(staging / after, view.colors, survey::kBitsOfColors);
    pictures[i] = {{"name", view.file.filename().string()}, {"before", before}, {"after", after}};
  });
  data["pictures"] = pictures;
  return data;
}

}  // namespace axial::apps
