// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"

namespace axial {

void fail_formatted(fmt::string_view format, fmt::format_args arguments) {
  throw Error(fmt::vformat(format, arguments));
}

}  // namespace axial
