// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"

#include "base/message.h"

namespace axial {

void fail_formatted(fmt::string_view format, fmt::format_args arguments) {
  throw Error(as_message(fmt::vformat(format, arguments)));
}

}  // namespace axial
