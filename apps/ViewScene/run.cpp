// SPDX-License-Identifier: GPL-3.0-or-later
#include "run.h"

#include "json_fields.h"

namespace axial::apps {
namespace {

using Json = nlohmann::ordered_json;

Json words_of(const JsonField& field) {
  Json words = Json::array();
  for (const JsonField& word : field.elements()) words.push_back(word.text());
  return words;
}

Json warnings_of(const JsonField& field) {
  Json warnings = Json::array();
  for (const JsonField& warning : field.elements())
    warnings.push_back(
        {{"text", warning.at("text").text()}, {"times", warning.at("times").number_from_0()}});
  return warnings;
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
  return report;
}

}  // namespace axial::apps
