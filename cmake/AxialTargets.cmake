# SPDX-License-Identifier: GPL-3.0-or-later
# Compiler flags, precompiled headers, and the functions add_axial_library(), add_axial_app(),
# add_axial_tests(), add_axial_test() and add_axial_test_support(). With them, the CMakeLists.txt of a
# folder only lists its files and libraries.

add_library(axial_flags INTERFACE)
target_compile_features(axial_flags INTERFACE cxx_std_20)
target_include_directories(axial_flags INTERFACE ${PROJECT_SOURCE_DIR}/libs/public)
target_link_libraries(axial_flags INTERFACE Eigen3::Eigen fmt::fmt opencv_core opencv_imgproc)
target_compile_options(axial_flags INTERFACE
  -Wall -Wextra -Wshadow -Wconversion $<$<BOOL:${AXIAL_WERROR}>:-Werror>
  # No fused multiply-add, so that results do not depend on what the optimiser would fuse; see "Same
  # input, same options" in CONTRIBUTING.md.
  -ffp-contract=off
  # No code reads errno or uses floating-point traps. The results are the same, and square roots
  # need no branch.
  -fno-math-errno -fno-trapping-math)
# The module of the Python package contains the libraries. In position-independent code, functions that
# could be replaced by another library are not inlined, unless the second option forbids this.
if(AXIAL_PYTHON)
  target_compile_options(axial_flags INTERFACE -fPIC -fno-semantic-interposition)
endif()
if(AXIAL_SANITIZE)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "AXIAL_SANITIZE needs clang++ (CMAKE_CXX_COMPILER), for libFuzzer")
  endif()
  # The checks for null pointers and alignment are off, because they would take a quarter of the
  # compile time: AddressSanitizer detects null pointers anyway, and Eigen asserts alignment itself.
  # The check of virtual tables needs type information that libraries of Debian may lack.
  # "fuzzer-no-link" adds the counters of executed code that the fuzz tests need. Warnings are those of
  # the release build: two compilers would not agree on them.
  target_compile_options(axial_flags INTERFACE -fsanitize=fuzzer-no-link,address,undefined
    -fno-sanitize=null,alignment,vptr -fno-sanitize-recover=all -fno-omit-frame-pointer -w)
  target_link_options(axial_flags INTERFACE -fsanitize=address,undefined)
  target_compile_definitions(axial_flags INTERFACE AXIAL_SANITIZED)
endif()

