// Bound of the correspondence model's stiffness, for stable steps. The tangent of every family is at most
// that of a linear law whose one modulus is the largest that the state has anywhere (`Majorant`). What that
// law's largest frequency is in this body does not depend on the state: it is found once per modulus, by the
// method of Lanczos.

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "peridynamics/correspondence.hpp"

namespace riven {

namespace {

constexpr int kSteps = 80;         // of Lanczos at most
constexpr int kStepsBetween = 10;  // looks at what it has found
constexpr double kAccuracy = 5e-3;
constexpr double kFineness = 2;        // moduli per factor of two for which the frequency is found
constexpr double kSoftest = 1.0 / 16;  // modulus over that at rest, below which no state counts as softer

/// A number in [-1, 1] that has nothing to do with those of its neighbours.
double noise(std::size_t n) {
  std::uint64_t x = (n + 1) * 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-52 - 1;
}

/// Upper bound of the largest eigenvalue l of K x = l M x, M the diagonal `mass` (0: no unknown), from the
/// Ritz value and its residual (Zhou and Li 2011). `product(x, y)`: y = K x.
template <class Product>
double largest_eigenvalue(const std::vector<double>& mass, const Product& product) {
  const std::size_t n = mass.size();
  std::vector<double> last(n, 0.0), now(n), next(n);
  const auto dot = [&](const std::vector<double>& a, const std::vector<double>& b) {
    return ordered_sum_of(n, [&](std::size_t i) { return mass[i] * a[i] * b[i]; });
  };
  for (std::size_t i = 0; i < n; ++i) now[i] = mass[i] > 0 ? noise(i) : 0;
  const double norm = std::sqrt(dot(now, now));
  for (double& value : now) value /= norm;
  std::vector<double> alpha, beta;
  double bound = 0;
  for (int step = 1; step <= kSteps; ++step) {
    product(now, next);
    for (std::size_t i = 0; i < n; ++i) next[i] = mass[i] > 0 ? next[i] / mass[i] : 0;
    alpha.push_back(dot(next, now));
    const double before = beta.empty() ? 0 : beta.back();
    for (std::size_t i = 0; i < n; ++i) next[i] -= alpha.back() * now[i] + before * last[i];
    beta.push_back(std::sqrt(dot(next, next)));
    const bool ends = step == kSteps || beta.back() <= 1e-10 * alpha.front();
    if (ends || step % kStepsBetween == 0) {
      const auto size = static_cast<Eigen::Index>(alpha.size());
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
      solver.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(alpha.data(), size),
                                    Eigen::Map<const Eigen::VectorXd>(beta.data(), size - 1));
      const double residual = beta.back() * std::abs(solver.eigenvectors()(size - 1, size - 1));
      bound = solver.eigenvalues()[size - 1] + residual;
      if (ends || residual < kAccuracy * bound) break;
    }
    for (std::size_t i = 0; i < n; ++i) {
      last[i] = now[i];
      now[i] = next[i] / beta.back();
    }
  }
  return bound;
}

// Tangents of four or nine rows; no fixed size, whose unrolled solvers take minutes to compile.
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 9, 9>;

constexpr std::size_t kPiece = 256;  // points that a thread takes at a time
constexpr int kLooks = 10;       // at the stiffness of a damaged body until its frequencies are found anew
constexpr double kSlack = 1e-6;  // tells equal tangents from larger ones in spite of rounding

/// Whether b - a is positive definite: much quicker than eigenvalues.
bool is_below(const SmallMatrix& a, const SmallMatrix& b) {
  return Eigen::LLT<SmallMatrix>(b - a).info() == Eigen::Success;
}

}  // namespace

template <int D>
std::vector<Majorant<D>> Correspondence::majorants(double a) const {
  std::vector<Majorant<D>> laws;
  for (const Rest& rest : rest_)
    laws.push_back({a * rest.longitudinal / stiffest_, 1 - 2 * rest.shear / rest.longitudinal});
  return laws;
}

