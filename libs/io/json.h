// SPDX-License-Identifier: GPL-3.0-or-later
// JSON texts and files. No other file has the JSON library parse or write: its parser and writer
// would be compiled again there, which takes seconds.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace axial::io {

// The file as JSON. Error that names the file for anything else, duplicate keys included.
nlohmann::json read_json(const std::filesystem::path& path);

// One JSON text, indented, with a newline at the end; written whole or not at all. Error that names
// the file for texts that are not UTF-8.
void write_json(const std::filesystem::path& path, const nlohmann::json& json);

// On one line, for messages.
std::string to_text(const nlohmann::json& json);

// On one line, or indented by `indent` spaces a level. Bytes that are not UTF-8 are replaced by
// U+FFFD.
std::string to_text(const nlohmann::ordered_json& json, int indent = -1);

// The text as JSON; null if it is malformed.
nlohmann::ordered_json json_from(std::string_view text);

}  // namespace axial::io
