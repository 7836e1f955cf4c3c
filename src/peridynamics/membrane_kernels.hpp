#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "body/bond_planes.hpp"
#include "material/law.hpp"
#include "peridynamics/weights.hpp"

namespace riven {

/// Force law of a point, times its volume: bond j carries weight/|xi|^2 ((a + b s^2) Y + n xi), where xi and
/// Y are the undeformed and deformed bond and s their ratio. Every kind of point has this form.
struct PointForce {
  double a = 0;  // N m, as are b and n
  double b = 0;
  std::array<double, 4> n{};  // row by row
};

/// The weight of a bond at the angle t, times its length: a combination of 1, c, s, s^2 and c s with c = cos
/// 2t and s = sin 2t, which spans the same functions as eq. (10) of the theory with fewer operations.
struct WeightFormula {
  static Moments terms(const Moments& angular) {
    const auto& [one, c, s, c4, s4] = angular;
    return {one, c, s, s * s, c * s};
  }
  /// From the coefficients of 1, cos 2t, sin 2t, cos 4t, sin 4t.
  static Moments coefficients(const Moments& of_angular) {
    const auto& [k1, kc, ks, kc4, ks4] = of_angular;
    return {k1 + kc4, kc, ks, -2 * kc4, 2 * ks4};
  }
};

/// What the kernels take and give for every stored point, however bonds are stored. The averages <s^2>, <s^4>
/// and <Y xi^T / |xi|^2> are those of the family, valid for one state as is what follows from them.
struct MembranePlanes {
  const double* volume = nullptr;  // m^3
  std::vector<double> kappa;       // modulus of the stabilisation (Pa)
  std::vector<double> mean_s2, mean_s4;
  std::array<std::vector<double>, 4> mean_gradient;
  std::vector<double> energy_density;  // J/m^3
};

/// A bond of the stencil, as the kernels read it.
struct MembraneBondOffset {
  std::ptrdiff_t shift = 0;  // to the neighbour, in storage entries
  double x = 0, y = 0;       // m
  double inverse2 = 0;       // 1/length^2
  Moments weight{};          // of WeightFormula, / length^3: times a point's coefficients w / length^2
  double whole_weight = 0;   // w / length^2 in a whole family
};

/// A body on a lattice. Points without coefficients are not the kernels' own: their averages and laws are
/// found elsewhere, and the forces of their laws are added afterwards.
struct MembraneLattice {
  std::vector<MembraneBondOffset> stencil;
  std::vector<BlockKind> blocks;        // intact: so are the families of all neighbours
  const std::uint8_t* masks = nullptr;  // of all blocks: a byte per bond of the stencil
  std::array<std::vector<double>, kMoments> coefficient;
  std::vector<double> a, b;  // the points' force laws
  std::array<std::vector<double>, 4> n;
  std::array<const double*, 2> u{};
  std::array<double*, 2> force{};  // N

  [[nodiscard]] bool has_coefficients(std::size_t point) const { return coefficient[0][point] != 0; }
  [[nodiscard]] PointForce law(std::size_t point) const {
    return {a[point], b[point], {n[0][point], n[1][point], n[2][point], n[3][point]}};
  }
  void set_law(std::size_t point, const PointForce& law) {
    a[point] = law.a;
    b[point] = law.b;
    for (std::size_t c = 0; c < 4; ++c) n[c][point] = law.n[c];
  }
};

/// A point as its neighbours read it, in two lines of the cache and groups of four.
struct alignas(64) MembranePoint {
  std::array<double, 2> x{}, u{};  // undeformed, and displacement (m)
  Moments coefficient{};
  PointForce law;
};

/// A body of listed points. A bond is its neighbour's number: its weight follows from where its ends are.
struct MembraneList {
  std::vector<MembranePoint> points;
  const std::size_t* begin = nullptr;        // bonds of point i: [begin[i], begin[i + 1])
  const std::uint32_t* neighbour = nullptr;  // readable eight entries beyond the last bond
  const std::uint8_t* masks = nullptr;       // those of point i start at byte begin[i] / 8 + i
  std::array<double*, 2> force{};

  [[nodiscard]] bool has_coefficients(std::size_t point) const { return points[point].coefficient[0] != 0; }
  [[nodiscard]] const PointForce& law(std::size_t point) const { return points[point].law; }
  void set_law(std::size_t point, const PointForce& law) { points[point].law = law; }
};

/// What the kernels do with points [begin, end), in whole blocks on a lattice. Each writes only its own
/// points.
template <class Bonds>
struct MembraneKernelsOn {
  /// Averages of the families, then energies and force laws. Returns how many families have collapsed.
  std::size_t (*respond)(const InvariantLaw& law, Bonds& on, MembranePlanes& planes, std::size_t begin,
                         std::size_t end);
  /// Forces on the points, from their own laws and those of their neighbours.
  void (*gather)(const Bonds& on, std::size_t begin, std::size_t end);
};

struct MembraneKernels {
  MembraneKernelsOn<MembraneLattice> lattice;
  MembraneKernelsOn<MembraneList> list;
};

/// The kernels of the instruction set in use.
MembraneKernels membrane_kernels();

}  // namespace riven
