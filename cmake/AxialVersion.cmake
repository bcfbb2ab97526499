# SPDX-License-Identifier: GPL-3.0-or-later
# axial_version: the version of the programs (libs/base/version.h).
set(AXIAL_INSTRUCTION_SETS "SSE2, AVX2, AVX-512")
if(AXIAL_SANITIZE)
  set(AXIAL_INSTRUCTION_SETS "SSE2")
endif()
set(header ${PROJECT_BINARY_DIR}/version/axial_commit.h)
# Runs at every build, because a commit changes no file that CMake watches. The header is rewritten only
# if its text changes.
add_custom_target(axial_commit BYPRODUCTS ${header}
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DHEADER=${header}
    -P ${PROJECT_SOURCE_DIR}/cmake/write_commit.cmake)
add_library(axial_version STATIC ${PROJECT_SOURCE_DIR}/libs/base/version.cpp)
add_dependencies(axial_version axial_commit)
target_include_directories(axial_version PUBLIC ${PROJECT_SOURCE_DIR}/libs PRIVATE ${PROJECT_BINARY_DIR}/version)
target_compile_definitions(axial_version PRIVATE AXIAL_VERSION="${PROJECT_VERSION}"
  AXIAL_INSTRUCTION_SETS="${AXIAL_INSTRUCTION_SETS}")
target_link_libraries(axial_version PRIVATE axial_flags fmt::fmt)
