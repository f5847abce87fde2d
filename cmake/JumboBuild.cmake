# SPDX-License-Identifier: Apache-2.0
# contrejour_jumbo(TARGET): compiles several files of the target as one, so that the headers they share are read once.
# This takes two to four times less processor time for a whole build: twelve files at a time, the command line took twice
# as long as it does with all of its files in three batches. Names in unnamed namespaces must differ within a target. Two functions of the same name are often the same function, which then belongs in a header.
#
# Kernels that Highway compiles once for each instruction set include themselves, so each remains a unit of its own.
option(CONTREJOUR_JUMBO "Compile files in batches: builds everything sooner, a changed file later" ON)
set(CONTREJOUR_JUMBO_BATCH 48 CACHE STRING "Files a batch; with fewer, a changed file compiles sooner")

function(contrejour_jumbo target)
  if(NOT CONTREJOUR_JUMBO)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_filename_component(path ${source} ABSOLUTE)
    if(EXISTS ${path})
      file(STRINGS ${path} own_unit REGEX "hwy/foreach_target.h")
      if(own_unit)
        set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      endif()
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${CONTREJOUR_JUMBO_BATCH})
endfunction()
