#pragma once

#include <string>

namespace riven {

/// A case that is read without complaint; tests change it line by line. Line 1 is the title.
inline const std::string static_case = R"case(title = "Membrane with a hole"

[geometry]
box = { size = ["0.5 m", "0.5 m"], thickness = "10 mm", spacing = "5 mm" }
horizon = "3 dx"

[[hole]]
disc = { radius = "80 mm" }

[set.core]
where = "sqrt(x^2 + y^2) < 100 mm"

[model]
kind = "membrane"
stabilisation = 4

[material.rubber]
law = "neo-hookean"
youngs_modulus = "0.109 GPa"

[[load]]
on = ["left", "right"]
displacement = ["(stretch - 1)*x", "free"]

[solver]
method = "dynamic-relaxation"
stretch = [1.5, 2, 2.5, 3]
tolerance = 1e-5

[output]
fields = ["displacement", "damage"]

[[probe]]
name = "force_x"
kind = "reaction"
on = "right"

[[expect]]
metric = "force_x"
value = "512 kN"
tolerance = "0.5 %"
at = 2
kind = "reference"
source = "finite elements"

[short]
set = ["solver.stretch=[1.5]"]
)case";

/// A run in time with what `static_case` does not use.
inline const std::string moving_case = R"case(title = "Bar that is pulled"
source = "A report, 2020, section 3"

[geometry]
box = { size = ["100 mm", "40 mm"], from = ["0 mm", "-20 mm"], thickness = "2 mm", points = [50, 20] }
horizon = "4 dx"

[[hole]]
box = { size = ["2 mm", "4 mm"], center = ["50 mm", 0] }

[[hole]]
box = { size = ["2 mm", "4 mm"], from = ["70 mm", 0] }

[[crack]]
from = [0, 0]
to = ["10 mm", 0]

[[inclusion]]
disc = { radius = "5 mm", center = ["30 mm", 0] }
motion = "fixed"

[[inclusion]]
disc = { radius = "5 mm", center = ["80 mm", 0] }

[set.ends]
where = "abs(x - 50 mm) > 50 mm - dx"

[set.patch]
box = { size = ["10 mm", "10 mm"] }

[set.round]
disc = { radius = "1 horizon", center = ["20 mm", 0] }

[material.rubber]
law = "yeoh"
density = "1.1 g/cm^3"
c10 = "0.2 MPa"
c20 = "17 kPa"

[[load]]
on = "ends"
displacement = ["0.1 m/s * t * sign(x - 50 mm)", 0]

[[load]]
on = ["patch", "top"]
displacement = ["free", "sin(20*x) * 5 mm"]

[solver]
method = "verlet"
until = "43 us"
step = "0.1 us"
safety = 0.7

[output]
every = "1 us"
history_every = "0.5 us"

[[probe]]
name = "corner"
kind = "displacement"
at = ["100 mm", "20 mm"]

[[probe]]
name = "lateral_stretch"
kind = "stretch"
from = [0, "-20 mm"]
to = [0, "20 mm"]

[[expect]]
metric = "displacement_corner_x"
min = "1 mm"
max = "2 mm"
at = "40 us"
kind = "published"

[[expect]]
field = "displacement"
file = "reference/bar.csv"
tolerance = 0.01
exclude_within = "1 horizon"
kind = "reference"

[short]
set = ["solver.until=10 us", "output.every=5 us"]

[[short.expect]]
metric = "displacement_corner_x"
value = 0
absolute_tolerance = "1 um"
kind = "reference"
)case";

}  // namespace riven
