#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "base/error.hpp"
#include "output/collection.hpp"
#include "output/vtu.hpp"
#include "scratch.hpp"
#include "verification/compare.hpp"
#include "verification/interpolate.hpp"

namespace riven {
namespace {

using test::message_of;
using test::Scratch;
using test::write_text;

constexpr double kSpacing = 0.01;
constexpr double kHorizon = 0.03;

/// Cell centres of a square of edge 0.4 around the origin.
std::vector<Point> square() {
  std::vector<Point> points;
  for (int i = -20; i < 20; ++i) {
    for (int j = -20; j < 20; ++j) points.push_back({(i + 0.5) * kSpacing, (j + 0.5) * kSpacing, 0});
  }
  return points;
}

Point linear(const Point& p) {
  return {0.5 * p[0] - 0.2 * p[1] + 0.01, 0.3 * p[0] + 0.7 * p[1] - 0.02, 0.1 * p[1]};
}

template <typename Field>
std::vector<Point> field_at(const std::vector<Point>& positions, Field&& field) {
  std::vector<Point> values;
  for (const Point& p : positions) values.push_back(field(p));
  return values;
}

double difference(const std::optional<Point>& a, const Point& b) {
  if (!a) return std::numeric_limits<double>::infinity();
  return std::hypot((*a)[0] - b[0], (*a)[1] - b[1], (*a)[2] - b[2]);
}

CompareSettings settings(Defects defects = {}) {
  return {std::move(defects), kSpacing, kHorizon, 0};
}

class RandomPlaces {
 public:
  Point next() { return {coordinate_(random_), coordinate_(random_), 0}; }

