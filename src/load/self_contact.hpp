#pragma once

#include <span>

#include "load/contact_pairs.hpp"

namespace riven {

struct SelfContactSettings {
  double distance = 0;   // m, at which points without a bond begin to repel, at most
  double stiffness = 0;  // k (N/m^7): force density per volume of the other end and depth
};

/// Repulsion between points of a body that no bond joins: crack faces and fragments.
///
/// A pair nearer than reach = min(L, distance), L its undeformed distance, has the energy
/// k (reach - r)^2 / 2 V_i V_j, after the short-range force of Silling and Askari (2005): nothing repels at
/// rest, forces are central and the gradient of an energy, and since bonds break at r > L none arises when
/// they do.
class SelfContact {
 public:
  SelfContact(const Body& body, const SelfContactSettings& settings);

  /// Adds the forces (N) to those on the points, a plane of the body's size per component as in u (m).
  void add_force(std::span<const double> u, std::span<double> force);
  /// Energy of the contacts (J).
  [[nodiscard]] double energy(std::span<const double> u);
  /// Adds a bound of the stiffness (N/m) to the rows of the points: what the contacts of this state add to
  /// the highest frequencies. What they take from them, turning, is left out.
  void add_bound(std::span<const double> u, std::span<double> bound);

  [[nodiscard]] const ContactPairs& pairs() const { return pairs_; }

 private:
  /// Calls visit(i, contact, K) for all contacts of each exposed point i, with the stiffness K = k V_i V_j
  /// (N/m); all of one point from one thread.
  template <class Visit>
  void for_each_contact(std::span<const double> u, const Visit& visit);

  const Body& body_;
  SelfContactSettings settings_;
  ContactPairs pairs_;
};

}  // namespace riven
