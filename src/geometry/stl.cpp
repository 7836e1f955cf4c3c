#include "geometry/stl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.hpp"
#include "geometry/file_cursor.hpp"

namespace riven {
namespace {

constexpr std::size_t kHeader = 80, kTriangle = 50;  // bytes of a binary file

/// Joins corners that are at one place.
class TriangleJoiner {
 public:
  void add(const std::array<Point, 3>& corners) {
    std::array<std::uint32_t, 3> number{};
    for (std::size_t n = 0; n < 3; ++n) {
      const auto [place, is_new] =
          number_.emplace(corners[n], static_cast<std::uint32_t>(joined_.corner.size()));
      if (is_new) joined_.corner.push_back(corners[n]);
      number[n] = place->second;
    }
    if (number[0] != number[1] && number[1] != number[2] && number[2] != number[0])
      joined_.triangle.push_back(number);
  }
  Triangles take() { return std::move(joined_); }

 private:
  Triangles joined_;
  std::map<Point, std::uint32_t> number_;
};

Triangles read_binary(FileCursor& in, std::size_t count) {
  in.set_binary();
  in.skip_bytes(kHeader + sizeof(std::uint32_t));
  TriangleJoiner joiner;
  for (std::size_t n = 0; n < count; ++n) {
    in.skip_bytes(3 * sizeof(float));  // its normal
    std::array<Point, 3> corners{};
    for (Point& corner : corners)
      for (double& x : corner)
        x = in.single("a coordinate of a corner") + 0.0;  // no -0, which is another place
    in.skip_bytes(sizeof(std::uint16_t));
    joiner.add(corners);
  }
  return joiner.take();
}

/// A word in small letters, as some programs write large ones.
std::string small_word(FileCursor& in) {
  std::string word(in.word());
  for (char& c : word)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return word;
}

void expect(FileCursor& in, const char* expected) {
  if (const std::string found = small_word(in); found != expected)
    in.fail(fmt::format("found {}; expected {}", FileCursor::described(found), expected));
}

Triangles read_ascii(FileCursor& in) {
  TriangleJoiner joiner;
  do {
    expect(in, "solid");
    in.skip_line();
    std::string word = small_word(in);
    for (; word == "facet"; word = small_word(in)) {
      in.skip_line();  // its normal
      expect(in, "outer");
      expect(in, "loop");
      std::array<Point, 3> corners{};
      for (Point& corner : corners) {
        expect(in, "vertex");
        for (double& x : corner) x = in.real("a coordinate of a corner") + 0.0;
      }
      expect(in, "endloop");
      expect(in, "endfacet");
      joiner.add(corners);
    }
    if (word != "endsolid")
      in.fail(fmt::format("found {}; expected facet or endsolid", FileCursor::described(word)));
    in.skip_line();
  } while (!in.at_end());
  return joiner.take();
}

}  // namespace

Triangles read_stl(const std::filesystem::path& file) {
  FileCursor in(file);
  // A binary file may begin with the word "solid", too: only its size tells.
  const std::uint32_t count = in.peek<std::uint32_t>(kHeader);
  const std::size_t whole = kHeader + sizeof count + kTriangle * count;
  if (in.size() >= kHeader + sizeof count && in.size() == whole) return read_binary(in, count);
  if (in.starts_with("solid") || in.starts_with("SOLID")) return read_ascii(in);
  throw InputError(Location{in.file()}, fmt::format("found {} bytes that do not begin with \"solid\"; "
                                                    "expected an STL file, which as a binary one of {} "
                                                    "triangles would have {} bytes; is it cut short?",
                                                    in.size(), count, whole));
}

}  // namespace riven
