#include "fem/element_kernel.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"

namespace riven {

namespace {

constexpr std::size_t kPiece = 8;  // elements whose gradients are answered at once

template <class E>
class KernelOf final : public ElementKernel {
 public:
  static constexpr int D = E::D, N = E::N, Q = E::Q, kDofs = D * N;
  static constexpr std::size_t kNodes = N, kPoints = Q, kComponents = D * D;
  using Tensor = Eigen::Matrix<double, D, D>;
  using Nodal = Eigen::Matrix<double, N, D>;
  using Stiffness = Eigen::Matrix<double, kDofs, kDofs>;
  using Slopes = Eigen::Map<const Nodal>;
  using PerPoint = std::array<double, kPoints>;
  using PerMode = Eigen::Matrix<double, D + 1, D + 1>;

  KernelOf(const MeshBody& mesh, std::vector<ElementLaw> element_laws, Dilatation of) : mesh_(mesh) {
    laws = std::move(element_laws);
    dilatation = of;
    lumped = mesh.lumped_volumes();
    make_slopes();
    make_modes();
    if (of == Dilatation::selective) make_mean_slopes();
    make_pieces();
    make_gather();
    make_memory();
    element_force_.resize(mesh.corner.size() * D);
    element_energy_.resize(mesh.elements());
  }

  std::optional<std::size_t> force(std::span<const double> u, std::span<double> force) override {
    const std::optional<std::size_t> wrong = sweep(u);
    if (wrong) return wrong;
    gather(force, -1);
    return std::nullopt;
  }

  double energy(std::span<const double> u) override {
    if (sweep(u)) return std::numeric_limits<double>::quiet_NaN();
    return ordered_sum_of(element_energy_.size(), [&](std::size_t e) { return element_energy_[e]; });
  }

  void tangent(std::span<const double> u, std::size_t first, std::size_t last,
               TangentBlocks& to) const override {
    for (std::size_t e = first; e < last; ++e) {
      const Stiffness k = stiffness(u, e);
      for (int r = 0; r < kDofs; ++r) to.dofs.push_back(entry(e, r));
      to.begin.push_back(to.dofs.size());
      to.values.insert(to.values.end(), k.data(), k.data() + k.size());
    }
  }

  /// Row sums of the elements' own matrices: no less than those of their sum.
  void bound(std::span<const double> u, std::span<double> bound) override {
    parallel_for(static_cast<std::ptrdiff_t>(mesh_.elements()), [&](std::ptrdiff_t n) {
      const auto e = static_cast<std::size_t>(n);
      const Eigen::Matrix<double, kDofs, 1> rows = stiffness(u, e).cwiseAbs().rowwise().sum();
      std::copy_n(rows.data(), kDofs, element_force_.data() + e * kNodes * D);
    });
    gather(bound, 1);
  }

  std::optional<std::size_t> turned_over(std::span<const double> u) const override {
    for (std::size_t e = 0; e < mesh_.elements(); ++e) {
      const Nodal moved = nodal(u, e);
      for (std::size_t q = 0; q < kPoints; ++q)
        if (!(gradient(moved, e, q).determinant() > 0)) return e;
    }
    return std::nullopt;
  }

  std::vector<ModelField> fields(std::span<const double> u) const override;

 private:
  struct Piece {
    std::size_t begin = 0, end = 0;  // of `order_`
    std::size_t material = 0;
  };

