#pragma once

#include <string_view>
#include <vector>

namespace riven::app {

/// A file of `src/app/starters`, held by the program so that an installed one needs no sources. KIND.toml is
/// the case that `riven new --kind KIND` writes; its first line is a comment that says what it is.
/// KIND.NAME is a file that stands beside it, as NAME.
struct StarterFile {
  std::string_view name;
  std::string_view text;
};

/// All of them; `cmake/embed.cmake` writes this function.
const std::vector<StarterFile>& starter_files();

}  // namespace riven::app
