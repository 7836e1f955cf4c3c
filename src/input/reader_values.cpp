#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

#include "base/nearest_name.hpp"
#include "input/element_mesh.hpp"
#include "input/reader.hpp"

namespace riven {
namespace {

// The value as users see it, and what it is.
std::string found(const toml::node& node) {
  if (node.is_table()) return "found a table";
  if (node.is_array()) return "found a list";
  std::ostringstream text;
  node.visit([&](const auto& concrete) {
    if constexpr (!toml::is_container<decltype(concrete)>) text << concrete;
  });
  if (node.is_string()) return fmt::format("found \"{}\"", node.as_string()->get());
  return fmt::format("found {}", text.str());
}

const std::string& string_of(const toml::node& node, const Origin& origin,
                             const std::string& expected = "a string in quotes") {
  if (!node.is_string()) origin.fail(fmt::format("{}; expected {}", found(node), expected));
  return node.as_string()->get();
}

const toml::array& list_of(const toml::node& node, const Origin& origin, const std::string& expected) {
  if (!node.is_array()) origin.fail(fmt::format("{}; expected {}", found(node), expected));
  return *node.as_array();
}

void check_among(const std::string& text, const std::vector<std::string>& among, const Origin& origin) {
  if (among.empty() || std::find(among.begin(), among.end(), text) != among.end()) return;
  origin.fail(fmt::format("found \"{}\"; expected {}{}{}", text, among.size() > 1 ? "one of " : "",
                          listed(among), did_you_mean(text, among)));
}

void check_range(double value, const Range& range, const Dimension& dimension, const Origin& origin) {
  const bool low = range.above_low ? value > range.low : value >= range.low;
  const bool high = range.below_high ? value < range.high : value <= range.high;
  if (low && high) return;
  const std::string unit = dimension == dimension::none ? "" : fmt::format(" {}", si_unit(dimension));
  std::string expected = fmt::format("{} {:g}{}", range.above_low ? "above" : "at least", range.low, unit);
  if (std::isfinite(range.high))
    expected += fmt::format(" and {} {:g}{}", range.below_high ? "below" : "at most", range.high, unit);
  origin.fail(fmt::format("found {:g}{}; expected a value {}", value, unit, expected));
}

int integer_of(const toml::node& node, int low, const Origin& origin) {
  const auto* value = node.as_integer();
  if (value == nullptr) origin.fail(fmt::format("{}; expected a whole number", found(node)));
  if (value->get() < low || value->get() > std::numeric_limits<int>::max())
    origin.fail(fmt::format("{}; expected a whole number from {} to {}", found(node), low,
                            std::numeric_limits<int>::max()));
  return static_cast<int>(value->get());
}

// A TOML number; nothing for other values.
std::optional<double> number_of(const toml::node& node, const Origin& origin) {
  if (!node.is_number()) return std::nullopt;
  const double number = *node.value<double>();
  if (!std::isfinite(number)) origin.fail(fmt::format("{}; expected a finite number", found(node)));
  return number;
}

}  // namespace

double Reader::quantity(const toml::node& node, const Dimension& dimension, const Range& range,
                        const Origin& origin) const {
  double value = 0;
  if (const auto number = number_of(node, origin)) {
    if (*number != 0 && dimension != dimension::none)
      origin.fail(needs_unit(fmt::format("{}", *number), dimension));
    value = *number;
  } else {
    const std::string expected =
        dimension == dimension::none
            ? "a number"
            : fmt::format("{} such as \"10 {}\"", named(dimension), usual_unit(dimension));
    value = parse_quantity(string_of(node, origin, expected), dimension, symbols(), origin);
  }
  check_range(value, range, dimension, origin);
  return value;
}

void Reader::read_value(const kind::Text& to, const toml::node& node, const Origin& origin) {
  const std::string& text = string_of(node, origin);
  check_among(text, to.among, origin);
  *to.to = text;
}

void Reader::read_value(const kind::Texts& to, const toml::node& node, const Origin& origin) {
  const toml::array& list = list_of(node, origin, "a list of strings");
  to.to->clear();
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Origin here = entry_origin(origin, i, list[i]);
    const std::string& text = string_of(list[i], here);
    check_among(text, to.among, here);
    if (std::find(to.to->begin(), to.to->end(), text) != to.to->end())
      here.fail(fmt::format("\"{}\" stands here twice", text));
    to.to->push_back(text);
  }
}

void Reader::read_value(const kind::Flag& to, const toml::node& node, const Origin& origin) {
  const auto* flag = node.as_boolean();
  if (flag == nullptr) origin.fail(found(node) + "; expected true or false");
  *to.to = flag->get();
}

void Reader::read_value(const kind::Integer& to, const toml::node& node, const Origin& origin) {
  *to.to = integer_of(node, to.low, origin);
}

