#include <cairo.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "report/chart.hpp"
#include "report/picture.hpp"
#include "report/point_raster.hpp"
#include "report/what_to_show.hpp"
#include "scratch.hpp"

namespace riven {
namespace {

using test::message_of;
using test::Scratch;

/// A picture as another program sees it.
class Png {
 public:
  explicit Png(const std::string& bytes) {
    const Scratch scratch;
    write_picture(scratch / "picture.png", bytes);
    cairo_surface_t* surface = cairo_image_surface_create_from_png((scratch / "picture.png").c_str());
    EXPECT_EQ(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
    width = cairo_image_surface_get_width(surface);
    height = cairo_image_surface_get_height(surface);
    const unsigned char* data = cairo_image_surface_get_data(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto word = reinterpret_cast<const std::uint32_t*>(data + y * stride)[x];
        pixels.push_back({static_cast<std::uint8_t>(word >> 16), static_cast<std::uint8_t>(word >> 8),
                          static_cast<std::uint8_t>(word)});
      }
    cairo_surface_destroy(surface);
  }

  [[nodiscard]] Colour at(int x, int y) const { return pixels[static_cast<std::size_t>(y * width + x)]; }

  /// Middle of the pixels that have a colour, and 5 x 5 pixels of it around them: cells, not the colour bar,
  /// which changes too quickly.
  [[nodiscard]] std::map<Colour, Pixel> cells() const {
    std::map<Colour, std::array<double, 3>> sums;
    for (int y = 2; y + 2 < height; ++y)
      for (int x = 2; x + 2 < width; ++x) {
        const Colour colour = at(x, y);
        bool even = colour != kWhite;
        for (int j = -2; j <= 2; ++j)
          for (int i = -2; i <= 2; ++i) even = even && at(x + i, y + j) == colour;
        if (!even) continue;
        auto& [sum_x, sum_y, count] = sums[colour];
        sum_x += x + 0.5;
        sum_y += y + 0.5;
        ++count;
      }
    std::map<Colour, Pixel> middles;
    for (const auto& [colour, sum] : sums) middles[colour] = {sum[0] / sum[2], sum[1] / sum[2]};
    return middles;
  }

  int width = 0, height = 0;
  std::vector<Colour> pixels;
};

/// A plate whose points have values from 0 to 1, moved by a homogeneous deformation.
struct Plate {
  static constexpr int kNx = 5, kNy = 4;
  PointCloud cloud;
  Scalar scalar{"heat", "Pa", {}};

