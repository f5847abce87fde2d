# SPDX-License-Identifier: Apache-2.0
# contrejour_common_headers(): gives every target made so far common_headers.h, compiled once (clang). For builds that
# only tests run, in which reading these headers is half of the work. The release build has to find what it includes.
# Sources of tests are not optimised in such builds: they compile in half the time, and what takes their time is the
# library, which is.
#
# Not target_precompile_headers(): ccache would share nothing between clones, whose compiled headers differ by the names
# of folders. It takes their `.sum` for them where CCACHE_PCH_EXTSUM is set, as ./dev does: what the headers say.
function(contrejour_common_headers)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" configuration)
  contrejour_compile_common_headers(common_headers "")
  contrejour_compile_common_headers(common_headers_of_tests -O0)
  get_property(folders DIRECTORY ${PROJECT_SOURCE_DIR} PROPERTY SUBDIRECTORIES)
  foreach(folder IN LISTS folders)
    if(folder STREQUAL ${PROJECT_SOURCE_DIR}/tests)
      contrejour_give_common_headers(${folder} common_headers_of_tests -O0)
    else()
      contrejour_give_common_headers(${folder} common_headers "")
    endif()
  endforeach()
endfunction()

# A target of this name, which compiles the headers with the flags of all targets and `more`.
function(contrejour_compile_common_headers name more)
  set(header ${PROJECT_SOURCE_DIR}/cmake/common_headers.h)
  set(compiled ${PROJECT_BINARY_DIR}/${name}.pch)
  separate_arguments(flags UNIX_COMMAND "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${configuration}}")
  get_directory_property(options COMPILE_OPTIONS)
  set(compile ${CMAKE_CXX_COMPILER} ${CMAKE_CXX20_STANDARD_COMPILE_OPTION} ${flags} ${options} ${more} -fPIC
              -x c++-header)
  add_custom_command(
    OUTPUT ${compiled} ${compiled}.sum
    COMMAND ${compile} -fpch-instantiate-templates -MD -MT ${compiled} -MF ${compiled}.d -o ${compiled}
            ${header}
    COMMAND ${compile} -E -dD -P -o ${compiled}.text ${header}
    COMMAND ${CMAKE_COMMAND} -E sha256sum ${name}.pch.text > ${compiled}.sum
    DEPENDS ${header} DEPFILE ${compiled}.d
    COMMENT "Compiling common headers" VERBATIM)
  add_custom_target(${name} DEPENDS ${compiled})
endfunction()

# The headers of target `name`, and the flags that they are compiled with, for all targets of a folder.
function(contrejour_give_common_headers folder name more)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    get_target_property(without ${target} DISABLE_PRECOMPILE_HEADERS)
    if(type MATCHES "LIBRARY|EXECUTABLE" AND NOT without)
      # Programs get -fPIC as well, because the headers are compiled once, with it.
      set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
      target_compile_options(${target} PRIVATE ${more} -fPIC "SHELL:-include-pch ${PROJECT_BINARY_DIR}/${name}.pch")
      add_dependencies(${target} ${name})
    endif()
  endforeach()
  get_property(inner DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(subfolder IN LISTS inner)
    contrejour_give_common_headers(${subfolder} ${name} "${more}")
  endforeach()
endfunction()
