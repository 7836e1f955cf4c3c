#pragma once

#include <span>
#include <string_view>

namespace riven {

/// A file of the sources, held by the program so that an installed one needs none.
struct EmbeddedFile {
  std::string_view path;  // in the source tree
  std::string_view text;
};

/// All of them; `cmake/embed.cmake` writes this function.
std::span<const EmbeddedFile> embedded_files();

}  // namespace riven
