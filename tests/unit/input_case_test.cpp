#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "input/case_reader.hpp"
#include "input_cases.hpp"

namespace riven {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the case does not hold " + from);
  return text.replace(at, from.size(), to);
}

std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_case(text, "case.toml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CaseReader, ReadsWhatIsWritten) {
  const Case c = parse_case(static_case, "case.toml");
  EXPECT_EQ(c.title, "Membrane with a hole");
  EXPECT_EQ(c.geometry.dimension, 2);
  EXPECT_EQ(c.geometry.spacing, 0.005);
  EXPECT_EQ(c.geometry.thickness, 0.01);
  EXPECT_DOUBLE_EQ(c.geometry.horizon, 0.015);
  EXPECT_EQ(c.geometry.horizon_at.line, 5);
  EXPECT_EQ(std::get<Box>(c.geometry.shape).half_size, (Point{0.25, 0.25, INFINITY}));
  ASSERT_EQ(c.holes.size(), 1U);
  EXPECT_EQ(std::get<Disc>(c.holes[0].shape).radius, 0.08);
  EXPECT_EQ((*c.sets.at(0).where)({{0.09, 0, 0}, 0, 1}), 1);
  EXPECT_EQ((*c.sets.at(0).where)({{0.11, 0, 0}, 0, 1}), 0);
  EXPECT_EQ(c.materials.at(0).name, "rubber");
  EXPECT_DOUBLE_EQ(*c.materials[0].number("youngs_modulus"), 0.109e9);
  ASSERT_EQ(c.loads.at(0).on.size(), 2U);
  EXPECT_EQ(c.loads[0].on[1].text, "right");
  EXPECT_DOUBLE_EQ((*c.loads[0].displacement[0].value)({{0.2, 0, 0}, 0, 3}), 0.4);
  EXPECT_FALSE(c.loads[0].displacement[1].value);
  EXPECT_EQ(c.solver.stretch, (std::vector<double>{1.5, 2, 2.5, 3}));
  EXPECT_EQ(c.expects.at(0).value->si, 512e3);
  EXPECT_EQ(c.expects[0].value->dimension, "N");
  EXPECT_DOUBLE_EQ(*c.expects[0].tolerance, 0.005);
  EXPECT_EQ(*c.expects[0].state, 2);
  EXPECT_EQ(c.short_run->set.at(0), "solver.stretch=[1.5]");
}

TEST(CaseReader, ReadsARunInTime) {
  const Case c = parse_case(moving_case, "case.toml");
  EXPECT_EQ(c.geometry.spacing, 0.002);
  EXPECT_EQ(std::get<Box>(c.geometry.shape).center, (Point{0.05, 0, 0}));
  EXPECT_NEAR(std::get<Box>(c.holes.at(1).shape).center[0], 0.071, 1e-15);
  EXPECT_NEAR(std::get<Box>(c.holes.at(1).shape).center[1], 0.002, 1e-15);
  EXPECT_EQ(c.cracks.at(0).segments.at(0).b, (Point{0.01, 0, 0}));
  EXPECT_EQ(c.inclusions.at(0).motion, "fixed");
  EXPECT_EQ(c.inclusions[1].motion, "free");
  EXPECT_DOUBLE_EQ(c.materials.at(0).density, 1100);
  EXPECT_EQ(*c.materials[0].number("c30"), 0);
  EXPECT_EQ(c.solver.until, 43e-6);
  EXPECT_EQ(*c.output.history_every, 0.5e-6);
  EXPECT_EQ(*c.probes.at(0).position, (Point{0.1, 0.02, 0}));
  EXPECT_DOUBLE_EQ(*c.expects.at(0).state, 40e-6);
  EXPECT_DOUBLE_EQ(c.expects.at(1).exclude_within, 0.008);
  EXPECT_EQ(c.short_run->expect.at(0).absolute_tolerance->dimension, "m");
}

