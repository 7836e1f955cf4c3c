#pragma once

#include <cstddef>
#include <vector>

namespace riven {

/// Runs `body(i)` for i in [0, n) on the threads of this run. `body` writes only what belongs to i, so
/// results do not depend on the number of threads.
template <class Body>
void parallel_for(std::ptrdiff_t n, const Body& body) {
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < n; ++i) body(i);
}

/// Length of the pieces in which long sums are made; fixed, so that the order of additions is.
inline constexpr std::size_t kSumChunk = 2048;

/// Runs `body(begin, end)` for pieces of [0, n), as `parallel_for` does.
template <class Body>
void parallel_pieces(std::size_t n, const Body& body, std::size_t piece = kSumChunk) {
  parallel_for(static_cast<std::ptrdiff_t>((n + piece - 1) / piece), [&](std::ptrdiff_t p) {
    const std::size_t begin = static_cast<std::size_t>(p) * piece;
    body(begin, begin + piece < n ? begin + piece : n);
  });
}

/// Sum over i in [0, n) of the values that `partial(begin, end)` returns for pieces of fixed length, added in
/// order: the same bits on any number of threads. `T` needs += and a default value that is zero.
template <class T, class Partial>
T ordered_sum(std::size_t n, const Partial& partial, std::size_t piece = kSumChunk) {
  std::vector<T> sums((n + piece - 1) / piece);
  parallel_pieces(
      n, [&](std::size_t begin, std::size_t end) { sums[begin / piece] = partial(begin, end); }, piece);
  T total{};
  for (const T& sum : sums) total += sum;
  return total;
}

/// Sum of a(i) over [0, n), in fixed order.
template <class Term>
double ordered_sum_of(std::size_t n, const Term& term) {
  return ordered_sum<double>(n, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += term(i);
    return sum;
  });
}

}  // namespace riven
