// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/same_file.h"

#include <sys/stat.h>

#include <map>
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

void require_no_inputs(std::span<const std::filesystem::path> outputs,
                       std::span<const std::filesystem::path> inputs, const std::string& setting) {
  std::map<Identity, const std::filesystem::path*> known;
  for (const std::filesystem::path& input : inputs)
    if (const auto identity = identity_of(input)) known.emplace(*identity, &input);
  for (const std::filesystem::path& output : outputs) {
    const auto identity = identity_of(output);
    const auto input = identity ? known.find(*identity) : known.end();
    if (input == known.end()) continue;
    fail("{} {}: is {}, which is read and would be overwritten", setting, output.string(),
         output == *input->second ? "an input" : "the input " + input->second->string());
  }
}

void require_different(std::span<const NamedOutput> outputs) {
  std::map<std::filesystem::path, const NamedOutput*> known;
  for (const NamedOutput& output : outputs) {
    if (output.path.empty()) continue;
    const auto [first, is_new] = known.emplace(output.path, &output);
    if (!is_new)
      fail("{} {}: is also a file of {}", output.setting, output.path.string(),
           first->second->setting);
  }
}

void require_not_an_input(const std::filesystem::path& output,
                          std::span<const std::filesystem::path> inputs,
                          const std::string& setting) {
  if (identity_of(output)) require_no_inputs({&output, 1}, inputs, setting);
}

}  // namespace axial
