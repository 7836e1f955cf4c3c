#pragma once

#include <functional>
#include <limits>
#include <ostream>
#include <string>

#include "output/parameter.hpp"

namespace riven {

/// Where a run stands. What a solver does not have stays as it is here and is not shown.
struct ProgressState {
  Parameter parameter = Parameter::stretch;
  double value = 0;   // stretch, time (s) or cycle
  int load_step = 0;  // from 1; 0: the solver has none
  int load_steps = 0;
  bool step_done = false;  // this call ends a load step
  double fraction = 0;     // of the whole run that is done, 0 to 1: gives the time left
  double residual = std::numeric_limits<double>::quiet_NaN();
  long iterations = 0;                                              // of this load step, or time steps so far
  double balance_error = std::numeric_limits<double>::quiet_NaN();  // relative
};

/// Shows where a run stands: one line that is rewritten on a terminal; elsewhere plain lines, at most one
/// every two seconds and one for each finished load step.
class Progress {
 public:
  using Clock = std::function<double()>;  // seconds, from any origin
  using Width = std::function<int()>;     // characters per line of the terminal; 0: not a terminal

  /// On standard error, whatever that is.
  Progress();
  Progress(std::ostream& out, Width width, Clock clock);

  /// Cheap enough to be called after every iteration or time step.
  void update(const ProgressState& state);

  /// Counts the time that a resumed run has taken before (s).
  void add_elapsed(double seconds) { start_ -= seconds; }

  /// Takes the rewritten line away, so that a message can stand there; the next update brings it back.
  void clear();

  /// Leaves the last state on the screen and ends the line.
  void finish();

 private:
  void show(const ProgressState& state);

  std::ostream& out_;
  Width width_;
  Clock clock_;
  double start_;
  double last_shown_ = -std::numeric_limits<double>::infinity();
  ProgressState last_;
  bool pending_ = false;  // `last_` is not on the screen
  bool line_open_ = false;
};

/// "step 3/8, stretch 1.5, residual 2.1e-04, iteration 340, 0:12 elapsed, 0:31 left, energy balance 1e-06".
std::string progress_text(const ProgressState& state, double elapsed_s);

}  // namespace riven
