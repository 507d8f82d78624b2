#pragma once
/// What a method sees inside, as plain data: a method fills it in, an adapter draws it (`gridmerge inspect`).
#include <string>
#include <variant>
#include <vector>

#include "gridmerge/grid/pose2.hpp"

namespace gridmerge {

/// A number for every point of a regular lattice: a spectrum, a sinogram, a surface of scores.
struct SurfaceView {
  int width = 0;
  int height = 0;
  std::vector<float> values;  ///< row-major from the lower left, width * height of them; NaN: nothing is known there
  double x_low = 0;           ///< outer edges of the first and the last column and row, in the axes' units
  double x_high = 1;
  double y_low = 0;
  double y_high = 1;
  std::string x_label;  ///< with its unit: "angle [deg]"
  std::string y_label;
  std::string value_label;    ///< what dark and bright mean: "votes squared"
  std::vector<Point2> marks;  ///< points that stand out, best first, in the axes' units
};

struct Curve {
  std::string label;
  std::vector<double> x;
  std::vector<double> y;  ///< as many as x
};

struct CurvesView {
  std::vector<Curve> curves;
  std::string x_label;
  std::string y_label;
  std::vector<double> marks;  ///< places along x that stand out, best first
};

/// Something drawn over a map.
struct Shape {
  enum class Kind { kPoints, kLine, kSegments };  ///< points; one line through all; from 0 to 1, from 2 to 3, ...
  Kind kind = Kind::kPoints;
  std::string label;
  std::vector<Point2> points;  ///< in the frame that MapView says
};

/// Shapes over one map or both. They are given in the local frame of the map that is shown; of the target, where both
/// are.
struct MapView {
  enum class Map { kTarget, kSource, kBoth };
  Map map = Map::kTarget;
  Pose2 local_target_from_source;  ///< where the source is drawn, if both are
  std::vector<Shape> shapes;       ///< the first on top
};

struct View {
  std::string name;   ///< snake_case, unique within one run: it becomes the file's name
  std::string title;  ///< one line that says what is seen
  std::variant<SurfaceView, CurvesView, MapView> content;
};

}  // namespace gridmerge
