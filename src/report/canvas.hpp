#pragma once

#include <cairo.h>

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "report/colour_map.hpp"

namespace riven {

struct PictureSize {
  int width = 1600, height = 1200;  // px
};

/// The length (px) that looks the same in pictures of all sizes: 1 px of 800 x 600.
double unit_of(PictureSize size);

/// "1600x1200". Throws InputError that names what was expected.
PictureSize picture_size(const std::string& text);

/// Where a text stands relative to its place.
enum class Align { left, centre, right };

/// A place in a picture (px), from its upper left corner.
struct Pixel {
  double x = 0, y = 0;
};

/// An image of pixels from the upper left corner, row by row.
struct Raster {
  int width = 0, height = 0;
  std::vector<Colour> pixels;
};

/// A white picture that is drawn on, then written: .png, or .svg and .pdf with lines and text that scale.
class Canvas {
 public:
  /// `unit`: what sizes of text and lines are multiples of. The kind of file follows from its ending. Throws
  /// InputError for one that is not known.
  Canvas(PictureSize size, double unit, const std::filesystem::path& path);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  [[nodiscard]] PictureSize size() const { return size_; }
  [[nodiscard]] double unit() const { return unit_; }

  void text(Pixel at, const std::string& text, double height, Align align = Align::left, bool bold = false);
  /// A text no wider than `width`: smaller letters first, then fewer.
  void fitted_text(Pixel at, std::string text, double height, double width, bool bold = false);
  /// Reading upwards, centred at a place.
  void text_upwards(Pixel at, const std::string& text, double height);
  [[nodiscard]] double text_width(const std::string& text, double height, bool bold = false);

  void line(std::span<const Pixel> points, Colour colour, double width, std::span<const double> dashes = {});
  void segment(Pixel from, Pixel to, Colour colour, double width);
  void disc(Pixel centre, double radius, Colour colour);
  void rectangle(Pixel corner, double width, double height, Colour colour);
  void frame(Pixel corner, double width, double height, Colour colour, double line_width);
  /// With a black line around it.
  void triangle(Pixel a, Pixel b, Pixel c, Colour colour, double line_width);
  void image(Pixel corner, double width, double height, const Raster& raster);
  /// What is drawn from here on shows inside a rectangle only, until `show_all`.
  void show_only(Pixel corner, double width, double height);
  void show_all();

  /// The complete file as bytes.
  [[nodiscard]] std::string finish();

 private:
  void set_font(double height, bool bold);
  void set_colour(Colour colour);

  PictureSize size_;
  double unit_;
  std::string bytes_;
  bool is_png_;
  std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface_;
  std::unique_ptr<cairo_t, void (*)(cairo_t*)> cairo_;
};

/// Writes a file of a canvas; one that exists is replaced. Throws RunError when it cannot be written.
void write_picture(const std::filesystem::path& path, const std::string& bytes);

inline constexpr Colour kBlack = {30, 30, 30};
inline constexpr Colour kFaint = {225, 225, 225};
inline constexpr Colour kWhite = {255, 255, 255};

}  // namespace riven
