// SPDX-License-Identifier: GPL-3.0-or-later
#include "option_names.h"

#include "base/setting_names.h"

namespace axial::apps {
namespace {

constexpr SettingName kOptions[] = {{"allow_missing", "--allow-missing"},
                                    {"bit_depth", "--bit-depth"},
                                    {"camera is flat_port", "--camera-model is flatport"},
                                    {"fusion.min_views", "--number-views-fuse"},
                                    {"fusion_tiles", "--fusion-tiles"},
                                    {"housing", "--housing"},
                                    {"ignore_mask_label", "--ignore-mask-label"},
                                    {"make_maps false", "--fusion-mode -1"},
                                    {"mask_folder", "--mask-path"},
                                    {"max_memory", "--max-memory"},
                                    {"neighbour_lists_output", "--output-view-neighbors-file"},
                                    {"output", "--output-file"},
                                    {"overwrite_dmaps true", "--overwrite-dmaps 1"},
                                    {"pinhole_export", "--pinhole-export"},
                                    {"plan", "--plan"},
                                    {"refractive", "--refractive"},
                                    {"report", "--report-file"},
                                    {"tile", "--tile"},
                                    {"until", "--until"},
                                    {"working_folder", "--working-folder"}};

}  // namespace

std::string option_of(std::string_view setting) {
  return name_in(kOptions, setting);
}

}  // namespace axial::apps
