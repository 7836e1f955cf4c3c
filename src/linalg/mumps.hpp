#pragma once

#include <fmt/format.h>
#include <mumps_c_types.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "linalg/factor_failure.hpp"
#include "linalg/symmetric_matrix.hpp"

// One BLAS or another is behind the factors; OpenBLAS with threads would use them as it likes.
extern "C" void openblas_set_num_threads(int threads) __attribute__((weak));
// Scotch orders with all cores, in another way each time, unless told not to; and it goes on with its random
// numbers, so that a second ordering would depend on the first.
extern "C" void SCOTCH_randomReset() __attribute__((weak));

namespace riven {

/// One sparse symmetric system in MUMPS, real or complex. `Id` and `Call` are its structure and entry point
/// for numbers of the kind `Number`. Only for what stands in src/linalg.
template <class Id, void (*Call)(Id*), class Number>
class Mumps {
 public:
  // Numbers that MUMPS 5 gives to its jobs and settings; its user guide, sections 5 and 6.
  static constexpr int kPositiveDefinite = 1;  // no pivoting
  static constexpr int kSymmetric = 2;
  static constexpr int kSingular = -10, kNegativePivot = -40;

  explicit Mumps(int symmetry) {
    if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
    setenv("SCOTCH_PTHREAD_NUMBER", "1", 1);  // NOLINT(concurrency-mt-unsafe): before any ordering
    id_.sym = symmetry;
    id_.par = 1;
    id_.comm_fortran = kWorld;
    run(kStart);
    check("the sparse solver does not start");
    for (const int stream : {1, 2, 3}) control(stream) = -1;  // no messages
    control(4) = 0;
    control(6) = 0;  // no permutation by values: an ordering is made once for all of them
    control(7) = kScotch;
    control(14) = kMoreWorkspace;
  }
  ~Mumps() { run(kEnd); }
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;

  void analyse(const SymmetricMatrix& pattern) {
    row_.clear();
    column_.clear();
    for (std::size_t i = 0; i < pattern.rows(); ++i)
      for (std::size_t k = pattern.begin[i]; k < pattern.begin[i + 1]; ++k) {
        row_.push_back(static_cast<MUMPS_INT>(i + 1));
        column_.push_back(pattern.column[k] + 1);
      }
    id_.n = static_cast<MUMPS_INT>(pattern.rows());
    id_.nnz = static_cast<MUMPS_INT8>(row_.size());
    id_.irn = row_.data();
    id_.jcn = column_.data();
    workspace_.reset();
    right_side_ = aligned(pattern.rows());
    if (pattern.rows() == 0) return;  // MUMPS knows no empty system
    if (SCOTCH_randomReset != nullptr) SCOTCH_randomReset();
    run(kAnalyse);
    check("no ordering for the tangent");
  }

  /// Factors the values, one per entry of the pattern. What went wrong is left in `info(1)`.
  void factor(const Number* values) {
    id_.a = reinterpret_cast<decltype(id_.a)>(const_cast<Number*>(values));  // MUMPS reads it only
    if (!workspace_) reserve();
    run(kFactor);
    while (info(1) == kWorkspaceTooSmall && control(14) < kMostWorkspace) {
      control(14) *= 2;
      reserve();
      run(kFactor);
    }
  }

  void solve(std::span<Number> x) {
    if (x.empty()) return;
    std::copy(x.begin(), x.end(), right_side_.get());
    id_.rhs = reinterpret_cast<decltype(id_.rhs)>(right_side_.get());
    run(kSolve);
    check("no solution");
    std::copy_n(right_side_.get(), x.size(), x.begin());
  }

  [[nodiscard]] int info(int number) const { return id_.infog[number - 1]; }
  [[nodiscard]] double flops() const { return id_.rinfog[0]; }
  [[nodiscard]] double bytes() const { return kMegabyte * info(16); }
  void check(const char* what) const {
    if (info(1) >= 0) return;
    throw FactorFailure(
        fmt::format("{}: MUMPS gave up with code {} ({}){}", what, info(1), info(2),
                    info(1) == -13 ? ": not enough memory; solvers without factors take less" : ""));
  }

 private:
  static constexpr int kStart = -1, kEnd = -2, kAnalyse = 1, kFactor = 2, kSolve = 3;
  static constexpr int kWorld = -987654;     // the communicator of a program without MPI
  static constexpr int kScotch = 3;          // ordering by nested dissection
  static constexpr int kMoreWorkspace = 30;  // per cent, over what the analysis foresees
  static constexpr int kWorkspaceTooSmall = -9;
  static constexpr int kMostWorkspace = 1000;
  static constexpr double kMegabyte = 1e6;

  struct Free {
    void operator()(Number* memory) const { std::free(memory); }
  };
  using AlignedBuffer = std::unique_ptr<Number[], Free>;

  /// Memory for n numbers, not set to anything.
  static AlignedBuffer aligned(std::size_t n) {
    constexpr std::size_t kAlignment = 64;
    const std::size_t bytes = (n * sizeof(Number) + kAlignment - 1) / kAlignment * kAlignment;
    auto* memory = static_cast<Number*>(std::aligned_alloc(kAlignment, bytes));
    if (memory == nullptr) throw std::bad_alloc();
    return AlignedBuffer(memory);
  }

  int& control(int number) { return id_.icntl[number - 1]; }
  void run(int job) {
    id_.job = job;
    Call(&id_);
  }
  /// What the analysis foresees, and some more.
  void reserve() {
    const double foreseen = id_.info[7] < 0 ? -kMegabyte * id_.info[7] : id_.info[7];
    const auto millions = static_cast<MUMPS_INT>(foreseen * (1 + 0.01 * control(14)) / kMegabyte + 1);
    workspace_ = aligned(static_cast<std::size_t>(millions) * 1000000);
    id_.wk_user = reinterpret_cast<decltype(id_.wk_user)>(workspace_.get());
    id_.lwk_user = -millions;
  }

  Id id_{};
  std::vector<MUMPS_INT> row_, column_;
  // Kept, as MUMPS would take new memory for every factorisation, and aligned, as BLAS rounds in another
  // order otherwise.
  AlignedBuffer workspace_, right_side_;
};

}  // namespace riven