TEST(CaseReader, DefaultsAreThoseOfTheStructs) {
  const Case c = parse_case(R"(title = "t"
[geometry]
disc = { radius = "1 m", thickness = "1 mm", spacing = "10 mm" }
[material.a]
law = "mooney-rivlin"
c10 = "1 MPa"
c01 = "0.5 MPa"
[solver]
method = "dynamic-relaxation"
stretch = [0.9, 0.8]
)",
                            "case.toml");
  const SolverInput solver;
  EXPECT_DOUBLE_EQ(c.geometry.horizon, 0.03);
  EXPECT_EQ(c.model.kind, ModelInput{}.kind);
  EXPECT_EQ(c.model.stabilisation, 4);
  EXPECT_EQ(c.solver.increment, solver.increment);
  EXPECT_EQ(c.solver.tolerance, 1e-5);  // of statics
  EXPECT_EQ(c.solver.max_iterations, solver.max_iterations);
  EXPECT_EQ(c.solver.safety, solver.safety);
  EXPECT_EQ(c.output.fields, OutputInput{}.fields);
  EXPECT_TRUE(std::holds_alternative<Disc>(c.geometry.shape));
  EXPECT_FALSE(c.short_run);
}

TEST(CaseReader, BodiesOfOneAndThreeDimensions) {
  const std::string rest = R"(
[material.a]
law = "neo-hookean"
c10 = "1 MPa"
[solver]
method = "dynamic-relaxation"
stretch = [2]
[[load]]
on = "front"
displacement = ["x", 0, "free"]
[set.ball]
ball = { radius = "0.1 m" }
)";
  const std::string box =
      "title = 't'\n[geometry]\nbox = { size = ['1 m', '1 m', '2 m'], points = [10, 10, 20] }\n";
  const Case c = parse_case(box + rest, "case.toml");
  EXPECT_EQ(c.geometry.dimension, 3);
  EXPECT_EQ(c.loads.at(0).displacement.size(), 3U);
  EXPECT_TRUE(std::holds_alternative<Ball>(*c.sets.at(0).shape));
  const std::string bar =
      "title = 't'\n[geometry]\nbox = { size = ['1 m'], area = '4 mm^2', points = [10] }\n";
  EXPECT_DOUBLE_EQ(parse_case(bar + rest.substr(0, rest.find("[[load]]")), "case.toml").geometry.thickness,
                   4e-6);
  EXPECT_NE(error_of(bar + rest.substr(0, rest.find("[set.ball]"))).find("\"front\" is neither an edge"),
            std::string::npos);
}

struct Wrong {
  const char* from;  // of static_case
  const char* to;
  const char* place;  // line, or line:column
  const char* message;
};

void PrintTo(const Wrong& wrong, std::ostream* out) {
  *out << wrong.from << " -> " << wrong.to;
}

class WrongInput : public testing::TestWithParam<Wrong> {};