  Plate() {
    PointField u{"displacement", 3, {}, "m"};
    for (int j = 0; j < kNy; ++j)
      for (int i = 0; i < kNx; ++i) {
        const double x = 0.02 * i, y = 0.02 * j;
        cloud.positions.push_back({x, y, 0});
        u.values.insert(u.values.end(), {0.2 * x + 0.1 * y, 0.3 * y, 0});
        scalar.values.push_back((i + kNx * j) / (kNx * kNy - 1.0));
      }
    cloud.fields.push_back(u);
  }
};

const PictureSettings kSettings{.size = {800, 600}, .trimmed = false, .title = "Plate", .state = "t = 1 s"};

TEST(Picture, PointsStandAtTheirDeformedPlaces) {
  const Plate plate;
  for (const double scale : {0.0, 1.0, 2.0}) {
    PictureSettings settings = kSettings;
    settings.scale = scale;
    const Png png(draw_field(plate.cloud, plate.scalar, settings, "x.png"));
    EXPECT_EQ(png.width, 800);
    EXPECT_EQ(png.height, 600);
    EXPECT_EQ(png.at(0, 0), kWhite);
    EXPECT_EQ(png.at(799, 599), kWhite);
    const std::map<Colour, Pixel> cells = png.cells();
    EXPECT_EQ(cells.size(), plate.scalar.values.size());
    const auto pixel = [&](std::size_t i) {
      const Colour colour = colour_map("viridis").at(plate.scalar.values[i]);
      EXPECT_TRUE(cells.contains(colour)) << i;
      return cells.contains(colour) ? cells.at(colour) : Pixel{};
    };
    const auto place = [&](std::size_t i) {
      const auto& x = plate.cloud.positions[i];
      return Pixel{x[0] + scale * (0.2 * x[0] + 0.1 * x[1]), x[1] + scale * 0.3 * x[1]};
    };
    // One scale in both directions, y upwards; cells are seen to half a pixel.
    const double per_metre = (pixel(4).x - pixel(0).x) / (place(4).x - place(0).x);
    for (std::size_t i = 0; i < plate.scalar.values.size(); ++i) {
      EXPECT_NEAR(pixel(i).x - pixel(0).x, per_metre * (place(i).x - place(0).x), 1.0) << i;
      EXPECT_NEAR(pixel(0).y - pixel(i).y, per_metre * (place(i).y - place(0).y), 1.0) << i;
    }
  }
}

TEST(Picture, RefusesDisplacementsThatAreNoVectors) {
  Plate plate;
  plate.cloud.fields[0].components = 1;
  plate.cloud.fields[0].values.resize(plate.cloud.positions.size());
  EXPECT_NE(message_of<InputError>([&] {
              draw_field(plate.cloud, plate.scalar, kSettings, "x.png");
            }).find("1 components; expected 3"),
            std::string::npos);
}

TEST(Picture, NoGapsBetweenCells) {
  const Plate plate;
  const Png png(draw_field(plate.cloud, plate.scalar, kSettings, "x.png"));
  const std::map<Colour, Pixel> cells = png.cells();
  const Pixel first = cells.at(colour_map("viridis").at(0)), last = cells.at(colour_map("viridis").at(1));
  for (double part = 0; part <= 1; part += 1e-3)
    EXPECT_NE(png.at(static_cast<int>(first.x + part * (last.x - first.x)),
                     static_cast<int>(first.y + part * (last.y - first.y))),
              kWhite);
}

TEST(Picture, ValuesBeyondTheRangeTakeTheColoursOfItsEnds) {
  Plate plate;
  plate.scalar.values[7] = std::nan("");
  PictureSettings settings = kSettings;
  settings.values = {0.4, 0.6};
  settings.map = &colour_map("inferno");
  const std::map<Colour, Pixel> cells = Png(draw_field(plate.cloud, plate.scalar, settings, "x.png")).cells();
  std::map<Colour, int> expected;  // how many points have it
  for (const double value : plate.scalar.values) ++expected[settings.map->at((value - 0.4) / 0.2)];
  EXPECT_EQ(cells.size(), expected.size());
  for (const auto& [colour, count] : expected) EXPECT_TRUE(cells.contains(colour));
  EXPECT_TRUE(cells.contains(colour_map("viridis").at(std::nan(""))));
}

TEST(Picture, TheColourBarGoesFromEndToEnd) {
  const Plate plate;
  const Png png(draw_field(plate.cloud, plate.scalar, kSettings, "x.png"));
  const auto is_end = [&](int x, int y, double end) {
    const Colour wanted = colour_map("viridis").at(end), found = png.at(x, y);
    for (std::size_t c = 0; c < 3; ++c)
      if (std::abs(wanted[c] - found[c]) > 3)
        return false;  // beside the frame a pixel is a step or two inside
    return true;
  };
  for (int x = png.width - 1; x > 0; --x) {
    std::vector<int> lows, highs;
    for (int y = 0; y < png.height; ++y) {
      if (is_end(x, y, 0)) lows.push_back(y);
      if (is_end(x, y, 1)) highs.push_back(y);
    }
    if (lows.empty() || highs.empty()) continue;
    EXPECT_GT(lows.front(), highs.back() + png.height / 3) << "the higher values are above";
    return;
  }
  ADD_FAILURE() << "no colour bar";
}

TEST(Picture, OfASolidTheNearestPointsAreSeen) {
  PointCloud cloud;
  Scalar scalar{"depth", "", {}};
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        cloud.positions.push_back({0.01 * i, 0.01 * j, 0.01 * k});
        scalar.values.push_back(i == 5 || j == 0 || k == 5 ? 1 : 0);  // the sides that the viewer sees
      }
  PictureSettings settings = kSettings;
  settings.map = &colour_map("purple-orange");  // one end is violet, the other brown
  const Png png(draw_field(cloud, scalar, settings, "x.png"));
  std::size_t brown = 0, violet = 0;
  for (int y = 70; y < png.height; ++y)  // below the title
    for (int x = 0; x < 450; ++x) {      // left of the colour bar
      const auto [red, green, blue] = png.at(x, y);
      brown += red > blue + 40 ? 1 : 0;
      violet += blue > red + 20 ? 1 : 0;
    }
  EXPECT_GT(brown, 50000U);
  EXPECT_LT(static_cast<double>(violet), 0.01 * static_cast<double>(brown));
}

TEST(Picture, OfABarIsACurve) {
  PointCloud cloud;
  Scalar scalar{"u", "m", {}};
  for (int i = 0; i < 50; ++i) {
    cloud.positions.push_back({0.01 * i, 0, 0});
    scalar.values.push_back(1e-6 * i);
  }
  const Png png(draw_field(cloud, scalar, kSettings, "x.png"));
  // From the lower left to the upper right: the mean height of coloured pixels rises with every tenth.
  double before = 0;
  for (int tenth = 0; tenth < 10; ++tenth) {
    double sum = 0, count = 0;
    for (int y = 75; y < 540; ++y)
      for (int x = 110 + 65 * tenth; x < 175 + 65 * tenth; ++x) {
        const auto [red, green, blue] = png.at(x, y);
        if (std::max({red, green, blue}) - std::min({red, green, blue}) < 30) continue;  // grey: grid
        sum += png.height - y;
        ++count;
      }
    ASSERT_GT(count, 0);
    EXPECT_GT(sum / count, before + 20);
    before = sum / count;
  }
}

// A peak that few points have is what one looks for in a curve; colours alone leave it out.
TEST(Picture, ACurveShowsItsHighestPoint) {
  PointCloud cloud;
  Scalar scalar{"u", "m", {}};
  for (int i = 0; i < 2001; ++i) {
    cloud.positions.push_back({0.01 * i, 0, 0});
    scalar.values.push_back(i == 1000 ? 1 : 0.001 * (i % 7));
  }
  const Png png(draw_field(cloud, scalar, kSettings, "x.png"));
  int coloured = 0;  // pixels in the upper fifth
  for (int y = 75; y < 170; ++y)
    for (int x = 110; x < 760; ++x) {
      const auto [red, green, blue] = png.at(x, y);
      if (std::max({red, green, blue}) - std::min({red, green, blue}) > 60) ++coloured;
    }
  EXPECT_GT(coloured, 2);
}

TEST(Picture, IsTrimmedToTheBody) {
  PointCloud strip;
  Scalar scalar{"heat", "", {}};
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 4; ++j) {
      strip.positions.push_back({0.01 * i, 0.01 * j, 0});
      scalar.values.push_back(i);
    }
  PictureSettings settings = kSettings;
  settings.trimmed = true;
  const Png png(draw_field(strip, scalar, settings, "x.png"));
  EXPECT_EQ(png.width, 800);
  EXPECT_LT(png.height, 400);
}

// Widths of a few pixels are rounded to whole ones: that must not shift a long body.
TEST(Picture, ThinBodiesFillTheirAxes) {
  const Colour body = colour_map("viridis").at(1);
  for (int columns = 3; columns < 9; ++columns) {
    PointCloud strip;
    for (int i = 0; i < columns; ++i)
      for (int j = 0; j < 97; ++j) strip.positions.push_back({0.01 * i, 0.01 * j, 0});
    const Scalar scalar{"heat", "", std::vector<double>(strip.positions.size(), 1)};
    const Png png(draw_field(strip, scalar, kSettings, "x.png"));
    std::vector<int> rows;
    int x = 0;
    for (; rows.size() < 300 && x < png.width; ++x) {
      rows.clear();
      for (int y = 0; y < png.height; ++y)
        if (png.at(x, y) == body) rows.push_back(y);
    }
    ASSERT_GT(rows.size(), 300U);
    // The lines of the frame: dark, and as far above as below.
    int above = rows.front(), below = rows.back();
    while (png.at(x, above) == body || png.at(x, above)[0] > 200) --above;
    while (png.at(x, below) == body || png.at(x, below)[0] > 200) ++below;
    EXPECT_NEAR(rows.front() - above, below - rows.back(), 1) << columns;
  }
}

TEST(Picture, KindsOfFiles) {
  const Plate plate;
  EXPECT_TRUE(draw_field(plate.cloud, plate.scalar, kSettings, "x.svg").find("<svg") != std::string::npos);
  EXPECT_TRUE(draw_field(plate.cloud, plate.scalar, kSettings, "x.pdf").starts_with("%PDF"));
  EXPECT_EQ(message_of<InputError>(
                [&] { static_cast<void>(draw_field(plate.cloud, plate.scalar, kSettings, "x.jpg")); }),
            "x.jpg: a picture ends in .png, .svg or .pdf, found \".jpg\"");
}

TEST(Picture, Sizes) {
  EXPECT_EQ(picture_size("800x600").height, 600);
  for (const char* wrong :
       {"", "800", "800x", "x600", "800x600x2", "-800x600", "800x1", "99999x600", "8e2x600"})
    EXPECT_NE(message_of<InputError>([&] { static_cast<void>(picture_size(wrong)); }).find("1600x1200"),
              std::string::npos)
        << wrong;
}

TEST(ColourRange, OfSigns) {
  const auto of = [](std::vector<double> values, const char* unit = "Pa") {
    const Range range = colour_range({"f", unit, std::move(values)});
    return std::pair(range.low, range.high);
  };
  EXPECT_EQ(of({1, 2, 3}), std::pair(1.0, 3.0));
  EXPECT_EQ(of({-1, 3}), std::pair(-3.0, 3.0));
  EXPECT_EQ(of({5, 5 + 1e-9}), std::pair(0.0, 5 + 1e-9)) << "constant but for rounding";
  EXPECT_EQ(of({0, 0}), std::pair(0.0, 1.0));
  EXPECT_EQ(of({}), std::pair(0.0, 1.0));
  std::vector<double> peaked(2000);
  for (std::size_t i = 0; i < peaked.size(); ++i) peaked[i] = 1 + static_cast<double>(i) / 2000;
  peaked[3] = 500;
  EXPECT_LT(of(peaked).second, 2.01) << "one point would leave one colour to all others";
  EXPECT_EQ(of(peaked, "").second, 500) << "damage is never cut";
}

TEST(TellingField, IsDamageOnceItGrows) {
  const auto cloud = [](std::vector<double> damage) {
    PointCloud made;
    made.positions.resize(damage.size());
    made.fields.push_back({"displacement", 3, std::vector<double>(3 * damage.size()), "m"});
    made.fields.push_back({"damage", 1, damage, ""});
    made.fields.push_back({"strain_energy_density", 1, std::vector<double>(damage.size()), "J/m^3"});
    return made;
  };
  // A crack that was there before is no news.
  EXPECT_EQ(telling_field(cloud({0, 0.4}), cloud({0, 0.4})), "strain_energy_density");
  EXPECT_EQ(telling_field(cloud({0.1, 0.4}), cloud({0, 0.4})), "damage");
  EXPECT_FALSE(message_of<InputError>([] { static_cast<void>(telling_field({}, {})); }).empty());
}

TEST(PointRaster, ACellIsNeverHiddenByItsNeighbour) {
  // Two squares of 20 px side by side, joined; the later one comes first.
  const Colour red = {255, 0, 0}, blue = {0, 0, 255};
  const auto tile = [](double x, Colour colour, std::array<double, 4> sides) {
    return Tile{{x, 20}, {1 / 20.0, 0, 0, -1 / 20.0}, sides, {20, 20}, colour};
  };
  const std::array tiles = {tile(40, blue, {0.85, 0.5, 0.5, 0.5}), tile(20, red, {0.5, 0.85, 0.5, 0.5})};
  const Raster raster = raster_of(tiles, true, 60, 40);
  const auto at = [&](int x, int y) { return raster.pixels[static_cast<std::size_t>(60 * y + x)]; };
  for (int x = 10; x < 50; ++x) EXPECT_EQ(at(x, 20), x < 30 ? red : blue) << x;
  EXPECT_EQ(at(9, 20), kWhite);
  EXPECT_EQ(at(50, 20), kWhite);
  EXPECT_EQ(at(30, 9), kWhite);
}

TEST(Chart, DrawsEverySeriesInItsColour) {
  const Chart chart{.title = "Forces",
                    .x = {"time", "s"},
                    .y = {"force", "N"},
                    .series = {{"a", {0, 1, 2}, {0, 1, 4}}, {"b", {0, 1, 2}, {0, -1, std::nan("")}}}};
  const Png png(draw_chart(chart, {800, 600}, "x.png"));
  const auto count = [&](Colour colour) { return std::count(png.pixels.begin(), png.pixels.end(), colour); };
  EXPECT_GT(count({0, 114, 178}), 200);
  EXPECT_GT(count({213, 94, 0}), 100);
  EXPECT_EQ(count({0, 158, 115}), 0);
  EXPECT_EQ(png.at(0, 0), kWhite);
  // Nothing to draw is still a picture.
  EXPECT_EQ(Png(draw_chart({.title = "Nothing"}, {800, 600}, "x.png")).width, 800);
}

}  // namespace
}  // namespace riven
