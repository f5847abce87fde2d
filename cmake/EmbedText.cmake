# SPDX-License-Identifier: Apache-2.0
# contrejour_embed_text(OUT FOLDER EXTENSION): a file of { "stem", "text" } rows of every FOLDER/*.EXTENSION, made anew
# when one changes; OUT becomes its path, in the current binary folder. For `#include` within an array.
set(CONTREJOUR_EMBED_TEXT ${CMAKE_CURRENT_LIST_DIR}/embed_text.cmake)

function(contrejour_embed_text out folder extension)
  file(GLOB files CONFIGURE_DEPENDS ${folder}/*.${extension})
  get_filename_component(name ${folder} NAME)
  set(rows ${CMAKE_CURRENT_BINARY_DIR}/bundled_${name}.inc)
  add_custom_command(
    OUTPUT ${rows}
    COMMAND ${CMAKE_COMMAND} -DOUT=${rows} -DFOLDER=${folder} -DEXTENSION=${extension} -P ${CONTREJOUR_EMBED_TEXT}
    DEPENDS ${files} ${CONTREJOUR_EMBED_TEXT}
    COMMENT "Embedding ${folder}"
    VERBATIM)
  set(${out} ${rows} PARENT_SCOPE)
endfunction()
