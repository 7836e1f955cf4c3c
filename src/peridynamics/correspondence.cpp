#include "peridynamics/correspondence.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/lanes.hpp"
#include "base/parallel.hpp"

namespace riven {

namespace {

constexpr std::size_t kPiece = 256;  // points that a thread takes at a time

Kinematics kinematics(int dimension, Plane plane) {
  if (dimension == 3) return Kinematics::solid;
  return plane == Plane::stress ? Kinematics::plane_stress : Kinematics::plane_strain;
}

void check(const Body& body) {
  if (body.dimension == 1)
    throw InputError(
        "the model \"correspondence\" has two or three dimensions; expected kind = \"pmb\" in one");
  if (!body.defects.inclusions.empty())
    throw InputError("the model \"correspondence\" has no rigid inclusions; expected holes and cracks only");
}

void check(const Material& material, Kinematics kinematics) {
  if (material.incompressible() && kinematics != Kinematics::plane_stress)
    throw InputError(fmt::format(
        "the material \"{}\" keeps its volume, so that its pressure does not follow from the deformation; "
        "expected a bulk_modulus, or plane stress in two dimensions",
        material.name));
}

std::vector<Material> materials(const CorrespondenceSettings& settings) {
  std::vector<Material> all{settings.material};
  all.insert(all.end(), settings.further.begin(), settings.further.end());
  return all;
}

template <int D>
double determinant(const GradientRows& f, std::size_t n) {
  if constexpr (D == 2) {
    return f[0][n] * f[3][n] - f[1][n] * f[2][n];
  } else {
    return f[0][n] * (f[4][n] * f[8][n] - f[5][n] * f[7][n]) -
           f[1][n] * (f[3][n] * f[8][n] - f[5][n] * f[6][n]) +
           f[2][n] * (f[3][n] * f[7][n] - f[4][n] * f[6][n]);
  }
}

/// Whether all of n gradients keep the orientation of space.
template <int D>
bool oriented(const GradientRows& f, std::size_t n) {
  bool all = true;
  for (std::size_t i = 0; i < n; ++i) all = all && determinant<D>(f, i) > 0;
  return all;
}

constexpr double kCrushed = 0.05;  // determinant of F below which a damaged family is debris

/// Room for the gradients, stresses and energies of some points.
template <std::size_t kPoints>
struct Batch {
  GradientRows f{}, p{};
  double energy[kPoints];
  double numbers[18][kPoints];

