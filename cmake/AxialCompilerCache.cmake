# SPDX-License-Identifier: GPL-3.0-or-later
# ccache, where it is installed and no other launcher is asked for: what was compiled before is not
# compiled again. It has to be told that precompiled headers are used.
find_program(AXIAL_CCACHE ccache)
mark_as_advanced(AXIAL_CCACHE)
if(AXIAL_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${AXIAL_CCACHE})
  add_compile_options(-fpch-preprocess)
endif()