 private:
  std::mt19937 random_{11};
  std::uniform_real_distribution<double> coordinate_{-0.2, 0.2};
};

TEST(Interpolation, IsExactForLinearFieldsUpToTheEdge) {
  const auto positions = square();
  const auto displacements = field_at(positions, linear);
  const Defects none;
  const Interpolation interpolation(positions, displacements, none, kSpacing, kHorizon);
  RandomPlaces places;
  for (int i = 0; i < 500; ++i) {
    const Point place = places.next();
    EXPECT_LT(difference(interpolation.at(place), linear(place)), 1e-14);
  }
  for (const Point& corner : {Point{0.2, 0.2, 0}, Point{-0.2, 0.2, 0}, Point{0.2, 0, 0}}) {
    EXPECT_LT(difference(interpolation.at(corner), linear(corner)), 1e-14);
  }
}

TEST(Interpolation, IsExactInOneAndThreeDimensions) {
  const Defects none;
  std::vector<Point> bar, cube;
  for (int i = 0; i < 8; ++i) {
    bar.push_back({i * kSpacing, 0, 0});
    for (int j = 0; j < 8; ++j) {
      for (int k = 0; k < 8; ++k) cube.push_back({i * kSpacing, j * kSpacing, k * kSpacing});
    }
  }
  const auto field = [](const Point& p) { return Point{p[0] + p[2], p[1] - 2 * p[2], p[2] + 1}; };
  const Point on_bar{0.0333, 0, 0}, in_cube{0.0333, 0.0101, 0.0687};
  const auto u_bar = field_at(bar, field), u_cube = field_at(cube, field);
  EXPECT_LT(difference(Interpolation(bar, u_bar, none, kSpacing, kHorizon).at(on_bar), field(on_bar)), 1e-14);
  EXPECT_LT(difference(Interpolation(cube, u_cube, none, kSpacing, kHorizon).at(in_cube), field(in_cube)),
            1e-14);
}

TEST(Interpolation, IsOfSecondOrderForSmoothFields) {
  const Defects none;
  const auto smooth = [](const Point& p) { return Point{std::sin(10 * p[0]) * std::cos(7 * p[1]), 0, 0}; };
  const auto error = [&](double spacing) {
    std::vector<Point> positions;
    for (int i = -30; i <= 30; ++i) {
      for (int j = -30; j <= 30; ++j) positions.push_back({i * spacing, j * spacing, 0});
    }
    const auto u = field_at(positions, smooth);
    const Interpolation interpolation(positions, u, none, spacing, 3 * spacing);
    double largest = 0;
    for (const Point& place : {Point{0.1234, 0.0521, 0}, Point{-0.05, 0.0111, 0}, Point{0.07, -0.11, 0}}) {
      largest = std::max(largest, difference(interpolation.at(place), smooth(place)));
    }
    return largest;
  };
  EXPECT_LT(error(0.01), 2e-2);
  EXPECT_LT(error(0.005), 0.35 * error(0.01));
}

// The two sides move differently: one wrong point spoils the value.
Point torn(const Point& p) {
  const Point u = linear(p);
  return p[0] > 0 ? u : Point{u[0] - 0.05, u[1] + 0.02, u[2]};
}

TEST(Interpolation, NeverMixesTheSidesOfACrack) {
  const Defects slit{{}, {{{0, -0.3, 0}, {0, 0.3, 0}}}, {}};
  const auto positions = square();
  const auto displacements = field_at(positions, torn);
  const Interpolation interpolation(positions, displacements, slit, kSpacing, kHorizon);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> beside(-0.02, 0.02), along(-0.2, 0.2);
  for (int i = 0; i < 500; ++i) {
    const Point place{beside(random), along(random), 0};
    EXPECT_LT(difference(interpolation.at(place), torn(place)), 1e-14) << place[0] << ' ' << place[1];
  }
  for (const double side : {-1e-7, 1e-7}) {
    const Point face{side, 0.037, 0};
    EXPECT_LT(difference(interpolation.at(face), torn(face)), 1e-14);
  }
  const Defects none;
  const Point near{0.002, 0.037, 0};
  EXPECT_GT(
      difference(Interpolation(positions, displacements, none, kSpacing, kHorizon).at(near), torn(near)),
      1e-3);
}

TEST(Interpolation, NeverLooksThroughASlot) {
  const Defects slot{{Box{{0, 0, 0}, {0.005, 0.3, 1}}}, {}, {}};
  std::vector<Point> positions;
  for (const Point& p : square()) {
    if (signed_distance(slot.holes[0], p) > 0 || std::abs(p[0]) > 0.006) positions.push_back(p);
  }
  const auto displacements = field_at(positions, torn);
  const Interpolation interpolation(positions, displacements, slot, kSpacing, kHorizon);
  for (const double x : {-0.012, -0.005, 0.005, 0.012}) {
    const Point place{x, 0.0333, 0};
    EXPECT_LT(difference(interpolation.at(place), torn(place)), 1e-14) << x;
  }
}

TEST(Interpolation, HasNoValueWhereNoneMakesSense) {
  const Defects defects{{Disc{{0.1, 0.1, 0}, 0.05}}, {{{-0.1, -0.05, 0}, {-0.1, 0.05, 0}}}, {}};
  std::vector<Point> positions;
  for (const Point& p : square()) {
    if (signed_distance(defects.holes[0], p) > 0) positions.push_back(p);
  }
  const auto displacements = field_at(positions, linear);
  const Interpolation interpolation(positions, displacements, defects, kSpacing, kHorizon);
  EXPECT_TRUE(interpolation.at({0, 0, 0}));
  EXPECT_FALSE(interpolation.at({-0.1, 0.01, 0})) << "on a crack";
  EXPECT_FALSE(interpolation.at({0.1, 0.145, 0})) << "in a hole";
  EXPECT_TRUE(interpolation.at({0.1, 0.15, 0})) << "on the hole's edge";
  EXPECT_TRUE(interpolation.at({0.205, 0, 0}));
  EXPECT_FALSE(interpolation.at({0.217, 0, 0})) << "far from every point";
}

TEST(Interpolation, WidensItsViewUntilThePointsSpanThePlane) {
  const Defects none;
  // Two columns 2.5 spacings apart: the first radius sees only one of them.
  std::vector<Point> positions;
  for (int j = 0; j < 10; ++j) {
    positions.push_back({0, j * kSpacing, 0});
    positions.push_back({2.5 * kSpacing, j * kSpacing, 0});
  }
  const auto displacements = field_at(positions, linear);
  const Point place{0.2 * kSpacing, 0.045, 0};
  EXPECT_LT(
      difference(Interpolation(positions, displacements, none, kSpacing, kHorizon).at(place), linear(place)),
      1e-14);
  // One column alone (a second far away) never does.
  for (Point& p : positions) p[0] *= 10;
  EXPECT_FALSE(Interpolation(positions, displacements, none, kSpacing, kHorizon).at({0.0001, 0.045, 0}));
}

TEST(Interpolation, KeepsInclusionsApart) {
  const Defects disc{{}, {}, {Disc{{0, 0, 0}, 0.08}}};
  // The disc moves rigidly, the rest otherwise.
  const auto field = [&](const Point& p) {
    return signed_distance(disc.inclusions[0], p) < 0 ? Point{1 - 0.2 * p[1], 2 + 0.2 * p[0], 0} : linear(p);
  };
  const auto positions = square();
  const auto displacements = field_at(positions, field);
  const Interpolation interpolation(positions, displacements, disc, kSpacing, kHorizon);
  const auto at_angle = [](double radius, double angle) {
    return Point{radius * std::cos(angle), radius * std::sin(angle), 0};
  };
  for (double angle = 0; angle < 6.28; angle += 0.1) {
    const Point outside = at_angle(0.083, angle), edge = at_angle(0.08, angle),
                inside = at_angle(0.077, angle);
    EXPECT_LT(difference(interpolation.at(outside), linear(outside)), 1e-14) << angle;
    EXPECT_LT(difference(interpolation.at(edge), linear(edge)), 1e-14) << angle;
    EXPECT_LT(difference(interpolation.at(inside), field(inside)), 1e-13) << angle;
  }
}

TEST(CompareState, MeasuresTheDeviation) {
  const auto positions = square();
  const ResultState state{1.5, positions, field_at(positions, linear)};
  std::vector<ReferencePoint> reference;
  for (const Point& p : {Point{0.011, 0.02, 0}, Point{-0.1, 0.07, 0}}) reference.push_back({p, linear(p)});
  EXPECT_LT(compare_state(state, reference, 2, settings()).relative_l2, 1e-13);
  const Point u0 = reference[0].displacement;
  reference[1].displacement[0] += 0.003;
  reference[1].displacement[1] -= 0.004;
  const Point u1 = reference[1].displacement;
  const auto result = compare_state(state, reference, 2, settings());
  EXPECT_NEAR(result.maximum, 0.005, 1e-12);
  EXPECT_EQ(result.maximum_at, reference[1].position);
  EXPECT_NEAR(result.relative_l2, 0.005 / std::hypot(std::hypot(u0[0], u0[1]), std::hypot(u1[0], u1[1])),
              1e-12);
  EXPECT_EQ(result.used, 2);
  EXPECT_EQ(result.value, 1.5);
}

TEST(CompareState, ComparesOnlyTheComponentsOfTheReference) {
  const auto positions = square();
  const ResultState state{1, positions, field_at(positions, linear)};
  const Point p{0.011, 0.02, 0};
  const Point u = linear(p);
  const std::vector<ReferencePoint> reference{{p, {u[0], u[1], 0}}};
  EXPECT_LT(compare_state(state, reference, 2, settings()).maximum, 1e-13);
  EXPECT_NEAR(compare_state(state, reference, 3, settings()).maximum, std::abs(u[2]), 1e-13);
}

TEST(CompareState, LeavesOutWhatIsNearADefectOrOutside) {
  const auto positions = square();
  const ResultState state{1, positions, field_at(positions, linear)};
  CompareSettings near = settings({{}, {{{0, -0.05, 0}, {0, 0.05, 0}}}, {}});
  near.exclude_within = 0.01;
  std::vector<ReferencePoint> reference{{{0.0099, 0, 0}, {}},
                                        {{0.01, 0, 0}, {}},
                                        {{0.0101, 0, 0}, {}},
                                        {{0, 0.0599, 0}, {}},
                                        {{0.3, 0, 0}, {}}};
  const auto result = compare_state(state, reference, 2, near);
  EXPECT_EQ(result.excluded, 2);
  EXPECT_EQ(result.used, 2);  // stated at the very distance: kept
  EXPECT_EQ(result.outside, 1);
}

TEST(CompareState, RefusesWhenNothingCanBeCompared) {
  const ResultState state{2.5, square(), field_at(square(), linear)};
  const std::string message = message_of<InputError>([&] {
    return compare_state(state, {{{1, 0, 0}, {}}, {{2, 0, 0}, {}}}, 2, settings());
  });
  EXPECT_NE(message.find("state 2.5: none of the 2 reference points"), message.npos) << message;
  EXPECT_THROW(compare_state({1, {}, {}}, {{{0, 0, 0}, {}}}, 2, settings()), InputError);
}

TEST(CompareState, ANaNIsNeverADeviationThatPasses) {
  const auto positions = square();
  ResultState state{1, positions, field_at(positions, linear)};
  state.displacements[820][0] = std::numeric_limits<double>::quiet_NaN();
  std::vector<ReferencePoint> reference{{{0.1, 0.1, 0}, {}}, {positions[820], {}}, {{0.15, 0.1, 0}, {}}};
  const auto result = compare_state(state, reference, 2, settings());
  EXPECT_TRUE(std::isnan(result.maximum));
  EXPECT_TRUE(std::isnan(result.relative_l2));
  EXPECT_EQ(result.maximum_at, positions[820]);
  EXPECT_TRUE(to_json(FieldDeviation{{result}, {}})["states"][0]["relative_l2"].is_null());
}

TEST(ReferencePoints, ReadsStatesAndIgnoresTheRest) {
  const Scratch scratch;
  write_text(scratch / "a.csv",
             "# made by hand\r\nlambda,kind,X_m,Y_m,ux_m,uy_m,mesh_change_m\r\n1.5,\"axis, x\",1,2,3,4,x\r\n"
             "2,b,5,6,7,8,\r\n1.5,c,9,10,11,12,\r\n");
  const auto reference = read_reference_points(scratch / "a.csv");
  EXPECT_EQ(reference.dimension, 2);
  ASSERT_EQ(reference.states.size(), 2u);
  EXPECT_EQ(reference.states[0].value, 1.5);
  ASSERT_EQ(reference.states[0].points.size(), 2u);
  EXPECT_EQ(reference.states[0].points[1].position, (Point{9, 10, 0}));
  EXPECT_EQ(reference.states[0].points[1].displacement, (Point{11, 12, 0}));
  EXPECT_EQ(reference.states[1].value, 2);
}

TEST(ReferencePoints, ReadsOneAndThreeDimensionsAndNoState) {
  const Scratch scratch;
  write_text(scratch / "a.csv", "uz_m,uy_m,ux_m,Z_m,Y_m,X_m\n6,5,4,3,2,1\n");
  const auto solid = read_reference_points(scratch / "a.csv");
  EXPECT_EQ(solid.dimension, 3);
  EXPECT_FALSE(solid.states[0].value);
  EXPECT_EQ(solid.states[0].points[0].position, (Point{1, 2, 3}));
  EXPECT_EQ(solid.states[0].points[0].displacement, (Point{4, 5, 6}));
  write_text(scratch / "b.csv", "t_s,X_m,ux_m\n0.5,1,2\n");
  const auto bar = read_reference_points(scratch / "b.csv");
  EXPECT_EQ(bar.dimension, 1);
  EXPECT_EQ(bar.states[0].value, 0.5);
}

TEST(ReferencePoints, ErrorsNameFileLineAndWhatWasExpected) {
  const Scratch scratch;
  const auto refused = [&](const std::string& text) {
    write_text(scratch / "a.csv", text);
    return message_of<InputError>([&] { return read_reference_points(scratch / "a.csv"); });
  };
  EXPECT_NE(refused("X_m,Y_m,ux_m,uy_m\n1,2,3,4\n1,2,three,4\n")
                .find("a.csv:3: column \"ux_m\": expected a number"),
            std::string::npos);
  EXPECT_NE(refused("X_m,Y_m,ux_m,uy_m\n1,2,nan,4\n").find("a.csv:2"), std::string::npos);
  EXPECT_NE(refused("X_m,Y_m,ux_m,uy\n").find("expected a column \"uy_m\""), std::string::npos);
  EXPECT_NE(refused("x,y,u\n1,2,3\n").find("expected a column \"X_m\"; there are: x, y, u"),
            std::string::npos);
  EXPECT_NE(refused("X_m,ux_m,lambda,time\n1,2,3,4\n").find("\"lambda\" and \"time\""), std::string::npos);
  EXPECT_NE(refused("X_m,ux_m\n").find("only column names"), std::string::npos);
}

void write_state(const std::filesystem::path& folder, Collection& collection, double value, double scale,
                 std::vector<double> damage = {}) {
  PointCloud cloud{square(), {}};
  PointField displacement{"displacement", 3, {}};
  for (const Point& p : cloud.positions) {
    for (const double u : linear(p)) displacement.values.push_back(scale * u);
  }
  cloud.fields.push_back(displacement);
  if (!damage.empty()) cloud.fields.push_back({"damage", 1, damage});
  const std::string file = "state-" + std::to_string(value) + ".vtu";
  write_vtu(folder / file, cloud);
  collection.add(value, file);
}

ReferencePoints reference_with(const std::vector<std::optional<double>>& values) {
  ReferencePoints reference{"ref.csv", 2, {}};
  const Point p{0.0123, 0.0456, 0};
  for (const auto& value : values) {
    const Point u = linear(p);
    const double scale = value.value_or(2);
    reference.states.push_back({value, {{p, {scale * u[0], scale * u[1], 0}}}});
  }
  return reference;
}

TEST(CompareFields, MatchesStatesByValue) {
  const Scratch scratch;
  Collection collection(scratch / "fields.pvd");
  for (const double value : {1.0, 1.5, 2.0}) write_state(scratch.path(), collection, value, value);
  const auto result =
      compare_fields(scratch.path(), reference_with({2 * (1 + 5e-7), 1.5, 1.5 * (1 + 2e-6), 3}), settings());
  ASSERT_EQ(result.states.size(), 2u);
  EXPECT_EQ(result.states[0].value, 2);
  EXPECT_LT(result.states[0].relative_l2, 1e-6);
  EXPECT_EQ(result.states[1].value, 1.5);
  EXPECT_LT(result.states[1].relative_l2, 1e-13);
  EXPECT_EQ(result.missing, (std::vector<double>{1.5 * (1 + 2e-6), 3}));
  EXPECT_EQ(result.uncompared, std::vector<double>{1});
  const auto last = compare_fields(scratch.path(), reference_with({std::nullopt}), settings());
  EXPECT_EQ(last.states.at(0).value, 2);
  EXPECT_LT(last.states[0].relative_l2, 1e-13);
  EXPECT_TRUE(last.uncompared.empty());
}

TEST(CompareFields, PointsWithoutBondsAreNotLive) {
  const Scratch scratch;
  Collection collection(scratch / "fields.pvd");
  const auto positions = square();
  std::vector<double> damage(positions.size(), 0.9);
  for (std::size_t i = 0; i < damage.size(); ++i) damage[i] = positions[i][0] > 0 ? 1 : 0.9;
  write_state(scratch.path(), collection, 2, 2, damage);
  const auto message = message_of<InputError>([&] {
    return compare_fields(scratch.path(), {"ref.csv", 2, {{2.0, {{{0.1, 0, 0}, {}}}}}}, settings());
  });
  EXPECT_NE(message.find("1 are where the result has no points"), message.npos) << message;
  EXPECT_NO_THROW(compare_fields(scratch.path(), {"ref.csv", 2, {{2.0, {{{-0.1, 0, 0}, {}}}}}}, settings()));
}

TEST(CompareFields, RefusesResultsThatCannotBeCompared) {
  const Scratch scratch;
  EXPECT_THROW(compare_fields(scratch.path(), reference_with({2}), settings()), InputError);
  Collection collection(scratch / "fields.pvd");
  write_state(scratch.path(), collection, 1.5, 1);
  const std::string none =
      message_of<InputError>([&] { return compare_fields(scratch.path(), reference_with({3}), settings()); });
  EXPECT_NE(none.find("which has 1.5"), none.npos) << none;
  write_vtu(scratch / "empty.vtu", {{{0, 0, 0}}, {}});
  collection.add(2, "empty.vtu");
  const std::string field =
      message_of<InputError>([&] { return compare_fields(scratch.path(), reference_with({2}), settings()); });
  EXPECT_NE(field.find("displacement"), field.npos) << field;
}

TEST(CompareHistory, InterpolatesLinearly) {
  const Scratch scratch;
  write_text(scratch / "history.csv", "stretch,reaction [N]\n1,0\n2,10\n4,50\n");
  write_text(scratch / "ref.csv",
             "case,lambda,F\nhole,1,0\nhole,1.5,5\nhole,3,34\nhole,4.0000001,50\nhole,5,1\n");
  const auto result = compare_history(scratch / "history.csv", scratch / "ref.csv", "reaction", "F");
  EXPECT_EQ(result.used, 4);
  EXPECT_EQ(result.outside, 1);
  EXPECT_NEAR(result.maximum, 4, 1e-12);
  EXPECT_EQ(result.maximum_at, 3);
  EXPECT_NEAR(result.relative_l2, 4 / std::sqrt(25 + 34 * 34 + 2500.0), 1e-12);
}

TEST(CompareHistory, TakesFallingStretchesAndAnyFirstColumn) {
  const Scratch scratch;
  write_text(scratch / "history.csv", "stretch,f\n1,0\n0.8,-2\n0.6,-4\n");
  write_text(scratch / "ref.csv", "x,f\n0.7,-3\n0.8,-2\n");
  const auto result = compare_history(scratch / "history.csv", scratch / "ref.csv", "f", "f");
  EXPECT_EQ(result.used, 2);
  EXPECT_LT(result.maximum, 1e-12);
}

TEST(CompareHistory, RefusesWhatCannotBeCompared) {
  const Scratch scratch;
  write_text(scratch / "history.csv", "time [s],f\n0,0\n1,1\n0.5,1\n");
  write_text(scratch / "ref.csv", "t_s,f\n2,1\n");
  const auto compare = [&](const char* column) {
    return message_of<InputError>(
        [&] { return compare_history(scratch / "history.csv", scratch / "ref.csv", "f", column); });
  };
  EXPECT_NE(compare("f").find("only rises or only falls"), std::string::npos);
  write_text(scratch / "history.csv", "time [s],f\n0,0\n1,1\n");
  EXPECT_NE(compare("f").find("none of its 1 rows"), std::string::npos);
  EXPECT_NE(compare("g").find("expected a column \"g\""), std::string::npos);
}

TEST(CompareReport, TableAndJsonHoldTheNumbers) {
  const FieldDeviation deviation{{{1.5, 0.0123, 4.5e-4, {0.25, -0.125, 0}, 80, 12, 3}}, {2.5}, {1, 1.25}};
  const std::string text = table(deviation);
  for (const char* part :
       {"1.5 ", "1.230e-02", "4.500e-04", "(0.25, -0.125, 0)", "80", "12", "3\n", "2.5  the result lacks",
        "\nnot compared, for the reference lacks them: 1, 1.25\n"}) {
    EXPECT_NE(text.find(part), text.npos) << part;
  }
  const auto json = to_json(deviation);
  EXPECT_EQ(json["states"][0]["relative_l2"], 0.0123);
  EXPECT_EQ(json["states"][0]["excluded"], 12);
  EXPECT_EQ(json["missing"][0], 2.5);
  EXPECT_EQ(json["uncompared"], (std::vector<double>{1, 1.25}));
  const HistoryDeviation history{0.5, 2, 1.25, 10, 1};
  EXPECT_NE(table(history).find("5.000e-01"), std::string::npos);
  EXPECT_EQ(to_json(history)["maximum_at"], 1.25);
}

}  // namespace
}  // namespace riven