  [[nodiscard]] std::size_t entry(std::size_t e, int dof) const {
    return static_cast<std::size_t>(dof % D) * mesh_.node.size() +
           mesh_.nodes(e)[static_cast<std::size_t>(dof / D)];
  }
  /// Undeformed places of an element's nodes (m).
  [[nodiscard]] Nodal places(std::size_t e) const {
    Nodal x;
    for (int a = 0; a < N; ++a)
      for (int d = 0; d < D; ++d)
        x(a, d) = mesh_.node[mesh_.nodes(e)[static_cast<std::size_t>(a)]][static_cast<std::size_t>(d)];
    return x;
  }
  [[nodiscard]] Nodal nodal(std::span<const double> u, std::size_t e) const {
    Nodal v;
    const auto nodes = mesh_.nodes(e);
    for (int a = 0; a < N; ++a)
      for (int d = 0; d < D; ++d)
        v(a, d) = u[static_cast<std::size_t>(d) * mesh_.node.size() + nodes[static_cast<std::size_t>(a)]];
    return v;
  }
  /// Slopes of the shape functions along x, y, z (1/m).
  [[nodiscard]] Slopes slopes(std::size_t e, std::size_t q) const {
    return Slopes(slope_.data() + (e * kPoints + q) * kNodes * D);
  }
  [[nodiscard]] Tensor gradient(const Nodal& moved, std::size_t e, std::size_t q) const {
    return Tensor::Identity() + moved.transpose() * slopes(e, q);
  }
  [[nodiscard]] const ElementLaw& law_of(std::size_t e) const { return laws[mesh_.material_of(e)]; }

  [[nodiscard]] Tensor mean_gradient(const Nodal& moved, std::size_t e) const {
    return Tensor::Identity() + moved.transpose() * mean_slope_[e];
  }

  void make_slopes();
  void make_modes();
  void make_mean_slopes();
  void make_pieces();
  void make_gather();
  void make_memory();
  /// Where what a quadrature point remembers begins.
  [[nodiscard]] std::size_t memory_of(std::size_t e, std::size_t q) const {
    const ElementLaw& law = law_of(e);
    return law.viscous ? memory_begin_[e] + q * law.viscous->memory() : 0;
  }
  /// What its past makes of the next forces.
  [[nodiscard]] ElementLaw::Step step_of(std::size_t e, std::size_t q) const {
    return law_of(e).step(memory.start() + memory_of(e, q), memory.elapsed());
  }
  void respond(const ElementLaw& law, std::size_t e, std::size_t at,
               const std::array<double*, kComponents>& f, const std::array<double*, kComponents>& p,
               double* energy);
  std::optional<std::size_t> sweep(std::span<const double> u);
  [[nodiscard]] std::size_t sweep_piece(const Piece& piece, std::span<const double> u);
  void add_mean(const ElementLaw& law, std::size_t e, std::size_t at,
                const std::array<double*, kComponents>& f, const std::array<double*, kComponents>& p);
  [[nodiscard]] Nodal add_selective(const ElementLaw& law, std::size_t e, const Nodal& moved);
  void gather(std::span<double> to, double sign) const;
  [[nodiscard]] Stiffness stiffness(std::span<const double> u, std::size_t e) const;
  [[nodiscard]] double mode(std::size_t e, std::size_t q, int m) const {
    return mode_[(e * kPoints + q) * static_cast<std::size_t>(modes_) + static_cast<std::size_t>(m)];
  }
  [[nodiscard]] PerPoint projected(std::size_t e, const PerPoint& values) const;
  [[nodiscard]] PerPoint dilatations(const Nodal& moved, std::size_t e) const;

