#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace riven {

/// Replaces a vector by an operator's product with it.
using VectorMap = std::function<void(std::span<double>)>;

/// Solves A P^-1 y = b, x = P^-1 y by GMRES without restart (Saad and Schultz 1986): right-preconditioned, so
/// that the residual it makes small is that of A x = b itself. `x`: b on entry. Returns the number of
/// iterations, at the most `most`, after which the residual is below `tolerance` times b, or x the best
/// found. Sums are ordered: the same bits on any number of threads.
std::size_t gmres(const VectorMap& product, const VectorMap& precondition, double tolerance, std::size_t most,
                  std::span<double> x);

}  // namespace riven
