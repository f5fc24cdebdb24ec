// The air over a region without the inside of upright prisms: what is free, what sees what, where shortest ways may
// turn.
#pragma once

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "paths/lattice.hpp"

namespace muster {

struct Spot {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;

  friend Spot operator+(Spot a, Spot b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Spot operator-(Spot a, Spot b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Spot operator*(double s, Spot a) { return {s * a.x, s * a.y, s * a.z}; }
};

inline double dot(Spot a, Spot b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double distance(Spot a, Spot b) { return std::sqrt(dot(a - b, a - b)); }

// Rings of a polygon, the inside by the even-odd rule.
class Rings {
 public:
  explicit Rings(std::vector<std::vector<Point>> rings);

  const std::vector<std::vector<Point>>& rings() const { return rings_; }
  Point low() const { return low_; }
  Point high() const { return high_; }
  bool inside(Point p) const;
  double distance_to_border(Point p) const;
  // Whether the part from t = `from` to `to` of the straight piece a-b runs through the inside (or, if not `inner`,
  // outside) for longer than kTouch.
  bool enters(Point a, Point b, double from, double to, bool inner) const;

 private:
  std::vector<std::vector<Point>> rings_;
  bool beside(Point a, Point direction, double off) const;
  bool enters_convex(Point a, Point b, double from, double to) const;

  // How deep a point is on the inner side of a line: dot(inward, p) - offset.
  struct Side {
    Point inward;
    double offset;
  };

  Point low_, high_;
  bool convex_ = false;
  std::vector<Side> sides_;  // of a convex whole
};

struct PrismShape {
  Rings base;
  double floor;
  double ceiling;
};

// An edge of an obstacle on which shortest ways may turn. `inward` is a unit normal of a level edge, towards the
// obstacle; an upright edge has the two walls that start there instead.
struct AirEdge {
  Spot from, to;
  bool upright = false;
  bool top = false;
  Point inward, other_wall;

  // Whether the line in this direction keeps out of the obstacle beside the edge.
  bool taut(Spot direction) const;
};

class Air {
 public:
  static constexpr double kTouch = 1e-7;  // metres that a line may be inside an obstacle: it touches

  // `top` bounds the height at which turns around the region's own corners are sought.
  Air(Rings region, std::vector<PrismShape> prisms, double lowest, double top);

  const std::vector<AirEdge>& edges() const { return edges_; }
  // The edges once more, with fewer corners where prisms are round: they run outside, by `off` at most, and where they
  // would run into something else they stay as they are.
  std::vector<AirEdge> loose_edges(double off) const;
  // An edge, and where it ends at the point, all that end there.
  std::vector<int> edges_at(Spot end, int edge) const;
  // Where edges pierce the triangle between two points and a free third one: the turns of the shortest way between the
  // two that keeps to the side of the third, and on which edge each is.
  std::vector<std::pair<Spot, int>> tight_turns(Spot a, Spot corner, Spot b) const;
  bool free(Spot p) const;
  bool sees(Spot a, Spot b) const {
    std::size_t none = prisms_.size();
    return sees(a, b, none);
  }
  // Looks first at prism `blocker`, and leaves there which one blocks: often the same for the next pair.
  bool sees(Spot a, Spot b, std::size_t& blocker) const;

 private:
  static bool blocks(const PrismShape& prism, Spot a, Spot b);
  bool clear(Point p, const PrismShape& but) const;
  std::vector<Point> loosened(const std::vector<Point>& ring, const PrismShape& prism, double off) const;

  // A prism's, upright.
  struct Box {
    Point low, high;
    double floor, ceiling;
    bool may_block(Spot a, Spot b) const;
  };

  Rings region_;
  std::vector<PrismShape> prisms_;
  std::vector<Box> boxes_;  // of the prisms, in little memory
  double lowest_, top_;
  std::vector<AirEdge> edges_;
  std::vector<std::pair<std::array<double, 3>, int>> ends_;  // in order
  std::vector<std::size_t> first_edge_;                      // of the region, of each prism, and the end
};

}  // namespace muster
