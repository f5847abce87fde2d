# SPDX-License-Identifier: Apache-2.0
# Installs the library, its headers, and the package `contrejour::contrejour` for find_package. Programs are
# installed where they are made, in apps/.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/contrejour)

set(libraries contrejour)
if(TARGET contrejour_shared)
  list(APPEND libraries contrejour_shared contrejour_c)
endif()
install(TARGETS ${libraries} EXPORT contrejour-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES include/contrejour.h include/contrejour_optics.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY include/contrejour DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT contrejour-targets NAMESPACE contrejour:: DESTINATION ${package_dir})
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The library is static, so whoever links it links what it uses: the config file finds every library that a layer
# names (`LINK` and `PUBLIC_LINK` of contrejour_layer). A target's package is its namespace but for these.
set(package_of_tl tl-expected)
set(without_namespace yaml-cpp)
get_property(linked GLOBAL PROPERTY CONTREJOUR_LINK)
get_property(linked_publicly GLOBAL PROPERTY CONTREJOUR_PUBLIC_LINK)
set(CONTREJOUR_FIND_DEPENDENCIES "")
foreach(target IN LISTS linked linked_publicly)
  if(target IN_LIST without_namespace)
    list(APPEND packages ${target})
    continue()
  endif()
  if(NOT target MATCHES "^([^:]+)::")
    message(FATAL_ERROR "${target}: a layer links imported targets only (package::target), so that the package can find them")
  endif()
  set(package ${CMAKE_MATCH_1})
  if(DEFINED package_of_${package})
    set(package ${package_of_${package}})
  endif()
  list(APPEND packages ${package})
endforeach()
list(REMOVE_DUPLICATES packages)
list(SORT packages)
foreach(package IN LISTS packages)
  string(APPEND CONTREJOUR_FIND_DEPENDENCIES "find_dependency(${package})\n")
endforeach()

configure_package_config_file(cmake/contrejour-config.cmake.in ${CMAKE_BINARY_DIR}/contrejour-config.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/contrejour-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/contrejour-config.cmake ${CMAKE_BINARY_DIR}/contrejour-config-version.cmake
        DESTINATION ${package_dir})

# pkg-config's file for programs in C (and in C++) that link the shared library. It finds the prefix from its own place,
# so that the package may be moved.
if(TARGET contrejour_shared)
  set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
  file(RELATIVE_PATH CONTREJOUR_PC_TO_PREFIX /${pkgconfig_dir} /)
  configure_file(cmake/contrejour.pc.in ${CMAKE_BINARY_DIR}/contrejour.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/contrejour.pc DESTINATION ${pkgconfig_dir})
endif()
