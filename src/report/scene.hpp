#pragma once

#include <array>
#include <functional>
#include <vector>

#include "output/vtu.hpp"
#include "report/canvas.hpp"
#include "report/point_shape.hpp"
#include "report/projection.hpp"
#include "report/ticks.hpp"

namespace riven {

/// Rectangle of the plane of view (m).
struct Frame {
  Range across, up;

  void include(const Frame& other);
};

/// The points of a cloud, displaced, as the viewer sees them (m), or its mesh.
class Scene {
 public:
  /// `scale`: of the displacements. Keeps a reference to the positions.
  Scene(const PointCloud& cloud, double scale);

  [[nodiscard]] const Projection& projection() const { return projection_; }
  /// On the plane of view.
  [[nodiscard]] const std::vector<Point>& places() const { return places_; }
  /// What they take of the plane of view, with their cells.
  [[nodiscard]] Frame frame() const;
  /// The undeformed body with its outermost cells (m).
  [[nodiscard]] Point size() const;

  /// The points in a frame that fills a raster: cells that share what is between them, or of a solid balls;
  /// the elements of a mesh.
  [[nodiscard]] Raster drawn(const Frame& frame, int width, int height,
                             const std::function<Colour(std::size_t)>& colour) const;

 private:
  [[nodiscard]] Raster drawn_mesh(const std::vector<Pixel>& places, double scale, int width, int height,
                                  const std::function<Colour(std::size_t)>& colour) const;
  [[nodiscard]] std::array<double, 4> cell(std::size_t i) const;
  [[nodiscard]] double radius(std::size_t i) const;
  [[nodiscard]] std::array<double, 4> sides(std::size_t i) const;
  [[nodiscard]] bool hidden(std::size_t i) const;
  [[nodiscard]] std::array<double, 2> reach(std::size_t i, double widths) const;

  const std::vector<Point>& positions_;  // undeformed
  Projection projection_;
  PointShapes cells_;
  std::vector<Point> places_;
  std::vector<Cells> mesh_;  // triangles and quads that are seen; empty: bare points
};

}  // namespace riven
