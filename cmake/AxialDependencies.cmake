# SPDX-License-Identifier: GPL-3.0-or-later
# All external libraries of the project, in the versions of Debian 12.
find_package(Eigen3 REQUIRED)
find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs calib3d aruco mcc video videoio)
find_package(JPEG REQUIRED)  # libjpeg-turbo
find_package(PNG REQUIRED)
find_package(TIFF REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(nanoflann REQUIRED)
find_package(embree 3 REQUIRED)
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)  # used as header-only library
find_package(Boost REQUIRED COMPONENTS program_options)
# With the component SuiteSparse, the package defines the targets of its parts, for example
# SuiteSparse::CHOLMOD.
find_package(Ceres REQUIRED COMPONENTS SuiteSparse)
find_package(GDAL REQUIRED)
find_package(pugixml REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(CGAL REQUIRED)
# CGAL adds -frounding-math to all files of the targets that link it. Here only the files that include
# CGAL get this option (axial_source_options), so that all other files keep the precompiled headers and
# the arithmetic of the rest of the project. GCC takes numbers in CGAL's headers for
# uninitialised that are not.
set_target_properties(CGAL PROPERTIES INTERFACE_COMPILE_OPTIONS "")
set(AXIAL_CGAL_OPTIONS -frounding-math $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
# These packages have no CMake files.
find_path(MAXFLOW_INCLUDE_DIR maxflow.h PATH_SUFFIXES maxflow-3.0 REQUIRED)
find_library(MAXFLOW_LIBRARY maxflow REQUIRED)
add_library(maxflow INTERFACE IMPORTED GLOBAL)
target_include_directories(maxflow SYSTEM INTERFACE ${MAXFLOW_INCLUDE_DIR})
target_link_libraries(maxflow INTERFACE ${MAXFLOW_LIBRARY})
find_package(TinyGLTF REQUIRED)
find_path(STB_INCLUDE_DIR stb/stb_rect_pack.h REQUIRED)  # used as header-only library
if(AXIAL_TESTS)
  # `python3` may be a script that looks for the interpreter, and takes ten times as long as the interpreter.
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  execute_process(COMMAND ${Python3_EXECUTABLE} -c "import sys; print(sys.executable)"
    OUTPUT_VARIABLE AXIAL_INTERPRETER OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  find_package(GTest REQUIRED)
  find_package(rapidcheck REQUIRED)
  include(GoogleTest)
endif()
if(AXIAL_PYTHON)
  # Debian's, unless the user sets another: a Python that stands before it in PATH may lack numpy.
  find_program(Python_EXECUTABLE python3 PATHS /usr/bin NO_DEFAULT_PATH)
  set(PYBIND11_FINDPYTHON ON)
  find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module NumPy)
  find_package(pybind11 REQUIRED)
endif()
if(AXIAL_SCIENCE)
  find_package(benchmark REQUIRED)
endif()
