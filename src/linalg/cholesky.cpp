#include "linalg/cholesky.hpp"

#include <dmumps_c.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <vector>

// One BLAS or another is behind the factors; OpenBLAS with threads would use them as it likes.
extern "C" void openblas_set_num_threads(int threads) __attribute__((weak));
// Scotch orders with all cores, in another way each time, unless told not to; and it goes on with its random
// numbers, so that a second ordering would depend on the first.
extern "C" void SCOTCH_randomReset() __attribute__((weak));

namespace riven {

namespace {

// Numbers that MUMPS 5 gives to its jobs and settings; its user guide, sections 5 and 6.
constexpr int kStart = -1, kEnd = -2, kAnalyse = 1, kFactor = 2, kSolve = 3;
constexpr int kWorld = -987654;       // the communicator of a program without MPI
constexpr int kPositiveDefinite = 1;  // kind of symmetry: no pivoting
constexpr int kScotch = 3;            // ordering by nested dissection
constexpr int kMoreWorkspace = 30;    // per cent, over what the analysis foresees
constexpr int kWorkspaceTooSmall = -9;
constexpr int kMostWorkspace = 1000;
constexpr double kMegabyte = 1e6;

struct Free {
  void operator()(double* memory) const { std::free(memory); }
};
using AlignedBuffer = std::unique_ptr<double[], Free>;

/// Memory for n numbers, not set to anything.
AlignedBuffer aligned(std::size_t n) {
  constexpr std::size_t kAlignment = 64;
  const std::size_t bytes = (n * sizeof(double) + kAlignment - 1) / kAlignment * kAlignment;
  auto* memory = static_cast<double*>(std::aligned_alloc(kAlignment, bytes));
  if (memory == nullptr) throw std::bad_alloc();
  return AlignedBuffer(memory);
}

}  // namespace

struct SparseCholesky::Mumps {
  DMUMPS_STRUC_C id{};
  std::vector<MUMPS_INT> row, column;
  // Kept, as MUMPS would take new memory for every factorisation, and aligned, as BLAS rounds in another
  // order otherwise.
  AlignedBuffer workspace, right_side;

  int& control(int number) { return id.icntl[number - 1]; }
  [[nodiscard]] int info(int number) const { return id.infog[number - 1]; }
  void run(int job) {
    id.job = job;
    dmumps_c(&id);
  }
  /// What the analysis foresees, and some more.
  void reserve() {
    const double foreseen = id.info[7] < 0 ? -kMegabyte * id.info[7] : id.info[7];
    const auto millions = static_cast<MUMPS_INT>(foreseen * (1 + 0.01 * control(14)) / kMegabyte + 1);
    workspace = aligned(static_cast<std::size_t>(millions) * 1000000);
    id.wk_user = workspace.get();
    id.lwk_user = -millions;
  }
  void check(const char* what) const {
    if (info(1) >= 0) return;
    throw FactorFailure(
        fmt::format("{}: MUMPS gave up with code {} ({}){}", what, info(1), info(2),
                    info(1) == -13 ? ": not enough memory; dynamic relaxation takes less" : ""));
  }
};

SparseCholesky::SparseCholesky() : mumps_(std::make_unique<Mumps>()) {
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  setenv("SCOTCH_PTHREAD_NUMBER", "1", 1);  // NOLINT(concurrency-mt-unsafe): before any ordering
  mumps_->id.sym = kPositiveDefinite;
  mumps_->id.par = 1;
  mumps_->id.comm_fortran = kWorld;
  mumps_->run(kStart);
  mumps_->check("the sparse solver does not start");
  for (const int stream : {1, 2, 3}) mumps_->control(stream) = -1;  // no messages
  mumps_->control(4) = 0;
  mumps_->control(7) = kScotch;
  mumps_->control(14) = kMoreWorkspace;
}

SparseCholesky::~SparseCholesky() {
  mumps_->run(kEnd);
}

void SparseCholesky::analyse(const SymmetricMatrix& pattern) {
  Mumps& m = *mumps_;
  m.row.clear();
  m.column.clear();
  for (std::size_t i = 0; i < pattern.rows(); ++i)
    for (std::size_t k = pattern.begin[i]; k < pattern.begin[i + 1]; ++k) {
      m.row.push_back(static_cast<MUMPS_INT>(i + 1));
      m.column.push_back(pattern.column[k] + 1);
    }
  m.id.n = static_cast<MUMPS_INT>(pattern.rows());
  m.id.nnz = static_cast<MUMPS_INT8>(m.row.size());
  m.id.irn = m.row.data();
  m.id.jcn = m.column.data();
  m.workspace.reset();
  m.right_side = aligned(pattern.rows());
  if (pattern.rows() == 0) return;  // MUMPS knows no empty system
  if (SCOTCH_randomReset != nullptr) SCOTCH_randomReset();
  m.run(kAnalyse);
  m.check("no ordering for the tangent");
}

double SparseCholesky::flops() const {
  return mumps_->id.rinfog[0];
}

double SparseCholesky::bytes() const {
  return kMegabyte * mumps_->info(16);
}

bool SparseCholesky::factor(const SymmetricMatrix& matrix) {
  if (matrix.rows() == 0) return true;
  Mumps& m = *mumps_;
  m.id.a = const_cast<double*>(matrix.value.data());  // MUMPS reads it only
  if (!m.workspace) m.reserve();
  m.run(kFactor);
  while (m.info(1) == kWorkspaceTooSmall && m.control(14) < kMostWorkspace) {
    m.control(14) *= 2;
    m.reserve();
    m.run(kFactor);
  }
  constexpr int kSingular = -10, kNegativePivot = -40;
  if (m.info(1) == kSingular || m.info(1) == kNegativePivot) return false;
  m.check("no factors of the tangent");
  return m.info(12) == 0;  // negative pivots
}

void SparseCholesky::solve(std::span<double> x) {
  if (x.empty()) return;
  Mumps& m = *mumps_;
  std::copy(x.begin(), x.end(), m.right_side.get());
  m.id.rhs = m.right_side.get();
  m.run(kSolve);
  m.check("no solution");
  std::copy_n(m.right_side.get(), x.size(), x.begin());
}

}  // namespace riven
