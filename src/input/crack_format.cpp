#include "input/crack_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "geometry/stl.hpp"
#include "geometry/surface.hpp"
#include "input/mesh_format.hpp"

namespace riven {
namespace {

using kind::Place;
using kind::Places;
using kind::Quantities;
using kind::Quantity;
using kind::Table;
using kind::Text;

Format describe_penny(CrackInput& crack) {
  if (!crack.penny) crack.penny.emplace();
  PennyCrack& penny = *crack.penny;
  const auto normal = std::make_shared<std::vector<double>>();
  if (penny.radius > 0) normal->assign(penny.normal.begin(), penny.normal.end());
  return {
      .doc = "A flat round crack.",
      .keys = {Key{"center", Place{&penny.center}, "Its centre; the origin unless given."},
               Key{"normal", Quantities{normal.get(), dimension::none, any_number, 3},
                   "Three numbers: a direction across the crack, of any length."}
                   .required(),
               Key{"radius", Quantity{&penny.radius, dimension::length, positive}, "Its radius."}.required()},
      .finish = [normal, &penny](const Check& check) {
        if (normal->size() != 3)
          check.fail("normal", fmt::format("found {} entries; expected 3", normal->size()));
        std::copy(normal->begin(), normal->end(), penny.normal.begin());
        if (penny.normal == Point{})
          check.fail("normal", "has no direction; expected an entry that is not 0");
      }};
}

Format describe_file(CrackInput& crack) {
  if (!crack.file) crack.file.emplace();
  return {.doc = "The triangles of an STL file (ASCII or binary); they need not enclose anything.",
          .keys = {Key{"file", Text{&crack.file->file}, "STL file, relative to the case file."}.required(),
                   Key{"unit", Text{&crack.file->unit}, "Of its coordinates, such as `\"mm\"`."}.otherwise(
                       "\"m\"")},
          .finish = [&crack](const Check& check) {
            static_cast<void>(length_unit(crack.file->unit, check));  // tells where the unit stands
          }};
}

void make_segments(CrackInput& crack, const Check& check) {
  const std::vector<Point> path =
      crack.path.empty() ? std::vector<Point>{*crack.from, *crack.to} : crack.path;
  for (std::size_t n = 0; n + 1 < path.size(); ++n) {
    if (path[n] == path[n + 1] && crack.path.empty())
      check.fail("to", "is the same place as from; expected a crack with a length");
    if (path[n] == path[n + 1])
      check.fail("path", fmt::format("corners {} and {} are at the same place; expected a way between them",
                                     n + 1, n + 2));
    crack.segments.push_back({path[n], path[n + 1]});
  }
}

std::shared_ptr<const CrackSurface> read_surface(const CrackFileInput& in, const Case& c,
                                                 const Check& check) {
  const std::filesystem::path file = c.file.parent_path() / in.file;
  std::shared_ptr<const CrackSurface> surface;
  try {
    Triangles triangles = read_stl(file);
    const double unit = length_unit(in.unit, check);
    for (Point& corner : triangles.corner)
      for (double& x : corner) x *= unit;
    surface = std::make_shared<const CrackSurface>(triangles);
  } catch (const InputError& wrong) {
    const std::string what = wrong.what();
    check.fail("surface", what.starts_with(file.string()) ? what : file.string() + ": " + what);
  }
  return surface;
}

void finish(CrackInput& crack, const Case& c, const Check& check) {
  for (const char* key : {"from", "path", "polygon", "penny", "surface"}) {
    const bool flat = key == std::string("from") || key == std::string("path");
    if (check.given(key) && c.geometry.dimension != (flat ? 2 : 3))
      check.fail(key, fmt::format("belongs to bodies in {} dimensions; this one has {}",
                                  flat ? "two" : "three", c.geometry.dimension));
  }
  if (crack.from || !crack.path.empty()) return make_segments(crack, check);
  if (crack.file) {
    crack.surface = read_surface(*crack.file, c, check);
  } else if (crack.penny) {
    crack.surface = std::make_shared<const CrackSurface>(*crack.penny);
  } else {
    try {
      crack.surface = std::make_shared<const CrackSurface>(PolygonCrack{crack.polygon});
    } catch (const InputError& wrong) {
      check.fail("polygon", wrong.what());
    }
  }
}

}  // namespace

Format describe_crack(CrackInput& crack, const Case& c) {
  return {.doc =
              "A crack of zero width: the bonds that cross it are cut. In two dimensions from end to end or "
              "along a path, in three a flat polygon, a penny or a surface of triangles.",
          .at = &crack.at,
          .keys = {Key{"from", Place{&crack.from}, "Two dimensions: one end of a straight crack."},
                   Key{"to", Place{&crack.to}, "Its other end."},
                   Key{"path", Places{&crack.path, 2},
                       "Two dimensions: the ends and corners of a crack of straight pieces."},
                   Key{"polygon", Places{&crack.polygon, 3},
                       "Three dimensions: the corners of a flat crack, in their order around it; they may be "
                       "re-entrant."},
                   Key{"penny",
                       Table{[&crack] { return describe_penny(crack); },
                             [&crack] { return crack.penny.has_value(); }},
                       "Three dimensions: a flat round crack."},
                   Key{"surface",
                       Table{[&crack] { return describe_file(crack); },
                             [&crack] { return crack.file.has_value(); }},
                       "Three dimensions: triangles from an STL file."}},
          // Of the second group, `to` is what goes with `from`.
          .groups = {{{"from", "path", "polygon", "penny", "surface"}},
                     {{"to", "path", "polygon", "penny", "surface"}}},
          .finish = [&crack, &c](const Check& check) { finish(crack, c, check); }};
}

}  // namespace riven
