#include "input/crack_probe_format.hpp"

namespace riven {

using kind::Integer;
using kind::Quantity;

const std::vector<std::string>& crack_probe_kinds() {
  static const std::vector<std::string> kinds{"crack-length", "crack-area",  "crack-speed", "crack-tip",
                                              "branches",     "crack-angle", "fragments"};
  return kinds;
}

std::vector<Key> crack_probe_keys(ProbeInput& p) {
  const auto kinds = [&p](std::vector<std::string> among) { return When{"kind", &p.kind, std::move(among)}; };
  return {
      Key{"damage", Quantity{&p.damage, dimension::none, fraction},
          "The share of its bonds that a point of a crack has lost; unless given what a straight crack "
          "takes from a point 3/4 of a spacing away, 0.34 at 3 dx."}
          .applies(kinds({"crack-length", "crack-speed", "crack-tip", "branches", "crack-angle"})),
      Key{"over", Quantity{&p.over, dimension::time, positive},
          "The last so much time, whose lengths make the speed; a twentieth of the run unless given."}
          .applies(kinds({"crack-speed"})),
      Key{"length", Quantity{&p.length, dimension::length, positive},
          "Branches: what is shorter does not count, two horizons unless given. Angle: the part of the "
          "crack from its beginning that is looked at, without the first horizon; all of it unless given."}
          .applies(kinds({"branches", "crack-angle"})),
      Key{"least", Integer{&p.least, 1},
          "Points of the smallest fragment that counts: fewer are dust from the faces of cracks."}
          .applies(kinds({"fragments"}))
          .otherwise("4")};
}

void check_crack_probe(const ProbeInput& probe, const Case& c, const Check& check) {
  if (probe.kind == "crack-speed" && !c.solver.in_time())
    check.fail("kind",
               "a speed needs a run in time, such as by the solver \"verlet\"; expected \"crack-length\"");
}

}  // namespace riven