# Precompiled headers: the external headers that most files include are parsed once for all files,
# which saves a third of the compile time. Files still include the headers that they use. Files with
# compile options of their own cannot use precompiled headers; declare them with
# axial_source_options(). Do not add a header whose inline functions instantiate templates, because
# every file would instantiate them again. nlohmann/json.hpp would cost each file 0.4 s, even if
# the file does not use it.
function(add_axial_parsed_headers name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINK" ${ARGN})
  add_library(${name} STATIC ${PROJECT_SOURCE_DIR}/cmake/parsed_headers.cpp)
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()

set(AXIAL_PARSED_HEADERS <Eigen/Core> <Eigen/Geometry> <fmt/format.h>
  <opencv2/core.hpp> <opencv2/imgproc.hpp>
  <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <random> <span> <string> <variant>
  <vector>)
set(AXIAL_PARSED_LIBRARIES Eigen3::Eigen fmt::fmt opencv_core opencv_imgproc)
add_axial_parsed_headers(axial_parsed
  HEADERS ${AXIAL_PARSED_HEADERS} LINK axial_flags ${AXIAL_PARSED_LIBRARIES})

# The linker lld saves two thirds of the link time.
include(CheckLinkerFlag)
check_linker_flag(CXX -fuse-ld=lld AXIAL_HAS_LLD)
if(AXIAL_HAS_LLD)
  target_link_options(axial_flags INTERFACE -fuse-ld=lld)
endif()
# Tests are compiled and linked far more often than they are run. -O1 saves a third of a test's
# compile time. With the sanitizers, -O0 saves two thirds of it. --as-needed drops libraries that a test does not use:
# opencv_imgcodecs alone loads a hundred libraries, which takes 0.15 s at each start.
set(AXIAL_TEST_OPTIMIZATION -O1)
if(AXIAL_SANITIZE)
  set(AXIAL_TEST_OPTIMIZATION -O0)
endif()
add_library(axial_test_flags INTERFACE)
target_link_libraries(axial_test_flags INTERFACE axial_flags)
target_link_options(axial_test_flags INTERFACE -Wl,--as-needed)
if(AXIAL_TESTS)
  add_axial_parsed_headers(axial_parsed_for_tests
    HEADERS ${AXIAL_PARSED_HEADERS} <gmock/gmock.h> <gtest/gtest.h>
    LINK axial_test_flags ${AXIAL_PARSED_LIBRARIES} GTest::gmock)
  target_compile_options(axial_parsed_for_tests PRIVATE ${AXIAL_TEST_OPTIMIZATION})
endif()

# axial_source_options(a.cpp b.cpp OPTIONS -mavx2) adds compile options to single source files,
# which then do not use the precompiled headers.
function(axial_source_options)
  cmake_parse_arguments(ARG "" "" "OPTIONS" ${ARGN})
  foreach(source IN LISTS ARG_UNPARSED_ARGUMENTS)
    set_property(SOURCE ${source} APPEND PROPERTY COMPILE_OPTIONS ${ARG_OPTIONS})
    set_property(SOURCE ${source} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
  endforeach()
endfunction()

# Unity builds: the compiler gets several source files of a target as one. Headers and templates are
# then compiled once for all of them, which halves the compile time. Types and constants in unnamed
# namespaces must differ between the files of a target; functions may be overloads. Files that share
# such names, and files whose speed is measured, are declared in APART and are compiled alone.
# Files with compile options of their own (axial_source_options) are compiled alone, too.
# -DAXIAL_UNITY=OFF compiles every file alone, for an editor and for work on a few files.
option(AXIAL_UNITY "Compile several source files as one" ON)
function(axial_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${AXIAL_UNITY} UNITY_BUILD_BATCH_SIZE 18)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# For files that instantiate the sweep for all cameras. With its default limits of growth for one
# file, the compiler would not even inline Eigen's products in the innermost loop.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(AXIAL_INLINE_ALL --param=inline-unit-growth=400 --param=large-function-growth=1000
    --param=max-inline-insns-single=400)
elseif(NOT AXIAL_SANITIZE)
  set(AXIAL_INLINE_ALL -mllvm -inline-threshold=2000)
endif()

# add_axial_library(io SOURCES ply/ply_read.cpp [APART json.cpp] LINK scene opencv_core) adds libs/io
# as the library axial_io. In LINK, the project's own libraries are written without the prefix
# axial_. Headers in folders private/ of libs/io are for this library alone: they are included as
# "ply/private/ply_header.h", which only its own files find. `scope`: of links to other projects.
function(axial_link target scope)
  foreach(item IN LISTS ARGN)
    if(TARGET axial_${item})
      target_link_libraries(${target} PUBLIC axial_${item})
    elseif(item MATCHES "^(fmt::fmt|Eigen3::Eigen|opencv_core)$")  # public headers include their headers
      target_link_libraries(${target} PUBLIC ${item})
    elseif(item MATCHES "^(nlohmann_json|nanoflann)::")  # headers alone: a user needs no package
      target_link_libraries(${target} ${scope} $<BUILD_INTERFACE:${item}>)
    elseif(TARGET ${item} OR item MATCHES "^opencv_")
      target_link_libraries(${target} ${scope} ${item})
    else()
      message(FATAL_ERROR "${target} links '${item}', which is no target")
    endif()
  endforeach()
endfunction()

function(add_axial_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;APART;LINK" ${ARGN})
  add_library(axial_${name} STATIC ${ARG_SOURCES} ${ARG_APART})
  axial_unity(axial_${name} ${ARG_APART})
  target_include_directories(axial_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/libs>)
  file(GLOB private ${CMAKE_CURRENT_SOURCE_DIR}/private ${CMAKE_CURRENT_SOURCE_DIR}/*/private)
  if(private)
    target_include_directories(axial_${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  endif()
  target_compile_features(axial_${name} PUBLIC cxx_std_20)
  target_link_libraries(axial_${name} PUBLIC $<BUILD_INTERFACE:axial_flags>)
  target_precompile_headers(axial_${name} REUSE_FROM axial_parsed)
  axial_link(axial_${name} PRIVATE ${ARG_LINK})
endfunction()

function(add_axial_app name)
  cmake_parse_arguments(ARG "" "" "SOURCES;APART;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES} ${ARG_APART})
  axial_unity(${name} ${ARG_APART})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/libs)
  target_link_libraries(${name} PRIVATE axial_flags axial_version)
  target_precompile_headers(${name} REUSE_FROM axial_parsed)
  axial_link(${name} PUBLIC ${ARG_LINK})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
endfunction()

# The unit tests of these folders read files and manage memory, so they are built with the
# sanitizers. The unit tests of the other folders are numeric and are built in release.
set(AXIAL_SANITIZED_FOLDERS base lens io scene picture cloud)
# The tests of these folders are compiled like the libraries, because they instantiate cameras: with
# the sanitizers and -O0 they would run four times as long.
set(AXIAL_OPTIMIZED_FOLDERS lens cloud)

# add_axial_test_support(pose_survey SOURCES survey.cpp LINK pose) adds a library for the tests of several
# programs, so that its sources are compiled once. Tests link it by its name.
function(add_axial_test_support name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_library(axial_${name} STATIC EXCLUDE_FROM_ALL ${ARG_SOURCES})
  axial_unity(axial_${name})
  axial_set_up_test(axial_${name})
  axial_link(axial_${name} PUBLIC ${ARG_LINK})
endfunction()

function(axial_set_up_test target)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/libs ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${target} PRIVATE AXIAL_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    AXIAL_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_link_libraries(${target} PRIVATE axial_test_flags ${AXIAL_PARSED_LIBRARIES} GTest::gmock)
  get_filename_component(folder ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  if(folder IN_LIST AXIAL_OPTIMIZED_FOLDERS)
    target_precompile_headers(${target} REUSE_FROM axial_parsed)
  else()
    target_precompile_headers(${target} REUSE_FROM axial_parsed_for_tests)
    target_compile_options(${target} PRIVATE ${AXIAL_TEST_OPTIMIZATION})
  endif()
endfunction()

# add_axial_tests(io TESTS dmap_test ply_test [APART json_test] [SHARDS 4] LINK io)
# adds tests/io/dmap_test.cpp, ... as one program and as the CTest case "io", or with the sanitizers
# "sanitized/io". APART: see "Unity builds" above. SHARDS: GoogleTest divides the tests of a long
# program among this many CTest cases, "io/1of4" to "io/4of4", which CTest runs in parallel. A CTest
# case has many tests, because the start of a program takes longer than most of them.
#
# add_axial_test(io/ply_test LINK io [SOURCES extra.cpp] [PROGRAMS InterfaceCOLMAP] [LABELS unit]
#                [BUILD release] [SHARDS 4 | EACH] [TIMEOUT 900] [PRIVATE_OF io])
# adds tests/io/ply_test.cpp as a program of its own, for a test that needs one of the options. Its
# CTest case is "io/ply_test". EACH: each test is a CTest case, "io/ply_test/Suite.Test", in a process
# of its own, for tests that measure their process. PROGRAMS are the programs that the test runs; they
# are built first. A test of LABELS unit (the default) is built in the build of its folder (see above),
# or in the build that BUILD names (release or sanitized); with AXIAL_EVERY_TEST in both builds.
# Tests with other labels are only built in release. PRIVATE_OF names the library whose private
# headers the test may include.
add_custom_target(axial_tests)
function(add_axial_tests folder)
  cmake_parse_arguments(ARG "" "SHARDS" "TESTS;APART;LINK" ${ARGN})
  axial_builds_test(here ${folder} unit)
  if(NOT here)
    return()
  endif()
  list(TRANSFORM ARG_TESTS APPEND .cpp)
  list(TRANSFORM ARG_APART APPEND .cpp)
  axial_add_test_program(${folder}_tests SOURCES ${ARG_TESTS} ${ARG_APART} LINK ${ARG_LINK})
  axial_unity(${folder}_tests ${ARG_APART})
  axial_add_cases(${folder}_tests ${folder} LABELS unit SHARDS ${ARG_SHARDS})
endfunction()

function(add_axial_test name)
  cmake_parse_arguments(ARG "EACH" "TIMEOUT;BUILD;PRIVATE_OF;SHARDS" "SOURCES;LINK;PROGRAMS;LABELS" ${ARGN})
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  string(REGEX REPLACE "/.*" "" folder ${name})
  axial_builds_test(here ${folder} "${ARG_LABELS}" ${ARG_BUILD})
  if(NOT here)
    return()
  endif()
  string(REPLACE "/" "_" target ${name})
  axial_add_test_program(${target} SOURCES ${PROJECT_SOURCE_DIR}/tests/${name}.cpp ${ARG_SOURCES}
    LINK ${ARG_LINK})
  axial_unity(${target})
  if(ARG_PRIVATE_OF)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/libs/${ARG_PRIVATE_OF})
  endif()
  if(ARG_PROGRAMS)
    add_dependencies(${target} ${ARG_PROGRAMS})
  endif()
  if(ARG_EACH)
    axial_discover_cases(${target} ${name} LABELS ${ARG_LABELS})
  else()
    axial_add_cases(${target} ${name} LABELS ${ARG_LABELS} TIMEOUT ${ARG_TIMEOUT} SHARDS ${ARG_SHARDS})
  endif()
endfunction()

# Sets `result` to true if this build has the tests of `folder` with these labels. The optional
# argument is the build that the test names.
function(axial_builds_test result folder labels)
  set(build release)
  if("unit" IN_LIST labels)
    if(AXIAL_EVERY_TEST)
      set(build both)
    elseif(ARGN)
      set(build ${ARGN})
    elseif(folder IN_LIST AXIAL_SANITIZED_FOLDERS)
      set(build sanitized)
    endif()
  endif()
  if(build STREQUAL "both" OR (AXIAL_SANITIZE AND build STREQUAL "sanitized") OR
     (NOT AXIAL_SANITIZE AND build STREQUAL "release"))
    set(${result} TRUE PARENT_SCOPE)
  else()
    set(${result} FALSE PARENT_SCOPE)
  endif()
endfunction()

function(axial_add_test_program target)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${target} ${ARG_SOURCES})
  axial_set_up_test(${target})
  target_link_libraries(${target} PRIVATE rapidcheck GTest::gtest_main)
  axial_link(${target} PUBLIC ${ARG_LINK})
  add_dependencies(axial_tests ${target})
endfunction()

# The CTest case is `name`, or the cases are "`name`/1ofN" to "`name`/NofN" of N shards.
function(axial_add_cases target name)
  cmake_parse_arguments(ARG "" "TIMEOUT;SHARDS" "LABELS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 900)
  endif()
  if(NOT ARG_SHARDS)
    set(ARG_SHARDS 1)
  endif()
  if(AXIAL_SANITIZE)
    string(PREPEND name "sanitized/")
  endif()
  set(cost 10)
  if(ARG_SHARDS GREATER 1)
    set(cost 50)
  endif()
  foreach(shard RANGE 1 ${ARG_SHARDS})
    set(case ${name})
    if(ARG_SHARDS GREATER 1)
      string(APPEND case /${shard}of${ARG_SHARDS})
    endif()
    math(EXPR index "${shard} - 1")
    add_test(NAME ${case} COMMAND ${target} --gtest_brief=1)
    # CTest starts the tests with the highest cost first; see tests/apps/CMakeLists.txt.
    set_tests_properties(${case} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT} COST ${cost}
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${ARG_SHARDS};GTEST_SHARD_INDEX=${index}")
  endforeach()
endfunction()

# The CTest cases are "`name`/Suite.Test".
function(axial_discover_cases target name)
  cmake_parse_arguments(ARG "" "" "LABELS" ${ARGN})
  if(AXIAL_SANITIZE)
    string(PREPEND name "sanitized/")
  endif()
  # With a sanitizer, on a busy machine, listing the cases can take longer than the default of 5 s.
  gtest_discover_tests(${target} TEST_PREFIX "${name}/" DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 300)
endfunction()