  Batch() {
    for (std::size_t c = 0; c < 9; ++c) {
      f[c] = numbers[c];
      p[c] = numbers[9 + c];
    }
  }
};

}  // namespace

Correspondence::Correspondence(Body body, CorrespondenceSettings settings)
    : BreakingModel(std::move(body), densities(materials(settings))), settings_(std::move(settings)) {
  const Body& on = Correspondence::body();
  check(on);
  for (const Material& material : materials(settings_)) {
    laws_.push_back({material, kinematics(on.dimension, settings_.plane)});
    check(material, laws_.back().kinematics);
    in_dimension([&]<int D>(std::integral_constant<int, D>) {
      const auto rest = laws_.back().respond<D>(Eigen::Matrix<double, D, D>::Identity());
      rest_.push_back({rest.tangent(0, 0), rest.tangent(1, 1)});
    });
    stiffest_ = std::max(stiffest_, rest_.back().longitudinal);
  }
  kernels_ = correspondence_kernels(on.dimension);
  volume_ = on.volume;
  for (const GhostPoint& ghost : on.ghosts) volume_[ghost.point] = volume_[ghost.master];
  find_shapes();
  if (settings_.stabilisation == Stabilisation::bond_associated)
    make_bonds();
  else if (const LatticeBonds* lattice = on.on_lattice())
    make_lattice(*lattice);
  else
    make_list(std::get<ListedBonds>(on.bonds));
}

void Correspondence::limits_set() {
  if (settings_.stabilisation == Stabilisation::bond_associated)
    throw InputError(
        "bonds of the variant \"bond-associated\" do not break; expected variant = "
        "\"stabilised\", or no limits of stretch");
}

/// `trace` of K (m^5), `weights`: sum of omega V (m^3).
double Correspondence::spring_of(std::size_t point, double trace, double weights) const {
  const int dimension = body().dimension;
  const Rest& rest = rest_[body().material_of(point)];
  if (settings_.stabilisation == Stabilisation::bond_associated) return 0;
  if (settings_.stabilisation == Stabilisation::energy)
    return settings_.factor * 4.0 / 3 * rest.shear * dimension / trace;
  // G C / omega_0, as published: numbers in SI units, though the unit is one of N/m^9 instead of N/m^7.
  const double bulk = rest.longitudinal - 2 * rest.shear * (dimension - 1) / dimension;
  const double horizon = body().horizon;
  const double c = dimension == 3 ? 18 * bulk / (std::numbers::pi * std::pow(horizon, 4))
                                  : 12 * bulk / (std::numbers::pi * body().thickness * std::pow(horizon, 3));
  return settings_.factor * c / weights;
}

void Correspondence::find_shapes() {
  const int dimension = body().dimension;
  shape_.assign(static_cast<std::size_t>(dimension * (dimension + 1) / 2),
                std::vector<double>(body().size(), 0.0));
  for (auto* values : {&spring_, &whole_weight_, &whole_trace_}) values->assign(body().size(), 0.0);
  share_.assign(body().size(), 1.0);
  for (const std::size_t i : body().points) {
    find_shape(i);
    if (shape_[0][i] == 0) ++loose_;
  }
}

/// K^-1, s and the share of the energy from the bonds that a point has.
void Correspondence::find_shape(std::size_t point) {
  const int dimension = body().dimension;
  Eigen::Matrix3d whole = Eigen::Matrix3d::Zero();
  double weights = 0;
  int bonds = 0;
  for_each_bond(point, [&](std::size_t, const Eigen::Vector3d& xi, double weight) {
    whole += weight * xi * xi.transpose();
    weights += weight;
    ++bonds;
  });
  const Eigen::MatrixXd k = whole.topLeftCorner(dimension, dimension);
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues();
  spring_[point] = 0;
  for (auto& component : shape_) component[point] = 0;
  if (times_crushed(point) > 0 || bonds <= dimension || !(values[dimension - 1] < kFlat * values[0])) return;
  const Eigen::MatrixXd inverse = k.inverse();
  for (int r = 0, c = 0; r < dimension; ++r)
    for (int s = r; s < dimension; ++s, ++c) shape_[static_cast<std::size_t>(c)][point] = inverse(r, s);
  if (whole_weight_[point] == 0) {
    whole_weight_[point] = weights;
    whole_trace_[point] = inverse.trace();
  }
  // A family's stiffness is as the share of its energy times tr K^-1.
  share_[point] = std::min(weights / whole_weight_[point], whole_trace_[point] / inverse.trace());
  spring_[point] = share_[point] * spring_of(point, k.trace(), weights);
}

void Correspondence::refit(std::span<const std::size_t> points) {
  for (const std::size_t i : points) {
    if (body().kind[i] == PointKind::body) find_shape(i);
    if (share_[i] < 1) damaged_ = true;
    if (!list_.points.empty()) list_.points[i].spring = spring_[i];
  }
  open_blocks(points, lattice_.blocks);
}

void Correspondence::make_lattice(const LatticeBonds& on) {
  for (std::size_t k = 0; k < on.stencil.size(); ++k)
    lattice_.stencil.push_back({on.stencil.shift[k], on.stencil.bond[k],
                                influence(settings_.influence, on.stencil.length[k], body().horizon)});
  const std::size_t blocks = body().size() / kLanes;
  for (std::size_t block = 0; block < blocks; ++block) lattice_.blocks.push_back(on.bonds.kind(block));
  lattice_.families.assign(blocks, 0);
  for (const std::size_t i : body().points)
    if (shape_[0][i] > 0) lattice_.families[i / kLanes] = 1;
  const double first = volume_[body().points.front()];
  if (std::all_of(body().points.begin(), body().points.end(),
                  [&](std::size_t i) { return volume_[i] == first; }))
    lattice_.uniform_volume = first;
  lattice_.masks = on.bonds.bytes().data();
  lattice_.volume = volume_.data();
  lattice_.spring = spring_.data();
  reply_.assign(static_cast<std::size_t>(body().dimension * body().dimension),
                std::vector<double>(body().size(), 0.0));
  for (std::size_t c = 0; c < shape_.size(); ++c) lattice_.shape[c] = shape_[c].data();
  for (std::size_t c = 0; c < reply_.size(); ++c) lattice_.reply[c] = reply_[c].data();
}

void Correspondence::make_list(const ListedBonds& list) {
  list_.points.resize(body().size());
  list_.weight.assign(list.begin.back() + kLanes, 0.0);
  for (std::size_t i = 0; i < body().size(); ++i) {
    list_.points[i].x = list.position[i];
    list_.points[i].spring = spring_[i];
    const Eigen::Vector3d x(list.position[i].data());
    for (std::size_t b = list.begin[i]; b < list.begin[i + 1]; ++b) {
      const std::size_t j = list.neighbour[b];
      const double length = (Eigen::Vector3d(list.position[j].data()) - x).norm();
      list_.weight[b] = influence(settings_.influence, length, body().horizon) * volume_[j];
    }
  }
  list_.begin = list.begin.data();
  list_.neighbour = list.neighbour.data();
  list_.masks = list.masks.data();
  list_.volume = volume_.data();
  list_.spring = spring_.data();
  reply_.assign(static_cast<std::size_t>(body().dimension * body().dimension),
                std::vector<double>(body().size(), 0.0));
  for (std::size_t c = 0; c < shape_.size(); ++c) list_.shape[c] = shape_[c].data();
  for (std::size_t c = 0; c < reply_.size(); ++c) list_.reply[c] = reply_[c].data();
}

/// Numbers the directed bonds of body points with a family, and lists those that end on each point.
void Correspondence::make_bonds() {
  first_bond_.assign(body().size() + 1, 0);
  first_incoming_.assign(body().size() + 2, 0);
  std::vector<std::uint32_t> ends;
  for (std::size_t i = 0; i < body().size(); ++i) {
    if (shape_[0][i] > 0)
      body().for_each_neighbour(i, [&](std::size_t j) {
        ends.push_back(static_cast<std::uint32_t>(j));
        ++first_incoming_[j + 2];
      });
    first_bond_[i + 1] = ends.size();
  }
  for (std::size_t i = 2; i < first_incoming_.size(); ++i) first_incoming_[i] += first_incoming_[i - 1];
  incoming_.resize(ends.size());
  for (std::size_t b = 0; b < ends.size(); ++b)
    incoming_[first_incoming_[ends[b] + 1]++] = static_cast<std::uint32_t>(b);
  first_incoming_.pop_back();
  pull_.resize(ends.size());
}

/// Marks damaged families that are crushed, and takes them for undeformed, which has no stress and no energy.
template <int D>
void Correspondence::find_crushed(std::size_t begin, std::size_t end, const GradientRows& f) {
  for_each_row(begin, end, [&](std::size_t i, std::size_t row) {
    if (share_[i] == 1) return;
    const bool is_crushed = !(determinant<D>(f, row) >= kCrushed);
    crushed()[i] = is_crushed && times_crushed(i) == 0 ? 1 : 0;
    if (!is_crushed) return;
    for (std::size_t c = 0; c < D * D; ++c) f[c][row] = c % (D + 1) == 0 ? 1 : 0;
  });
}

void Correspondence::find_crushed(std::size_t begin, std::size_t end, const GradientRows& f) {
  if (!damaged_) return;
  in_dimension([&]<int D>(std::integral_constant<int, D>) { find_crushed<D>(begin, end, f); });
}

/// Stresses and energies of the rows that the kernels make of [begin, end), by the law of each row's material
/// and to the share that its family has left. False where a law says nothing.
template <class Law>
bool Correspondence::respond(const std::vector<Law>& laws, std::size_t begin, std::size_t end,
                             std::size_t rows, const GradientRows& f, const GradientRows& p,
                             double* energy) const {
  if (laws.size() == 1 && !damaged_) return laws.front().stress(rows, f.data(), p.data(), energy) == 0;
  std::array<std::size_t, kPiece> point{};
  for_each_row(begin, end, [&](std::size_t i, std::size_t row) { point[row] = i; });
  const auto components = static_cast<std::size_t>(body().dimension * body().dimension);
  bool sound = true;
  for (std::size_t first = 0, last = 0; first < rows; first = last) {
    const std::size_t material = body().material_of(point[first]);
    while (last < rows && body().material_of(point[last]) == material) ++last;
    GradientRows run_f{}, run_p{};
    for (std::size_t c = 0; c < components; ++c) {
      run_f[c] = f[c] + first;
      run_p[c] = p[c] + first;
    }
    sound = laws[material].stress(last - first, run_f.data(), run_p.data(), energy + first) == 0 && sound;
  }
  for (std::size_t row = 0; row < rows; ++row) {
    energy[row] *= share_[point[row]];
    for (std::size_t c = 0; c < components; ++c) p[c][row] *= share_[point[row]];
  }
  return sound;
}

/// Two sweeps: the second one reads the replies that the first one made. False where a law says nothing.
template <class Bonds, class Law>
bool Correspondence::sweep(Bonds& bonds, const CorrespondenceSweeps<Bonds>& kernels,
                           const std::vector<Law>& laws) {
  std::atomic<bool> sound = true;
  parallel_pieces(
      body().size(),
      [&](std::size_t begin, std::size_t end) {
        Batch<kPiece> batch;
        const std::size_t n = kernels.deform(bonds, begin, end, batch.f);
        // Not where a bound asks what a linear law makes of some motion.
        if (std::is_same_v<Law, Constitution>) find_crushed(begin, end, batch.f);
        const bool turned = !(body().dimension == 2 ? oriented<2>(batch.f, n) : oriented<3>(batch.f, n));
        if (turned && std::is_same_v<Law, Constitution>) sound = false;
        if (!respond(laws, begin, end, n, batch.f, batch.p, batch.energy)) sound = false;
        kernels.reply(bonds, begin, end, batch.f, batch.p);
      },
      kPiece);
  parallel_pieces(list_.points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t c = 0; c < std::min<std::size_t>(8, reply_.size()); ++c)
        list_.points[i].reply[c] = reply_[c][i];
      if (reply_.size() == 9) list_.points[i].last_reply = reply_[8][i];
    }
  });
  parallel_pieces(
      body().size(), [&](std::size_t begin, std::size_t end) { kernels.pull(bonds, begin, end); }, kPiece);
  return sound;
}

