# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DSOURCE_DIR=DIR -DHEADER=FILE -P write_commit.cmake
# Defines AXIAL_COMMIT in FILE: the commit that last changed the sources of the programs. Commits to
# documents and tests leave it as it is, and with it the bytes of the programs.
set(sources CMakeLists.txt cmake apps libs refractive)
set(commit unknown)
find_program(git git)
if(git)
  execute_process(COMMAND ${git} log -1 --format=%h --abbrev=7 -- ${sources} WORKING_DIRECTORY ${SOURCE_DIR}
    OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed AND found)
    set(commit ${found})
    execute_process(COMMAND ${git} diff --quiet HEAD -- ${sources} WORKING_DIRECTORY ${SOURCE_DIR}
      ERROR_QUIET RESULT_VARIABLE changed)
    if(changed)
      string(APPEND commit "+")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define AXIAL_COMMIT \"${commit}\"\n")
