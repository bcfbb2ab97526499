// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/same_file.h"

#include <sys/stat.h>

#include <optional>
#include <utility>

#include "base/error.h"

namespace axial {
namespace {

using Identity = std::pair<dev_t, ino_t>;

std::optional<Identity> identity_of(const std::filesystem::path& path) {
  struct stat status {};
  if (path.empty() || ::stat(path.c_str(), &status) != 0) return std::nullopt;
  return Identity{status.st_dev, status.st_ino};
}

}  // namespace

void require_not_an_input(const std::filesystem::path& output,
                          std::span<const std::filesystem::path> inputs,
                          const std::string& option) {
  const std::optional<Identity> target = identity_of(output);
  if (!target) return;
  for (const std::filesystem::path& input : inputs)
    if (identity_of(input) == target)
      fail("{} {}: is {}, which is read and would be overwritten", option, output.string(),
           output == input ? std::string("an input") : "the input " + input.string());
}

}  // namespace axial