/// Eq. (6a): each family pushes the ends of its bonds and keeps what it does to each; then every point
/// collects.
template <int D, class Law>
bool Correspondence::sweep_bonds(const std::vector<Law>& laws, std::span<const double> u,
                                 std::span<double> force) {
  using Tensor = Eigen::Matrix<double, D, D>;
  std::atomic<bool> sound = true;
  parallel_for(static_cast<std::ptrdiff_t>(body().points.size()), [&](std::ptrdiff_t number) {
    const Family<D> own = family<D>(body().points[static_cast<std::size_t>(number)], u);
    const auto gauges = this->gauges(own);
    const std::size_t n = gauges.size();
    std::vector<double> numbers((2 * D * D + 1) * n);
    GradientRows f{}, p{};
    for (std::size_t c = 0; c < D * D; ++c) {
      f[c] = numbers.data() + c * n;
      p[c] = numbers.data() + (D * D + c) * n;
      for (std::size_t k = 0; k < n; ++k)
        f[c][k] = gauges[k].f(static_cast<Eigen::Index>(c / D), static_cast<Eigen::Index>(c % D));
    }
    if (std::is_same_v<Law, Constitution> && !oriented<D>(f, n)) sound = false;
    if (laws[own.material].stress(n, f.data(), p.data(), numbers.data() + 2 * D * D * n) != 0) sound = false;
    Tensor q = Tensor::Zero();
    std::array<double, 3>* pulls = pull_.data() + first_bond_[own.point];
    for (std::size_t k = 0; k < n; ++k) {
      const auto xi = own.xi.col(static_cast<Eigen::Index>(k));
      Tensor stress;
      for (int c = 0; c < D * D; ++c)
        stress(c / D, c % D) = gauges[k].share * p[static_cast<std::size_t>(c)][k];
      const Eigen::Matrix<double, D, 1> along = stress * xi / xi.squaredNorm();
      q += stress - along * xi.transpose();
      for (int d = 0; d < D; ++d) pulls[k][static_cast<std::size_t>(d)] = own.volume * along[d];
    }
    const Tensor reply = own.volume * q * own.inverse_shape;
    for (std::size_t k = 0; k < n; ++k) {
      const auto bond = static_cast<Eigen::Index>(k);
      const Eigen::Matrix<double, D, 1> pull = own.weight[bond] * reply * own.xi.col(bond);
      for (int d = 0; d < D; ++d) pulls[k][static_cast<std::size_t>(d)] += pull[d];
    }
  });
  parallel_for(static_cast<std::ptrdiff_t>(body().size()), [&](std::ptrdiff_t number) {
    const auto i = static_cast<std::size_t>(number);
    for (std::size_t d = 0; d < D; ++d) {
      double sum = 0;
      for (std::size_t b = first_bond_[i]; b < first_bond_[i + 1]; ++b) sum += pull_[b][d];
      for (std::size_t n = first_incoming_[i]; n < first_incoming_[i + 1]; ++n) sum -= pull_[incoming_[n]][d];
      force[d * body().size() + i] = sum;
    }
  });
  return sound;
}

