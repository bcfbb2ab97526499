// SPDX-License-Identifier: GPL-3.0-or-later
// The memory that texturing may use. The functions that say how much a stage needs stand beside the
// stage, in the header of the stage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "axial/base.h"

namespace axial::texture {

class Budget {
 public:
  // Without a limit.
  Budget() = default;
  // `max_bytes`: the limit; 0: none. Errors name the limit by name_of("max_memory").
  Budget(std::uint64_t max_bytes, SettingNames name_of);

  // A copy whose errors add that a larger value of the setting `name_of(setting)` needs less
  // memory.
  Budget less_by(std::string_view setting) const;

  // Error if `bytes` are more than the limit. The message is one line. It tells how many megabytes
  // more `work` needs.
  void require(std::uint64_t bytes, const std::string& work) const;

  // The limit without `fixed` bytes; 0 if `fixed` is larger.
  std::uint64_t room(std::uint64_t fixed) const;

  // What is left if `fixed` bytes are in use. Error as for require() if `fixed` is larger than the
  // limit.
  Budget without(std::uint64_t fixed, const std::string& work) const;

  // How many items, at least 1 and at most `most`, can be in memory at the same time, where each
  // takes `each` bytes, besides `fixed` bytes. Error as for require() if there is no room for one.
  std::size_t items(std::uint64_t fixed, std::uint64_t each, std::size_t most,
                    const std::string& work) const;

 private:
  std::uint64_t limit_ = std::numeric_limits<std::uint64_t>::max();
  SettingNames name_of_ = own_name;
  std::string advice_;  // the end of the errors
};

}  // namespace axial::texture
