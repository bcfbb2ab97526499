// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/faces/photograph_source.h"

namespace axial::texture {

ImageSource source_of(const survey::Photographs& photographs) {
  return [&](std::size_t view) {
    survey::Pixels pixels = photographs.read(view, survey::Channels::color);
    return ViewImage{std::move(pixels.color), std::move(pixels.mask)};
  };
}

}  // namespace axial::texture