/// Shows the kernels a state.
void Correspondence::look_at(std::span<const double> u) {
  const std::size_t size = body().size();
  const auto dimension = static_cast<std::size_t>(body().dimension);
  for (std::size_t d = 0; d < dimension; ++d) lattice_.u[d] = u.data() + d * size;
  parallel_pieces(list_.points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t d = 0; d < dimension; ++d) list_.points[i].u[d] = u[d * size + i];
  });
}

template <class Law>
bool Correspondence::force_by(const std::vector<Law>& laws, std::span<const double> u,
                              std::span<double> force) {
  if (settings_.stabilisation == Stabilisation::bond_associated)
    return in_dimension(
        [&]<int D>(std::integral_constant<int, D>) { return sweep_bonds<D>(laws, u, force); });
  look_at(u);
  for (std::size_t d = 0; d < static_cast<std::size_t>(body().dimension); ++d)
    lattice_.out[d] = list_.out[d] = force.data() + d * body().size();
  return body().on_lattice() != nullptr ? sweep(lattice_, kernels_.lattice, laws)
                                        : sweep(list_, kernels_.list, laws);
}

std::optional<Breakdown> Correspondence::internal_force(std::span<const double> u, std::span<double> force) {
  if (force_by(laws_, u, force)) return std::nullopt;
  return find_fault(u);
}

