#include "report/axes.hpp"

#include <algorithm>

namespace riven {

namespace {

constexpr double kTick = 5, kGap = 4;

double widest(Canvas& canvas, const Range& range, double length) {
  double width = 0;
  for (const std::string& text : tick_texts(ticks(range, ticks_along(canvas, length))))
    width = std::max(width, canvas.text_width(text, kTextHeight * canvas.unit()));
  return width;
}

}  // namespace

int ticks_along(const Canvas& canvas, double length) {
  constexpr double kApart = 50;
  return std::clamp(static_cast<int>(length / (kApart * canvas.unit())), 2, 10);
}

Pixel Axes::at(double x_value, double y_value) const {
  return {corner.x + width * (x_value - x.low) / x.width(),
          corner.y + height * (y.high - y_value) / y.width()};
}

void Axes::draw(Canvas& canvas) const {
  const double u = canvas.unit(), bottom = corner.y + height;
  const std::vector<double> across = ticks(x, ticks_along(canvas, width)),
                            up = ticks(y, ticks_along(canvas, height));
  const std::vector<std::string> below = tick_texts(across), beside = tick_texts(up);
  double free = 0;  // right of the last number: where they are too dense, some are left out
  for (std::size_t n = 0; n < across.size(); ++n) {
    const double place = at(across[n], y.low).x;
    if (grid) canvas.segment({place, corner.y}, {place, bottom}, kFaint, u);
    canvas.segment({place, bottom}, {place, bottom + kTick * u}, kBlack, u);
    const double half = canvas.text_width(below[n], kTextHeight * u) / 2;
    if (place - half < free) continue;
    free = place + half + kGap * u;
    canvas.text({place, bottom + (kTick + kGap + 0.75 * kTextHeight) * u}, below[n], kTextHeight * u,
                Align::centre);
  }
  for (std::size_t n = 0; n < up.size(); ++n) {
    const double place = at(x.low, up[n]).y;
    if (grid) canvas.segment({corner.x, place}, {corner.x + width, place}, kFaint, u);
    canvas.segment({corner.x - kTick * u, place}, {corner.x, place}, kBlack, u);
    canvas.text({corner.x - (kTick + kGap) * u, place + 0.36 * kTextHeight * u}, beside[n], kTextHeight * u,
                Align::right);
  }
  canvas.frame(corner, width, height, kBlack, u);
  canvas.text({corner.x + width / 2, bottom + room_below(canvas) - kGap * u}, x_label, kTextHeight * u,
              Align::centre);
  canvas.text_upwards({corner.x - room_left(canvas, y, height) + kTextHeight * u, corner.y + height / 2},
                      y_label, kTextHeight * u);
}

double room_left(Canvas& canvas, const Range& y, double height) {
  return widest(canvas, y, height) + (kTick + 3 * kGap + kTextHeight) * canvas.unit();
}

double room_below(const Canvas& canvas) {
  return (kTick + 4 * kGap + 2 * kTextHeight) * canvas.unit();
}

void draw_title(Canvas& canvas, const std::string& title, const std::string& below) {
  const double u = canvas.unit(), width = canvas.size().width - 2 * kPadding * u;
  canvas.fitted_text({kPadding * u, (kPadding + 0.8 * kTitleHeight) * u}, title, kTitleHeight * u, width,
                     true);
  canvas.fitted_text({kPadding * u, (kPadding + kTitleHeight + 1.3 * kTextHeight) * u}, below,
                     kTextHeight * u, width);
}

double title_room(const Canvas& canvas, bool has_below) {
  return (2 * kPadding + kTitleHeight + (has_below ? kTextHeight + 2 * kGap : 0)) * canvas.unit();
}

}  // namespace riven
