#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/error.hpp"

namespace riven {

/// Named arrays: all that a run needs to go on later as if it had never stopped. A class that takes part
/// lists its members once, in `each_member`, for both directions:
///
///     template <class Self, class Each>
///     static void each_member(Self& self, const Each& each) {
///       each("verlet.step", self.step_);
///     }
///     void save(Snapshot& to) const { each_member(*this, to.saving()); }
///     void restore(const Snapshot& from) { each_member(*this, from.restoring()); }
///
/// Members may be numbers, bool, strings, arrays and vectors of numbers.
class Snapshot {
 public:
  using Bytes = std::vector<std::uint8_t>;
  using Array = std::variant<std::vector<double>, std::vector<std::int64_t>, Bytes>;

  class Saving {
   public:
    explicit Saving(Snapshot& to) : to_(to) {}
    template <class T>
    void operator()(const std::string& name, const T& value) const {
      if (!to_.arrays.emplace(name, packed(value)).second)
        throw std::logic_error("a snapshot has two arrays called " + name);
    }

   private:
    Snapshot& to_;
  };

  /// Throws InputError where the snapshot lacks an array, or has it in another type or length.
  class Restoring {
   public:
    explicit Restoring(const Snapshot& from) : from_(from) {}
    template <class T>
    void operator()(const std::string& name, T& value) const {
      const auto found = from_.arrays.find(name);
      if (found == from_.arrays.end() || !unpack(found->second, value))
        throw InputError("\"" + name + "\" is missing or does not fit this case");
    }

   private:
    const Snapshot& from_;
  };

  [[nodiscard]] Saving saving() { return Saving(*this); }
  [[nodiscard]] Restoring restoring() const { return Restoring(*this); }

  bool operator==(const Snapshot&) const = default;

  std::map<std::string, Array> arrays;

 private:
  template <class T>
  using Stored = std::conditional_t<std::floating_point<T>, double, std::int64_t>;

  template <class T>
  static Array packed(const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      return std::vector<Stored<T>>{static_cast<Stored<T>>(value)};
    } else if constexpr (std::same_as<typename T::value_type, char> ||
                         std::same_as<typename T::value_type, std::uint8_t>) {
      return Bytes(value.begin(), value.end());
    } else {
      return std::vector<Stored<typename T::value_type>>(value.begin(), value.end());
    }
  }

  /// A vector that has a length already keeps it.
  template <class T>
  static bool unpack(const Array& from, T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      const auto* array = std::get_if<std::vector<Stored<T>>>(&from);
      if (array == nullptr || array->size() != 1) return false;
      value = static_cast<T>(array->front());
    } else {
      const Array sample = packed(T{});
      if (sample.index() != from.index()) return false;
      return std::visit(
          [&](const auto& array) {
            if (!value.empty() && value.size() != array.size()) return false;
            if constexpr (requires { value.resize(array.size()); }) value.resize(array.size());
            for (std::size_t i = 0; i < array.size(); ++i)
              value[i] = static_cast<typename T::value_type>(array[i]);
            return true;
          },
          from);
    }
    return true;
  }
};

}  // namespace riven
