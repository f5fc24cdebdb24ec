// The corners of a polygonal region and what sees them.
#pragma once

#include <vector>

#include "paths/sights.hpp"

namespace muster {

// A region of the plane with its border, the inside on the left of every ring. Its points are rounded to a lattice of
// 2^-29 of its size, on which all decisions are exact.
class PolygonSights : public Sights {
 public:
  // `rings` are closed without repeating the first point. Throws std::invalid_argument if there is none.
  explicit PolygonSights(const std::vector<std::vector<Point>>& rings);

  Lattice snap(Point p) const override;
  bool free(Lattice p) const override;
  bool sees(Lattice a, Lattice b) const override;
  std::vector<int> seen_from(Lattice p, const Ellipse& within) const override;
  std::vector<int> neighbours(int corner) const override;
  std::vector<int> onward(int corner, Lattice coming, const Ellipse& within) const override;
  bool may_be_blocked() const override { return true; }
  std::optional<double> some_length(Point, Point) const override { return std::numeric_limits<double>::infinity(); }
  double extent() const override;

 private:
  // A side from `at` to `next`; `before` is the point before it on the ring.
  struct Side {
    Lattice before, at, next;
  };

  Lattice rounded(Point p) const;
  void add_ring(const std::vector<Point>& ring);
  void sort_into_boxes();
  bool passes(const Side& side, Lattice a, Lattice b) const;
  template <class Visit>
  bool for_boxes(Lattice a, Lattice b, Visit visit) const;

  Point origin_;
  double scale_ = 1.0;
  std::vector<Side> sides_;
  // Boxes of the plane, each with the sides that meet it: box_sides_[box_first_[b]] to before [b + 1].
  int boxes_ = 1;  // along a side of the whole
  std::int64_t box_size_ = 1;
  std::vector<int> box_first_;
  std::vector<int> box_sides_;
};

}  // namespace muster
