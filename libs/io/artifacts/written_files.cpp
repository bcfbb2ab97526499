// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/artifacts/written_files.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/artifacts/artifact.h"

namespace axial::io {
namespace fs = std::filesystem;

namespace {

bool leads_out(const fs::path& path) {
  return path.is_absolute() || path != path.lexically_normal() || path.empty() ||
         *path.begin() == "..";
}

}  // namespace

nlohmann::json list_files(const fs::path& folder) {
  nlohmann::json listed = nlohmann::json::object();
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (fs::is_regular_file(entry.symlink_status()))
      listed[entry.path().lexically_relative(folder).generic_string()] =
          print_of_file(entry.path());
  return listed;
}

WrittenFiles find_written(const fs::path& folder, const nlohmann::json& listed) {
  WrittenFiles found;
  if (!listed.is_object()) return found;
  for (const auto& [name, print] : listed.items()) {
    const fs::path path = name;
    std::error_code error;
    if (leads_out(path) ||
        fs::symlink_status(folder / path, error).type() != fs::file_type::regular)
      continue;
    (print == print_of_file(folder / path) ? found.unchanged : found.changed).push_back(path);
  }
  std::ranges::sort(found.unchanged);
  std::ranges::sort(found.changed);
  return found;
}

void remove_below(const fs::path& folder, const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    fs::remove(folder / file);
    std::error_code error;  // ignored: the folder is not empty
    for (fs::path above = file.parent_path(); !above.empty(); above = above.parent_path())
      if (!fs::is_directory(fs::symlink_status(folder / above, error)) ||
          !fs::remove(folder / above, error))
        break;
  }
}

}  // namespace axial::io