void Reader::read_value(const kind::Integers& to, const toml::node& node, const Origin& origin) {
  const toml::array& list = list_of(node, origin, "a list of whole numbers, such as [100, 100]");
  to.to->clear();
  for (std::size_t i = 0; i < list.size(); ++i)
    to.to->push_back(integer_of(list[i], to.low, entry_origin(origin, i, list[i])));
}

void Reader::read_value(const kind::Quantity& to, const toml::node& node, const Origin& origin) {
  const double value = quantity(node, to.dimension, to.range, origin);
  std::visit([&](auto* member) { *member = value; }, to.to);
}

void Reader::read_value(const kind::Quantities& to, const toml::node& node, const Origin& origin) {
  const toml::array& list = list_of(node, origin, fmt::format("a list, each entry {}", named(to.dimension)));
  if (list.empty() || list.size() > to.most)
    origin.fail(fmt::format("found a list of {} entries; expected {}", list.size(),
                            list.empty() ? "one at least" : fmt::format("1 to {}", to.most)));
  to.to->clear();
  for (std::size_t i = 0; i < list.size(); ++i)
    to.to->push_back(quantity(list[i], to.dimension, to.range, entry_origin(origin, i, list[i])));
}

void Reader::read_value(const kind::AnyUnit& to, const toml::node& node, const Origin& origin) {
  if (const auto number = number_of(node, origin)) {
    *to.to = AnyQuantity{*number, "1"};
    return;
  }
  const Quantity value =
      parse_quantity(string_of(node, origin, "a number, or a string such as \"12 N\""), symbols(), origin);
  *to.to = AnyQuantity{value.si, si_unit(value.dimension)};
}

void Reader::read_place(Point& to, const Range& range, const toml::node& node, const Origin& origin) const {
  const auto count = static_cast<std::size_t>(case_.geometry.dimension);
  const toml::array& list = list_of(node, origin, fmt::format("a list of {} lengths", count));
  if (list.size() != count)
    origin.fail(fmt::format("found {} entries; expected {}, one per direction", list.size(), count));
  for (std::size_t i = 0; i < count; ++i)
    to[i] = quantity(list[i], dimension::length, range, entry_origin(origin, i, list[i]));
}

void Reader::read_value(const kind::Place& to, const toml::node& node, const Origin& origin) {
  std::visit(
      [&](auto* member) {
        Point place{};
        if constexpr (std::is_same_v<decltype(member), Point*>) place = *member;
        read_place(place, to.range, node, origin);
        *member = place;
      },
      to.to);
}

void Reader::read_value(const kind::Places& to, const toml::node& node, const Origin& origin) {
  const toml::array& list = list_of(node, origin, "a list of places, each a list of lengths");
  if (list.size() < to.least)
    origin.fail(fmt::format("found {} places; expected {} or more", list.size(), to.least));
  to.to->assign(list.size(), Point{});
  for (std::size_t i = 0; i < list.size(); ++i)
    read_place((*to.to)[i], any_number, list[i], entry_origin(origin, i, list[i]));
}

void Reader::read_value(const kind::Condition& to, const toml::node& node, const Origin& origin) {
  *to.to = parse_condition(string_of(node, origin, "a formula such as \"x > 0\""), symbols({"x", "y", "z"}),
                           origin);
}

ComponentInput Reader::component(const kind::Components& of, const toml::node& node,
                                 const Origin& origin) const {
  if (const auto number = number_of(node, origin)) {
    if (*number != 0) origin.fail(needs_unit(fmt::format("{}", *number), of.dimension));
    return {Expression("0", "0", origin.at)};
  }
  const std::string sample = of.at_start || of.dimension != dimension::length
                                 ? fmt::format("10 {}", usual_unit(of.dimension))
                                 : std::string("(stretch - 1)*x");
  const std::string& text =
      string_of(node, origin, fmt::format("\"free\", 0 or {} such as \"{}\"", named(of.dimension), sample));
  if (text == "free") return {};
  std::vector<std::string> variables{"x", "y", "z"};
  if (!of.at_start) variables.emplace_back(case_.solver.in_time() ? "t" : "stretch");
  return {parse_formula(text, of.dimension, symbols(std::move(variables)), origin)};
}

void Reader::read_value(const kind::Formula& to, const toml::node& node, const Origin& origin) {
  *to.to = component({.to = nullptr, .dimension = to.dimension}, node, origin).value;
  if (!*to.to) origin.fail(fmt::format("found \"free\"; expected {}", named(to.dimension)));
}

