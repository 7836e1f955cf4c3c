#include "load/self_contact.hpp"

#include "base/parallel.hpp"

namespace riven {

namespace {

constexpr std::size_t kPiece = 256;  // points that a thread takes at a time

}  // namespace

SelfContact::SelfContact(const Body& body, const SelfContactSettings& settings)
    : body_(body), settings_(settings), pairs_(body, settings.distance) {}

template <class Visit>
void SelfContact::for_each_contact(std::span<const double> u, const Visit& visit) {
  pairs_.update(u);
  parallel_pieces(
      pairs_.points().size(),
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
          const std::size_t i = pairs_.points()[n];
          const double per_volume = settings_.stiffness * body_.volume[i];
          pairs_.for_each_contact(n, [&](const ContactPairs::Contact& contact) {
            visit(i, contact, per_volume * body_.volume[contact.other]);
          });
        }
      },
      kPiece);
}

void SelfContact::add_force(std::span<const double> u, std::span<double> force) {
  for_each_contact(u, [&](std::size_t i, const ContactPairs::Contact& contact, double stiffness) {
    for (std::size_t d = 0; d < static_cast<std::size_t>(body_.dimension); ++d)
      force[d * body_.size() + i] += stiffness * contact.gap * contact.towards[d];
  });
}

double SelfContact::energy(std::span<const double> u) {
  pairs_.update(u);
  return ordered_sum_of(pairs_.points().size(), [&](std::size_t n) {
    const std::size_t i = pairs_.points()[n];
    double sum = 0;  // of k (reach - r)^2 / 2 V_j, half for each end
    pairs_.for_each_contact(n, [&](const ContactPairs::Contact& contact) {
      sum += 0.25 * contact.gap * contact.gap * body_.volume[contact.other];
    });
    return settings_.stiffness * body_.volume[i] * sum;
  });
}

/// The tangent of a pair is K (e e^T - (reach - r) / r (1 - e e^T)), and its energy at most twice that of its
/// ends with the other one held: twice the sums over the rows of K e e^T bound the first part.
void SelfContact::add_bound(std::span<const double> u, std::span<double> bound) {
  for_each_contact(u, [&](std::size_t i, const ContactPairs::Contact& contact, double stiffness) {
    const Point& e = contact.towards;
    const double sum = std::abs(e[0]) + std::abs(e[1]) + std::abs(e[2]);
    for (std::size_t d = 0; d < static_cast<std::size_t>(body_.dimension); ++d)
      bound[d * body_.size() + i] += 2 * stiffness * std::abs(e[d]) * sum;
  });
}

}  // namespace riven
