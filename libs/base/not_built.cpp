// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/not_built.h"

#include <algorithm>

#include "base/error.h"

namespace axial {

void declare_not_built(OptionList& list, std::span<NotBuilt> options) {
  for (NotBuilt& option : options)
    list.add_with_default(option.name, &option.value, "not built yet: accepts only the default");
}

void refuse_not_built(std::span<const NotBuilt> options) {
  for (const NotBuilt& option : options) {
    const std::string full = option.name;
    if (std::ranges::find(option.accepted, option.value) == option.accepted.end())
      fail("--{} {}: not built yet", full.substr(0, full.find(',')), option.value);
  }
}

}  // namespace axial
