#include "solver/work.hpp"

namespace riven {

ParabolicWork::Sample ParabolicWork::sample(const Constraints& constraints, double parameter) {
  return {parameter,
          {constraints.offsets().begin(), constraints.offsets().end()},
          {constraints.forces().begin(), constraints.forces().end()}};
}

void ParabolicWork::begin(const Constraints& constraints, double parameter) {
  past_.assign(1, sample(constraints, parameter));
}

double ParabolicWork::since_last_call(const Constraints& constraints, double parameter) {
  Sample now = sample(constraints, parameter);
  const Sample& last = past_.back();
  // Weights of the force now, at the last sample and at the one before; trapezoidal while there is no such.
  double w_now = 0.5, w_last = 0.5, w_before = 0;
  if (past_.size() == 2) {
    const double h = now.parameter - last.parameter, k = last.parameter - past_.front().parameter;
    w_now = (2 * h + 3 * k) / (6 * (h + k));
    w_last = (h + 3 * k) / (6 * k);
    w_before = -h * h / (6 * k * (h + k));
  }
  double work = 0;
  for (std::size_t n = 0; n < now.offset.size(); ++n)
    work += (w_now * now.force[n] + w_last * last.force[n] + w_before * past_.front().force[n]) *
            (now.offset[n] - last.offset[n]);
  if (past_.size() == 2) past_.erase(past_.begin());
  past_.push_back(std::move(now));
  return work;
}

}  // namespace riven
