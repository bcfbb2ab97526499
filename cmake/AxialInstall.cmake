# SPDX-License-Identifier: GPL-3.0-or-later
# cmake --install: programs, their man pages and documents (component "programs"); libraries, the public
# headers (libs/public and refractive) and the CMake package AxialMVS (component "development"); the Python package
# (component "python", python/CMakeLists.txt). cpack -G DEB makes packages (AxialPackages.cmake).
include(GNUInstallDirs)
set(doc_dir ${CMAKE_INSTALL_DATAROOTDIR}/doc/axialmvs)
include(CMakePackageConfigHelpers)

# Programs.
install(TARGETS ${AXIAL_PROGRAMS} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
foreach(script reconstruct colmap-model)
  install(PROGRAMS apps/pipeline/${script} DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs RENAME axial-${script})
endforeach()
# The package of these scripts, which they look for in this folder of the prefix.
install(DIRECTORY apps/pipeline/axial_pipeline DESTINATION share/axialmvs COMPONENT programs
  FILES_MATCHING PATTERN "*.py" PATTERN __pycache__ EXCLUDE)
install(FILES apps/pipeline/Snakefile DESTINATION share/axialmvs COMPONENT programs)
install(DIRECTORY apps/pipeline/profiles DESTINATION share/axialmvs COMPONENT programs)
install(FILES README.md LICENSE CHANGELOG.md DESTINATION ${doc_dir} COMPONENT programs)
install(DIRECTORY docs DESTINATION ${doc_dir} COMPONENT programs
  PATTERN "*.py" EXCLUDE PATTERN __pycache__ EXCLUDE PATTERN paper EXCLUDE)

# Man pages, from --help.
find_program(AXIAL_HELP2MAN help2man)
find_program(AXIAL_GZIP gzip)
find_program(AXIAL_SCRIPT_PYTHON python3)
mark_as_advanced(AXIAL_HELP2MAN AXIAL_GZIP AXIAL_SCRIPT_PYTHON)
set(pages)
# axial_add_page(NAME PROGRAM DEPENDENCIES OPTIONS...): the compressed man page of the program in section 1.
function(axial_add_page name program dependencies)
  set(page ${PROJECT_BINARY_DIR}/man/${name}.1)
  add_custom_command(OUTPUT ${page}.gz DEPENDS ${dependencies}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/man
    COMMAND ${AXIAL_HELP2MAN} --no-info --manual AxialMVS
      --name "program of AxialMVS, dense 3D reconstruction under water and in air" ${ARGN} --output ${page} ${program}
    COMMAND ${AXIAL_GZIP} -9nf ${page}
    COMMENT "Writing the man page of ${name}" VERBATIM)
  set(pages ${pages} ${page}.gz PARENT_SCOPE)
endfunction()
if(AXIAL_HELP2MAN AND AXIAL_GZIP AND AXIAL_SCRIPT_PYTHON AND NOT AXIAL_SANITIZE)
  foreach(program IN LISTS AXIAL_PROGRAMS)
    axial_add_page(${program} $<TARGET_FILE:${program}> ${program})
  endforeach()
  # The scripts print their names as they are called.
  file(GLOB modules CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/apps/pipeline/axial_pipeline/*.py)
  set(links ${PROJECT_BINARY_DIR}/scripts)
  file(MAKE_DIRECTORY ${links})
  foreach(script reconstruct colmap-model)
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/apps/pipeline/${script} ${links}/axial-${script} SYMBOLIC)
    axial_add_page(axial-${script} ${links}/axial-${script}
      "${PROJECT_SOURCE_DIR}/apps/pipeline/${script};${modules}" --version-string ${PROJECT_VERSION})
  endforeach()
  add_custom_target(man ALL DEPENDS ${pages})
  install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT programs)
endif()

# Libraries. A component of the package is a library with a public header of its name. Other libraries are
# installed if a component links them. AXIAL_PACKAGES_<component>: the packages that its link needs.
set(include_dir ${CMAKE_INSTALL_INCLUDEDIR}/axialmvs)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/AxialMVS)

# Adds the library and all that it links to `libraries`, and the packages of other targets to `packages`.
set(package_of_SQLite SQLite3)
set(package_of_Boost "Boost COMPONENTS program_options")
set(package_of_Ceres "Ceres COMPONENTS SuiteSparse")
set(package_of_SuiteSparse "${package_of_Ceres}")
set(package_of_embree "embree 3")
macro(axial_add_links_of library)
  list(APPEND libraries ${library})
  get_target_property(links axial_${library} INTERFACE_LINK_LIBRARIES)
  foreach(link IN LISTS links)
    string(REGEX REPLACE "^[$]<LINK_ONLY:(.*)>$" "\\1" link "${link}")
    if(link MATCHES "^axial_(.*)$")
      if(NOT CMAKE_MATCH_1 IN_LIST libraries)
        axial_add_links_of(${CMAKE_MATCH_1})
      endif()
    elseif(link MATCHES "^opencv_(.*)$")
      list(APPEND opencv ${CMAKE_MATCH_1})
    elseif(link MATCHES "^([A-Za-z0-9_-]+)(::|$)")
      set(package ${CMAKE_MATCH_1})
      if(package_of_${package})
        set(package "${package_of_${package}}")
      endif()
      list(APPEND packages "${package}")
    endif()
  endforeach()
endmacro()

foreach(library IN LISTS AXIAL_LIBRARIES)
  if(library STREQUAL "refractive" OR EXISTS ${PROJECT_SOURCE_DIR}/libs/public/axial/${library}.h)
    set(libraries)
    set(packages)
    set(opencv)
    axial_add_links_of(${library})
    if(opencv)
      list(REMOVE_DUPLICATES opencv)
      list(JOIN opencv " " opencv)
      list(APPEND packages "OpenCV COMPONENTS ${opencv}")
    endif()
    list(REMOVE_DUPLICATES packages)
    string(APPEND component_packages "set(AxialMVS_${library}_packages \"${packages}\")\n")
    list(APPEND components ${library})
    list(APPEND installed ${libraries})
  endif()
endforeach()
list(REMOVE_DUPLICATES installed)
foreach(library IN LISTS installed)
  set_target_properties(axial_${library} PROPERTIES EXPORT_NAME ${library})
  target_include_directories(axial_${library} INTERFACE $<INSTALL_INTERFACE:${include_dir}>)
  install(TARGETS axial_${library} EXPORT AxialMVSTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
endforeach()
foreach(headers refractive libs/public/axial)
  install(DIRECTORY ${headers} DESTINATION ${include_dir} COMPONENT development
    FILES_MATCHING PATTERN "*.h" PATTERN LICENSE)
endforeach()
install(EXPORT AxialMVSTargets NAMESPACE Axial:: DESTINATION ${package_dir} COMPONENT development)
configure_package_config_file(cmake/AxialMVSConfig.cmake.in ${PROJECT_BINARY_DIR}/AxialMVSConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/AxialMVSConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/AxialMVSConfig.cmake ${PROJECT_BINARY_DIR}/AxialMVSConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT development)

include(AxialPackages)
