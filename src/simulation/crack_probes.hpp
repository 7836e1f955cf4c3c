#pragma once

#include <map>
#include <optional>
#include <vector>

#include "base/snapshot.hpp"
#include "body/crack_paths.hpp"
#include "output/history.hpp"
#include "simulation/simulation.hpp"

namespace riven {

/// The probes that follow cracks and fragments (docs/theory/cracks.md). They read the bonds alone, and
/// remember the longest crack so far and, for its speed, the lengths of some time.
class CrackProbes {
 public:
  /// The simulation is at its start. Throws InputError for what a body of these dimensions does not have.
  explicit CrackProbes(const Simulation& simulation);

  [[nodiscard]] static bool is_one(const ProbeInput& probe);
  /// What a probe gives.
  static std::vector<HistoryColumn> columns(const ProbeInput& probe);

  /// Looks at the body as it is now; what follows belongs to this moment (stretch or s).
  void look(double parameter);
  /// Values of the case's probe of this number, a value per column.
  [[nodiscard]] std::vector<double> values(std::size_t probe) const;

  void save(Snapshot& to) const;
  void restore(const Snapshot& from);

 private:
  /// What a probe remembers of the moments before.
  struct Memory {
    double longest = 0;                // m
    std::vector<double> time, length;  // of the last moments (s, m)
  };
  /// The points that a probe looks at, and from which share of lost bonds on.
  struct View {
    std::string on;
    double damage = 0;
    auto operator<=>(const View&) const = default;
  };

  template <class Self, class Each>
  static void each_member(Self& self, const Each& each);
  void check(const ProbeInput& probe) const;
  [[nodiscard]] View view(const ProbeInput& probe) const;
  [[nodiscard]] std::vector<std::size_t> points(const std::string& on) const;
  [[nodiscard]] CrackPaths paths(const View& view) const;
  void remember(const ProbeInput& probe, double parameter, Memory& memory) const;
  [[nodiscard]] double speed(const Memory& memory) const;

  const Simulation& simulation_;
  double depth_ = 0;                      // of a flat crack (m)
  std::vector<double> before_, now_;      // share of lost bonds of each of the body's points
  std::map<View, CrackPaths> paths_;      // now
  std::map<std::size_t, Memory> memory_;  // by probe
};

}  // namespace riven
