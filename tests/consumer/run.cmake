# SPDX-License-Identifier: Apache-2.0
# cmake -DBUILD=... -DSOURCE=... -DWORK=... -DCOMPILER=... -P run.cmake
# Installs the build, moves what was installed (a package must not remember where it was made), builds the consumer
# against it and runs it.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/made)
file(RENAME ${WORK}/made ${WORK}/moved)
run(${CMAKE_COMMAND} -G Ninja -S ${SOURCE} -B ${WORK}/build -DCMAKE_PREFIX_PATH=${WORK}/moved
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)
run(${WORK}/build/consumer_of_shared)
set(in_c cooke-triplet ${WORK}/flare.pfm size=48x32 fnumber=8)
run(${WORK}/build/consumer_in_c ${in_c})

# A program in C that is built without CMake.
find_program(PKG_CONFIG NAMES pkgconf pkg-config)
file(GLOB_RECURSE pc_file ${WORK}/moved/*/contrejour.pc)
if(NOT pc_file)
  message(FATAL_ERROR "no contrejour.pc was installed")
endif()
if(PKG_CONFIG)
  execute_process(COMMAND ${PKG_CONFIG} --cflags --libs ${pc_file} OUTPUT_VARIABLE flags
                  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  run(cc -std=c99 -Wall -Wextra -pedantic -Werror ${SOURCE}/../../examples/c/flare.c -o ${WORK}/in_c ${flags})
  cmake_path(GET pc_file PARENT_PATH library_dir)
  cmake_path(GET library_dir PARENT_PATH library_dir)
  run(${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${library_dir} ${WORK}/in_c ${in_c})
endif()

# The shared library exports the public headers' functions and classes, and none of its own internals.
find_program(NM NAMES nm llvm-nm REQUIRED)
file(GLOB_RECURSE shared_libraries ${WORK}/moved/*/libcontrejour.so)
list(LENGTH shared_libraries count)
if(NOT count EQUAL 1)
  message(FATAL_ERROR "one shared library was to be installed: ${shared_libraries}")
endif()
execute_process(COMMAND ${NM} -DC --defined-only ${shared_libraries} OUTPUT_VARIABLE exported COMMAND_ERROR_IS_FATAL ANY)
if(NOT exported MATCHES " T contrejour::render\\(")
  message(FATAL_ERROR "contrejour::render() is not exported")
endif()
if(exported MATCHES " [TBDRV] (contrejour::internal::[^\n]*)")
  message(FATAL_ERROR "an internal name is exported: ${CMAKE_MATCH_1}")
endif()

# No layer of ours, no path of the source or build folder may leak into the package.
file(GLOB_RECURSE package_files ${WORK}/moved/*/cmake/contrejour/*.cmake)
if(NOT package_files)
  message(FATAL_ERROR "no package files were installed")
endif()
foreach(file IN LISTS package_files)
  file(READ ${file} text)
  string(REPLACE "contrejour_shared" "" text "${text}")  # public as well
  if(text MATCHES "contrejour_[a-z]")
    message(FATAL_ERROR "${file} names ${CMAKE_MATCH_0}: an internal target")
  endif()
  foreach(path ${BUILD} ${WORK}/made)
    string(FIND "${text}" "${path}" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${file} holds the path ${path}")
    endif()
  endforeach()
endforeach()

run(${WORK}/moved/bin/contrejour --help)
