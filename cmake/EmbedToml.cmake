# contrejour_embed_toml(OUT FOLDER): a file of { "stem", "text" } rows of every FOLDER/*.toml, made anew when one changes;
# OUT becomes its path, in the current binary folder. For `#include` within an array.
set(CONTREJOUR_EMBED_TOML ${CMAKE_CURRENT_LIST_DIR}/embed_toml.cmake)

function(contrejour_embed_toml out folder)
  file(GLOB files CONFIGURE_DEPENDS ${folder}/*.toml)
  get_filename_component(name ${folder} NAME)
  set(rows ${CMAKE_CURRENT_BINARY_DIR}/bundled_${name}.inc)
  add_custom_command(
    OUTPUT ${rows}
    COMMAND ${CMAKE_COMMAND} -DOUT=${rows} -DFOLDER=${folder} -P ${CONTREJOUR_EMBED_TOML}
    DEPENDS ${files} ${CONTREJOUR_EMBED_TOML}
    COMMENT "Embedding ${folder}"
    VERBATIM)
  set(${out} ${rows} PARENT_SCOPE)
endfunction()
