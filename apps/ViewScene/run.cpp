// SPDX-License-Identifier: GPL-3.0-or-later
#include "run.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "json_fields.h"

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

Json words_of(const JsonField& field) {
  Json words = Json::array();
  for (const JsonField& word : field.elements())
    words.push_back(without_folders(word.text(), "=:,", "=:,"));
  return words;
}

Json warnings_of(const JsonField& field) {
  Json warnings = Json::array();
  for (const JsonField& warning : field.elements())
    warnings.push_back(
        {{"text", without_folders(warning.at("text").text(), " =:,'\"(", " =:,;'\")")},
         {"times", warning.at("times").number_from_0()}});
  return warnings;
}

// Numbers, of which those that are not known are null.
Json numbers_of(const JsonField& field) {
  Json numbers = Json::array();
  for (const JsonField& number : field.elements())
    numbers.push_back(number.value.is_null() ? Json() : Json(number.number()));
  return numbers;
}

Json control_of(const JsonField& field) {
  Json rows = Json::array();
  for (const JsonField& row : field.elements())
    rows.push_back({{"name", row.at("name").text()},
                    {"use", row.at("use").text()},
                    {"photographs", row.at("photographs").number_from_0()},
                    {"residual_mm", numbers_of(row.at("residual_mm"))},
                    {"expected_sigma_mm", numbers_of(row.at("expected_sigma_mm"))}});
  return rows;
}

}  // namespace

Json run_report(const std::filesystem::path& file) {
  const JsonField whole{file, "", io::read_json(file)};
  Json report{{"command", words_of(whole.at("command"))}, {"steps", Json::array()}};
  for (const JsonField& step : whole.at("steps").elements()) {
    const JsonField version = step.at("version");
    report["steps"].push_back({{"name", step.at("name").text()},
                               {"command", words_of(step.at("command"))},
                               {"seconds", step.at("seconds").number_from_0()},
                               {"version", version.value.is_null() ? Json() : Json(version.text())},
                               {"warnings", warnings_of(step.at("warnings"))}});
  }
  if (whole.value.contains("control")) report["control"] = control_of(whole.at("control"));
  return report;
}

}  // namespace axial::apps
