// SPDX-License-Identifier: GPL-3.0-or-later
#include "run.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "io/bytes/json.h"
#include "io/bytes/json_place.h"

namespace axial::apps {
namespace {

using Json = nlohmann::ordered_json;

// The text in which absolute paths are replaced by their last names: a page may be published, and
// the folders of a computer can contain the name of its user. A path begins at a slash at the
// beginning of the text or behind one of `before`, and ends before one of `ends`.
std::string without_folders(const std::string& text, std::string_view before,
                            std::string_view ends) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const bool begins = text[i] == '/' && text.find('/', i + 1) != i + 1 &&
                        (i == 0 || before.find(text[i - 1]) != std::string_view::npos);
    if (begins) {
      const std::size_t end = std::min(text.find_first_of(ends, i), text.size());
      const std::size_t last = text.rfind('/', text[end - 1] == '/' ? end - 2 : end - 1);
      i = last == std::string::npos || last < i ? i + 1 : last + 1;
      result += text.substr(i, end - i);
      i = end;
    } else {
      result += text[i++];
    }
  }
  return result;
}

Json words_of(const io::JsonPlace& field) {
  Json words = Json::array();
  for (const io::JsonPlace& word : field.elements())
    words.push_back(without_folders(word.text(), "=:,", "=:,"));
  return words;
}

Json warnings_of(const io::JsonPlace& field) {
  Json warnings = Json::array();
  for (const io::JsonPlace& warning : field.elements())
    warnings.push_back({{"text", without_folders(warning.text("text"), " =:,'\"(", " =:,;'\")")},
                        {"times", warning.at("times").number_from_0()}});
  return warnings;
}

// Numbers, of which those that are not known are null.
Json numbers_of(const io::JsonPlace& field) {
  Json numbers = Json::array();
  for (const io::JsonPlace& number : field.elements())
    numbers.push_back(number.json.is_null() ? Json() : Json(number.number()));
  return numbers;
}

Json control_of(const io::JsonPlace& field) {
  Json rows = Json::array();
  for (const io::JsonPlace& row : field.elements())
    rows.push_back({{"name", row.text("name")},
                    {"use", row.text("use")},
                    {"photographs", row.at("photographs").number_from_0()},
                    {"residual_mm", numbers_of(row.at("residual_mm"))},
                    {"expected_sigma_mm", numbers_of(row.at("expected_sigma_mm"))}});
  return rows;
}

}  // namespace

Json run_report(const std::filesystem::path& file) {
  const nlohmann::json content = io::read_json(file);
  const io::JsonPlace whole = io::JsonPlace::of_file(content, file);
  Json report{{"command", words_of(whole.at("command"))}, {"steps", Json::array()}};
  for (const io::JsonPlace& step : whole.elements("steps")) {
    const io::JsonPlace version = step.at("version");
    report["steps"].push_back({{"name", step.text("name")},
                               {"command", words_of(step.at("command"))},
                               {"seconds", step.at("seconds").number_from_0()},
                               {"version", version.json.is_null() ? Json() : Json(version.text())},
                               {"warnings", warnings_of(step.at("warnings"))}});
  }
  if (whole.has("control")) report["control"] = control_of(whole.at("control"));
  return report;
}

}  // namespace axial::apps
