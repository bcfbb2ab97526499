// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/control: a reader for each format. `text` is the content of `file`. Each throws
// the Errors of read_control().
#pragma once

#include <filesystem>
#include <string>

#include "control/control.h"
#include "control/control_reading.h"

namespace axial::control {

Control read_json_control(const std::string& text, const std::filesystem::path& file,
                          const ControlReading& options);
Control read_gcp_list(const std::string& text, const std::filesystem::path& file,
                      const ControlReading& options);
Control read_markers_xml(const std::string& text, const std::filesystem::path& file,
                         const ControlReading& options);
// Tables with and without a header.
Control read_table(const std::string& text, const std::filesystem::path& file,
                   const ControlReading& options);

// Whether the first line that is no comment states a system and the second is an observation.
bool is_gcp_list(const std::string& text);

}  // namespace axial::control
