// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/memory.h"

#include <algorithm>

#include "base/error.h"

namespace axial::texture {

Budget::Budget(std::uint64_t max_bytes, SettingNames name_of) : name_of_(name_of) {
  if (max_bytes > 0) limit_ = max_bytes;
}

Budget Budget::less_by(std::string_view setting) const {
  Budget copy = *this;
  copy.advice_ = "; a larger " + name_of_(setting) + " needs less memory";
  return copy;
}

void Budget::require(std::uint64_t bytes, const std::string& work) const {
  if (bytes > limit_)
    fail("{}: {} needs {} MB more{}", name_of_("max_memory"), work,
         (bytes - limit_) / 1'000'000 + 1, advice_);
}

std::uint64_t Budget::room(std::uint64_t fixed) const {
  return limit_ > fixed ? limit_ - fixed : 0;
}

Budget Budget::without(std::uint64_t fixed, const std::string& work) const {
  require(fixed, work);
  Budget rest = *this;
  if (limit_ != std::numeric_limits<std::uint64_t>::max()) rest.limit_ -= fixed;
  return rest;
}

std::size_t Budget::items(std::uint64_t fixed, std::uint64_t each, std::size_t most,
                          const std::string& work) const {
  require(fixed + each, work);
  const std::uint64_t fit = room(fixed) / std::max<std::uint64_t>(each, 1);
  return static_cast<std::size_t>(
      std::clamp<std::uint64_t>(fit, 1, std::max<std::size_t>(most, 1)));
}

}  // namespace axial::texture