  const MeshBody& mesh_;
  std::vector<double> slope_;       // of element, quadrature point, direction, node (1/m)
  std::vector<double> weight_;      // of element, quadrature point (m^3)
  std::vector<double> volume_;      // of elements (m^3)
  int modes_ = 1;                   // functions that J is projected on: a constant, or linear ones too
  std::vector<double> mode_;        // of element, quadrature point, mode (m^-3/2)
  std::vector<Nodal> mean_slope_;   // of elements (1/m), if U is taken of their mean gradient
  std::vector<std::size_t> order_;  // elements by material
  std::vector<Piece> pieces_;
  std::vector<std::size_t> first_;         // of each node, in `slot_`
  std::vector<std::size_t> memory_begin_;  // of elements
  std::vector<std::size_t> slot_;          // element times nodes plus node of the element
  std::vector<double> element_force_;      // of element, node, direction (N)
  std::vector<double> element_energy_;     // J
};

template <class E>
void KernelOf<E>::make_slopes() {
  const auto rule = E::rule();
  for (std::size_t e = 0; e < mesh_.elements(); ++e) {
    const Nodal x = places(e);
    volume_.push_back(0);
    for (const auto& point : rule) {
      const auto f = E::at(point.at);
      const Tensor jacobian = x.transpose() * f.slope;
      const Nodal slope = f.slope * jacobian.inverse();
      slope_.insert(slope_.end(), slope.data(), slope.data() + slope.size());
      weight_.push_back(point.weight * jacobian.determinant() * (D == 2 ? mesh_.thickness : 1));
      volume_.back() += weight_.back();
    }
  }
}

/// 1 (and x, y, z), orthonormal over each element, by Gram and Schmidt.
template <class E>
void KernelOf<E>::make_modes() {
  modes_ = dilatation == Dilatation::linear ? D + 1 : 1;
  const auto rule = E::rule();
  for (std::size_t e = 0; e < mesh_.elements(); ++e) {
    const Nodal x = places(e);
    const Eigen::Map<const Eigen::Array<double, Q, 1>> weight(weight_.data() + e * kPoints);
    Eigen::Array<double, Q, D + 1> values = Eigen::Array<double, Q, D + 1>::Ones();
    for (int q = 0; q < Q; ++q)
      values.template rightCols<D>().row(q) =
          (E::at(rule[static_cast<std::size_t>(q)].at).value.transpose() * x).array();
    for (int m = 0; m < modes_; ++m) {
      for (int pass = 0; pass < 2; ++pass)  // the second one takes what rounding has left
        for (int n = 0; n < m; ++n)
          values.col(m) -= (weight * values.col(m) * values.col(n)).sum() * values.col(n).eval();
      values.col(m) /= std::sqrt((weight * values.col(m).square()).sum());
    }
    for (int q = 0; q < Q; ++q)
      for (int m = 0; m < modes_; ++m) mode_.push_back(values(q, m));
  }
}

/// At the centre of a four-node quadrilateral; the centre's own of other shapes would fail the patch test.
template <class E>
void KernelOf<E>::make_mean_slopes() {
  for (std::size_t e = 0; e < mesh_.elements(); ++e) {
    Nodal sum = Nodal::Zero();
    for (std::size_t q = 0; q < kPoints; ++q) sum += weight_[e * kPoints + q] * slopes(e, q);
    mean_slope_.push_back(sum / volume_[e]);
  }
}

template <class E>
void KernelOf<E>::make_pieces() {
  for (std::size_t m = 0; m < laws.size(); ++m) {
    const std::size_t begin = order_.size();
    for (std::size_t e = 0; e < mesh_.elements(); ++e)
      if (mesh_.material_of(e) == m) order_.push_back(e);
    for (std::size_t at = begin; at < order_.size(); at += kPiece)
      pieces_.push_back({at, std::min(at + kPiece, order_.size()), m});
  }
}

template <class E>
void KernelOf<E>::make_gather() {
  first_.assign(mesh_.node.size() + 1, 0);
  for (const std::uint32_t node : mesh_.corner) ++first_[node + 1];
  for (std::size_t n = 0; n + 1 < first_.size(); ++n) first_[n + 1] += first_[n];
  slot_.resize(mesh_.corner.size());
  std::vector<std::size_t> next = first_;
  for (std::size_t s = 0; s < slot_.size(); ++s) slot_[next[mesh_.corner[s]]++] = s;
}

template <class E>
void KernelOf<E>::make_memory() {
  std::vector<double> at_rest;
  for (std::size_t e = 0; e < mesh_.elements(); ++e) {
    memory_begin_.push_back(at_rest.size());
    const std::optional<Viscoelastic>& viscous = law_of(e).viscous;
    if (!viscous) continue;
    const std::size_t each = viscous->memory();
    at_rest.resize(at_rest.size() + kPoints * each);
    for (std::size_t q = 0; q < kPoints; ++q) viscous->forget(at_rest.data() + memory_of(e, q));
  }
  memory.begin(std::move(at_rest));
}

template <class E>
void KernelOf<E>::gather(std::span<double> to, double sign) const {
  const std::size_t nodes = mesh_.node.size();
  parallel_for(static_cast<std::ptrdiff_t>(nodes), [&](std::ptrdiff_t i) {
    const auto n = static_cast<std::size_t>(i);
    std::array<double, D> sum{};
    for (std::size_t s = first_[n]; s < first_[n + 1]; ++s)
      for (std::size_t d = 0; d < D; ++d) sum[d] += element_force_[slot_[s] * D + d];
    for (std::size_t d = 0; d < D; ++d) to[d * nodes + n] = sign * sum[d];
  });
}

/// Forces and energies of all elements; the first one that the law says nothing of.
template <class E>
std::optional<std::size_t> KernelOf<E>::sweep(std::span<const double> u) {
  std::vector<std::size_t> wrong(pieces_.size());
  parallel_for(static_cast<std::ptrdiff_t>(pieces_.size()), [&](std::ptrdiff_t n) {
    const auto p = static_cast<std::size_t>(n);
    wrong[p] = sweep_piece(pieces_[p], u);
  });
  if (std::all_of(wrong.begin(), wrong.end(), [](std::size_t n) { return n == 0; })) return std::nullopt;
  for (std::size_t e = 0; e < mesh_.elements(); ++e)
    if (!std::isfinite(element_energy_[e])) return e;
  return std::nullopt;
}

/// Returns how many gradients the law says nothing of.
template <class E>
std::size_t KernelOf<E>::sweep_piece(const Piece& piece, std::span<const double> u) {
  std::array<double, kComponents * kPiece * kPoints> f_of, p_of;
  std::array<double, kPiece * kPoints> energy;
  std::array<double*, kComponents> f, p;
  for (std::size_t c = 0; c < kComponents; ++c) {
    f[c] = f_of.data() + c * kPiece * kPoints;
    p[c] = p_of.data() + c * kPiece * kPoints;
  }
  const std::size_t count = (piece.end - piece.begin) * kPoints;
  for (std::size_t n = piece.begin, at = 0; n < piece.end; ++n) {
    const Nodal moved = nodal(u, order_[n]);
    for (std::size_t q = 0; q < kPoints; ++q, ++at) {
      const Tensor gradient_here = gradient(moved, order_[n], q);
      for (int r = 0; r < D; ++r)
        for (int s = 0; s < D; ++s) f[static_cast<std::size_t>(D * r + s)][at] = gradient_here(r, s);
    }
  }
  const ElementLaw& law = laws[piece.material];
  std::size_t unanswered = 0;
  if (law.viscous) {
    for (std::size_t n = piece.begin, at = 0; n < piece.end; ++n, at += kPoints)
      respond(law, order_[n], at, f, p, energy.data());
    for (std::size_t at = 0; at < count; ++at) unanswered += std::isfinite(energy[at]) ? 0 : 1;
  } else {
    unanswered = law.local.stress(law.kinematics, count, f.data(), p.data(), energy.data());
  }
  for (std::size_t n = piece.begin, at = 0; n < piece.end; ++n, at += kPoints) {
    const std::size_t e = order_[n];
    element_energy_[e] = 0;
    for (std::size_t q = 0; q < kPoints; ++q) element_energy_[e] += weight_[e * kPoints + q] * energy[at + q];
    const bool selective = law.mean && dilatation == Dilatation::selective;
    if (law.mean && !selective) add_mean(law, e, at, f, p);
    Nodal force = selective ? add_selective(law, e, nodal(u, e)) : Nodal::Zero();
    for (std::size_t q = 0; q < kPoints; ++q) {
      Tensor stress;
      for (int c = 0; c < D * D; ++c) stress(c / D, c % D) = p[static_cast<std::size_t>(c)][at + q];
      force += weight_[e * kPoints + q] * slopes(e, q) * stress.transpose();
    }
    for (int a = 0; a < N; ++a)
      for (int d = 0; d < D; ++d)
        element_force_[(e * kNodes + static_cast<std::size_t>(a)) * D + static_cast<std::size_t>(d)] =
            force(a, d);
  }
  return unanswered;
}

/// Stresses and energies of an element that relaxes, whose gradients begin at `at`; keeps what its points
/// will remember.
template <class E>
void KernelOf<E>::respond(const ElementLaw& law, std::size_t e, std::size_t at,
                          const std::array<double*, kComponents>& f,
                          const std::array<double*, kComponents>& p, double* energy) {
  for (std::size_t q = 0; q < kPoints; ++q) {
    Tensor here;
    for (int c = 0; c < D * D; ++c) here(c / D, c % D) = f[static_cast<std::size_t>(c)][at + q];
    const std::size_t memory_at = memory_of(e, q);
    const ElementLaw::Step step = step_of(e, q);
    const Eigen::Matrix3d whole = law.template in_space<D>(here, step);
    const Tensor stress = law.template viscous_stress<D>(here, whole, step);
    for (int c = 0; c < D * D; ++c) p[static_cast<std::size_t>(c)][at + q] = stress(c / D, c % D);
    energy[at + q] =
        law.viscous->remember(memory.start() + memory_at, memory.elapsed(), whole, memory.last() + memory_at);
    if (!stress.allFinite()) energy[at + q] = std::numeric_limits<double>::quiet_NaN();
  }
}

/// Adds what U gives to the stresses of an element, whose gradients begin at `at`, and to its energy: with
/// the projected J, the integral of U and the projected U' times J F^-T.
template <class E>
void KernelOf<E>::add_mean(const ElementLaw& law, std::size_t e, std::size_t at,
                           const std::array<double*, kComponents>& f,
                           const std::array<double*, kComponents>& p) {
  std::array<Tensor, kPoints> g;
  PerPoint j{}, pressure{};
  for (std::size_t q = 0; q < kPoints; ++q) {
    Tensor here;
    for (int c = 0; c < D * D; ++c) here(c / D, c % D) = f[static_cast<std::size_t>(c)][at + q];
    g[q] = cofactor<D>(here);
    j[q] = here.determinant();
  }
  j = projected(e, j);
  double second = 0;
  for (std::size_t q = 0; q < kPoints; ++q)
    element_energy_[e] += weight_[e * kPoints + q] * volume_energy(*law.mean, j[q], pressure[q], second);
  pressure = projected(e, pressure);
  for (std::size_t q = 0; q < kPoints; ++q)
    for (int c = 0; c < D * D; ++c)
      p[static_cast<std::size_t>(c)][at + q] += pressure[q] * g[q](c / D, c % D);
}

/// Adds V U, of the J of the mean gradient, to the energy of an element; returns the force of it.
template <class E>
typename KernelOf<E>::Nodal KernelOf<E>::add_selective(const ElementLaw& law, std::size_t e,
                                                       const Nodal& moved) {
  const Tensor f = mean_gradient(moved, e);
  double first = 0, second = 0;
  element_energy_[e] += volume_[e] * volume_energy(*law.mean, f.determinant(), first, second);
  return volume_[e] * first * mean_slope_[e] * cofactor<D>(f).transpose();
}

/// Values at quadrature points fitted by the modes, least squares over the element.
template <class E>
typename KernelOf<E>::PerPoint KernelOf<E>::projected(std::size_t e, const PerPoint& values) const {
  PerPoint fit{};
  for (int m = 0; m < modes_; ++m) {
    double c = 0;
    for (std::size_t q = 0; q < kPoints; ++q) c += weight_[e * kPoints + q] * mode(e, q, m) * values[q];
    for (std::size_t q = 0; q < kPoints; ++q) fit[q] += c * mode(e, q, m);
  }
  return fit;
}

/// The J that U is taken of.
template <class E>
typename KernelOf<E>::PerPoint KernelOf<E>::dilatations(const Nodal& moved, std::size_t e) const {
  PerPoint j{};
  if (dilatation == Dilatation::selective) {
    j.fill(mean_gradient(moved, e).determinant());
    return j;
  }
  for (std::size_t q = 0; q < kPoints; ++q) j[q] = gradient(moved, e, q).determinant();
  return projected(e, j);
}

/// Rows and columns: nodes, and within them directions.
template <class E>
typename KernelOf<E>::Stiffness KernelOf<E>::stiffness(std::span<const double> u, std::size_t e) const {
  const ElementLaw& law = law_of(e);
  const Nodal moved = nodal(u, e);
  PerPoint pressure{}, second{};  // U' and U''
  if (law.mean) {
    const PerPoint j = dilatations(moved, e);
    for (std::size_t q = 0; q < kPoints; ++q) volume_energy(*law.mean, j[q], pressure[q], second[q]);
    pressure = projected(e, pressure);
  }
  Stiffness k = Stiffness::Zero();
  Eigen::Matrix<double, kDofs, D + 1> sum =
      Eigen::Matrix<double, kDofs, D + 1>::Zero();  // q of eq. (16), by mode
  PerMode stiffer = PerMode::Zero();                // U'', by modes
  Eigen::Matrix<double, D * D, kDofs> b = Eigen::Matrix<double, D * D, kDofs>::Zero();
  const auto set_slopes = [&b](const auto& slope) {
    for (int a = 0; a < N; ++a)
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < D; ++j) b(D * i + j, D * a + i) = slope(a, j);
  };
  // The tangent of J F^-T at a point, which goes into q there.
  const auto dilate = [&](const Tensor& f, std::size_t q, double w) {
    const Tensor g = f.inverse().transpose();
    const auto flat_g = flat<D>(g);
    const Eigen::Matrix<double, kDofs, 1> pull = w * b.transpose() * flat<D>(cofactor<D>(f));
    for (int m = 0; m < modes_; ++m) sum.col(m) += mode(e, q, m) * pull;
    return typename ResponseIn<D>::Tangent(
        f.determinant() * (flat_g * flat_g.transpose() + derivative_of_inverse_transpose<D>(g)));
  };
  const bool selective = law.mean && dilatation == Dilatation::selective;
  for (std::size_t q = 0; q < kPoints; ++q) {
    const double w = weight_[e * kPoints + q];
    set_slopes(slopes(e, q));
    const Tensor f = gradient(moved, e, q);
    typename ResponseIn<D>::Tangent tangent = law.template respond<D>(f, step_of(e, q)).tangent;
    if (law.mean && !selective) tangent += pressure[q] * dilate(f, q, w);
    k.noalias() += w * b.transpose() * (tangent * b).eval();
    for (int m = 0; law.mean && m < modes_; ++m)
      for (int n = 0; n < modes_; ++n) stiffer(m, n) += w * second[q] * mode(e, q, m) * mode(e, q, n);
  }
  if (selective) {
    set_slopes(mean_slope_[e]);
    const double w = volume_[e];
    k += w * pressure[0] * b.transpose() * (dilate(mean_gradient(moved, e), 0, w) * b).eval();
  }
  if (law.mean) k += sum * stiffer * sum.transpose();
  return 0.5 * (k + k.transpose());
}

// ---- what is shown ----

/// Deformation gradient, stress P and energy density of a quadrature point, in space.
struct PointState {
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity(), stress = Eigen::Matrix3d::Zero();
  double energy = 0;

