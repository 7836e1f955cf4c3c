# Writes a C++ source that holds the starters of `riven new`: cmake -D FOLDER=... -D OUTPUT=... -P embed.cmake
file(GLOB files ${FOLDER}/*)
set(entries "")
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND entries "    {\"${name}\", R\"riven(${text})riven\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Written by cmake/embed.cmake from ${FOLDER}.
#include \"app/starters.hpp\"

namespace riven::app {

const std::vector<StarterFile>& starter_files() {
  static const std::vector<StarterFile> files{
${entries}  };
  return files;
}

}  // namespace riven::app
")
