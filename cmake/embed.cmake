# riven_embed(SOURCE FILES...): writes the C++ file SOURCE, which holds the files for `base/embedded.hpp`. The assembler
# takes them in as they are: no limit on their length, and no time to compile.
function(riven_embed source)
  set(blocks "")
  set(names "")
  set(entries "")
  set(number 0)
  foreach(file IN LISTS ARGN)
    cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE path)
    set(name riven_embedded_${number})
    string(APPEND blocks "${name}:\n  .incbin \"${file}\"\n${name}_end:\n")
    string(APPEND names "extern const char ${name}[], ${name}_end[];\n")
    string(APPEND entries "    {\"${path}\", {${name}, static_cast<std::size_t>(${name}_end - ${name})}},\n")
    math(EXPR number "${number} + 1")
  endforeach()
  file(CONFIGURE OUTPUT ${source} CONTENT "// Written by cmake/embed.cmake.
#include \"base/embedded.hpp\"

#include <cstddef>

asm(R\"(.pushsection .rodata
@blocks@.popsection)\");

extern \"C\" {
@names@}

namespace riven {

std::span<const EmbeddedFile> embedded_files() {
  static const EmbeddedFile files[] = {
@entries@  };
  return files;
}

}  // namespace riven
" @ONLY)
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS "${ARGN}")
endfunction()
