#pragma once

#include "input/format.hpp"

namespace riven {

/// An array of tables over a vector; `describe_one(item, index)` is the format of an element.
template <class Item, class Describe>
kind::Tables tables(std::vector<Item>& items, Describe describe_one) {
  return {[&items] { return items.size(); },
          [&items, describe_one](std::size_t i) {
            if (i == items.size()) items.emplace_back();
            return describe_one(items[i], i);
          }};
}

/// Named tables over a vector of items with a `name`; `describe_one(item)` is the format of an element.
template <class Item, class Describe>
kind::NamedTables named_tables(std::vector<Item>& items, Describe describe_one) {
  return {[&items] { return items.size(); },
          [&items, describe_one](std::size_t i) { return describe_one(items[i]); },
          [&items](std::size_t i) -> std::string& {
            if (i == items.size()) items.emplace_back();
            return items[i].name;
          }};
}

}  // namespace riven
