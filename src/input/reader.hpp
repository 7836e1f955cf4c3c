#pragma once

#include <string>

#include "input/format.hpp"
#include "input/source.hpp"

namespace riven {

/// Fills a Case from TOML through its Format; throws InputError for the first thing that is wrong.
class Reader {
 public:
  Reader(const Source& source, Case& to) : source_(source), case_(to) {}

  void read_all();

 private:
  class TableCheck;

  void read(const toml::table& table, const Format& format, const std::string& path);
  void read_key(const toml::table& table, const Key& key, const std::string& path);
  void read_fallback(const toml::table& table, const Key& key, const std::string& path);
  void check_names(const toml::table& table, const Format& format, const std::string& path) const;
  void check_groups(const toml::table& table, const Format& format, const std::string& path) const;

  // One for each kind of value.
  void read_value(const kind::Text& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Texts& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Flag& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Integer& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Integers& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Quantity& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Quantities& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::AnyUnit& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Place& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Places& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Condition& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Formula& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Components& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Interval& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Part& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Parts& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Table& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::Tables& to, const toml::node& node, const Origin& origin);
  void read_value(const kind::NamedTables& to, const toml::node& node, const Origin& origin);

  [[nodiscard]] double quantity(const toml::node& node, const Dimension& dimension, const Range& range,
                                const Origin& origin) const;
  void read_place(Point& to, const Range& range, const toml::node& node, const Origin& origin) const;
  [[nodiscard]] ComponentInput component(const kind::Components& of, const toml::node& node,
                                         const Origin& origin) const;
  [[nodiscard]] Named part(const toml::node& node, const Origin& origin) const;
  [[nodiscard]] Symbols symbols(std::vector<std::string> variables = {}) const;
  [[nodiscard]] Origin entry_origin(const Origin& list, std::size_t index, const toml::node& node) const;

  const Source& source_;
  Case& case_;
};

}  // namespace riven
