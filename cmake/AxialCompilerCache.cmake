# SPDX-License-Identifier: GPL-3.0-or-later
# Compiles with ccache if it is installed and no other compiler launcher is set. ccache supports
# precompiled headers only with these settings.
find_program(AXIAL_CCACHE ccache)
mark_as_advanced(AXIAL_CCACHE)
if(AXIAL_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${AXIAL_CCACHE})
  add_compile_options(-fpch-preprocess)
endif()
# Clang stores the time in a precompiled header, so that ccache would take it for another one.
if(CMAKE_CXX_COMPILER_LAUNCHER MATCHES ccache AND CMAKE_CXX_COMPILER_ID STREQUAL Clang)
  add_compile_options("SHELL:-Xclang -fno-pch-timestamp")
endif()
