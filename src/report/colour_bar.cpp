#include "report/colour_bar.hpp"

#include <algorithm>

#include "report/axes.hpp"

namespace riven {

namespace {

// Canvas units: the bar's thickness, its gap to what is before it, and to its numbers.
constexpr double kBar = 16, kBarGap = 22, kNumberGap = 7, kTickLength = 4;

/// The colours from one end to the other.
Raster colours_of(const ColourMap& map, bool upwards) {
  constexpr int kSteps = 256;
  Raster raster{upwards ? 1 : kSteps, upwards ? kSteps : 1, {}};
  for (int n = 0; n < kSteps; ++n) {
    const int step = upwards ? kSteps - 1 - n : n;
    raster.pixels.push_back(map.at(step / (kSteps - 1.0)));
  }
  return raster;
}

double widest(Canvas& canvas, const std::vector<std::string>& texts) {
  double width = 0;
  for (const std::string& text : texts)
    width = std::max(width, canvas.text_width(text, kTextHeight * canvas.unit()));
  return width;
}

}  // namespace

double ColourBar::room(Canvas& canvas) const {
  const double u = canvas.unit();
  if (!upwards) return (kBarGap + kBar + kNumberGap + 2.6 * kTextHeight) * u;
  const std::vector<double> at = ticks(colours, ticks_along(canvas, canvas.size().height));
  return widest(canvas, tick_texts(at)) + (kBarGap + kBar + 2 * kNumberGap + 1.3 * kTextHeight) * u;
}

void ColourBar::draw_tips(Canvas& canvas, Pixel corner, double width, double height) const {
  const double tip = 0.55 * kBar * canvas.unit(), bottom = corner.y + height, right = corner.x + width;
  const Pixel middle{corner.x + width / 2, corner.y + height / 2};
  if (values.low < colours.low)
    canvas.triangle({corner.x, bottom}, upwards ? Pixel{right, bottom} : corner,
                    upwards ? Pixel{middle.x, bottom + tip} : Pixel{corner.x - tip, middle.y}, map.at(0),
                    canvas.unit());
  if (values.high > colours.high)
    canvas.triangle({right, corner.y}, upwards ? corner : Pixel{right, bottom},
                    upwards ? Pixel{middle.x, corner.y - tip} : Pixel{right + tip, middle.y}, map.at(1),
                    canvas.unit());
}

void ColourBar::draw(Canvas& canvas, Pixel corner, double length) const {
  const double u = canvas.unit(), width = upwards ? kBar * u : length, height = upwards ? length : kBar * u;
  (upwards ? corner.x : corner.y) += kBarGap * u;
  draw_tips(canvas, corner, width, height);
  canvas.image(corner, width, height, colours_of(map, upwards));
  canvas.frame(corner, width, height, kBlack, u);
  const std::vector<double> at = ticks(colours, ticks_along(canvas, length));
  const std::vector<std::string> texts = tick_texts(at);
  const double right = corner.x + width, bottom = corner.y + height;
  for (std::size_t n = 0; n < at.size(); ++n) {
    const double part = (at[n] - colours.low) / colours.width();
    const Pixel place =
        upwards ? Pixel{right, bottom - part * height} : Pixel{corner.x + part * width, bottom};
    const double x = upwards ? kTickLength * u : 0, y = upwards ? 0 : kTickLength * u;
    canvas.segment(place, {place.x + x, place.y + y}, kBlack, u);
    if (upwards) {
      canvas.text({place.x + kNumberGap * u, place.y + 0.36 * kTextHeight * u}, texts[n], kTextHeight * u);
    } else {
      canvas.text({place.x, place.y + (kNumberGap + 0.75 * kTextHeight) * u}, texts[n], kTextHeight * u,
                  Align::centre);
    }
  }
  if (upwards) {
    const double beside = widest(canvas, texts) + (2 * kNumberGap + 0.8 * kTextHeight) * u;
    canvas.text_upwards({right + beside, corner.y + height / 2}, label, kTextHeight * u);
  } else {
    canvas.text({corner.x + width / 2, bottom + (kNumberGap + 2.3 * kTextHeight) * u}, label, kTextHeight * u,
                Align::centre);
  }
}

}  // namespace riven
