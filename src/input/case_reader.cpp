#include "input/case_reader.hpp"

#include <fstream>
#include <iterator>

#include "input/reader.hpp"

namespace riven {

Case parse_case(std::string_view text, const std::string& file, const std::vector<std::string>& overrides) {
  const Source source(text, file, overrides);
  Case result;
  result.file = file;  // tables stand beside it
  Reader(source, result).read_all();
  return result;
}

Case read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  const Location at{file.string()};
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw InputError(at, "is a directory; expected a case file in TOML");
  if (!std::filesystem::exists(file, ignored))
    throw InputError(at, "no such file; expected a case file in TOML");
  std::ifstream stream(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream) throw InputError(at, "cannot be read; are you allowed to?");
  return parse_case(text, file.string(), overrides);
}

}  // namespace riven
