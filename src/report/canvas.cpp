#include "report/canvas.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "output/atomic_file.hpp"

namespace riven {

namespace {

constexpr int kLeast = 200, kMost = 10000;  // px

cairo_status_t append(void* to, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

cairo_surface_t* make_surface(PictureSize size, const std::filesystem::path& path, std::string& bytes) {
  const std::string ending = path.extension().string();
  if (ending == ".png") return cairo_image_surface_create(CAIRO_FORMAT_RGB24, size.width, size.height);
  if (ending == ".svg") return cairo_svg_surface_create_for_stream(append, &bytes, size.width, size.height);
  if (ending == ".pdf") return cairo_pdf_surface_create_for_stream(append, &bytes, size.width, size.height);
  throw InputError(
      fmt::format("{}: a picture ends in .png, .svg or .pdf, found \"{}\"", path.string(), ending));
}

std::uint32_t packed(Colour colour) {
  return static_cast<std::uint32_t>(colour[0] << 16 | colour[1] << 8 | colour[2]);
}

}  // namespace

PictureSize picture_size(const std::string& text) {
  PictureSize size;
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  const bool is_size = width.ec == std::errc{} && width.ptr != end && *width.ptr == 'x';
  const auto height = is_size ? std::from_chars(width.ptr + 1, end, size.height) : width;
  const auto fits = [](int pixels) { return pixels >= kLeast && pixels <= kMost; };
  if (!is_size || height.ec != std::errc{} || height.ptr != end || !fits(size.width) || !fits(size.height))
    throw InputError(fmt::format("--size {}: expected width x height in pixels, {} to {}, as in 1600x1200",
                                 text, kLeast, kMost));
  return size;
}

double unit_of(PictureSize size) {
  return std::min(size.width / 800.0, size.height / 600.0);
}

Canvas::Canvas(PictureSize size, double unit, const std::filesystem::path& path)
    : size_(size),
      unit_(unit),
      is_png_(path.extension() == ".png"),
      surface_(make_surface(size, path, bytes_), cairo_surface_destroy),
      cairo_(cairo_create(surface_.get()), cairo_destroy) {
  rectangle({0, 0}, size.width, size.height, kWhite);
}

Canvas::~Canvas() = default;

void Canvas::set_font(double height, bool bold) {
  cairo_select_font_face(cairo_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_.get(), height);
}

void Canvas::set_colour(Colour colour) {
  cairo_set_source_rgb(cairo_.get(), colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
}

double Canvas::text_width(const std::string& text, double height, bool bold) {
  set_font(height, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_.get(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(Pixel at, const std::string& text, double height, Align align, bool bold) {
  const double width = text_width(text, height, bold);
  set_colour(kBlack);
  cairo_move_to(cairo_.get(),
                at.x - (align == Align::centre  ? width / 2
                        : align == Align::right ? width
                                                : 0),
                at.y);
  cairo_show_text(cairo_.get(), text.c_str());
  cairo_new_path(cairo_.get());  // the end of a text would begin the next line
}

void Canvas::fitted_text(Pixel at, std::string text, double height, double width, bool bold) {
  constexpr double kSmallest = 0.75;
  const double wanted = text_width(text, height, bold);
  height *= std::clamp(width / std::max(wanted, 1.0), kSmallest, 1.0);
  std::string shown = text;
  while (!text.empty() && text_width(shown, height, bold) > width) {
    // Not in the middle of a letter of several bytes.
    while (text.size() > 1 && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U) text.pop_back();
    text.pop_back();
    shown = text + "…";
  }
  this->text(at, shown, height, Align::left, bold);
}

void Canvas::text_upwards(Pixel at, const std::string& text, double height) {
  cairo_save(cairo_.get());
  cairo_translate(cairo_.get(), at.x, at.y);
  cairo_rotate(cairo_.get(), -std::numbers::pi / 2);
  this->text({0, 0}, text, height, Align::centre);
  cairo_restore(cairo_.get());
}

void Canvas::line(std::span<const Pixel> points, Colour colour, double width,
                  std::span<const double> dashes) {
  set_colour(colour);
  cairo_set_line_width(cairo_.get(), width);
  cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_dash(cairo_.get(), dashes.data(), static_cast<int>(dashes.size()), 0);
  for (const Pixel& point : points) cairo_line_to(cairo_.get(), point.x, point.y);
  cairo_stroke(cairo_.get());
}

void Canvas::segment(Pixel from, Pixel to, Colour colour, double width) {
  line(std::array{from, to}, colour, width);
}

void Canvas::disc(Pixel centre, double radius, Colour colour) {
  set_colour(colour);
  cairo_arc(cairo_.get(), centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  cairo_fill(cairo_.get());
}

void Canvas::rectangle(Pixel corner, double width, double height, Colour colour) {
  set_colour(colour);
  cairo_rectangle(cairo_.get(), corner.x, corner.y, width, height);
  cairo_fill(cairo_.get());
}

void Canvas::frame(Pixel corner, double width, double height, Colour colour, double line_width) {
  set_colour(colour);
  cairo_set_dash(cairo_.get(), nullptr, 0, 0);
  cairo_set_line_width(cairo_.get(), line_width);
  cairo_rectangle(cairo_.get(), corner.x, corner.y, width, height);
  cairo_stroke(cairo_.get());
}

void Canvas::triangle(Pixel a, Pixel b, Pixel c, Colour colour, double line_width) {
  for (const Pixel& point : {a, b, c}) cairo_line_to(cairo_.get(), point.x, point.y);
  cairo_close_path(cairo_.get());
  set_colour(colour);
  cairo_fill_preserve(cairo_.get());
  set_colour(kBlack);
  cairo_set_dash(cairo_.get(), nullptr, 0, 0);
  cairo_set_line_width(cairo_.get(), line_width);
  cairo_stroke(cairo_.get());
}

void Canvas::image(Pixel corner, double width, double height, const Raster& raster) {
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> source(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, raster.width, raster.height), cairo_surface_destroy);
  cairo_surface_flush(source.get());
  const int stride = cairo_image_surface_get_stride(source.get());
  unsigned char* const data = cairo_image_surface_get_data(source.get());
  for (int y = 0; y < raster.height; ++y) {
    auto* const row = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride);
    for (int x = 0; x < raster.width; ++x)
      row[x] = packed(raster.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(raster.width) +
                                    static_cast<std::size_t>(x)]);
  }
  cairo_surface_mark_dirty(source.get());
  cairo_save(cairo_.get());
  cairo_translate(cairo_.get(), corner.x, corner.y);
  cairo_scale(cairo_.get(), width / raster.width, height / raster.height);
  cairo_set_source_surface(cairo_.get(), source.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo_.get()), CAIRO_FILTER_BILINEAR);
  cairo_pattern_set_extend(cairo_get_source(cairo_.get()), CAIRO_EXTEND_PAD);  // no fading at the edges
  cairo_rectangle(cairo_.get(), 0, 0, raster.width, raster.height);
  cairo_fill(cairo_.get());
  cairo_restore(cairo_.get());
}

void Canvas::show_only(Pixel corner, double width, double height) {
  cairo_rectangle(cairo_.get(), corner.x, corner.y, width, height);
  cairo_clip(cairo_.get());
}

void Canvas::show_all() {
  cairo_reset_clip(cairo_.get());
}

std::string Canvas::finish() {
  if (is_png_) cairo_surface_write_to_png_stream(surface_.get(), append, &bytes_);
  cairo_surface_finish(surface_.get());
  const cairo_status_t status = cairo_surface_status(surface_.get());
  if (status != CAIRO_STATUS_SUCCESS)
    throw RunError(fmt::format("cannot draw the picture: {}", cairo_status_to_string(status)));
  return std::move(bytes_);
}

void write_picture(const std::filesystem::path& path, const std::string& bytes) {
  AtomicFile file(path);
  file.stream() << bytes;
  file.commit();
}

}  // namespace riven
