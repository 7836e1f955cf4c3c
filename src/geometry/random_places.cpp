#include "geometry/random_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace riven {
namespace {

/// Places in [0, 1) by a generator and a map that the language fixes; its distributions differ from library
/// to library.
class Generator {
 public:
  explicit Generator(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

// std::hypot is not rounded the same everywhere; the root is.
double length(const Point& a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

Point between(const Point& a, const Point& b) {
  return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

/// Where centres may be.
class Room {
 public:
  Room(const Shape& body, double inset, int dimension)
      : dimension_(static_cast<std::size_t>(dimension)), box_(std::holds_alternative<Box>(body)) {
    if (box_) {
      center_ = std::get<Box>(body).center;
      half_ = std::get<Box>(body).half_size;
    } else {
      center_ = std::get<Disc>(body).center;
      half_ = {std::get<Disc>(body).radius, std::get<Disc>(body).radius, 0};
    }
    for (std::size_t k = 0; k < 3; ++k) half_[k] = k < dimension_ ? half_[k] - inset : 0;
  }

  [[nodiscard]] bool empty() const { return *std::min_element(half_.begin(), half_.begin() + axes()) < 0; }
  [[nodiscard]] std::size_t dimension() const { return dimension_; }
  [[nodiscard]] double low(std::size_t k) const { return center_[k] - half_[k]; }
  [[nodiscard]] double extent(std::size_t k) const { return 2 * half_[k]; }

  /// Its area or volume if it were wider by `more` on all sides.
  [[nodiscard]] double measure(double more) const {
    if (!box_) return std::numbers::pi * (half_[0] + more) * (half_[0] + more);
    double product = 1;
    for (std::size_t k = 0; k < dimension_; ++k) product *= 2 * (half_[k] + more);
    return product;
  }

  /// Anywhere in it, every place as likely as any other.
  [[nodiscard]] Point anywhere(Generator& random) const {
    Point place = center_;
    do {
      for (std::size_t k = 0; k < dimension_; ++k) place[k] = low(k) + extent(k) * random();
    } while (!box_ && length(between(center_, place)) > half_[0]);
    return place;
  }

  /// The nearest place in it.
  [[nodiscard]] Point into(Point place) const {
    if (box_) {
      for (std::size_t k = 0; k < dimension_; ++k)
        place[k] = std::clamp(place[k], low(k), low(k) + extent(k));
      return place;
    }
    const double away = length(between(center_, place));
    if (away > half_[0])
      for (std::size_t k = 0; k < dimension_; ++k)
        place[k] = center_[k] + (place[k] - center_[k]) * (half_[0] / away);
    return place;
  }

 private:
  [[nodiscard]] std::ptrdiff_t axes() const { return static_cast<std::ptrdiff_t>(dimension_); }

  std::size_t dimension_;
  bool box_;
  Point center_{}, half_{};
};

/// Who lies near whom: numbers of places by cells at least `reach` wide.
class Cells {
 public:
  Cells(const Room& room, double reach, std::size_t number) : room_(room) {
    // No more cells than places, whatever the reach.
    const auto most = static_cast<double>(number);
    for (std::size_t k = 0; k < room.dimension(); ++k) {
      const double side = std::ceil(std::pow(most, 1.0 / static_cast<double>(room.dimension())));
      count_[k] = static_cast<std::size_t>(std::clamp(std::floor(room.extent(k) / reach), 1.0, side));
    }
    cells_.resize(count_[0] * count_[1] * count_[2]);
  }

  void add(const Point& place, std::size_t number) {
    cells_[cell(index(place, 0), index(place, 1), index(place, 2))].push_back(number);
  }

  /// Calls `visit(number)` for all within the reach of a place, and some beyond, in a fixed order.
  template <class Visit>
  void each_near(const Point& place, const Visit& visit) const {
    std::array<std::size_t, 3> first{}, last{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = index(place, k);
      first[k] = at > 0 ? at - 1 : 0;
      last[k] = std::min(at + 1, count_[k] - 1);
    }
    for (std::size_t a = first[0]; a <= last[0]; ++a)
      for (std::size_t b = first[1]; b <= last[1]; ++b)
        for (std::size_t c = first[2]; c <= last[2]; ++c)
          for (const std::size_t number : cells_[cell(a, b, c)]) visit(number);
  }

 private:
  [[nodiscard]] std::size_t index(const Point& place, std::size_t k) const {
    if (count_[k] == 1) return 0;
    const double part = (place[k] - room_.low(k)) / room_.extent(k) * static_cast<double>(count_[k]);
    return static_cast<std::size_t>(std::clamp(part, 0.0, static_cast<double>(count_[k] - 1)));
  }
  [[nodiscard]] std::size_t cell(std::size_t a, std::size_t b, std::size_t c) const {
    return (a * count_[1] + b) * count_[2] + c;
  }

  const Room& room_;
  std::array<std::size_t, 3> count_{1, 1, 1};
  std::vector<std::vector<std::size_t>> cells_;
};

/// Random sequential addition; fewer than `number` if one finds no room in many tries.
std::vector<Point> put_down(const Room& room, double apart, std::size_t number, Generator& random) {
  constexpr int kMostTries = 2000;
  std::vector<Point> places;
  Cells cells(room, apart, number);
  for (int tries = 0; places.size() < number && tries < kMostTries; ++tries) {
    const Point place = room.anywhere(random);
    bool free = true;
    cells.each_near(place, [&](std::size_t n) { free = free && length(between(place, places[n])) >= apart; });
    if (!free) continue;
    cells.add(place, places.size());
    places.push_back(place);
    tries = -1;
  }
  return places;
}

/// One sweep over all pairs that are too near: each goes half of what is missing, and a little more, so that
/// the sweeps come to an end. Returns whether there were any.
bool push_once(std::vector<Point>& places, const Room& room, double apart) {
  constexpr double kMore = 1e-3;  // of the distance wanted
  Cells cells(room, apart, places.size());
  for (std::size_t n = 0; n < places.size(); ++n) cells.add(places[n], n);
  bool pushed = false;
  for (std::size_t n = 0; n < places.size(); ++n)
    cells.each_near(places[n], [&](std::size_t other) {
      if (other <= n) return;
      const Point along = between(places[n], places[other]);
      const double now = length(along);
      if (now >= apart) return;
      pushed = true;
      // Two at the same place part along x.
      const Point direction =
          now > 0 ? Point{along[0] / now, along[1] / now, along[2] / now} : Point{1, 0, 0};
      const double step = 0.5 * ((1 + kMore) * apart - now);
      for (std::size_t k = 0; k < room.dimension(); ++k) {
        places[n][k] -= step * direction[k];
        places[other][k] += step * direction[k];
      }
      places[n] = room.into(places[n]);
      places[other] = room.into(places[other]);
    });
  return pushed;
}

/// All anywhere, then pushed apart; nothing if they do not come to rest.
std::optional<std::vector<Point>> push_apart(const Room& room, double apart, std::size_t number,
                                             Generator& random) {
  constexpr int kMostSweeps = 5000;
  std::vector<Point> places;
  while (places.size() < number) places.push_back(room.anywhere(random));
  for (int sweep = 0; sweep < kMostSweeps; ++sweep)
    if (!push_once(places, room, apart)) return places;
  return std::nullopt;
}

}  // namespace

double filled_fraction(const RandomPlaces& places, const Shape& body, int dimension) {
  const Room room(body, places.radius + places.margin, dimension);
  if (room.empty()) return std::numeric_limits<double>::infinity();
  const double reach = places.radius + 0.5 * places.gap;
  const double one =
      dimension == 2 ? std::numbers::pi * reach * reach : 4 * std::numbers::pi / 3 * reach * reach * reach;
  return places.number * one / room.measure(reach);
}

std::optional<std::vector<Point>> random_places(const RandomPlaces& places, const Shape& body,
                                                int dimension) {
  const double densest =
      dimension == 2 ? std::numbers::pi / std::sqrt(12.0) : std::numbers::pi / std::sqrt(18.0);
  const Room room(body, places.radius + places.margin, dimension);
  if (room.empty() || (places.number > 1 && filled_fraction(places, body, dimension) > densest))
    return std::nullopt;
  const double apart = 2 * places.radius + places.gap;
  const auto number = static_cast<std::size_t>(places.number);
  Generator random(places.seed);
  std::vector<Point> found = put_down(room, apart, number, random);
  if (found.size() == number) return found;
  return push_apart(room, apart, number, random);
}

}  // namespace riven
