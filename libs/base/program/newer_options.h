// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace axial {

// Throws an Error that names `option` if it is an option of OpenMVS 2.4 that the program of this
// name does not have, so that users of OpenMVS see that they have not mistyped it. `option`: an
// option that the program does not know, with its dashes ("--fusion-filter", "-t").
void refuse_newer_option(const std::string& program, const std::string& option);

}  // namespace axial