  /// Equivalent of the Cauchy stress.
  [[nodiscard]] double mises() const {
    const Eigen::Matrix3d cauchy = stress * f.transpose() / f.determinant();
    const Eigen::Matrix3d deviator = cauchy - cauchy.trace() / 3 * Eigen::Matrix3d::Identity();
    return std::sqrt(1.5) * deviator.norm();
  }
};

template <int D>
PointState point_state(const ElementLaw& law, const Eigen::Matrix<double, D, D>& f, double mean_j,
                       const double* past, double elapsed) {
  const ElementLaw::Step step = law.step(past, elapsed);
  PointState state;
  state.f = law.in_space<D>(f, step);
  if (law.kinematics == Kinematics::plane_stress) {
    const ResponseIn<D> response = law.respond<D>(f, step);
    state.stress.template topLeftCorner<D, D>() = response.stress;
    state.energy = law.energy(response.energy, state.f, past, elapsed);
    return state;
  }
  const Response response = law.viscous ? law.viscous->solid(state.f, step) : law.local.solid(state.f);
  state.stress = response.stress;
  state.energy = law.energy(response.energy, state.f, past, elapsed);
  if (!law.mean) return state;
  double first = 0, second = 0;
  state.energy += volume_energy(*law.mean, mean_j, first, second);
  state.stress += first * cofactor<3>(state.f);
  return state;
}

template <class E>
std::vector<ModelField> KernelOf<E>::fields(std::span<const double> u) const {
  const std::size_t nodes = mesh_.node.size();
  std::vector<ModelField> fields{{"strain_energy_density", 1, std::vector<double>(nodes), "J/m^3"},
                                 {"nominal_stress", 9, std::vector<double>(9 * nodes), "Pa"},
                                 {"deformation_gradient", 9, std::vector<double>(9 * nodes), ""},
                                 {"mises_stress", 1, std::vector<double>(nodes), "Pa"}};
  std::vector<double> weights(nodes, 0.0);
  const auto rule = E::rule();
  for (std::size_t e = 0; e < mesh_.elements(); ++e) {
    const Nodal moved = nodal(u, e);
    const PerPoint j = dilatations(moved, e);
    for (std::size_t q = 0; q < kPoints; ++q) {
      const ElementLaw& law = law_of(e);
      const PointState state = point_state<D>(law, gradient(moved, e, q), j[q],
                                              memory.start() + memory_of(e, q), memory.elapsed());
      const double mises = state.mises();
      const auto value = E::at(rule[q].at).value;
      for (int a = 0; a < N; ++a) {
        const std::size_t node = mesh_.nodes(e)[static_cast<std::size_t>(a)];
        const double w = weight_[e * kPoints + q] * value(a) * value(a);
        weights[node] += w;
        fields[0].values[node] += w * state.energy;
        for (int c = 0; c < 9; ++c) {
          const std::size_t at = 9 * node + static_cast<std::size_t>(c);
          fields[1].values[at] += w * state.stress(c / 3, c % 3);
          fields[2].values[at] += w * state.f(c / 3, c % 3);
        }
        fields[3].values[node] += w * mises;
      }
    }
  }
  for (ModelField& field : fields)
    for (std::size_t n = 0; n < field.values.size(); ++n)
      field.values[n] /= weights[n / static_cast<std::size_t>(field.components)];
  return fields;
}

}  // namespace

std::unique_ptr<ElementKernel> make_element_kernel(const MeshBody& mesh, std::vector<ElementLaw> laws,
                                                   Dilatation dilatation) {
  return with_element(mesh.shape, [&]<class E>(E) -> std::unique_ptr<ElementKernel> {
    return std::make_unique<KernelOf<E>>(mesh, std::move(laws), dilatation);
  });
}

}  // namespace riven
