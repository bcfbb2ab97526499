// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/bytes/json.h"

#include <new>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"

namespace axial::io {
namespace {

using Json = nlohmann::json;

constexpr int kDeepest = 1000;  // copies and texts of values need the stack for each level

// Remembers the keys of every open object. The parser itself silently keeps the last of two values
// with the same key.
class DuplicateKeys {
 public:
  bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
    if (depth > kDeepest) fail("more than {} lists or objects lie inside one another", kDeepest);
    if (event == Json::parse_event_t::object_start) open_.emplace_back();
    if (event == Json::parse_event_t::object_end) open_.pop_back();
    if (event == Json::parse_event_t::key && !open_.back().insert(parsed).second)
      fail("key {} occurs twice", parsed.dump());
    return true;
  }

 private:
  std::vector<std::set<std::string>> open_;
};

}  // namespace

Json read_json(const std::filesystem::path& path) {
  constexpr std::uintmax_t kLargest = 256u << 20;
  return parse_json(read_file(path, kLargest), path.string());
}

Json read_object(const std::filesystem::path& path) {
  try {
    if (Json json = read_json(path); json.is_object()) return json;
  } catch (const Error&) {
    // Missing or damaged.
  }
  return Json::object();
}

Json parse_json(std::string_view text, const std::string& name) {
  try {
    return Json::parse(text, DuplicateKeys());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    fail_in(name, "malformed JSON: {}", error.what());
  }
}

void write_json(const std::filesystem::path& path, const Json& value) {
  // JSON cannot hold names in another encoding than UTF-8 exactly. Fail rather than change them.
  try {
    write_atomically(path, value.dump(2) + "\n");
  } catch (const Json::exception& error) {
    fail_in(path, "cannot be written: {}", error.what());
  }
}

std::string to_text(const Json& value) {
  return value.dump();
}

std::string to_text(const nlohmann::ordered_json& value, int indent) {
  return value.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

nlohmann::ordered_json json_from(std::string_view text) {
  const auto parsed = nlohmann::ordered_json::parse(text, nullptr, false);
  return parsed.is_discarded() ? nlohmann::ordered_json() : parsed;
}

}  // namespace axial::io
