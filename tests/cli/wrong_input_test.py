"""Wrong input ends with 2 and one line that says where and what was expected; nothing is left on disk."""

import os
import pathlib
import random
import re
import unittest

from program import BLOCK, BLOCK_BOX, BOX, HOLE, IMPACT, MOVING, PLAIN, POINTS, ProgramTest, box_stl, lattice_csv, replaced, squares

EXPECT = """
[[expect]]
metric = "force_x"
value = "1 kN"
tolerance = "1 %"
at = 1.4
kind = "reference"
"""
FIELD = """
[[expect]]
field = "displacement"
file = "points.csv"
tolerance = "1 %"
kind = "reference"
"""
PMB = replaced(MOVING, 'law = "neo-hookean"', 'law = "linear-elastic"') + '\n[model]\nkind = "pmb"\n'
LPS = replaced(replaced(MOVING, 'law = "neo-hookean"', 'law = "linear-elastic"'), 'youngs_modulus = "6 MPa"',
               'youngs_modulus = "6 MPa"\npoissons_ratio = 0.3') + '\n[model]\nkind = "lps"\n'
CORRESPONDENCE = PLAIN + '\n[model]\nkind = "correspondence"\n'
STATIC_PMB = replaced(PLAIN, 'law = "neo-hookean"', 'law = "linear-elastic"') + '\n[model]\nkind = "pmb"\n'

SLABS = replaced(PMB, 'method = "verlet"', 'method = "space-time"')
BOND_MOVING = MOVING + '\n[model]\nkind = "membrane-bond"\nloading = "planar"\nvariant = "published"\n'
BOND = PLAIN + '\n[model]\nkind = "membrane-bond"\nloading = "planar"\nvariant = "published"\n'
SET = """
[set.{name}]
where = "{where}"
"""

TABLE = replaced(replaced(MOVING, "[geometry]", '[table.pull]\nfile = "pull.csv"\n\n[geometry]'),
                 '"1e4 /s^2 * x * t*t"', '"pull(t) * x / 0.1 m"')
STATIC_TABLE = replaced(replaced(PLAIN, "[geometry]", '[table.pull]\nfile = "steps.csv"\n\n[geometry]'),
                        '"(stretch - 1)*x"', '"pull(stretch) * x"')
CLOUD = replaced(PLAIN, BOX, POINTS)
FIELDS = replaced(replaced(PLAIN, 'on = ["left", "right", "bottom", "top"]', 'on = "all"'), 'on = "right"', 'on = "all"')
FIELDS = replaced(replaced(FIELDS + SET.format(name="all", where="x > -1 m"), "[material", '[field.part]\nfile = "rows.csv"\n\n[material'), "(stretch - 1)*x", "(stretch - 1)*part")
MESH = replaced(PLAIN, BOX, 'mesh = { file = "sheet.msh", unit = "mm", thickness = "10 mm" }')
POLYGON_KEY = 'polygon = [["20 mm", 0, 0], ["20 mm", "20 mm", 0], ["20 mm", "20 mm", "20 mm"], ["20 mm", 0, "20 mm"]]'
POLYGON = f"\n[[crack]]\n{POLYGON_KEY}\n"
CRACKED = HOLE + '\n[[crack]]\nfrom = ["60 mm", 0]\nto = ["70 mm", 0]\n'
SOLID = replaced(BLOCK, BLOCK_BOX, 'surface = { file = "block.stl", unit = "mm", spacing = "5 mm" }')

FREE = replaced(replaced(CLOUD, ', box = { size = ["0.2 m", "0.2 m"] }', ""), 'on = ["left", "right", "bottom", "top"]', 'on = "all"')
FREE = replaced(FREE, 'on = "right"', 'on = "all"') + SET.format(name="all", where="x > -1 m")

ELEMENTS = 'box = { size = ["0.2 m", "0.2 m"], thickness = "10 mm", elements = [4, 3] }'
MESHED = replaced(replaced(PLAIN, BOX, ELEMENTS), 'horizon = "3 dx"\n', "") + '\n[model]\nkind = "finite-elements"\n'
PUNCH = MESHED + ('\n[[impactor]]\nname = "punch"\nflat = { from = ["-50 mm", "101 mm"], to = ["50 mm", "101 mm"] }\n'
                  'displacement = [0, "(1 - stretch) * 10 mm"]\n')

