// SPDX-License-Identifier: GPL-3.0-or-later
#include "stb_packer.h"

#include <vector>

// The packer is a header of C code, which is compiled here. Its warnings are not ours.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
#define STBRP_STATIC
#define STB_RECT_PACK_IMPLEMENTATION
#include <stb/stb_rect_pack.h>
#pragma GCC diagnostic pop

namespace axial::texture {

void pack_with_stb(cv::Size texture, std::span<StbRect> rects) {
  std::vector<stbrp_node> nodes(static_cast<std::size_t>(texture.width));
  stbrp_context context{};
  stbrp_init_target(&context, texture.width, texture.height, nodes.data(), texture.width);
  std::vector<stbrp_rect> placed(rects.size());
  for (std::size_t i = 0; i < rects.size(); ++i)
    placed[i] = {static_cast<int>(i), rects[i].size.width, rects[i].size.height, 0, 0, 0};
  if (placed.empty()) return;
  stbrp_pack_rects(&context, placed.data(), 1);  // the skyline is flat: the first goes to (0, 0)
  stbrp_pack_rects(&context, placed.data() + 1, static_cast<int>(placed.size()) - 1);
  for (const stbrp_rect& rect : placed)
    if (rect.was_packed)
      rects[static_cast<std::size_t>(rect.id)].corner = cv::Point(rect.x, rect.y);
}

}  // namespace axial::texture