TEST_P(WrongInput, IsNamedWithItsPlace) {
  const Wrong& wrong = GetParam();
  const std::string message = error_of(replaced(static_case, wrong.from, wrong.to));
  const std::string place = std::string("case.toml:") + wrong.place + ":";
  EXPECT_EQ(message.substr(0, place.size()), place) << message;
  EXPECT_NE(message.find(wrong.message), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Names, WrongInput,
    testing::Values(
        Wrong{"horizon =", "horizn =", "5:1",
              "geometry.horizn: unknown key; valid here are box, disc, points, mesh, surface, arch, "
              "quadrilateral, element, horizon, "
              "bonds; did you "
              "mean "
              "\"horizon\"?"},
        Wrong{"stabilisation =", "stabilization =", "15", "did you mean \"stabilisation\"?"},
        Wrong{"stabilisation =", "until =", "15:1", "\"until\" belongs in [solver]"},
        Wrong{"tolerance = 1e-5", "youngs_modulus = \"1 MPa\"", "28:1", "belongs in [material.NAME]"},
        Wrong{"horizon =", "displacement =", "5:1", "belongs in [[load]]"},
        Wrong{"[solver]", "[slover]", "25:2", "did you mean \"solver\"?"},
        Wrong{"title =", "titel =", "1:1", "did you mean \"title\"?"},
        Wrong{"title = \"Membrane with a hole\"", "", "1:1", "title: missing"},
        Wrong{"\"membrane\"", "\"membran\"", "14:8",
              "found \"membran\"; expected one of membrane, membrane-bond, pmb, lps, correspondence, "
              "finite-elements; did you "
              "mean "
              "\"membrane\"?"},
        Wrong{"\"neo-hookean\"", "\"neo-hokean\"", "18", "did you mean \"neo-hookean\"?"},
        Wrong{"\"dynamic-relaxation\"", "\"newtons\"", "26",
              "expected one of dynamic-relaxation, newton, verlet, space-time, "
              "generalised-alpha"},
        Wrong{"\"damage\"]", "\"damge\"]", "31:27", "output.fields.2: found \"damge\""},
        Wrong{"\"damage\"]", "\"displacement\"]", "31", "twice"},
        Wrong{"on = [\"left\"", "on = [\"lefft\"", "22:7", "did you mean \"left\"?"},
        Wrong{"on = \"right\"", "on = \"cor\"", "36", "did you mean \"core\"?"},
        Wrong{"on = [\"left\"", "on = [\"right\"", "22", "names \"right\" twice"},
        Wrong{"on = [\"left\", \"right\"]", "on = []", "22", "empty list"},
        Wrong{"[set.core]", "[set.left]", "10:1", "is the name of an edge"},
        Wrong{"kind = \"reaction\"", "kind = \"force\"", "35", "expected one of reaction"}));

INSTANTIATE_TEST_SUITE_P(
    Values, WrongInput,
    testing::Values(
        Wrong{"thickness = \"10 mm\"", "thickness = 10", "4:48",
              "geometry.box.thickness: 10 has no unit; write \"10 mm\" (a length)"},
        Wrong{"thickness = \"10 mm\"", "thickness = \"10\"", "4", "has no unit; write \"10 mm\""},
        Wrong{"\"10 mm\"", "\"10 mmm\"", "4:52", "unknown unit \"mmm\""},
        Wrong{"\"10 mm\"", "\"10 MPa\"", "4:48", "is a pressure (Pa); expected a length, such as \"10 mm\""},
        Wrong{"\"10 mm\"", "\"-10 mm\"", "4:48", "found -0.01 m; expected a value above 0 m"},
        Wrong{"\"10 mm\"", "\"1 mm / 0\"", "4:48", "gives no finite number"},
        Wrong{"\"10 mm\"", "nan", "4", "expected a finite number"},
        Wrong{"\"10 mm\"", "true", "4", "found true; expected a length such as \"10 mm\""},
        Wrong{"\"10 mm\"", "\"3 dx\"", "4:51", "known only after"},
        Wrong{"\"3 dx\"", "\"3 dy\"", "5:14", "unknown unit \"dy\""},
        Wrong{"\"3 dx\"", "\"2 mm\"", "5:11", "below the spacing"},
        Wrong{"\"3 dx\"", "\"1 horizon\"", "5:14", "known only after"},
        Wrong{"title = \"Membrane with a hole\"", "title = 3", "1:9", "found 3; expected a string"},
        Wrong{"stabilisation = 4", "stabilisation = -1", "15:17", "at least 0"},
        Wrong{"stabilisation = 4", "stabilisation = inf", "15", "expected a finite number"},
        Wrong{"stabilisation = 4", "stabilisation = \"4 mm\"", "15", "is a length (m); expected a number"},
        Wrong{"tolerance = 1e-5", "max_iterations = 1.5", "28:18", "expected a whole number"},
        Wrong{"tolerance = 1e-5", "max_iterations = 0", "28", "from 1 to"},
        Wrong{"tolerance = 1e-5", "tolerance = 2", "28", "at most 1"},
        Wrong{"stretch = [1.5, 2, 2.5, 3]", "stretch = [1.5, 2, 1.8]", "27:11", "1.8 comes after 2"},
        Wrong{"stretch = [1.5, 2, 2.5, 3]", "stretch = [1]", "27", "move away from 1"},
        Wrong{"stretch = [1.5, 2, 2.5, 3]", "stretch = []", "27", "expected one at least"},
        Wrong{"stretch = [1.5, 2, 2.5, 3]", "stretch = 2", "27", "found 2; expected a list"},
        Wrong{"(stretch - 1)*x", "(strech - 1)*x", "23:19", "did you mean \"stretch\"?"},
        Wrong{"(stretch - 1)*x", "(t - 1)*x", "23:19", "\"t\" is not known here; known are x, y, z, stretch"},
        Wrong{"(stretch - 1)*x", "(stretch - 1)", "23", "has no unit"},
        Wrong{"(stretch - 1)*x", "(stretch - 1*x", "23:17", "parenthesis"},
        Wrong{", \"free\"]", "]", "23:16", "found 1 entries; expected 2"},
        Wrong{"\"(stretch - 1)*x\"", "\"free\"", "23", "every entry is \"free\""},
        Wrong{"\"(stretch - 1)*x\"", "5", "23", "write \"5 mm\""},
        Wrong{"< 100 mm", "< 100", "11:9", "do not fit together"},
        Wrong{"< 100 mm", "", "11", "true or false"},
        Wrong{"< 100 mm", "= 100 mm", "11:26", "does not compare"},
        Wrong{"\"Membrane with a hole\"", "\"\"", "1:9", "title: found an empty text"},
        Wrong{"(stretch - 1)*x", "sqrt(-1)*x", "23:17", "gives no finite number"},
        Wrong{"< 100 mm", "< 100 mm &&", "11:9", "formula cannot be read: Unexpected end of expression"},
        Wrong{"[[hole]]", "[hole]", "7", "expected an array of tables, written [[hole]]"},
        Wrong{"disc = { radius", "disk = { radius", "8:1", "did you mean \"disc\"?"},
        Wrong{"at = 2", "at = \"2 ms\"", "42", "is a time (s); expected a number"}));

INSTANTIATE_TEST_SUITE_P(
    Rules, WrongInput,
    testing::Values(
        Wrong{"spacing = \"5 mm\"", "spacing = \"5 mm\", points = [100, 100]", "4",
              "given together with spacing; expected exactly one of spacing, points"},
        Wrong{", spacing = \"5 mm\"", "", "4", "expected one of spacing, points"},
        Wrong{"spacing = \"5 mm\"", "points = [100, 90]", "4",
              "expected equal spacing, such as 100 points instead of 90"},
        Wrong{"spacing = \"5 mm\"", "points = [100]", "4", "expected 2, one per direction"},
        Wrong{"spacing = \"5 mm\"", "spacing = \"5 m\"", "4", "larger than the body"},
        Wrong{"thickness = \"10 mm\", ", "", "4", "geometry.box.thickness: missing"},
        Wrong{"box = { size", "disc = { radius = '1 m', thickness = '1 m', spacing = '1 m' }\nbox = { size",
              "4", "given together with box; expected exactly one of box, disc"},
        Wrong{"disc = { radius = \"80 mm\" }", "ball = { radius = \"80 mm\" }", "8", "three dimensions"},
        Wrong{"disc = { radius = \"80 mm\" }",
              "box = { size = ['1 mm', '1 mm'], center = [0, 0], from = [0, 0] }", "8",
              "given together with center; expected at most one"},
        Wrong{"disc = { radius = \"80 mm\" }", "", "7",
              "hole.1: nothing found; expected one of disc, box, ball"},
        Wrong{"radius = \"80 mm\"", "", "8:8",
              "hole.1.disc.radius: missing; expected a length such as \"10 mm\""},
        Wrong{"\"dynamic-relaxation\"\nstretch = [1.5, 2, 2.5, 3]\ntolerance = 1e-5",
              "\"verlet\"\nuntil = '1 s'", "17:1", "material.rubber.density: missing with solver.method"},
        Wrong{"tolerance = 1e-5", "until = \"1 s\"", "28:9",
              "does not apply here; it belongs to method = \"verlet\""},
        Wrong{"stretch = [1.5, 2, 2.5, 3]", "", "25:1", "solver.stretch: missing"},
        Wrong{"fields =", "every = \"1 s\"\nfields =", "31", "belongs to solver.method = \"verlet\""},
        Wrong{"youngs_modulus = \"0.109 GPa\"", "", "17:1",
              "expected one of youngs_modulus, shear_modulus, c10"},
        Wrong{"youngs_modulus =", "c10 = '1 MPa'\nyoungs_modulus =", "19",
              "given together with youngs_modulus"},
        Wrong{"youngs_modulus =", "c01 = '1 MPa'\nyoungs_modulus =", "19",
              "belongs to law = \"mooney-rivlin\""},
        Wrong{"law = \"neo-hookean\"\nyoungs_modulus = \"0.109 GPa\"", "law = \"yeoh\"", "17",
              "c10: missing"},
        Wrong{"[[load]]", "[material.other]\nlaw = 'neo-hookean'\nc10 = '1 MPa'\n[[load]]", "17",
              "are without `on`"},
        Wrong{"[[load]]", "[material.other]\non = 'left'\nlaw = 'neo-hookean'\nc10 = '1 MPa'\n[[load]]",
              "22:6", "is an edge"},
        Wrong{"[[load]]", "[[interface]]\nbetween = ['rubber', 'ruber']\ncritical_stretch = 1\n[[load]]",
              "22:11", "no material \"ruber\""},
        Wrong{"[[load]]", "[[interface]]\nbetween = ['rubber', 'rubber']\ncritical_stretch = 1\n[[load]]",
              "22:22", "stands here twice"},
        Wrong{"[material.rubber]\nlaw = \"neo-hookean\"\nyoungs_modulus = \"0.109 GPa\"", "", "1:1",
              "material: missing"},
        Wrong{"on = \"right\"", "", "33:1", "probe.1.on: missing with kind = \"reaction\""},
        Wrong{"[[expect]]", "[[probe]]\nname = 'force_x'\nkind = 'reaction'\non = 'left'\n[[expect]]", "39:8",
              "is the name of another one"},
        Wrong{"metric = \"force_x\"", "", "38:1", "expected one of metric, field"},
        Wrong{"metric = \"force_x\"", "metric = 'a'\nfield = 'displacement'", "40",
              "given together with metric"},
        Wrong{"value = \"512 kN\"", "", "39", "nothing to compare with"},
        Wrong{"value = \"512 kN\"", "value = 0", "41", "expected absolute_tolerance"},
        Wrong{"value = \"512 kN\"", "value = \"512 kN\"\nmin = 3", "40", "expected one of both"},
        Wrong{"tolerance = \"0.5 %\"", "", "40", "a reference decides"},
        Wrong{"tolerance = \"0.5 %\"", "absolute_tolerance = \"1 mm\"", "41", "is in m; expected N"},
        Wrong{"metric = \"force_x\"\nvalue = \"512 kN\"", "field = 'displacement'", "38",
              "expect.1.file: missing"},
        Wrong{"solver.stretch=[1.5]", "solver.stretch", "47", "expected \"path.to.key=value\""},
        Wrong{"[[hole]]", "[[crack]]\nfrom = [0, 0]\nto = [0, 0]\n[[hole]]", "9", "same place as from"},
        Wrong{"[[hole]]", "[[inclusion]]\nname = 'a'\ndisc = {radius = '1 mm'}\n[[hole]]", "8",
              "unknown key"}));

INSTANTIATE_TEST_SUITE_P(
    Toml, WrongInput,
    testing::Values(Wrong{"title = \"Membrane with a hole\"", "title = Membrane", "1", "is not TOML here"},
                    Wrong{"horizon = \"3 dx\"", "horizon = \"3 dx\"\nhorizon = \"4 dx\"", "6", "redefine"},
                    Wrong{"[geometry]", "[geometry", "3", "is not TOML here"},
                    Wrong{"membrane", "mem\xff\xfe", "14", "is not TOML here"}));

TEST(WrongInput, TimeDoesNotKnowTheStretch) {
  EXPECT_NE(error_of(replaced(moving_case, "0.1 m/s * t", "0.1 m * stretch")).find("known are x, y, z, t"),
            std::string::npos);
  EXPECT_NE(error_of(replaced(moving_case, "until = \"43 us\"", ""))
                .find("solver.until: missing with method = \"verlet\""),
            std::string::npos);
  EXPECT_NE(
      error_of(replaced(moving_case, "at = \"40 us\"", "at = 40")).find("40 has no unit; write \"40 ms\""),
      std::string::npos);
}

TEST(WrongInput, FilesThatAreNoCases) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "riven-input-test";
  std::filesystem::create_directories(folder);
  const auto message = [](const std::filesystem::path& file) -> std::string {
    try {
      read_case(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(folder / "none.toml"),
            (folder / "none.toml").string() + ": no such file; expected a case file in TOML");
  EXPECT_NE(message(folder).find("is a directory"), std::string::npos);
  std::ofstream(folder / "binary.toml", std::ios::binary) << std::string(
      "\x7f"
      "ELF\0\1\2",
      7);
  EXPECT_NE(message(folder / "binary.toml").find("is a binary file"), std::string::npos);
  std::ofstream(folder / "empty.toml").close();
  EXPECT_NE(message(folder / "empty.toml").find("title: missing"), std::string::npos);
  std::ofstream(folder / "good.toml") << static_case;
  EXPECT_EQ(message(folder / "good.toml"), "accepted");
  std::filesystem::remove_all(folder);
}

// A rectangular hole of a sheet goes through its whole thickness; with a finite third size no bond would be
// cut.
TEST(CaseReader, BoxesOfASheetAreEndlessAcrossIt) {
  const Case c = parse_case(std::string(static_case) + "\n[[hole]]\nbox = { size = [\"1 mm\", \"2 mm\"] }\n",
                            "case.toml");
  const Box& box = std::get<Box>(c.holes.back().shape);
  EXPECT_DOUBLE_EQ(box.half_size[0], 0.0005);
  EXPECT_DOUBLE_EQ(box.half_size[1], 0.001);
  EXPECT_TRUE(std::isinf(box.half_size[2]));
}

TEST(Overrides, ChangeValuesOfAnyKind) {
  const Case c = parse_case(static_case, "case.toml",
                            {"geometry.horizon=4 dx", "solver.stretch=[1.2, 1.4]",
                             "load.1.displacement.2=1 mm", "output.fields=[\"damage\"]", "title=Another",
                             "geometry.box.spacing=\"10 mm\"", "solver.increment = 0.05", "load.1.on=top"});
  EXPECT_DOUBLE_EQ(c.geometry.horizon, 0.04);
  EXPECT_EQ(c.solver.stretch, (std::vector<double>{1.2, 1.4}));
  EXPECT_EQ((*c.loads[0].displacement[1].value)({}), 1e-3);
  EXPECT_EQ(c.output.fields, std::vector<std::string>{"damage"});
  EXPECT_EQ(c.title, "Another");
  EXPECT_EQ(c.solver.increment, 0.05);
  EXPECT_EQ(c.loads[0].on[0].text, "top");
}

TEST(Overrides, MakeSectionsThatAreNotThere) {
  const std::string text = replaced(static_case, "[model]\nkind = \"membrane\"\nstabilisation = 4", "");
  EXPECT_EQ(parse_case(text, "case.toml", {"model.stabilisation=2"}).model.stabilisation, 2);
}

TEST(Overrides, AreCheckedLikeTheFile) {
  EXPECT_EQ(error_of(static_case, {"geometry.horizon=1 mm"}).substr(0, 24), "--set geometry.horizon: ");
  EXPECT_NE(error_of(static_case, {"geometry.horizon=1 mm"}).find("below the spacing"), std::string::npos);
  EXPECT_NE(error_of(static_case, {"geometry.horizn=1 mm"}).find("did you mean \"horizon\"?"),
            std::string::npos);
  EXPECT_NE(error_of(static_case, {"load.2.on=top"})
                .find("--set load.2.on: load has 1 entry; expected a number from 1 to 1"),
            std::string::npos);
  EXPECT_NE(error_of(static_case, {"title.x=1"}).find("title is neither a table nor a list"),
            std::string::npos);
  EXPECT_NE(error_of(static_case, {"title"}).find("expected path.to.key=value"), std::string::npos);
  EXPECT_NE(error_of(static_case, {"=3"}).find("expected path.to.key=value"), std::string::npos);
  EXPECT_NE(error_of(static_case, {"solver..stretch=3"}).find("empty name"), std::string::npos);
  EXPECT_NE(error_of(static_case, {"solver.stretch=[1.5"}).find("expected a list"), std::string::npos);
  EXPECT_NE(error_of(static_case, {"output.foo.bar=1"}).find("--set output.foo.bar: output.foo: unknown key"),
            std::string::npos);
}

}  // namespace
}  // namespace riven
