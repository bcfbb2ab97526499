// SPDX-License-Identifier: GPL-3.0-or-later
// Standard input, output and error, which a program may be started without (">&-").
#pragma once

namespace axial {

// Opens /dev/null in the place of each of them that is closed. The next file that is opened would
// take its number else, and what is meant for the stream would be written into that file. To be
// called before anything opens one.
void open_standard_streams();

}  // namespace axial
