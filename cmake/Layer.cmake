# SPDX-License-Identifier: Apache-2.0
# contrejour_layer(NAME SOURCES ... [DEPENDS layers ...] [LINK libraries ...] [PUBLIC_LINK libraries ...])
# One static target a folder, `contrejour_NAME`; `contrejour` gathers all of them into the library users link.
# tools/check_layers.py holds the includes to the same order.
function(contrejour_layer name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;LINK;PUBLIC_LINK" ${ARGN})
  add_library(contrejour_${name} STATIC ${arg_SOURCES})
  target_include_directories(contrejour_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  list(TRANSFORM arg_DEPENDS PREPEND contrejour_)
  target_link_libraries(contrejour_${name} PUBLIC ${arg_DEPENDS} ${arg_PUBLIC_LINK} PRIVATE ${arg_LINK})
  target_compile_definitions(contrejour_${name} PRIVATE CONTREJOUR_BUILDING)
  contrejour_jumbo(contrejour_${name})
  set_property(GLOBAL APPEND PROPERTY CONTREJOUR_LAYERS contrejour_${name})
  set_property(GLOBAL APPEND PROPERTY CONTREJOUR_LINK ${arg_LINK})
  set_property(GLOBAL APPEND PROPERTY CONTREJOUR_PUBLIC_LINK ${arg_PUBLIC_LINK})
endfunction()
