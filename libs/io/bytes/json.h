// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and writes JSON texts and files. Only json.cpp calls the parser and the writer of the JSON
// library, because their code takes seconds to compile in each source file that calls them.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace axial::io {

// Reads a JSON file. Error that names the file for a file larger than 256 MiB, malformed JSON, or a
// key that occurs twice in an object.
nlohmann::json read_json(const std::filesystem::path& path);

// Writes `json` indented, with a newline at the end. The file is written completely or not at all.
// Error that names the file for text that is not UTF-8.
void write_json(const std::filesystem::path& path, const nlohmann::json& json);

// Returns the JSON text on one line, for messages.
std::string to_text(const nlohmann::json& json);

// Returns the JSON text on one line if `indent` is negative, otherwise indented by `indent` spaces
// for each level. Bytes that are not UTF-8 are replaced by U+FFFD.
std::string to_text(const nlohmann::ordered_json& json, int indent = -1);

// Parses a text. Returns null if the text is malformed.
nlohmann::ordered_json json_from(std::string_view text);

}  // namespace axial::io
