// The corners of a grid's obstacles and what sees them: [oh2017].
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "paths/grid.hpp"
#include "paths/sights.hpp"

namespace muster {

// Rows of bits.
class BitRows {
 public:
  BitRows() = default;
  BitRows(int rows, int columns) : words_((columns + 63) / 64), bits_(static_cast<std::size_t>(rows) * words_, 0) {}

  void set(int row, int column) { word(row, column) |= std::uint64_t{1} << (column % 64); }
  // The first column from `from` on, and before `end`, with a bit set, or not set; `end` if there is none.
  int next_set(int row, int from, int end) const { return next(row, from, end, 0); }
  int next_clear(int row, int from, int end) const { return next(row, from, end, ~std::uint64_t{0}); }

 private:
  std::uint64_t& word(int row, int column) { return bits_[static_cast<std::size_t>(row) * words_ + column / 64]; }
  int next(int row, int from, int end, std::uint64_t flip) const;

  int words_ = 0;
  std::vector<std::uint64_t> bits_;
};

class GridSights : public Sights {
 public:
  explicit GridSights(const GridMap& map);

  const GridMap& map() const { return map_; }
  Lattice snap(Point p) const override { return GridMap::snap(p); }
  bool free(Lattice p) const override { return map_.free(p); }
  bool sees(Lattice a, Lattice b) const override { return map_.sees(a, b); }
  std::vector<int> seen_from(Lattice p, const Ellipse& within) const override;
  std::vector<int> neighbours(int corner) const override;
  std::vector<int> onward(int corner, Lattice coming, const Ellipse& within) const override;
  bool may_be_blocked() const override { return false; }
  std::optional<double> some_length(Point a, Point b) const override;
  double extent() const override { return std::hypot(map_.rows(), map_.columns()); }

 private:
  // The grid turned over so that a quadrant becomes the one up and right.
  struct View {
    bool flips_x = false;
    bool flips_y = false;
    BitRows blocked;  // rows x columns
    BitRows corners;  // grid points, of those corners alone that are taut towards the lower left

    Lattice turned(Lattice direction) const {
      return {flips_x ? -direction.x : direction.x, flips_y ? -direction.y : direction.y};
    }
    bool contains(Lattice direction) const { return turned(direction).x >= 0 && turned(direction).y >= 0; }
  };
  struct Cone;
  class Frame;

  void find_corners();
  void add_corner(int x, int y);
  void make_view(View& view, bool flips_x, bool flips_y) const;
  const View& view(bool flips_x, bool flips_y) const { return views_[2 * flips_y + flips_x]; }
  int number(int x, int y) const { return numbers_[static_cast<std::size_t>(y) * (map_.columns() + 1) + x]; }
  Lattice placed(const View& view, Lattice p) const;
  void scan(const View& view, Lattice origin, Lattice left, Lattice right, const Ellipse& within,
            std::vector<int>& found) const;
  void clip(const View& view, Lattice origin, const Cone& cone, const Frame& frame, std::vector<Cone>& open) const;
  void collect(const View& view, Lattice origin, const Cone& cone, const Frame& frame, std::vector<int>& found) const;
  void look_along(std::size_t line, Lattice origin, std::vector<int>& found) const;

  GridMap map_;
  std::vector<int> numbers_;  // of grid points; -1: no corner
  std::array<View, 4> views_;
};

}  // namespace muster