/// The first point whose gradient turns matter inside out, or is one that the law says nothing of.
std::optional<Breakdown> Correspondence::find_fault(std::span<const double> u) const {
  return in_dimension([&]<int D>(std::integral_constant<int, D>) -> std::optional<Breakdown> {
    for (const std::size_t i : body().points)
      for (const Gauge<D>& gauge : gauges(family<D>(i, u))) {
        if (share_[i] < 1 && gauge.f.determinant() < kCrushed) continue;
        const double j = gauge.f.determinant();
        if (!(j > 0))
          return Breakdown{body().position(i),
                           fmt::format("the deformation gradient of the point's {} has the "
                                       "determinant {:.3g}: points have moved through one another",
                                       gauge.bond < 0 ? "family" : "bonds", j)};
        if (!std::isfinite(laws_[body().material_of(i)].respond<D>(gauge.f).energy))
          return Breakdown{body().position(i),
                           "the material's law has no stress for the deformation of the point's family"};
      }
    return std::nullopt;
  });
}

/// Calls visit(point, row) for the points whose rows the kernels make of [begin, end).
template <class Visit>
void Correspondence::for_each_row(std::size_t begin, std::size_t end, const Visit& visit) const {
  std::size_t row = 0;
  for (std::size_t i = begin; i < end; ++i) {
    if (body().on_lattice() != nullptr && lattice_.families[i / kLanes] == 0) continue;
    visit(i, row++);
  }
}

