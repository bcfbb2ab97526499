// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and writes JSON texts and files. Only json.cpp calls the parser and the writer of the JSON
// library, because their code takes seconds to compile in each source file that calls them.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace axial::io {

// Reads a JSON file. Throws an Error that names the file if it cannot be read, is larger than 256
// MiB, contains malformed JSON, or contains a key twice in one object.
nlohmann::json read_json(const std::filesystem::path& path);

// Returns the JSON object in a file. Returns an object without entries if there is no such file, or
// if its content is not an object: for files that a later run can do without.
nlohmann::json read_object(const std::filesystem::path& path);

// Parses a JSON text that is a part of the file `name`. Throws an Error that begins with `name` for
// malformed JSON, more than 1,000 lists or objects inside one another, or a key that an object
// contains twice.
nlohmann::json parse_json(std::string_view text, const std::string& name);

// Writes `json` indented, with a newline at the end. The file is written completely or not at all.
// Throws an Error that names the file if it cannot be written, or if a text in `json` is not UTF-8.
void write_json(const std::filesystem::path& path, const nlohmann::json& json);

// Returns the JSON text on one line, for messages. Precondition: all texts in `json` are UTF-8,
// because otherwise the JSON library throws its own exception.
std::string to_text(const nlohmann::json& json);

// Returns the JSON text on one line if `indent` is negative, otherwise indented by `indent` spaces
// for each level. Bytes that are not UTF-8 are replaced by U+FFFD.
std::string to_text(const nlohmann::ordered_json& json, int indent = -1);

// Parses a text. Returns null if the text is malformed. Of a key that occurs twice in an object,
// the last value is taken.
nlohmann::ordered_json json_from(std::string_view text);

}  // namespace axial::io
