// SPDX-License-Identifier: GPL-3.0-or-later
#include "textured/private/file_names.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/base64.h"
#include "base/error.h"
#include "base/file_extension.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// The only entry of a folder with this name in any case.
std::optional<fs::path> entry_in_any_case(const fs::path& folder, const std::string& name) {
  std::optional<fs::path> found;
  std::error_code error;
  const std::string wanted = lower_case(name);
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end;
       !error && entry != end; entry.increment(error)) {
    const fs::path entry_name = entry->path().filename();
    if (lower_case(entry_name.string()) != wanted) continue;
    if (found) return {};
    found = folder / entry_name;
  }
  return found;
}

std::optional<fs::path> file_in_any_case(fs::path folder, const fs::path& name) {
  if (name.is_absolute()) return {};
  for (const fs::path& part : name) {
    std::error_code ignored;
    if (fs::exists(folder / part, ignored)) {
      folder /= part;
      continue;
    }
    const auto entry = entry_in_any_case(folder, part.string());
    if (!entry) return {};
    folder = *entry;
  }
  if (!is_file(folder)) return {};
  return folder;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

std::string without_escapes(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    if (low >= 0) i += 2;
    result += low >= 0 ? static_cast<char>(16 * high + low) : text[i];
  }
  return result;
}

}  // namespace

std::optional<fs::path> file_beside(const fs::path& folder, const std::string& name) {
  if (name.empty() || name.find('\0') != std::string::npos) return {};
  if (is_file(folder / name)) return folder / name;
  std::string with_slashes = name;
  std::ranges::replace(with_slashes, '\\', '/');
  if (is_file(folder / with_slashes)) return folder / with_slashes;
  if (const auto found = file_in_any_case(folder, with_slashes)) return found;
  return file_in_any_case(folder, fs::path(with_slashes).filename());
}

fs::path path_beside(const fs::path& folder, const std::string& name) {
  return file_beside(folder, name).value_or(folder / name);
}

fs::path file_of_uri(const fs::path& folder, const std::string& uri) {
  if (const auto found = file_beside(folder, without_escapes(uri))) return *found;
  if (const auto found = file_beside(folder, uri)) return *found;
  return folder / without_escapes(uri);
}

std::string bytes_of_data_uri(const std::string& uri, const std::string& owner) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos) fail("{} has a data URI without a comma", owner);
  const bool is_base64 = std::string_view(uri).substr(0, comma).ends_with(";base64");
  const std::string_view data = std::string_view(uri).substr(comma + 1);
  if (!is_base64 || data.find('%') != std::string_view::npos) {
    std::string bytes = without_escapes(data);
    return is_base64 ? base64_decoded(bytes, owner) : bytes;
  }
  return base64_decoded(data, owner);
}

}  // namespace axial::io