/// The smallest modulus a whose majorants are above all tangents in a state (Pa).
template <int D>
double Correspondence::majorant_of(std::span<const double> u) {
  std::vector<SmallMatrix> scale;
  for (const Majorant<D>& law : majorants<D>(1))
    scale.push_back(Eigen::SelfAdjointEigenSolver<SmallMatrix>(law.a * law.unit()).operatorInverseSqrt());
  const SmallMatrix one = SmallMatrix::Identity(D * D, D * D);
  struct Largest {
    double value = 0;
    void operator+=(const Largest& other) { value = std::max(value, other.value); }
  };
  if (settings_.stabilisation != Stabilisation::bond_associated) look_at(u);
  const auto among = [&](std::size_t begin, std::size_t end) {
    Largest most;
    for_each_gradient<D>(begin, end, u, [&](const Eigen::Matrix<double, D, D>& f, std::size_t material) {
      const SmallMatrix scaled = scale[material] * laws_[material].respond<D>(f).tangent * scale[material];
      if (is_below(scaled, (1 + kSlack) * most.value * one)) return;
      most += {Eigen::SelfAdjointEigenSolver<SmallMatrix>(scaled, Eigen::EigenvaluesOnly)
                   .eigenvalues()[D * D - 1]};
    });
    return most;
  };
  return (1 + kSlack) * ordered_sum<Largest>(body().size(), among, kPiece).value;
}

/// Largest eigenvalue of the majorants' stiffness over masses (1/s^2). Ghosts follow their masters as at a
/// plane of symmetry.
template <int D>
double Correspondence::largest_eigenvalue_of(double a) {
  const std::size_t size = body().size();
  std::vector<double> mass(dofs(), 0.0), bent(dofs(), 0.0);
  this->mass(mass);
  const auto sign = [](const GhostPoint& ghost, std::size_t d) {
    return ghost.faces.test(2 * d) || ghost.faces.test(2 * d + 1) ? -1.0 : 1.0;
  };
  const std::vector<Majorant<D>> laws = majorants<D>(a);
  return largest_eigenvalue(mass, [&](const std::vector<double>& x, std::vector<double>& y) {
    bent = x;
    for (std::size_t d = 0; d < D; ++d)
      for (const GhostPoint& ghost : body().ghosts)
        bent[d * size + ghost.point] = sign(ghost, d) * x[d * size + ghost.master];
    static_cast<void>(force_by(laws, bent, y));
    for (std::size_t d = 0; d < D; ++d)
      for (const GhostPoint& ghost : body().ghosts)
        y[d * size + ghost.master] += sign(ghost, d) * y[d * size + ghost.point];
    for (double& value : y) value = -value;
  });
}

/// The same between two moduli for which it is known: it is a convex function of the modulus, since the
/// stiffness is linear in it, so that the chord lies above.
double Correspondence::scale_of(double a) {
  const double place = kFineness * std::log2(a / stiffest_);
  const auto at = [&](int step) {
    const auto [found, isnew] = eigenvalues_.try_emplace(step, 0.0);
    const double modulus = stiffest_ * std::exp2(step / kFineness);
    if (isnew)
      found->second = in_dimension(
          [&]<int D>(std::integral_constant<int, D>) { return largest_eigenvalue_of<D>(modulus); });
    return std::pair(modulus, found->second);
  };
  constexpr double kRounding = 1e-9;
  const int below = static_cast<int>(std::floor(place + kRounding));
  const auto [low, first] = at(below);
  if (place - below < kRounding) return first;
  const auto [high, second] = at(below + 1);
  return first + (second - first) * (a - low) / (high - low);
}

void Correspondence::stiffness_bound(std::span<const double> u, std::span<double> bound) {
  if (damaged_ && ++looks_ >= kLooks) {  // bonds that broke have changed the frequencies a little
    eigenvalues_.clear();
    looks_ = 0;
  }
  const double a = in_dimension([&]<int D>(std::integral_constant<int, D>) { return majorant_of<D>(u); });
  const double scale = scale_of(std::max(a, kSoftest * stiffest_));
  mass(bound);
  for (double& row : bound) row *= scale;
}

}  // namespace riven
