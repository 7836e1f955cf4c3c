// Bodies from closed surfaces: what lies inside, STL files, and what is refused.

#include "geometry/surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numeric>

#include "base/error.hpp"
#include "body/lattice_body.hpp"
#include "geometry/stl.hpp"
#include "support/random.hpp"
#include "support/surfaces.hpp"
#include "unit/scratch.hpp"

namespace riven::testing {
namespace {

/// Volume of all cells of a lattice over the surface's box, shifted against it by parts of a cell.
double covered_volume(const Surface& surface, double spacing, const Point& shift = {}) {
  const Box& box = surface.box();
  std::array<int, 3> cells{};
  Point first{};
  for (std::size_t a = 0; a < 3; ++a) {
    cells[a] = static_cast<int>(std::ceil(2 * box.half_size[a] / spacing)) + 2;
    first[a] = box.center[a] - box.half_size[a] + (shift[a] - 0.5) * spacing;
  }
  double parts = 0;
  for (int j = 0; j < cells[1]; ++j)
    for (int k = 0; k < cells[2]; ++k)
      for (const double part : surface.covered_fractions(
               {first[0], first[1] + j * spacing, first[2] + k * spacing}, spacing, cells[0])) {
        EXPECT_GE(part, 0);
        EXPECT_LE(part, 1);
        parts += part;
      }
  return parts * std::pow(spacing, 3);
}

TEST(Surface, OfABoxCoversItsPartOfEachCell) {
  Random random(1);
  for (int n = 0; n < 100; ++n) {
    // Along x the ends lie anywhere; across, lines through quarters of cells see ends between quarters.
    const auto quarter = [&](int low, int high) { return 0.25 * random.integer(low, high); };
    const Point lower{random.between(-2, 0), quarter(-8, 0), quarter(-8, 0)},
        upper{random.between(0.1, 3), quarter(1, 12), quarter(1, 12)};
    const Surface surface(box_surface(lower, upper));
    Box box;
    for (std::size_t a = 0; a < 3; ++a) {
      box.center[a] = 0.5 * (lower[a] + upper[a]);
      box.half_size[a] = 0.5 * (upper[a] - lower[a]);
      EXPECT_DOUBLE_EQ(surface.box().half_size[a], box.half_size[a]);
    }
    EXPECT_NEAR(surface.volume(), 8 * box.half_size[0] * box.half_size[1] * box.half_size[2], 1e-13);
    for (int j = -3; j <= 3; ++j)
      for (int k = -3; k <= 3; ++k) {
        const Point first{-3, 1.0 * j, 1.0 * k};
        const std::vector<double> found = surface.covered_fractions(first, 1, 8);
        for (int i = 0; i < 8; ++i)
          ASSERT_NEAR(found[static_cast<std::size_t>(i)],
                      covered_fraction(box, {i - 3.0, first[1], first[2]}, 1, 3), 1e-9);
      }
    for (const bool filled : surface.filled_faces()) EXPECT_TRUE(filled);
  }
}

// Lines go exactly through corners, and along edges and sides.
TEST(Surface, OfAnOctahedronIsMetAtItsCornersAndEdges) {
  for (const double radius : {1.0, 2.0}) {
    const Surface surface(ball_surface(radius, 0));
    const double step = 0.25;  // of the lines; the cube's edge is 1
    for (int j = -4; j <= 4; ++j)
      for (int k = -4; k <= 4; ++k) {
        const Point first{-2.5, j * step + 0.125,
                          k * step + 0.125};  // the second line of four is at j * step
        std::vector<double> expected(6, 0.0);
        for (int b = -1; b <= 2; ++b)
          for (int c = -1; c <= 2; ++c) {
            const double reach = radius - std::abs((j + b) * step) - std::abs((k + c) * step);
            for (int i = 0; i < 6 && reach > 0; ++i)
              expected[static_cast<std::size_t>(i)] +=
                  std::max(0.0, std::min(reach, i - 2.0) - std::max(-reach, i - 3.0)) / 16;
          }
        const std::vector<double> found = surface.covered_fractions(first, 1, 6);
        for (std::size_t i = 0; i < 6; ++i)
          ASSERT_NEAR(found[i], expected[i], 1e-9) << j << ' ' << k << ' ' << i;
      }
    for (const bool filled : surface.filled_faces()) EXPECT_FALSE(filled);
  }
}

TEST(Surface, OfABallIsFilledWithItsVolume) {
  const Surface ball(ball_surface(1, 5));
  // 8192 triangles, whose middles lie inside of the ball; measured: -0.0015.
  EXPECT_NEAR(ball.volume() / (4.0 / 3 * std::numbers::pi), 1, 0.002);
  Random random(2);
  std::array<double, 3> error{};
  for (std::size_t n = 0; n < error.size(); ++n)
    for (int trial = 0; trial < 4; ++trial) {
      const double found = covered_volume(ball, 0.4 / std::pow(2.0, n),
                                          {random.between(0, 1), random.between(0, 1), random.between(0, 1)});
      error[n] = std::max(error[n], std::abs(found / ball.volume() - 1));
    }
  // Lines a quarter of the spacing apart integrate a depth that ends like a root: order 3/2 at least.
  // Measured: 1.5e-3 with 5 cells across, 5e-4, 1.1e-4.
  EXPECT_LT(error[0], 5e-3);
  EXPECT_LT(error[2], error[0] / 8);
}

TEST(Surface, OfAnyPositionKeepsItsVolume) {
  Random random(3);
  for (int n = 0; n < 20; ++n) {
    const Eigen::Matrix3d turn = Eigen::Quaterniond(random.between(-1, 1), random.between(-1, 1),
                                                    random.between(-1, 1), random.between(-1, 1))
                                     .normalized()
                                     .toRotationMatrix();
    const Eigen::Vector3d shift(random.between(-5, 5), random.between(-5, 5), random.between(-5, 5));
    const auto map = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return turn * x + shift; };
    const Surface box(moved(box_surface({0, 0, 0}, {1, 2, 0.7}), map));
    EXPECT_NEAR(box.volume(), 1.4, 1e-13);
    // The same with 6 and 7 cells across; measured: 5e-4 of the box, 2e-4 of the ring at most.
    EXPECT_NEAR(covered_volume(box, 0.1), 1.4, 2e-3 * 1.4);
    const Surface ring(moved(torus_surface(1, 0.3, 24, 12), map));
    EXPECT_NEAR(covered_volume(ring, 0.1), ring.volume(), 2e-3 * ring.volume());
  }
}

TEST(Surface, MayHaveCavitiesAndSeveralBodies) {
  const Triangles large = box_surface({0, 0, 0}, {4, 4, 4}), small = box_surface({1, 1, 1}, {3, 3, 3});
  const Surface hollow(together(large, turned_over(small)));
  EXPECT_NEAR(hollow.volume(), 64 - 8, 1e-12);
  EXPECT_NEAR(covered_volume(hollow, 0.5), 56, 1e-9);
  const Surface inwards(together(turned_over(large), small));  // all of it turned over
  EXPECT_NEAR(inwards.volume(), 56, 1e-12);
  EXPECT_NEAR(covered_volume(inwards, 0.5), 56, 1e-9);
  const Surface two(together(large, box_surface({6, 0, 0}, {7, 1, 1})));
  EXPECT_NEAR(covered_volume(two, 0.5), 65, 1e-9);
  const Surface overlapping(together(large, box_surface({3, 0, 0}, {5, 4, 4})));
  EXPECT_NEAR(covered_volume(overlapping, 0.5), 80, 1e-9);
  const Surface wrong(together(large, turned_over(box_surface({6, 0, 0}, {7, 1, 1}))));
  EXPECT_NE(test::message_of<InputError>([&] {
              covered_volume(wrong, 0.5);
            }).find("face inwards around a body of their own near (6, "),
            std::string::npos);
}

TEST(Surface, IsRefusedUnlessItIsClosed) {
  Triangles box = box_surface({0, 0, 0}, {1, 2, 3});
  box.triangle.pop_back();
  EXPECT_NE(test::message_of<InputError>([&] { Surface{box}; })
                .find("not closed: 3 of 18 edges are open or have triangles that face different ways, the "
                      "first from (0, 0, 3) m "
                      "to (0, 2, 3) m; expected"),
            std::string::npos)
      << test::message_of<InputError>([&] { Surface{box}; });
  box = box_surface({0, 0, 0}, {1, 2, 3});
  std::swap(box.triangle[5][0], box.triangle[5][1]);
  EXPECT_NE(test::message_of<InputError>([&] { Surface{box}; }).find("where a triangle is turned over"),
            std::string::npos);
  for (std::size_t n = 0; n < 12; ++n) {
    Triangles one_less = box_surface({0, 0, 0}, {1, 2, 3});
    one_less.triangle.erase(one_less.triangle.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_THROW(Surface{one_less}, InputError);
  }
  EXPECT_THROW(Surface{Triangles{}}, InputError);
  EXPECT_NE(test::message_of<InputError>([&] {
              Surface{box_surface({0, 0, 0}, {1, 1, 0})};
            }).find("encloses no volume"),
            std::string::npos);
}

class Stl : public ::testing::Test {
 protected:
  Triangles read(const std::string& bytes) {
    test::write_text(scratch_ / "s.stl", bytes);
    return read_stl(scratch_ / "s.stl");
  }
  std::string refusal(const std::string& bytes) {
    return test::message_of<InputError>([&] { read(bytes); });
  }
  test::Scratch scratch_;
};

TEST_F(Stl, SaysTheSameInTextAndBytes) {
  // Decimal numbers of few digits survive single precision.
  const Triangles box = box_surface({-0.1, 12.7, 0}, {3.3, 25.4, 0.001});
  const Triangles ascii = read(stl_text(box, false)), binary = read(stl_text(box, true));
  EXPECT_EQ(ascii.corner, binary.corner);
  EXPECT_EQ(ascii.triangle, binary.triangle);
  EXPECT_EQ(Surface(ascii).box().half_size, Surface(box).box().half_size);
  EXPECT_EQ(ascii.corner.size(), 8U);
  EXPECT_NEAR(Surface(ascii).volume(), 3.4 * 12.7 * 0.001, 1e-15);
  const Triangles ball = read(stl_text(ball_surface(10, 3), true));
  EXPECT_EQ(ball.triangle.size(), 512U);
  EXPECT_NEAR(Surface(ball).volume(), Surface(ball_surface(10, 3)).volume(), 1e-3);  // single precision
}

TEST_F(Stl, JoinsCornersAndDropsTrianglesWithoutArea) {
  std::string text = stl_text(box_surface({0, 0, 0}, {1, 1, 1}), false);
  text.replace(text.find("vertex 0 0 0"), 12, "vertex -0 0 0.0");
  text +=
      "SOLID another\r\nFACET normal 0 0 0\r\nOUTER LOOP\r\nVERTEX 1 1 1\r\nVERTEX 1 1 1\r\nVERTEX 0 0 "
      "0\r\nENDLOOP\r\nENDFACET\r\nENDSOLID\r\n";
  const Triangles found = read(text);
  EXPECT_EQ(found.corner.size(), 8U);
  EXPECT_EQ(found.triangle.size(), 12U);
  EXPECT_NO_THROW(Surface{found});
}

TEST_F(Stl, CutShortAtAnyByteIsRefused) {
  for (const bool binary : {false, true}) {
    const std::string whole = stl_text(box_surface({0, 0, 0}, {1, 1, 1}), binary);
    // As text the name behind endsolid may be missing.
    const std::size_t needed = binary ? whole.size() : whole.find("endsolid") + 8;
    for (std::size_t length = 0; length < needed; ++length)
      ASSERT_THROW(read(whole.substr(0, length)), InputError)
          << length << (binary ? " bytes" : " characters");
    EXPECT_NO_THROW(read(whole.substr(0, needed)));
  }
}

TEST_F(Stl, WithAnyMistakeIsReadOrRefused) {
  Random random(5);
  for (int n = 0; n < 500; ++n) {
    std::string bytes = stl_text(box_surface({0, 0, 0}, {1, 1, 1}), n % 2 == 0);
    const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
    bytes[at] = static_cast<char>(random.integer(0, 255));
    try {
      const Surface surface(read(bytes));
      static_cast<void>(surface.covered_fractions({-1, 0.3, 0.4}, 0.5, 6));
    } catch (const InputError& error) {
      EXPECT_STRNE(error.what(), "");
    }
  }
}

TEST_F(Stl, NamesWhatIsWrongAndWhere) {
  const std::string text = stl_text(box_surface({0, 0, 0}, {1, 1, 1}), false);
  const auto changed = [&](const std::string& old, const std::string& by) {
    std::string other = text;
    return other.replace(other.find(old), old.size(), by);
  };
  const std::pair<std::string, std::string> mistakes[] = {
      {"", "s.stl: found 0 bytes that do not begin with \"solid\"; expected an STL file"},
      {changed("outer", "inner"), "s.stl:3: found \"inner\"; expected outer"},
      {changed("vertex 0 0 1", "vertex 0 0 l"), "s.stl:5: found \"l\"; expected a coordinate of a corner"},
      {changed("vertex 0 0 1", "vertex 0 0 inf"),
       "s.stl:5: found inf; expected a coordinate of a corner, a finite number"},
      {changed("vertex 0 0 1\n", ""), "s.stl:6: found \"endloop\"; expected vertex"},
      {changed("endfacet", "facet"), "s.stl:8: found \"facet\"; expected endfacet"},
      {text.substr(0, text.find("endsolid")), "found the end of the file; expected facet or endsolid"},
      {text + "more", "found \"more\"; expected solid"},
  };
  for (const auto& [bytes, said] : mistakes)
    EXPECT_NE(refusal(bytes).find(said), std::string::npos) << refusal(bytes) << "\nexpected: " << said;
}

TEST(SurfaceBody, OfABoxIsTheBodyOfTheBox) {
  const Box box{{0.5, 1, 1.5}, {0.5, 1, 1.5}};
  LatticeBodyInput in{.dimension = 3,
                      .shape = box,
                      .thickness = 1,
                      .spacing = 0.25,
                      .horizon = 0.75,
                      .defects = {},
                      .mirrored = Faces(0b000011)};
  in.defects.holes = {Ball{{0.5, 1, 1.5}, 0.4}};
  const Body plain = make_lattice_body(in);
  const Surface surface(box_surface({0, 0, 0}, {1, 2, 3}));
  in.surface = &surface;
  const Body body = make_lattice_body(in);
  EXPECT_EQ(body.kind, plain.kind);
  EXPECT_EQ(body.points, plain.points);
  EXPECT_EQ(body.complete, plain.complete);
  for (std::size_t n = 0; n < body.size(); ++n) ASSERT_NEAR(body.volume[n], plain.volume[n], 1e-12);
}

TEST(SurfaceBody, KeepsTheVolumeOfItsSurface) {
  const Surface surface(ball_surface(1, 3));
  LatticeBodyInput in{.dimension = 3,
                      .shape = surface.box(),
                      .thickness = 1,
                      .spacing = 0.1,
                      .horizon = 0.3,
                      .defects = {},
                      .mirrored = {}};
  in.surface = &surface;
  const Body body = make_lattice_body(in);
  double volume = 0;
  for (const std::size_t i : body.points) {
    volume += body.volume[i];
    // A point stands for half a cell at least, so it is hardly outside.
    EXPECT_LT(std::hypot(body.position(i)[0], body.position(i)[1], body.position(i)[2]), 1.03);
  }
  EXPECT_NEAR(volume / surface.volume(), 1, 1e-3);  // as above; measured: 1e-5
}

}  // namespace
}  // namespace riven::testing
