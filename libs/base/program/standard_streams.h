// SPDX-License-Identifier: GPL-3.0-or-later
// Standard input, output and error. A program may be started with closed streams (">&-").
#pragma once

namespace axial {

// Opens /dev/null for each closed standard stream. Otherwise the next opened file would get the
// stream's descriptor, and output to the stream would be written into that file. Call this function
// before any file is opened.
void open_standard_streams();

}  // namespace axial
