#include "input/set_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "base/nearest_name.hpp"
#include "input/element_mesh.hpp"
#include "input/format_lists.hpp"
#include "input/shape_format.hpp"

namespace riven {
namespace {

using kind::Integer;
using kind::Quantity;
using kind::Table;
using kind::Text;

std::vector<std::string> group_names(const GeometryInput& geometry) {
  std::vector<std::string> names = edge_groups(geometry);
  for (std::string& name : other_groups(geometry)) names.push_back(std::move(name));
  if (geometry.points)
    for (const PointGroup& known : geometry.points->list->groups) names.push_back(known.name);
  return names;
}

void check_group(const std::string& group, const GeometryInput& geometry, const Check& check) {
  if (!is_element_mesh(geometry) && !(geometry.points && geometry.points->is_mesh()))
    check.fail("group", "belongs to bodies from a mesh (geometry.mesh); expected where or a shape");
  const std::vector<std::string> names = group_names(geometry);
  if (std::find(names.begin(), names.end(), group) == names.end())
    check.fail("group", fmt::format("the mesh has no physical group \"{}\"; it has {}{}", group,
                                    names.empty() ? "none" : listed(names), did_you_mean(group, names)));
}

Format describe_turned_box(TurnedShape& turned, const Case& c) {
  const auto shape = std::make_shared<std::optional<Shape>>(turned.shape);
  Format format = describe_box(*shape);
  format.doc = "A rectangle or box.";
  format.keys.push_back(Key{"angle", Quantity{&turned.angle, dimension::none},
                            "By which it is turned about its centre, counterclockwise in the x-y plane, such "
                            "as `\"30 deg\"`."}
                            .otherwise("0"));
  format.finish = [shape, &turned, &c, finish_box = format.finish](const Check& check) {
    finish_box(check);
    turned.shape = shape->value();
    if (turned.angle != 0 && c.geometry.dimension == 1)
      check.fail("angle", "belongs to bodies in two or three dimensions");
    if (std::abs(turned.angle) > 2 * std::numbers::pi)
      check.fail("angle", fmt::format("{:g} rad is more than a turn; write \"{:g} deg\" for degrees",
                                      turned.angle, turned.angle));
  };
  return format;
}

Format describe_listed_round(TurnedShape& round, bool ball, const Case& c) {
  const auto shape = std::make_shared<std::optional<Shape>>(round.shape);
  Format format = describe_round(*shape, ball);
  format.finish = [shape, &round, &c, finish_round = format.finish](const Check& check) {
    finish_round(check);
    round.shape = shape->value();
    check_shape(round.shape, c, check);
  };
  return format;
}

/// The dimensions in which shapes of a kind lie beside each other: discs in space are cylinders.
int packed_dimension(bool balls) {
  return balls ? 3 : 2;
}

void find_centers(RandomShapesInput& random, bool balls, const Case& c, const Check& check) {
  const int dimension = packed_dimension(balls);
  if (c.geometry.dimension < dimension)
    check.fail("", balls ? "belongs to bodies in three dimensions; expected random_discs"
                         : "belongs to bodies in two or three dimensions");
  constexpr int kMost = 10'000;
  if (random.places.number > kMost)
    check.fail("number", fmt::format("found {}; expected {} at most", random.places.number, kMost));
  auto centers = random_places(random.places, c.geometry.shape, dimension);
  if (!centers) {
    const RandomPlaces& p = random.places;
    const double filled = filled_fraction(p, c.geometry.shape, dimension);
    const std::string asked = std::isfinite(filled)
                                  ? fmt::format(
                                        "with the gaps around them they fill {:.3g} of the {} open to them, "
                                        "and about {} at most can "
                                        "be filled at random",
                                        filled, balls ? "volume" : "area", balls ? 0.5 : 0.8)
                                  : std::string("the body is too small for one");
    check.fail("number",
               fmt::format("no room for {} {} of radius {:g} m, {:g} m apart and {:g} m from the edge: "
                           "{}; expected fewer, smaller ones or a smaller gap",
                           p.number, balls ? "balls" : "discs", p.radius, p.gap, p.margin, asked));
  }
  random.centers = std::move(*centers);
}

Format describe_random(std::optional<RandomShapesInput>& random, bool balls, const Case& c) {
  if (!random) random.emplace();
  struct Form {
    int seed;
    std::optional<double> gap, margin;
  };
  RandomPlaces& places = random->places;
  const auto form = std::make_shared<Form>(Form{static_cast<int>(places.seed), {}, {}});
  if (places.number > 0) *form = {form->seed, places.gap, places.margin};
  return {
      .doc = fmt::format("Equal {} at random places inside the body's shape, apart from each other. The same "
                         "numbers give the same places on every machine; `riven check` prints them.",
                         balls ? "balls" : "discs"),
      .keys = {Key{"number", Integer{&places.number, 1}, "How many."}.required(),
               Key{"radius", Quantity{&places.radius, dimension::length, positive}, "Of each."}.required(),
               Key{"seed", Integer{&form->seed, 0}, "Another number gives other places."}.otherwise("1"),
               Key{"gap", Quantity{&form->gap, dimension::length, not_negative},
                   "Least distance between two of them; the spacing unless given."},
               Key{"margin", Quantity{&form->margin, dimension::length, not_negative},
                   "Least distance from the edge of the body; `gap` unless given."}},
      .finish = [form, &random, &places, balls, &c](const Check& check) {
        places.seed = static_cast<std::uint64_t>(form->seed);
        places.gap = form->gap.value_or(c.geometry.spacing);
        places.margin = form->margin.value_or(places.gap);
        find_centers(*random, balls, c, check);
      }};
}

std::vector<Key> list_keys(SetInput& set, const Case& c) {
  const auto rounds = [&c](bool ball) {
    return [&c, ball](TurnedShape& t, std::size_t) { return describe_listed_round(t, ball, c); };
  };
  return {
      Key{"discs", tables(set.discs, rounds(false)), "Several circles."},
      Key{"boxes", tables(set.boxes, [&c](TurnedShape& t, std::size_t) { return describe_turned_box(t, c); }),
          "Several rectangles or boxes, each at its own angle."},
      Key{"balls", tables(set.balls, rounds(true)), "Several balls; three dimensions only."},
      Key{"random_discs",
          Table{[&set, &c] { return describe_random(set.random_discs, false, c); },
                [&set] { return set.random_discs.has_value(); }},
          "Circles at random places."},
      Key{"random_balls",
          Table{[&set, &c] { return describe_random(set.random_balls, true, c); },
                [&set] { return set.random_balls.has_value(); }},
          "Balls at random places; three dimensions only."}};
}

void check_set(const SetInput& set, const Case& c, const Check& check) {
  if (!set.group.empty()) check_group(set.group, c.geometry, check);
  const std::vector<std::string> edges{"left", "right", "bottom", "top", "back", "front"};
  if (std::find(edges.begin(), edges.end(), set.name) != edges.end())
    check.fail("", fmt::format("\"{}\" is the name of an edge; expected another name than {}", set.name,
                               listed(edges)));
  for (const auto& groups : {edge_groups(c.geometry), other_groups(c.geometry)})
    if (std::find(groups.begin(), groups.end(), set.name) != groups.end())
      check.fail("", fmt::format("\"{}\" is the name of a physical group of the mesh, which loads and probes "
                                 "know by it; expected another name",
                                 set.name));
  if (set.shape) check_shape(*set.shape, c, check);
  for (const char* key : {"discs", "boxes", "balls"})
    if (check.given(key) && shapes_of(set).empty()) check.fail(key, "found an empty list; expected a shape");
}

}  // namespace

Format describe(SetInput& set, const Case& c) {
  std::vector<Key> keys = {
      Key{"where", kind::Condition{&set.where}, "A formula of x, y, z that is true in the set."},
      Key{"group", Text{&set.group},
          "A physical group of the mesh, by its name: the points of its elements, or, of a group of edges or "
          "faces, "
          "those of the elements that touch it. Of finite elements its nodes."}};
  for (Key& key : shape_keys(set.shape)) keys.push_back(std::move(key));
  Group one_of{{"where", "group", "disc", "box", "ball"}};
  for (Key& key : list_keys(set, c)) {
    one_of.keys.push_back(key.name);
    keys.push_back(std::move(key));
  }
  return {.doc = "A named set of points, for loads and probes.",
          .at = &set.at,
          .keys = std::move(keys),
          .groups = {std::move(one_of)},
          .finish = [&set, &c](const Check& check) { check_set(set, c, check); }};
}

std::vector<TurnedShape> shapes_of(const SetInput& set) {
  std::vector<TurnedShape> shapes;
  if (set.shape) shapes.push_back({*set.shape});
  for (const auto* list : {&set.discs, &set.boxes, &set.balls})
    shapes.insert(shapes.end(), list->begin(), list->end());
  if (set.random_discs)
    for (const Point& center : set.random_discs->centers)
      shapes.push_back({Disc{center, set.random_discs->places.radius}});
  if (set.random_balls)
    for (const Point& center : set.random_balls->centers)
      shapes.push_back({Ball{center, set.random_balls->places.radius}});
  return shapes;
}

}  // namespace riven