double Correspondence::strain_energy(std::span<const double> u) {
  if (settings_.stabilisation == Stabilisation::bond_associated) {
    const std::vector<ModelField> of_points = fields(u);
    return ordered_sum_of(points(),
                          [&](std::size_t n) { return volume_[body().points[n]] * of_points[1].values[n]; });
  }
  look_at(u);
  return ordered_sum<double>(
      body().size(),
      [&](std::size_t begin, std::size_t end) {
        Batch<kPiece> batch;
        double rest[kPiece], energy = 0;
        const std::size_t n = body().on_lattice() != nullptr
                                  ? kernels_.lattice.measure(lattice_, begin, end, batch.f, rest)
                                  : kernels_.list.measure(list_, begin, end, batch.f, rest);
        find_crushed(begin, end, batch.f);
        respond(laws_, begin, end, n, batch.f, batch.p, batch.energy);
        for_each_row(begin, end, [&](std::size_t i, std::size_t row) {
          energy += body().volume[i] * (batch.energy[row] + 0.5 * spring_[i] * rest[row]);
        });
        return energy;
      },
      kPiece);
}

template <int D>
void Correspondence::for_each_gradient(
    std::size_t begin, std::size_t end, std::span<const double> u,
    const std::function<void(const Eigen::Matrix<double, D, D>&, std::size_t)>& visit) {
  if (settings_.stabilisation == Stabilisation::bond_associated) {
    for (std::size_t i = begin; i < end; ++i)
      for (const Gauge<D>& gauge : gauges(family<D>(i, u))) visit(gauge.f, body().material_of(i));
    return;
  }
  Batch<kPiece> batch;
  if (body().on_lattice() != nullptr) {
    kernels_.lattice.deform(lattice_, begin, end, batch.f);
  } else {
    kernels_.list.deform(list_, begin, end, batch.f);
  }
  find_crushed(begin, end, batch.f);
  for_each_row(begin, end, [&](std::size_t i, std::size_t row) {
    Eigen::Matrix<double, D, D> f;
    for (std::size_t c = 0; c < D * D; ++c)
      f(static_cast<Eigen::Index>(c / D), static_cast<Eigen::Index>(c % D)) = batch.f[c][row];
    visit(f, body().material_of(i));
  });
}

std::optional<Breakdown> Correspondence::inspect(std::span<const double> /*u*/) {
  return std::nullopt;
}

std::size_t Correspondence::bytes() const {
  return body().bytes() + 5 * volume_.size() * sizeof(double) +
         (shape_.size() + reply_.size()) * body().size() * sizeof(double) + lattice_.blocks.size() * 2 +
         list_.points.size() * sizeof(CorrespondencePoint) + list_.weight.size() * sizeof(double) +
         (first_bond_.size() + first_incoming_.size()) * sizeof(std::size_t) +
         incoming_.size() * sizeof(std::uint32_t) + pull_.size() * sizeof(pull_.front());
}

template void Correspondence::for_each_gradient<2>(
    std::size_t, std::size_t, std::span<const double>,
    const std::function<void(const Eigen::Matrix<double, 2, 2>&, std::size_t)>&);
template void Correspondence::for_each_gradient<3>(
    std::size_t, std::size_t, std::span<const double>,
    const std::function<void(const Eigen::Matrix<double, 3, 3>&, std::size_t)>&);
template bool Correspondence::force_by(const std::vector<Majorant<2>>&, std::span<const double>,
                                       std::span<double>);
template bool Correspondence::force_by(const std::vector<Majorant<3>>&, std::span<const double>,
                                       std::span<double>);

}  // namespace riven
