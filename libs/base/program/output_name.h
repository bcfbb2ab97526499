// SPDX-License-Identifier: GPL-3.0-or-later
// The names of output files: one rule for all programs. A known extension of a name is replaced by
// the extension of the file that is written. Every other dot belongs to the name: the outputs
// "reef.2024" and "reef.2025" are different files. Exception: the output of MapSurface,
// CompareSurveys, MeasureSurface and ProjectLabels is the begin of the names, and none of these
// extensions is replaced.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/program/parsed_options.h"

namespace axial {

// Returns the extension of `path` in lower case if it is known: .mvs, .ply, .obj, .glb or .gltf, in
// upper or lower case. Returns an empty text for every other path.
std::string known_extension(const std::filesystem::path& path);

// Returns `path` without its extension if the extension is known, otherwise `path` itself.
std::filesystem::path without_known_extension(std::filesystem::path path);

// Returns `path` with `extension` (".housing.json"), which replaces a known extension and is
// appended to every other path.
std::filesystem::path with_extension(const std::filesystem::path& path, std::string_view extension);

// Throws an Error that names `option` and `path` if `path` contains a control character, for
// example a line break. Such a name cannot be written into the header of a PLY or into an MTL
// file, so that the result could not be read again.
void refuse_control_characters(const std::filesystem::path& path, const std::string& option);

// Throws an Error if `path` has the extension of a format of clouds or meshes that the programs do
// not write (.stl and others), or that only TransformScene writes (.las): the user expects this
// format. `option`: as above.
void refuse_other_format(const std::filesystem::path& path, const std::string& option);

// Returns in_working_folder() for a file to write, the value of `option` ("--output-file"). Throws
// an Error that names both if `path` ends in a slash, "." or "..", and so has no name for the file.
std::filesystem::path output_in_working_folder(const CommonOptions& common, const std::string& path,
                                               const std::string& option);

// Returns `given`, the path of an output that parse_options() took from the value of `option`, or
// `otherwise` if `given` is empty. Throws an Error if `otherwise` contains control characters.
std::filesystem::path output_or(const std::filesystem::path& given,
                                const std::filesystem::path& otherwise, const std::string& option);

// Returns in_working_folder() for a folder to write, the value of `option`. An empty path stays
// empty. Throws the Error of refuse_control_characters().
std::filesystem::path folder_in_working_folder(const CommonOptions& common, const std::string& path,
                                               const std::string& option);

}  // namespace axial