# case, what is replaced, by what, the key's line as a fragment (the message must name its line), part of the message
MISTAKES = [
    ("elements for a membrane", MESHED, 'kind = "finite-elements"', 'kind = "membrane"', "[geometry]", 'expected [model] kind = "finite-elements"'),
    ("finite elements without a mesh", MESHED, ELEMENTS, BOX, "[geometry]", "needs a mesh"),
    ("one number of elements", MESHED, "[4, 3]", "[4]", "elements", "expected 2, one per direction"),
    ("elements of space in the plane", MESHED, ELEMENTS, ELEMENTS + '\nelement = "h8"', "element =", "expected one of q4, q8, t3"),
    ("a kind of element for points", PLAIN, 'horizon = "3 dx"', 'element = "q4"', "element =", "belongs to finite elements"),
    ("a horizon for elements", MESHED, ELEMENTS, ELEMENTS + '\nhorizon = "3 dx"', "horizon", "belongs to points"),
    ("a hole in a mesh", MESHED, "[solver]", '[[hole]]\ndisc = { radius = "1 cm" }\n\n[solver]', "[[hole]]", "has no holes"),
    ("a limit of elements", MESHED, 'density = "1100 kg/m^3"', 'density = "1100 kg/m^3"\ncritical_stretch = 1', "[material", "has no bonds that break"),
    ("another limit of elements", MESHED, 'density = "1100 kg/m^3"', 'density = "1100 kg/m^3"\ncritical_energy_density = "1 MPa"', "[material", "has no bonds that break"),
    ("a layer of elements", MESHED, 'displacement = ["(stretch - 1)*x", "(stretch - 1)*y"]', 'layer = "1 mm"\ntraction = ["1 MPa", 0]', "[[load]]", "has no layers of points"),
    ("damage of elements", MESHED, "[solver]", '[output]\nfields = ["damage"]\n\n[solver]', "[output]", 'has no field "damage"'),
    ("an overload of elements", MESHED, 'kind = "reaction"\non = "right"', 'kind = "overload"', "[[probe]]", 'has no "overload" to be followed'),
    ("a rubber without bulk modulus", MESHED, 'kind = "finite-elements"', 'kind = "finite-elements"\nplane = "strain"', "[model]", "expected a bulk_modulus"),
    ("a mean dilatation of a sheet", MESHED, 'kind = "finite-elements"', 'kind = "finite-elements"\ndilatation = "mean"', "[model]", "nothing locks"),
    ("edges that do not agree", MESHED, "[solver]", '[[load]]\non = "corner"\ndisplacement = ["1 mm", "free"]\n\n[set.corner]\nwhere = "x + y > 199 mm"\n\n[solver]', 'on = "corner"', "expected equal displacements"),
    ("an arch too deep", MESHED, ELEMENTS, 'arch = { span = "100 mm", rise = "50 mm", depth = "110 mm", thickness = "1 mm", elements = [40, 2] }', "arch", "twice the radius"),
    ("corners clockwise", MESHED, ELEMENTS, 'quadrilateral = { corners = [[0, 0], [0, "1 m"], ["1 m", "1 m"], ["1 m", 0]], thickness = "1 mm", elements = [4, 2] }', "corners", "counterclockwise"),
    ("a flat of no width", PUNCH, 'to = ["50 mm"', 'to = ["-50 mm"', "flat =", "two places"),
    ("a flat on points", IMPACT, "sphere = {", 'flat = { from = [0, 0, 0], to = ["1 mm", 0, 0] }\n# ', "flat =", 'belongs to the model "finite-elements"'),
    ("a flat the wrong way round", PUNCH, 'from = ["-50 mm", "101 mm"], to = ["50 mm", "101 mm"]', 'from = ["50 mm", "101 mm"], to = ["-50 mm", "101 mm"]',
     "[[impactor]]", "the body to the right of the way from"),
    ("an impactor that starts inside", PUNCH, "flat = {", 'sphere = { center = [0, 0], radius = "1 mm" }\n# ', "[[impactor]]", "no side of the mesh faces it"),
    ("a flat in the body", PUNCH, '"101 mm"], to = ["50 mm", "101 mm"', '"98 mm"], to = ["50 mm", "98 mm"', "[[impactor]]", "impactor punch: reaches 0.002"),
    ("a punch that is elsewhere at the start", PUNCH, "(1 - stretch)", "(2 - stretch)", "[[impactor]]", "at stretch 1 already"),
    ("a punch that moves both ways", PUNCH, "displacement = [0, \"(1", "velocity = [0, 0]\ndisplacement = [0, \"(1", "displacement", "velocity, displacement"),
    ("a punch of a speed in statics", PUNCH, 'displacement = [0, "(1 - stretch) * 10 mm"]', 'velocity = [0, "1 m/s"]', "velocity", "needs motion in time"),
    ("a punch along a path", PUNCH, 'method = "dynamic-relaxation"', 'method = "newton"\ncontrol = "arc-length"', "[[impactor]]", 'expected control = "load"'),
    ("a punch that is free in part", PUNCH, '[0, "(1 - stretch) * 10 mm"]', '["free", 0]', "displacement = [", 'has an entry "free"'),
    ("a punch with mass", PUNCH, 'name = "punch"', 'name = "punch"\nmass = "1 kg"', "mass", "belongs to peridynamic models"),
    ("an impactor of points that sticks", IMPACT, 'mass = "20 g"', 'mass = "20 g"\nsurface = "sticking"', "surface", 'belongs to the model "finite-elements"'),
    ("an impactor of points that is displaced", IMPACT, "velocity = [0, 0, \"10 m/s * (1 - cos(2*pi*t/20us))\"]", "displacement = [0, 0, 0]", "displacement",
     "expected velocity"),
    ("an impactor of points in statics", PLAIN, "[solver]", '[[impactor]]\nname = "ball"\nsphere = { center = [0, "1 m"], radius = "1 mm" }\n\n[solver]',
     "[[impactor]]", 'expected method = "verlet"'),
    ("titel", PLAIN, "title =", "titel =", "titel =", 'did you mean "title"?'),
    ("unknown key", PLAIN, 'horizon = "3 dx"', 'horizn = "3 dx"', "horizn", 'did you mean "horizon"?'),
    ("unknown table", PLAIN, "[solver]", "[slover]", "[slover]", 'did you mean "solver"?'),
    ("key of another table", PLAIN, 'horizon = "3 dx"', 'until = "1 s"', "until", '"until" belongs in [solver]'),
    ("key of another method", PLAIN, "stretch = [1.2, 1.4]", 'stretch = [2]\nuntil = "1 s"', "until", "verlet"),
    ("not TOML", PLAIN, "[solver]", "[solver", "[solver", "expected"),
    ("a key twice", PLAIN, 'horizon = "3 dx"', 'horizon = "3 dx"\nhorizon = "2 dx"', 'horizon = "2 dx"', "horizon"),
    ("no unit", PLAIN, 'thickness = "10 mm"', "thickness = 10", "box =", 'write "10 mm"'),
    ("another dimension", PLAIN, '"6 MPa"', '"6 mm"', "youngs_modulus", "expected a pressure"),
    ("unknown unit", PLAIN, '"6 MPa"', '"6 Mpa"', "youngs_modulus", 'unknown unit "Mpa"'),
    ("a unit that begins with 1", MOVING, "1e4 /s^2", "1e4 1/s^2", "displacement", 'write "1e4 /s^2"'),
    ("two numbers", MOVING, "1e4 /s^2", "1e4 2 /s^2", "displacement", "two numbers stand side by side"),
    ("negative", PLAIN, '"6 MPa"', '"-6 MPa"', "youngs_modulus", "above 0"),
    ("no number", PLAIN, '"6 MPa"', "nan", "youngs_modulus", "finite"),
    ("unknown law", PLAIN, '"neo-hookean"', '"neohookean"', "law =", 'did you mean "neo-hookean"?'),
    ("unknown method", PLAIN, '"dynamic-relaxation"', '"newtons"', "method =", "dynamic-relaxation, newton, verlet, space-time, generalised-alpha"),
    ("stretch to and fro", PLAIN, "[1.2, 1.4]", "[1.4, 1.2]", "stretch = [", "1.2 comes after 1.4"),
    ("a bracket", PLAIN, '"(stretch - 1)*x"', '"(stretch - 1*x"', "displacement", "parenthesis"),
    ("unknown variable", PLAIN, '"(stretch - 1)*x"', '"(strech - 1)*x"', "displacement", 'did you mean "stretch"?'),
    ("time in statics", PLAIN, '"(stretch - 1)*x"', '"1 m/s * t"', "displacement", '"t" is not known here'),
    ("one component", PLAIN, ', "(stretch - 1)*y"', "", "displacement", "expected 2"),
    ("unknown edge", PLAIN, '["left",', '["lefft",', "on = [", 'did you mean "left"?'),
    ("unknown probe", PLAIN, '"reaction"', '"force"', 'kind = "force"', "expected one of reaction"),
    ("horizon below the spacing", PLAIN, '"3 dx"', '"0.5 dx"', "horizon", "below the spacing"),
    ("an edge without points", PLAIN + '\n[[hole]]\nbox = { from = ["65 mm", "-0.2 m"], size = ["2 mm", "0.4 m"] }\n',
     '["65 mm", "-0.2 m"], size = ["2 mm", "0.4 m"]', '["65 mm", "-0.2 m"], size = ["0.2 m", "0.4 m"]', 'on = [',
     'lies within a horizon of the edge "right"'),
    ("a probe named as the first column", PLAIN, 'name = "force"', 'name = "stretch"', "[[probe]]", "heads a column of history.csv"),
    ("a loading misspelt", BOND, '"planar"', '"plannar"', "loading =", 'did you mean "planar"?'),
    ("no loading", BOND, 'loading = "planar"', "", "[model]", "model.loading: missing"),
    ("unknown variant", BOND, '"published"', '"printed"', "variant =", "expected one of published, zero-residual"),
    ("a loading of the other model", BOND, '"membrane-bond"', '"membrane"', "loading =",
     'does not apply here; it belongs to kind = "membrane-bond"'),
    ("stabilised bonds", BOND, 'variant = "published"', 'variant = "published"\nstabilisation = 4', "stabilisation =",
     'it belongs to kind = "membrane"'),
    ("bonds of another law", BOND, 'law = "neo-hookean"\nyoungs_modulus = "6 MPa"', 'law = "yeoh"\nc10 = "1 MPa"', "law =",
     'expected "neo-hookean"'),
    ("a field of the other model", BOND + '\n[output]\nfields = ["damage"]\n', '["damage"]', '["weight_minimum"]', "[output]",
     'the model "membrane-bond" has no field "weight_minimum"'),
    ("springs of rubber", MOVING + '\n[model]\nkind = "pmb"\n', 'kind = "pmb"', 'kind = "pmb"\nplane = "strain"', "[material.rubber]",
     'the model "pmb" has no law "neo-hookean"; expected "linear-elastic"'),
    ("linear rubber", PLAIN, 'law = "neo-hookean"', 'law = "linear-elastic"', "[material.rubber]",
     'the model "membrane" has no law "linear-elastic"; expected "neo-hookean"'),
    ("a compressible membrane", PLAIN, 'law = "neo-hookean"', 'law = "neo-hookean"\nbulk_modulus = "1 GPa"', "[material.rubber]",
     'the model "membrane" keeps its volume'),
    ("a law that no membrane has", PLAIN, 'law = "neo-hookean"\nyoungs_modulus = "6 MPa"',
     'law = "ogden"\nmoduli = ["1 MPa"]\nexponents = [2]', "[material.rubber]", 'the model "membrane" has no law "ogden"'),
    ("terms of two lengths", PLAIN, 'law = "neo-hookean"\nyoungs_modulus = "6 MPa"',
     'law = "ogden"\nmoduli = ["1 MPa"]\nexponents = [2, 3]', "exponents", "2 exponents and 1 moduli"),
    ("another Poisson's ratio", PMB, 'youngs_modulus = "6 MPa"', 'youngs_modulus = "6 MPa"\npoissons_ratio = 0.3', "[material.rubber]",
     'the model "pmb" has 0.3333 here'),
    ("springs that break when pressed", PMB, 'youngs_modulus = "6 MPa"', 'youngs_modulus = "6 MPa"\ncritical_stretch = -0.1',
     "critical_stretch", "expected a value above 0"),
    ("springs with stabilisation", PMB, 'kind = "pmb"', 'kind = "pmb"\nstabilisation = 4', "stabilisation",
     'it belongs to kind = "membrane"'),
    ("an inclusion in springs", PMB + '\n[[inclusion]]\ndisc = { radius = "30 mm" }\n', '"30 mm"', '"31 mm"', "[[inclusion]]",
     "has no rigid inclusions"),
    ("a solid without Poisson's ratio", LPS, "poissons_ratio = 0.3", "", "[material.rubber]",
     'poissons_ratio: missing; expected a number above -1 and below 0.5'),
    ("an incompressible linear solid", LPS, "poissons_ratio = 0.3", "poissons_ratio = 0.5", "poissons_ratio",
     'found 0.5; expected a value above -1 and below 0.5'),
    ("more than incompressible", LPS, "poissons_ratio = 0.3", "poissons_ratio = 0.6", "poissons_ratio",
     'found 0.6; expected a value above -1 and below 0.5'),
    ("two limits of one bond", LPS, "poissons_ratio = 0.3",
     'poissons_ratio = 0.3\ncritical_stretch = 0.1\ncritical_energy_release_rate = "1 J/m^2"',
     "critical_energy_release_rate", "expected one of both"),
    ("a stretch that no law reaches", LPS, "poissons_ratio = 0.3",
     'poissons_ratio = 0.3\ncritical_energy_release_rate = "1e30 J/m^2"', "[model]", "which no stretch below 1000 reaches"),
    ("an inclusion in a linear solid", LPS + '\n[[inclusion]]\ndisc = { radius = "30 mm" }\n', '"30 mm"', '"31 mm"', "[[inclusion]]",
     'the model "lps" has no rigid inclusions'),
    ("a solid of bonds along the axes", LPS, 'horizon = "3 dx"', 'horizon = "1 dx"', "[model]", "too few directions"),
    ("rubber without a pressure", CORRESPONDENCE, 'kind = "correspondence"', 'kind = "correspondence"\nplane = "strain"',
     "[model]", "expected a bulk_modulus, or plane stress"),
    ("a variant of bonds", CORRESPONDENCE, 'kind = "correspondence"', 'kind = "correspondence"\nvariant = "zero-residual"',
     "variant", "expected one of stabilised, bond-associated, published"),
    ("a variant of correspondence", BOND, '"published"', '"bond-associated"', "variant", "expected one of published, zero-residual"),
    ("a published factor", CORRESPONDENCE, 'kind = "correspondence"', 'kind = "correspondence"\nvariant = "published"', "[model]",
     "stabilisation: missing; the published stabilisation depends on the unit of length"),
    ("bonds that are stabilised twice", CORRESPONDENCE, 'kind = "correspondence"',
     'kind = "correspondence"\nvariant = "bond-associated"\nstabilisation = 1', "stabilisation", "needs none"),
    ("an inclusion in correspondence", CORRESPONDENCE + '\n[[inclusion]]\ndisc = { radius = "30 mm" }\n', '"30 mm"', '"31 mm"',
     "[[inclusion]]", 'the model "correspondence" has no rigid inclusions'),
    ("influence of springs", PMB, 'kind = "pmb"', 'kind = "pmb"\ninfluence = "constant"', "influence",
     'it belongs to kind = "lps"'),
    ("slabs without a tangent", BOND_MOVING, 'method = "verlet"', 'method = "space-time"', "[solver]",
     'the model "membrane-bond" has no tangent for "space-time"; expected "dynamic-relaxation" or "verlet"'),
    ("generalised-alpha without a tangent", BOND_MOVING, 'method = "verlet"', 'method = "generalised-alpha"\nstep = "1 us"', "[solver]",
     'no tangent for "generalised-alpha"'),
    ("generalised-alpha without a step", PMB, 'method = "verlet"', 'method = "generalised-alpha"', "[solver]", "solver.step: missing"),
    ("too many points in time", SLABS, 'method = "space-time"', 'method = "space-time"\nscheme = "single-field"\ngauss_points = 7',
     "gauss_points", "expected 2 to 6"),
    ("points of the other scheme", SLABS, 'method = "space-time"', 'method = "space-time"\ngauss_points = 4', "gauss_points",
     'it belongs to scheme = "single-field"'),
    ("a radius beyond 1", PMB, 'method = "verlet"', 'method = "generalised-alpha"\nstep = "1 us"\nspectral_radius = 1.1', "spectral_radius",
     "found 1.1"),
    ("a safety of slabs", SLABS, 'method = "space-time"', 'method = "space-time"\nsafety = 0.5', "safety", 'method = "verlet"'),
    ("arc-length of relaxation", PLAIN, '"dynamic-relaxation"', '"dynamic-relaxation"\ncontrol = "arc-length"', "control", 'method = "newton"'),
    ("steps of a path by loads", PLAIN, '"dynamic-relaxation"', '"newton"\nmax_steps = 5', "max_steps", 'control = "arc-length"'),
    ("an unknown control", PLAIN, '"dynamic-relaxation"', '"newton"\ncontrol = "arc"', "control", "load, arc-length"),
    ("arc-length without a tangent", BOND, '"dynamic-relaxation"', '"newton"\ncontrol = "arc-length"', "[solver]", "has no tangent"),
    ("arc-length of bonds that break", replaced(STATIC_PMB, '"dynamic-relaxation"', '"newton"\ncontrol = "arc-length"'),
     'law = "linear-elastic"', 'law = "linear-elastic"\ncritical_stretch = 0.1', "[solver]", "break"),
    ("arc-length of an interface that breaks", replaced(STATIC_PMB, '"dynamic-relaxation"', '"newton"\ncontrol = "arc-length"'),
     "[solver]", '[set.half]\nwhere = "x > 0 m"\n\n[material.other]\non = "half"\nlaw = "linear-elastic"\nyoungs_modulus = "1 MPa"\n'
     'density = "1000 kg/m^3"\n\n[[interface]]\nbetween = ["rubber", "other"]\ncritical_stretch = 0.1\n\n[solver]', "[[interface]]", "its bonds break"),
    ("contact in slabs", SLABS, "[solver]", "[contact]\n\n[solver]", "[contact]", 'method = "verlet"'),
    ("contact in statics", PLAIN, "[solver]", "[contact]\n\n[solver]", "[contact]", 'method = "verlet"'),
    ("contact of less than a spacing", IMPACT, "[contact]", '[contact]\ndistance = "0.5 dx"', "distance", "points could pass between others"),
    ("contact beyond the horizon", IMPACT, "[contact]", '[contact]\ndistance = "4 dx"', "distance", "beyond the horizon"),
    ("a contact without stiffness", IMPACT, "[contact]", "[contact]\nstiffness = 0", "stiffness", "above 0"),
    ("an impactor of two shapes", IMPACT, 'mass = "20 g"', 'mass = "20 g"\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }',
     "plane", "sphere, plane"),
    ("two impactors of one name", IMPACT, 'name = "wall"\nplane', 'name = "ball"\nplane', 'name = "ball"', "the name of another one"),
    ("a plane with mass", IMPACT, "velocity = [0, 0, \"10 m/s", "mass = \"1 kg\"\nvelocity = [0, 0, \"10 m/s", "mass = \"1 kg\"",
     "depends on t"),
    ("a plane with mass that starts", IMPACT, 'velocity = [0, 0, "10 m/s * (1 - cos(2*pi*t/20us))"]', 'mass = "1 kg"', 'mass = "1 kg"',
     "belongs to spheres"),
    ("an impactor that is free in part", IMPACT, '[0, 0, "-60 m/s"]', '["free", 0, "-60 m/s"]', "velocity", "has an entry \"free\""),
    ("a normal without direction", IMPACT, "normal = [0, 0, 2]", "normal = [0, 0, 0]", "normal", "is zero"),
    ("a normal in the plane", IMPACT, "normal = [0, 0, 2]", "normal = [0, 2]", "normal", "expected 3"),
    ("an impactor in the body", IMPACT, '"10.5 mm"', '"9 mm"', "[[impactor]]", "impactor ball: reaches 0.00"),
    ("an impactor on a wild way", IMPACT, "(1 - cos(2*pi*t/20us))", "sqrt(t/1us - 50)", "[[impactor]]", "no finite number"),
    ("a probe of no impactor", IMPACT, 'impactor = "ball"', 'impactor = "bal"', 'impactor = "bal"', 'did you mean "ball"?'),
    ("a probe of an impactor without one", MOVING, 'kind = "reaction"\non = "right"', 'kind = "impactor"\nimpactor = "ball"',
     'impactor = "ball"', "known are none"),
    ("no density in motion", MOVING, 'density = "1100 kg/m^3"', "", "[material.rubber]", "density"),
    ("empty set", PLAIN + SET.format(name="far", where="x > 1 m"), "x > 1 m", "x > 2 m", "[set.far]", "the set is empty"),
    ("overlap", HOLE + '\n[[hole]]\ndisc = { radius = "5 mm", center = ["9 mm", 0] }\n', "9 mm", "10 mm",
     "[[hole]]", "overlaps the one at"),
    ("edge between points", PLAIN, "points = [20, 20]", 'spacing = "11 mm"', "[geometry]", "does not divide the size"),
    ("edge along itself", PLAIN, 'on = ["left", "right", "bottom", "top"]\ndisplacement = ["(stretch - 1)*x", '
     '"(stretch - 1)*y"]', 'on = "left"\ndisplacement = ["free", "(stretch - 1)*y"]', 'on = "left"', "along itself only"),
    ("displaced twice", PLAIN + '\n[[load]]\non = "left"\ndisplacement = [0, "free"]\n', "[0,", '["1 mm",', 'on = "left"',
     "displaced twice"),
    ("long step", MOVING, 'until = "4 ms"', 'until = "4 ms"\nstep = "1 ms"', "[solver]", "above the stable step"),
    ("probe outside", HOLE, 'from = ["-30 mm", 0]', 'from = ["-30 m", 0]', "[[probe]]", "there is no material at"),
    ("hole outside", HOLE + '\n[[hole]]\ndisc = { radius = "5 mm", center = ["70 mm", 0] }\n', "70 mm", "900 mm",
     "[[hole]]", "lies outside of the body"),
    ("crack outside", HOLE + '\n[[crack]]\nfrom = ["60 mm", 0]\nto = ["70 mm", 0]\n', '["60 mm", 0]\nto = ["70 mm", 0]',
     '["0.6 m", 0]\nto = ["0.7 m", 0]', "[[crack]]", "lies outside of the body"),
    ("inclusion across an edge", HOLE + '\n[[inclusion]]\ndisc = { radius = "5 mm", center = ["70 mm", 0] }\n', "70 mm",
     "98 mm", "[[inclusion]]", "reaches out of the body"),
    ("component of a third direction", PLAIN, 'kind = "reaction"', 'kind = "reaction"\ncomponent = "z"', "[[probe]]",
     "expected one of the body's 2"),
    ("component of a stretch", HOLE, 'kind = "stretch"', 'kind = "stretch"\ncomponent = "x"', 'component = "x"', "reaction"),
    ("probe in the hole", HOLE, 'from = ["-30 mm", 0]', "from = [0, 0]", "[[probe]]", "there is no material at"),
    ("one metric twice", HOLE, '"hole_x"', '"force_x"', "[[probe]]", "gives the metric force_x, which a probe above"),
    ("body of three dimensions", PLAIN, 'size = ["0.2 m", "0.2 m"], thickness = "10 mm", points = [20, 20]',
     'size = ["0.2 m", "0.2 m", "0.2 m"], points = [6, 6, 6]', "displacement", "expected 3"),
    ("too many points", PLAIN, "points = [20, 20]", "points = [2000000, 2000000]", "[geometry]", "expected a larger spacing"),
    ("unknown metric", PLAIN + EXPECT, '"force_x"', '"forcex"', "[[expect]]", 'did you mean "force_x"?'),
    ("other unit", PLAIN + EXPECT, '"1 kN"', '"1 kPa"', "[[expect]]", '"force_x" is in N'),
    ("no such state", PLAIN + EXPECT, "at = 1.4", "at = 1.45", "[[expect]]", "its states are 1.2, 1.4"),
    ("no such time", MOVING + EXPECT, "at = 1.4", 'at = "1 ms"', "[[expect]]", "no output state at 0.001"),
    ("no such file", PLAIN + FIELD, "points.csv", "pionts.csv", "[[expect]]", "pionts.csv: there is no such file"),
    ("field not written", PLAIN + FIELD + '\n[output]\nfields = ["damage"]\n', "points.csv", "points.csv ", "[[expect]]",
     "displacement is not written"),
    ("state between", PLAIN + FIELD, "points.csv", "between.csv", "[[expect]]", "no output state at 1.3"),
    ("states beyond", PLAIN + FIELD, "points.csv", "beyond.csv", "[[expect]]", "none of the run's output states"),
    ("no such table file", TABLE, "pull.csv", "pul.csv", 'file = "pul.csv"', "pul.csv: there is no such file"),
    ("a folder as a table", TABLE, "pull.csv", ".", 'file = "."', "there is no such file"),
    ("no file", TABLE, 'file = "pull.csv"', "", "[table.pull]", "table.pull.file: missing; expected a string"),
    ("unknown key of a table", TABLE, 'file = "pull.csv"', 'file = "pull.csv"\nvalues = "u"', "values", 'did you mean "value"?'),
    ("no such column", TABLE, 'file = "pull.csv"', 'file = "pull.csv"\nargument = "tim"', 'file = "pull.csv"',
     'pull.csv:1: expected a column "tim"; there are: time [ms], displacement [mm]; did you mean "time"?'),
    ("one column twice", TABLE, 'file = "pull.csv"', 'file = "pull.csv"\nargument = "displacement"', 'file = "pull.csv"',
     "is both argument and value"),
    ("no number in a table", TABLE, "pull.csv", "letters.csv", 'file = "letters.csv"',
     'letters.csv:3: column "u [mm]": expected a number, found "one"'),
    ("a number with a unit", TABLE, "pull.csv", "united.csv", 'file = "united.csv"',
     'united.csv:2: column "u [mm]": expected a number, found "0 mm"'),
    ("no number's number", TABLE, "pull.csv", "nan.csv", 'file = "nan.csv"', "nan.csv:3: column \"u [mm]\": found nan"),
    ("one row", TABLE, "pull.csv", "short.csv", 'file = "short.csv"', "short.csv:1: found one row"),
    ("a row too long", TABLE, "pull.csv", "ragged.csv", 'file = "ragged.csv"', "ragged.csv:3: expected 2 cells"),
    ("to and fro", TABLE, "pull.csv", "fro.csv", 'file = "fro.csv"', "fro.csv:4: column \"t [ms]\": 1 comes after 2"),
    ("unknown unit of a column", TABLE, "pull.csv", "unit.csv", 'file = "unit.csv"', 'unknown unit "sec"'),
    ("unknown outside", TABLE, 'file = "pull.csv"', 'file = "pull.csv"\noutside = "holds"', 'outside', 'did you mean "hold"?'),
    ("a table called x", replaced(TABLE, "pull(t)", "t / 1 s"), "[table.pull]", "[table.x]", "[table.x]", '"x" is a variable'),
    ("a table called sin", replaced(TABLE, "pull(t)", "t / 1 s"), "[table.pull]", "[table.sin]", "[table.sin]", '"sin" is a function'),
    ("a table called mm", replaced(TABLE, "pull(t)", "t / 1 s"), "[table.pull]", "[table.mm]", "[table.mm]", '"mm" is a unit'),
    ("a table called dx", replaced(TABLE, "pull(t)", "t / 1 s"), "[table.pull]", "[table.dx]", "[table.dx]", '"dx" is a length'),
    ("a hyphen", TABLE, "[table.pull]", "[table.my-pull]", "[table.my-pull]", "which formulas could not use"),
    ("unknown table", TABLE, "pull(t)", "pul(t)", "displacement", 'did you mean "pull"?'),
    ("a table without argument", TABLE, "pull(t)", "pull", "displacement", '"pull" is a table'),
    ("one column name twice", TABLE, 'file = "pull.csv"', 'file = "twins.csv"\nargument = "t"', 'file = "twins.csv"',
     'twins.csv:1: found the columns "t [ms]" and "t [s]"'),
    ("semicolons", TABLE, "pull.csv", "semicolons.csv", 'file = "semicolons.csv"', "semicolons.csv:1: found cells separated by semicolons"),
    ("two arguments", TABLE, "pull(t)", "pull(t, x)", "displacement", "Too many parameters"),
    ("a place for a time", TABLE, "pull(t)", "pull(x)", "displacement", "the table pull takes a time"),
    ("an area for a length", TABLE, "pull(t) * x / 0.1 m", "pull(t) * 1 m", "displacement", "an area (m^2); expected a length"),
    ("a table that ends early", TABLE, 'until = "4 ms"', 'until = "4.1 ms"', "displacement", "pull.csv goes from 0 s to 0.004 s"),
    ("a table that begins late", TABLE, "pull(t)", "pull(t - 1 us)", "displacement", "the table pull has no value at -1e-06 s"),
    ("a table that ends between", TABLE, "pull(t)", "pull(5 ms * sin(1e3*t))", "displacement", "the table pull has no value at"),
    ("a stretch beyond a table", STATIC_TABLE, "[1.2, 1.4]", "[1.2, 1.5]", "displacement", "(at x = "),
    ("no number from a table", TABLE, "pull(t) * x", "1 mm * sqrt(pull(t) / 1 mm - 1) * x", "[[load]]", "is no finite number at time 0"),
    ("a set beyond a table", TABLE + SET.format(name="far", where="y > pull(x * 1 s/m) + 1 mm"), "1 s/m", "2 s/m", "where",
     "the table pull has no value"),
    ("a constant beyond a table", TABLE, 'until = "4 ms"', 'until = "1 s * pull(5 ms) / 1 mm"', "until", "no value at 0.005 s"),
    ("volumes too large for the box", CLOUD, "sheet.csv", "large.csv", "points =", "is the unit of the volumes right?"),
    ("volumes too large without a box", FREE, "sheet.csv", "large.csv", "points =", "is the unit of the volumes right?"),
    ("volumes too small without a box", FREE, "sheet.csv", "small.csv", "[geometry]", "is the unit of the volumes right?"),
    ("no file of points", CLOUD, "sheet.csv", "shet.csv", "points =", "shet.csv: there is no such file"),
    ("points outside of the box", CLOUD, 'size = ["0.2 m", "0.2 m"]', 'size = ["0.1 m", "0.2 m"]', "points =",
     "sheet.csv:2: the point at (-0.095, -0.095) m lies outside of the box"),
    ("points on a loaded edge", CLOUD, 'size = ["0.2 m", "0.2 m"]', 'size = ["0.19 m", "0.2 m"]', "[geometry]",
     'sheet.csv:2: the point lies on the edge "left"'),
    ("edges of points without a box", CLOUD, ', box = { size = ["0.2 m", "0.2 m"] }', "", "on = [",
     'points have no edge "left" as long as nobody says where the body ends; expected box = '),
    ("points without a thickness", CLOUD, ', thickness = "10 mm"', "", "points =", "thickness: missing"),
    ("points and a box", CLOUD, POINTS, POINTS + "\n" + BOX, "points = {", "given together with"),
    ("bonds of points on a lattice", CLOUD, POINTS, POINTS + '\nbonds = "lattice"', "bonds =", 'expected "listed"'),
    ("no file of a field", FIELDS, 'file = "rows.csv"', 'file = "row.csv"', "file =", "row.csv: there is no such file"),
    ("a field of a taken name", FIELDS, "[field.part]", "[field.x]", "[field.x]", '"x" is a variable in formulas'),
    ("a field misspelt", FIELDS, "(stretch - 1)*part", "(stretch - 1)*prt", "displacement", 'did you mean "part"?'),
    ("a field in another dimension", FIELDS, "(stretch - 1)*part", "(stretch - 1)*part*part", "displacement", 'the field part gives a length ("part [mm]")'),
    ("two rows at one place", FIELDS, 'file = "rows.csv"', 'file = "again.csv"', "file =", "again.csv:402: the point at (-0.075, -0.095) m stands in line 4 already"),
    ("a point without a row", FIELDS, 'file = "rows.csv"', 'file = "few.csv"', "displacement", "the field part has no value at ("),
    ("no file of a mesh", MESH, "sheet.msh", "shet.msh", "mesh =", "shet.msh: there is no such file"),
    ("points for a mesh", MESH, "sheet.msh", "sheet.csv", "mesh =", 'sheet.csv:1: found "x"; expected $MeshFormat'),
    ("an older mesh", MESH, "sheet.msh", "older.msh", "mesh =", 'older.msh:2: in $MeshFormat: found version "2.2" of the format MSH; expected 4.1'),
    ("a mesh without a thickness", MESH, ', thickness = "10 mm"', "", "mesh =", "thickness: missing"),
    ("a mesh in no unit", MESH, 'unit = "mm"', 'unit = "mn"', "mesh =", 'unit: found "mn"; expected a unit of length'),
    ("an unknown group", MESH + '\n[set.top_row]\ngroup = "top row"\n', '"top row"', '"toprow"', "group =",
     'has no physical group "toprow"; it has top row; did you mean "top row"?'),
    ("a group without a mesh", PLAIN + SET.format(name="s", where="x > 0"), 'where = "x > 0"', 'group = "s"', "group =", "belongs to bodies from a mesh"),
    ("an edge that the mesh has not", MESH, '"left", "right"', '"left", "back"', "on = [", 'the body has no edge "back"'),
    ("no file of a surface", SOLID, "block.stl", "blok.stl", "surface =", "blok.stl: there is no such file"),
    ("an open surface", SOLID, "block.stl", "open.stl", "surface =", "open.stl: the surface is not closed: 3 of 18 edges"),
    ("a surface without spacing", SOLID, ', spacing = "5 mm"', "", "surface =", "spacing: missing"),
    ("a surface below the spacing", SOLID, 'unit = "mm"', 'unit = "um"', "surface =", "is larger than the body"),
    ("a surface in no unit", SOLID, 'unit = "mm"', 'unit = "MPa"', "surface =", 'unit: found "MPa"; expected a unit of length'),
    ("a crack with one end", CRACKED, 'to = ["70 mm", 0]', "", "[[crack]]", "nothing found; expected one of to, path,"),
    ("a crack of two forms", CRACKED, 'to = ["70 mm", 0]', 'to = ["70 mm", 0]\npath = [[0, 0], ["1 mm", 0]]', "path =", "given together with from"),
    ("a crack without length", CRACKED, '["70 mm", 0]', '["60 mm", 0]', "to =", "the same place as from"),
    ("a path that stands still", CRACKED, 'from = ["60 mm", 0]\nto = ["70 mm", 0]', 'path = [["60 mm", 0], ["70 mm", 0], ["70 mm", 0]]', "path =",
     "corners 2 and 3 are at the same place"),
    ("a path of one place", CRACKED, 'from = ["60 mm", 0]\nto = ["70 mm", 0]', 'path = [["60 mm", 0]]', "path =", "found 1 places; expected 2 or more"),
    ("a path without a unit", CRACKED, 'from = ["60 mm", 0]\nto = ["70 mm", 0]', 'path = [["60 mm", 0], [70, 0]]', "path =", "crack.1.path.2.1: 70 has no unit"),
    ("a path outside", CRACKED, 'from = ["60 mm", 0]\nto = ["70 mm", 0]', 'path = [["1 m", 0], ["2 m", 0], ["2 m", "1 m"]]', "[[crack]]", "lies outside of the body"),
    ("a polygon in the plane", CRACKED, 'from = ["60 mm", 0]\nto = ["70 mm", 0]', 'polygon = [[0, 0], ["1 mm", 0], [0, "1 mm"]]', "polygon =", "bodies in three dimensions; this one has 2"),
    ("a line in space", BLOCK + POLYGON, POLYGON_KEY, 'from = [0, 0, 0]\nto = [0, 0, "9 mm"]', "from =", "bodies in two dimensions; this one has 3"),
    ("a polygon that is not flat", BLOCK + POLYGON, '["20 mm", 0, "20 mm"]', '["21 mm", 0, "20 mm"]', "polygon =", "the corners do not lie in one plane"),
    ("a polygon without area", BLOCK + POLYGON, POLYGON_KEY, 'polygon = [[0, 0, 0], ["1 mm", 0, 0], ["2 mm", 0, 0]]', "polygon =", "enclose no area"),
    ("a polygon that crosses itself", BLOCK + POLYGON, POLYGON_KEY, 'polygon = [["20 mm", 0, 0], ["20 mm", "20 mm", "20 mm"], ["20 mm", "20 mm", 0], ["20 mm", 0, "5 mm"]]', "polygon =", "crosses the one from"),
    ("a polygon outside", BLOCK + POLYGON, POLYGON_KEY, 'polygon = [["9 m", 0, 0], ["9 m", "1 mm", 0], ["9 m", 0, "1 mm"]]', "[[crack]]", "cuts no bond"),
    ("a penny between the points", BLOCK + POLYGON, POLYGON_KEY, 'penny = { center = ["20 mm", "11 mm", "10.7 mm"], normal = [1, 0, 0], radius = "0.1 mm" }', "[[crack]]", "cuts no bond"),
    ("a penny without a direction", BLOCK + POLYGON, POLYGON_KEY, 'penny = { normal = [0, 0, 0], radius = "9 mm" }', "penny =", "normal: has no direction"),
    ("a penny of two numbers", BLOCK + POLYGON, POLYGON_KEY, 'penny = { normal = [0, 1], radius = "9 mm" }', "penny =", "found 2 entries; expected 3"),
    ("a penny of no size", BLOCK + POLYGON, POLYGON_KEY, 'penny = { normal = [0, 1, 0], radius = "0 mm" }', "penny =", "expected a value above 0"),
    ("no file of a crack", BLOCK + POLYGON, POLYGON_KEY, 'surface = { file = "crack.stl" }', "surface =", "crack.stl: there is no such file"),
    ("a crack in no unit", BLOCK + POLYGON, POLYGON_KEY, 'surface = { file = "block.stl", unit = "s" }', "surface =", 'unit: found "s"; expected a unit of length'),
    ("a path of a crack in space", BLOCK, 'kind = "reaction"\non = "right"', 'kind = "crack-length"', "[[probe]]", 'expected kind = "crack-area"'),
    ("a speed without time", PLAIN, 'kind = "reaction"\non = "right"', 'kind = "crack-speed"', "kind =", "a speed needs a run in time"),
    ("a speed between two rows", MOVING, 'kind = "reaction"\non = "right"', 'kind = "crack-speed"\nover = "1.5 ms"', "[[probe]]", "a slope over 0.0015 s needs rows"),
    ("a crack at an edge", MOVING, 'kind = "reaction"', 'kind = "branches"', "[[probe]]", "edges have no points"),
    ("an angle at the root", MOVING, 'kind = "reaction"\non = "right"', 'kind = "crack-angle"\nlength = "1 dx"', "[[probe]]", 'expected length = "2 horizon" or more'),
    ("a threshold above all", MOVING, 'kind = "reaction"\non = "right"', 'kind = "branches"\ndamage = 1.5', "damage =", "at most 1"),
    ("a reaction of nothing", MOVING, 'kind = "reaction"\non = "right"', 'kind = "reaction"', "[[probe]]", "on: missing"),
    ("unknown bonds", PLAIN, BOX, BOX + '\nbonds = "list"', "bonds =", 'did you mean "listed"?'),
    ("too many states", MOVING, 'every = "2 ms"', 'every = "1e-30 s"', "every =", "gives 4e+27 output states; expected 1e+06 at most"),
    ("too many rows", MOVING, 'history_every = "1 ms"', 'history_every = "1e-30 s"', "history_every =", "rows of the history"),
    ("too many steps", replaced(MOVING, '[output]\nevery = "2 ms"\nhistory_every = "1 ms"\n', ""), 'until = "4 ms"', 'until = "1e9 s"', "until =", "time steps of"),
    ("too many short steps", MOVING, 'until = "4 ms"', 'until = "4 ms"\nstep = "1e-20 s"', "step =", "gives 4e+17 time steps"),
    ("too many load steps", PLAIN, "stretch = [1.2, 1.4]", "stretch = [1.2, 1.4]\nincrement = 1e-30", "increment =", "load steps"),
    ("more than the disk holds", replaced(replaced(replaced(MOVING, "points = [20, 20]", "points = [100, 100]"), 'every = "2 ms"\n', 'every = "5 ns"\n'),
                                          '"4 ms"', '"4.4 ms"'), '"1 ms"', '"2 ms"', "[output]", "on disk"),
    ("a size of zero", PLAIN, '"0.2 m", "0.2 m"', '"0 m", "0.2 m"', "size", "expected a value above 0"),
    ("a negative size", PLAIN, '"0.2 m", "0.2 m"', '"-0.2 m", "0.2 m"', "size", "expected a value above 0"),
    ("a negative radius", HOLE, 'radius = "30 mm"', 'radius = "-30 mm"', "radius", "above 0"),
    ("a size without end", PLAIN, '"0.2 m", "0.2 m"', '"inf m", "0.2 m"', "size", "inf"),
    ("a number without end", PLAIN, "stretch = [1.2, 1.4]", "stretch = [1.2, inf]", "stretch =", "expected a finite number"),
    ("a number too large for a double", PLAIN, '"6 MPa"', '"1e999 Pa"', "youngs_modulus", "1e999"),
    ("a division by zero", PLAIN, '"6 MPa"', '"6 MPa / 0"', "youngs_modulus", "gives no finite number"),
    ("a division by zero in a load", PLAIN, '"(stretch - 1)*x"', '"1 mm / 0"', "displacement", "finite"),
    ("too few arguments", PLAIN, '"(stretch - 1)*x"', '"1 mm * pow(stretch)"', "displacement", "pow"),
    ("too many arguments", PLAIN, '"(stretch - 1)*x"', '"1 mm * sin(stretch, 1)"', "displacement", "sin"),
    ("unknown function", PLAIN, '"(stretch - 1)*x"', '"1 mm * sine(stretch)"', "displacement", "sine"),
    ("an operator alone", PLAIN, '"(stretch - 1)*x"', '"(stretch - ) * x"', "displacement", "stretch"),
    ("an empty formula", PLAIN, '"(stretch - 1)*x"', '""', "displacement", "load.1.displacement.1"),
    ("a number for a text", PLAIN, 'law = "neo-hookean"', "law = 3", "law = 3", "expected a string"),
    ("a text for a number", PLAIN, "[20, 20]", '["20", 20]', "points", "expected a whole number"),
    ("a table for a list", PLAIN, "[1.2, 1.4]", "{ a = 1 }", "stretch =", "found a table; expected a list"),
    ("a list for a table", PLAIN, BOX, "box = [1, 2]", "box = [1, 2]", "found a list; expected a table"),
    ("a date", PLAIN, '"6 MPa"', "2024-01-01", "youngs_modulus", "2024-01-01"),
    ("a truth value", PLAIN, '"6 MPa"', "true", "youngs_modulus", "true"),
    ("half a point", PLAIN, "[20, 20]", "[20.5, 20]", "points", "expected a whole number"),
    ("a huge integer", PLAIN, "[20, 20]", "[9223372036854775807, 20]", "points", "expected a whole number from"),
    ("an integer that no machine holds", PLAIN, "[20, 20]", "[99999999999999999999, 20]", "points", "is not TOML here"),
    ("a single table for an array", PLAIN, "[[load]]", "[load]", "[load]", "an array of tables, written [[load]]"),
    ("a section twice", PLAIN, "[solver]", "[geometry]", "[geometry]", "is not TOML here"),
    ("a very long line", PLAIN, '"Sheet"', '"' + 200000 * "x" + '" y', "title =", "is not TOML here"),
    ("deep nesting", PLAIN, "[1.2, 1.4]", 5000 * "[" + 5000 * "]", "stretch =", "is not TOML here"),
    ("deep brackets", PLAIN, '"(stretch - 1)*x"', '"' + 5000 * "(" + '"', "displacement", "displacement"),
    ("broken reference", PLAIN + FIELD, "points.csv", "broken.csv", "[[expect]]", "broken.csv:2"),
]