void Reader::read_value(const kind::Components& to, const toml::node& node, const Origin& origin) {
  const auto count = static_cast<std::size_t>(case_.geometry.dimension);
  const toml::array& list =
      list_of(node, origin, fmt::format("a list of {} entries, one per direction", count));
  if (list.size() != count)
    origin.fail(fmt::format("found {} entries; expected {}, one per direction", list.size(), count));
  to.to->clear();
  for (std::size_t i = 0; i < count; ++i)
    to.to->push_back(component(to, list[i], entry_origin(origin, i, list[i])));
}

void Reader::read_value(const kind::Interval& to, const toml::node& node, const Origin& origin) {
  const std::string expected = "\"5 min\", \"1000 steps\" or \"never\"";
  const std::string& text = string_of(node, origin, expected);
  *to.to = {};
  if (text == "never") return;
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const std::string unit = text.substr(std::min(text.find_first_not_of(' ', digits), text.size()));
  if (unit == "steps" || unit == "step") {
    const auto [end, problem] = std::from_chars(text.data(), text.data() + digits, to.to->steps);
    if (problem != std::errc{} || to.to->steps < 1)
      origin.fail(fmt::format("found \"{}\"; expected a whole number of steps from 1 to {}", text,
                              std::numeric_limits<int>::max()));
    return;
  }
  try {
    to.to->seconds = quantity(node, dimension::time, positive, origin);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}; for checkpoints {}", error.what(), expected));
  }
}

Named Reader::part(const toml::node& node, const Origin& origin) const {
  const std::string& name = string_of(node, origin, "the name of an edge or a set");
  const std::vector<std::string> known = part_names(case_);
  const std::array<std::string_view, 6> edges{"left", "right", "bottom", "top", "back", "front"};
  const bool is_edge = std::find(edges.begin(), edges.end(), name) != edges.end();
  const auto& points = case_.geometry.points;
  const bool from_cad =
      case_.geometry.surface || is_element_mesh(case_.geometry) || (points && points->is_mesh());
  if (is_edge && from_cad && std::find(known.begin(), known.end(), name) == known.end())
    origin.fail(
        fmt::format("the body has no edge \"{}\": its boundary does not cover all of that side of the box "
                    "around it; known are "
                    "{}; expected a set{}",
                    name, known.empty() ? "none" : listed(known), did_you_mean(name, known)));
  if (is_edge && points && !points->is_mesh() && !points->has_edges())
    origin.fail(fmt::format(
        "points have no edge \"{}\" as long as nobody says where the body ends; expected box = {{ size = "
        "[...], from = [...] }} in geometry.points, or a set",
        name));
  if (std::find(known.begin(), known.end(), name) == known.end())
    origin.fail(fmt::format("\"{}\" is neither an edge of the body nor a set; known are {}{}", name,
                            known.empty() ? "none (a disc has no edges)" : listed(known),
                            did_you_mean(name, known)));
  return {name, origin.at};
}

void Reader::read_value(const kind::Part& to, const toml::node& node, const Origin& origin) {
  *to.to = part(node, origin);
}

void Reader::read_value(const kind::Parts& to, const toml::node& node, const Origin& origin) {
  to.to->clear();
  if (!node.is_array()) {
    to.to->push_back(part(node, origin));
    return;
  }
  const toml::array& list = *node.as_array();
  if (list.empty()) origin.fail("found an empty list; expected the name of an edge or a set");
  for (std::size_t i = 0; i < list.size(); ++i)
    to.to->push_back(part(list[i], entry_origin(origin, i, list[i])));
}

void Reader::read_value(const kind::Table& to, const toml::node& node, const Origin& origin) {
  if (!node.is_table()) origin.fail(fmt::format("{}; expected a table", found(node)));
  read(*node.as_table(), to.open(), origin.key);
}

void Reader::read_value(const kind::Tables& to, const toml::node& node, const Origin& origin) {
  const toml::array& list =
      list_of(node, origin, fmt::format("an array of tables, written [[{}]]", origin.key));
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Origin here = entry_origin(origin, i, list[i]);
    if (!list[i].is_table()) here.fail(fmt::format("{}; expected a table", found(list[i])));
    read(*list[i].as_table(), to.open(to.count()), here.key);
  }
}

void Reader::read_value(const kind::NamedTables& to, const toml::node& node, const Origin& origin) {
  if (!node.is_table())
    origin.fail(fmt::format("{}; expected tables, written [{}.NAME]", found(node), origin.key));
  for (const auto& [name, value] : *node.as_table()) {
    const std::string path = fmt::format("{}.{}", origin.key, name.str());
    const Origin here = source_.origin(path, value);
    if (!value.is_table())
      here.fail(fmt::format("{}; expected a section [{}.NAME]", found(value), origin.key));
    const std::size_t index = to.count();
    to.name(index) = std::string(name.str());
    read(*value.as_table(), to.open(index), path);
  }
}

}  // namespace riven
