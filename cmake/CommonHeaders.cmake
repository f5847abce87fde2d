# SPDX-License-Identifier: Apache-2.0
# contrejour_common_headers(): gives every target made so far common_headers.h, compiled once (clang). For builds that
# only tests run, in which reading these headers is half of the work. The release build has to find what it includes.
#
# Not target_precompile_headers(): ccache would share nothing between clones, whose compiled headers differ by the names
# of folders. It takes their `.sum` for them where CCACHE_PCH_EXTSUM is set, as ./dev does: what the headers say.
function(contrejour_common_headers)
  set(header ${PROJECT_SOURCE_DIR}/cmake/common_headers.h)
  set(compiled ${PROJECT_BINARY_DIR}/common_headers.pch)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" configuration)
  separate_arguments(flags UNIX_COMMAND "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${configuration}}")
  get_directory_property(options COMPILE_OPTIONS)
  set(compile ${CMAKE_CXX_COMPILER} ${CMAKE_CXX20_STANDARD_COMPILE_OPTION} ${flags} ${options} -fPIC -x c++-header)
  add_custom_command(
    OUTPUT ${compiled} ${compiled}.sum
    COMMAND ${compile} -fpch-instantiate-templates -MD -MT ${compiled} -MF ${compiled}.d -o ${compiled}
            ${header}
    COMMAND ${compile} -E -dD -P -o ${compiled}.text ${header}
    COMMAND ${CMAKE_COMMAND} -E sha256sum common_headers.pch.text > ${compiled}.sum
    DEPENDS ${header} DEPFILE ${compiled}.d
    COMMENT "Compiling common headers" VERBATIM)
  add_custom_target(common_headers DEPENDS ${compiled})
  contrejour_give_common_headers(${PROJECT_SOURCE_DIR} ${compiled})
endfunction()

function(contrejour_give_common_headers folder compiled)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    get_target_property(without ${target} DISABLE_PRECOMPILE_HEADERS)
    if(type MATCHES "LIBRARY|EXECUTABLE" AND NOT without)
      # Programs get -fPIC as well, because the headers are compiled once, with it.
      set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
      target_compile_options(${target} PRIVATE -fPIC "SHELL:-include-pch ${compiled}")
      add_dependencies(${target} common_headers)
    endif()
  endforeach()
  get_property(inner DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(subfolder IN LISTS inner)
    contrejour_give_common_headers(${subfolder} ${compiled})
  endforeach()
endfunction()