class WrongInput(ProgramTest):
    def setUp(self):
        super().setUp()
        header = "lambda,X_m,Y_m,ux_m,uy_m\n"
        self.write("sheet.csv", lattice_csv(20, 10))
        self.write("points.csv", header + "1.4,0.01,0,0.004,0\n")
        self.write("between.csv", header + "1.2,0.01,0,0.002,0\n1.3,0.01,0,0.003,0\n")
        self.write("beyond.csv", header + "3,0.01,0,0.02,0\n")
        self.write("broken.csv", header + "1.4,0.01,zero,0.002,0\n")
        self.write("pull.csv", "time [ms],displacement [mm]\n0,0\n1,1\n4,2\n")
        self.write("steps.csv", "stretch,pull\n1,0\n1.4,0.4\n")
        for name, rows in {"letters": "0,0\n1,one\n", "united": "0,0 mm\n1,1 mm\n", "nan": "0,0\n1,nan\n", "short": "0,0\n",
                           "ragged": "0,0\n1,1,1\n", "fro": "0,0\n2,1\n1,2\n"}.items():
            self.write(f"{name}.csv", "t [ms],u [mm]\n" + rows)
        self.write("unit.csv", "t [sec],u [mm]\n0,0\n1,1\n")
        self.write("twins.csv", "t [ms],t [s],u [mm]\n0,0,0\n4,4,1\n")
        self.write("semicolons.csv", "t [ms];u [mm]\n0;0\n4;1\n")
        places = [(-95 + 10 * i, -95 + 10 * j) for j in range(20) for i in range(20)]
        rows = ["x [mm],y [mm],part [mm]\n", *(f"{x},{y},{x}\n" for x, y in places)]
        self.write("rows.csv", "".join(rows))
        self.write("few.csv", "".join(rows[:-1]))
        self.write("again.csv", "".join(rows + rows[3:4]))
        self.write("sheet.msh", squares(20, 10))
        self.write("older.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")
        self.write("block.stl", box_stl(40, 20, 30))
        self.write("open.stl", re.sub("facet.*?endfacet\n", "", box_stl(40, 20, 30), count=1, flags=re.DOTALL))
        self.write("large.csv", lattice_csv(20, 10).replace("mm^3", "cm^3"))
        self.write("small.csv", lattice_csv(20, 10).replace("1000.0", "0.001").replace("1000\n", "0.001\n"))

    def test_each_mistake_is_named_with_its_place(self):
        for name, text, old, new, marked, message in MISTAKES:
            with self.subTest(name):
                wrong = replaced(text, old, new)
                case = self.write("case.toml", wrong)
                said = self.refused("run", case)
                place = re.match(r"error: (.*?):(\d+):(\d+): ", said)
                self.assertIsNotNone(place, said)
                self.assertEqual(place[1], str(case))
                line = wrong.splitlines()[int(place[2]) - 1]
                if new not in line and marked not in line:  # a parser may notice on the line below
                    line = wrong.splitlines()[int(place[2]) - 2]
                self.assertTrue(marked in line or new in line, f"{said}points at: {line}")
                self.assertLessEqual(int(place[3]), len(line) + 1)
                self.assertIn(message, said)
                # The memory that is free changes from one command to the next.
                checked, ran = (re.sub(r"\S+ GB are available", "some GB are available", words)
                                for words in (self.refused("check", case), said))
                self.assertEqual(checked, ran, "check and run must agree")

    def test_the_cases_are_right_without_the_mistake(self):
        for name, text in {"plain": PLAIN + EXPECT, "hole": HOLE + FIELD, "moving": MOVING, "table": TABLE,
                           "steps": STATIC_TABLE, "mesh": MESH, "solid": SOLID, "fields": FIELDS, "cracked": CRACKED,
                           "polygon": BLOCK + POLYGON}.items():
            self.command("check", self.write(f"{name}.toml", text))

    def test_three_dimensions_have_no_membrane(self):
        text = replaced(PLAIN, 'size = ["0.2 m", "0.2 m"], thickness = "10 mm", points = [20, 20]',
                        'size = ["0.2 m", "0.2 m", "0.2 m"], points = [6, 6, 6]')
        text = replaced(text, '"(stretch - 1)*y"]', '"(stretch - 1)*y", "free"]')
        said = self.refused("run", self.write("case.toml", text))
        self.assertRegex(said, r"case\.toml:\d+")
        self.assertIn("two-dimensional", said)

    def test_overrides_are_named(self):
        case = self.write("case.toml", PLAIN)
        for override, message in {
                "solver.stretc=[2]": 'did you mean "stretch"?',
                "geometry.box.points=[20]": "expected 2",
                "load.4.on=left": "expected a number from 1 to 1",
                "solver": "expected path.to.key=value",
                "material.rubber.youngs_modulus=6 mm": "expected a pressure"}.items():
            with self.subTest(override):
                said = self.refused("run", case, "--set", override)
                self.assertIn(message, said)
                self.assertIn("--set", said)
                self.assertEqual(said.count(override.split("=")[0]), 1, "the key stands there once")

    def test_the_short_variant_is_checked(self):
        text = PLAIN + '\n[short]\nset = ["solver.stretch=[1.1]"]\n'
        self.command("check", self.write("right.toml", text))
        self.write("wrong.toml", replaced(text, "stretch=[1.1]", "strech=[1.1]"))
        self.assertIn('did you mean "stretch"?', self.refused("check", "wrong.toml"))
        self.write("late.toml", text + '[[short.expect]]\nmetric = "force_x"\nmin = "1 N"\nat = 1.4\nkind = "reference"\n')
        self.assertIn("its states are 1.1", self.refused("check", "late.toml"))

    def test_a_result_that_is_there_stays_as_it_is(self):
        self.command("run", self.write("right.toml", PLAIN), "-o", "kept")

        def content():
            return {p: (p.read_bytes(), p.stat().st_mtime_ns) for p in (self.top / "kept").rglob("*") if p.is_file()}

        before = content()
        wrong = self.write("wrong.toml", replaced(PLAIN, "youngs_modulus", "youngs_modulu"))
        late = self.write("late.toml", replaced(PLAIN + EXPECT, "at = 1.4", "at = 1.45"))
        for words in ([wrong, "--force"], [late, "--force"], ["right.toml"], ["right.toml", "--set", "solver.stretch=[0]", "--force"]):
            self.refused("run", *words, "-o", "kept")
        self.assertEqual(content(), before)
        # Folders that cannot be.
        self.write("file", "mine")
        for folder in ("file", "file/under", "/proc/riven"):
            self.refused("run", "right.toml", "-o", folder)
        self.assertEqual((self.top / "file").read_text(), "mine")
        if os.geteuid() != 0:  # root may write everywhere
            (self.top / "locked").mkdir(mode=0o500)
            self.refused("run", "right.toml", "-o", "locked/out")

    def test_files_that_are_none(self):
        (self.top / "folder").mkdir()
        (self.top / "utf16.toml").write_bytes(PLAIN.encode("utf-16"))
        (self.top / "random.toml").write_bytes(bytes(random.Random(2).randrange(1, 256) for _ in range(2000)))
        (self.top / "program.toml").write_bytes(pathlib.Path("/bin/true").read_bytes())
        for name in ("utf16.toml", "random.toml", "program.toml"):
            self.assertRegex(self.refused("run", name), rf"{name}(:\d+:\d+)?: is (not TOML here|a binary file)")
        if os.geteuid() != 0:  # root may read everything
            self.write("locked.toml", PLAIN).chmod(0)
            self.assertIn("cannot be read", self.refused("run", "locked.toml"))
        self.assertIn("is a directory", self.refused("run", "folder/"))
        self.write("empty.toml", "")
        (self.top / "bytes.toml").write_bytes(b"title = \"\xff\xfe\"\n")
        self.assertIn("is a directory", self.refused("run", "folder"))
        self.assertIn("title: missing", self.refused("run", "empty.toml"))
        self.assertIn("bytes.toml:1", self.refused("run", "bytes.toml"))
        self.assertIn("no such file", self.refused("run", "nothing.toml"))


if __name__ == "__main__":
    unittest.main()
