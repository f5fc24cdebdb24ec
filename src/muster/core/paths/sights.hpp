// What is seen from where: the corners around which shortest paths turn, and the straight pieces between them.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "paths/lattice.hpp"

namespace muster {

// A convex corner of an obstacle: two walls start here, and the obstacle lies in the angle of less than 180 degrees
// between.
struct Corner {
  Lattice at;
  Point place;  // the same point in its own unit
  Lattice one_wall;
  Lattice other_wall;

  // Whether a straight piece in this direction, to or from here, may be part of a shortest path that turns here: its
  // line does not enter the obstacle (it is taut).
  bool taut(Lattice direction) const {
    const std::int64_t one = cross(direction, one_wall), other = cross(direction, other_wall);
    return (one >= 0 && other >= 0) || (one <= 0 && other <= 0);
  }
  // Whether the obstacle is to the left of one who passes in a taut direction.
  bool on_left(Lattice direction) const { return cross(direction, one_wall) + cross(direction, other_wall) > 0; }
  // Whether one who comes here in a taut direction may leave in another: on the same side of the obstacle, turning
  // towards it.
  bool turns(Lattice coming, Lattice leaving) const {
    const bool left = on_left(coming);
    const std::int64_t to_left = cross(coming, leaving);
    return on_left(leaving) == left && (left ? to_left >= 0 : to_left <= 0);
  }
};

// The points through which a way from `here` to `goal` may lead that is no longer than `length`.
struct Ellipse {
  Point here, goal;
  double length = std::numeric_limits<double>::infinity();

  bool holds(Point p) const { return distance(here, p) + distance(p, goal) <= length; }
};

// A plane with obstacles. The corners have numbers from 0.
class Sights {
 public:
  virtual ~Sights() = default;
  const std::vector<Corner>& corners() const { return corners_; }

  // The point of the lattice for a place. One that is free but for rounding becomes free.
  virtual Lattice snap(Point p) const = 0;
  virtual bool free(Lattice p) const = 0;
  // Whether the straight piece between two free points is free.
  virtual bool sees(Lattice a, Lattice b) const = 0;
  // The corners other than `p` itself that see it and are taut towards it; all of those in the ellipse.
  virtual std::vector<int> seen_from(Lattice p, const Ellipse& within) const = 0;
  // The corners that a corner sees, taut at both ends. Each pair is told from one of its corners alone. One corner may
  // hide another that lies straight behind it.
  virtual std::vector<int> neighbours(int corner) const = 0;
  // Those to which a shortest way may go on that comes to a corner in this direction, taut at both ends; all of those
  // in the ellipse. Where it only `may_be_blocked`, whether the corner sees them is left open.
  virtual std::vector<int> onward(int corner, Lattice coming, const Ellipse& within) const = 0;
  virtual bool may_be_blocked() const = 0;
  // The length of some way, which bounds that of the shortest; nothing if there is none. Infinite where finding one is
  // no easier than finding the shortest.
  virtual std::optional<double> some_length(Point a, Point b) const = 0;
  // No two free points are further apart, in the places' unit.
  virtual double extent() const = 0;

 protected:
  std::vector<Corner> corners_;
};

}  // namespace muster
