#pragma once

#include <cmath>
#include <limits>

#include "peridynamics/failure_limits.hpp"
#include "peridynamics/point_model.hpp"
#include "peridynamics/stretch_kernels.hpp"

namespace riven {

/// A point model whose bonds break for good beyond a stretch that the materials of their ends decide. What a
/// bond takes with it is the energy that its two families lose in the state in which it breaks.
class BreakingModel : public PointModel {
 public:
  [[nodiscard]] Passage advance(std::span<const double> u, std::span<double> force) override;
  [[nodiscard]] double dissipated_energy() const override { return dissipated_; }
  [[nodiscard]] double overload(std::span<const double> u) const override;
  void save(Snapshot& to) const override;
  void restore(const Snapshot& from) override;

  /// From now on bonds break. Throws InputError for limits that are not positive, or not as many as the body
  /// has pairs of materials.
  void set_limits(FailureLimits limits);
  [[nodiscard]] const FailureLimits& limits() const { return limits_; }
  [[nodiscard]] bool breaks() const { return !limits_.stretch.empty(); }
  /// The limit of stretch that goes with a critical energy release rate (J/m^2) between two materials: where
  /// all bonds are stretched so, those across a plane take this energy per area with them when they break.
  /// The plane is one between rows of a lattice; of scattered points it has any place and direction.
  [[nodiscard]] double critical_stretch(double energy_release_rate, std::size_t a, std::size_t b) const;
  /// Energy (J) of a stored point's own family in a state.
  [[nodiscard]] virtual double family_energy(std::size_t point, std::span<const double> u) const = 0;

 protected:
  using PointModel::PointModel;

  /// Follows the bonds of stored points (ascending), of which some have gone or, after `restore`, come back.
  virtual void refit(std::span<const std::size_t> points) = 0;
  /// Points (ascending) whose families `refit` changes when these lose bonds.
  [[nodiscard]] virtual std::vector<std::size_t> changed_by(std::vector<std::size_t> points) const {
    return points;
  }
  /// Whether families may be stiffer after `refit`.
  [[nodiscard]] virtual bool stiffens() const { return false; }
  /// For `refit`: blocks of points that have lost bonds are no longer intact, but kernels still visit them.
  static void open_blocks(std::span<const std::size_t> points, std::vector<BlockKind>& blocks);

  /// A whole family: bonds (m) and volumes of their ends (m^3).
  struct WholeFamily {
    std::vector<Eigen::Vector3d> xi;
    std::vector<double> volume;
  };
  /// Energy density (J/m^3) of a family of a material, all of whose bonds have one stretch (r - L) / L, at an
  /// interface with another one.
  [[nodiscard]] virtual double equal_stretch_energy(double stretch, std::size_t material,
                                                    std::size_t other) const = 0;
  /// The share of it that is left when only some of the bonds are.
  [[nodiscard]] virtual double share_left(const WholeFamily& family, const std::vector<bool>& exists,
                                          std::size_t material) const = 0;

  /// A bond of a point: offset of the stencil, or place in the list.
  struct LongBond {
    std::size_t point = 0, bond = 0, end = 0;
    double excess = 0;  // squared ratio of its stretch to the limit, or ratio of energies, less 1
  };
  /// Bonds to break: those beyond their limit among the groups of points that `beyond` marks, and those of
  /// points with too much energy; ascending, each from one end or from both.
  [[nodiscard]] std::vector<LongBond> long_bonds(std::span<const double> u) const;
  /// Breaks bonds. Returns the points that have lost some, ascending.
  std::vector<std::size_t> lose(std::vector<LongBond> bonds, std::span<const double> u);
  /// Of stored points, by each force evaluation of a model whose families may collapse: in which they have.
  /// `advance` counts them and has `refit` take them for something simpler from then on. Empty: no bond
  /// breaks.
  [[nodiscard]] std::span<std::uint8_t> crushed() { return crushed_; }
  /// Energy (J) that a crushed family gives up, less what is left of it.
  [[nodiscard]] virtual double crushed_energy(std::size_t point, std::span<const double> u) const {
    const double energy = family_energy(point, u);
    return std::isfinite(energy) ? energy : 0;
  }
  [[nodiscard]] int times_crushed(std::size_t point) const {
    return times_crushed_.empty() ? 0 : times_crushed_[point];
  }
  [[nodiscard]] static Passage passage(const std::vector<LongBond>& bonds);

  /// Of groups of points, blocks of eight on a lattice and single ones in a list: the least squared ratio of
  /// lengths at which one of their bonds breaks, and whether one may be beyond it.
  [[nodiscard]] std::span<const double> least_limit2() const { return least_limit2_; }
  [[nodiscard]] std::span<std::uint8_t> beyond() { return beyond_; }
  /// A line for `describe`.
  [[nodiscard]] std::vector<std::string> describe_limits() const;
  /// Shows the limits to kernels that mark such groups themselves.
  virtual void limits_set() {}

 private:
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    each("bonds.masks", self.bond_masks());
    each("bonds.times_crushed", self.times_crushed_);
    each("bonds.dissipated", self.dissipated_);
  }
  [[nodiscard]] const std::vector<std::uint8_t>& bond_masks() const { return body().masks(); }
  [[nodiscard]] std::vector<std::uint8_t>& bond_masks() { return own_body().masks(); }
  [[nodiscard]] std::size_t group() const;
  [[nodiscard]] double limit2(std::size_t point, std::size_t end) const;
  [[nodiscard]] WholeFamily whole_family() const;
  [[nodiscard]] double lost_depth(const WholeFamily& family, std::size_t material) const;
  void find_least_limits();
  void look_for_long_bonds(std::span<const double> u);
  [[nodiscard]] std::vector<LongBond> bonds_of_loaded_points(std::span<const double> u) const;
  [[nodiscard]] double energy_over_limit(std::size_t point, std::span<const double> u) const;
  void add_points_to_lose(std::vector<LongBond>& bonds) const;
  bool count_crushed(std::span<const double> u);
  [[nodiscard]] double squared_ratio(std::size_t point, std::size_t end, std::span<const double> u) const;

  FailureLimits limits_;
  std::vector<double> least_limit2_;
  std::vector<std::uint8_t> beyond_;
  StretchLattice lattice_;
  FindLongBonds find_long_bonds_ = nullptr;
  std::vector<std::uint8_t> crushed_, times_crushed_;
  double dissipated_ = 0;
};

}  // namespace riven
