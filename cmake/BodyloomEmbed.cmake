# bodyloom_embed(TARGET SYMBOL FILE)
#   Puts the bytes of FILE into the library, so that the program needs no path to it. The bytes lie between the symbols
#   SYMBOL_begin and SYMBOL_end (extern "C" const unsigned char[]). A changed file rebuilds the object; its checksum is
#   part of the source, so that compiler caches see the change too.
function(bodyloom_embed target symbol file)
  get_filename_component(path ${file} ABSOLUTE)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
  file(SHA256 ${path} checksum)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${symbol}.cc)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
// Generated. Contents: SHA-256 @checksum@
__asm__(
    ".section .rodata\n"
    ".balign 16\n"
    ".globl @symbol@_begin\n"
    "@symbol@_begin:\n"
    ".incbin \"@path@\"\n"
    ".globl @symbol@_end\n"
    "@symbol@_end:\n"
    ".byte 0\n"
    ".previous\n");
]])
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS ${path})
  target_sources(${target} PRIVATE ${source})
endfunction()
