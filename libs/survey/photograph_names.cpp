// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/photograph_names.h"

#include <algorithm>

namespace axial::survey {
namespace {

namespace fs = std::filesystem;

fs::path common_folder(const Survey& survey) {
  fs::path common = survey.views.front().file.parent_path();
  for (const View& view : survey.views) {
    const fs::path folder = view.file.parent_path();
    const auto ends = std::ranges::mismatch(common, folder);
    fs::path shared;
    for (auto part = common.begin(); part != ends.in1; ++part) shared /= *part;
    common = shared;
  }
  return common;
}

}  // namespace

std::vector<fs::path> photograph_names(const Survey& survey) {
  const fs::path folder = common_folder(survey);
  std::vector<fs::path> names;
  for (const View& view : survey.views) names.push_back(view.file.lexically_relative(folder));
  return names;
}

std::vector<std::size_t> views_named(const std::string& name, const Survey& survey) {
  std::vector<std::size_t> found;
  if (survey.views.empty()) return found;
  const std::vector<fs::path> names = photograph_names(survey);
  for (std::size_t view = 0; view < names.size(); ++view)
    if (names[view].generic_string() == name) found.push_back(view);
  if (!found.empty()) return found;
  for (std::size_t view = 0; view < survey.views.size(); ++view) {
    const std::string path = survey.views[view].file.generic_string();
    if (path == name || path.ends_with("/" + name)) found.push_back(view);
  }
  return found;
}

}  // namespace axial::survey
