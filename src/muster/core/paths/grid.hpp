// The occupancy grid: which cells are blocked, and which points see each other across it.
#pragma once

#include <cstdint>
#include <vector>

#include "paths/lattice.hpp"

namespace muster {

// Cells of side 1; (0, 0) lies between the points (0, 0) and (1, 1). Free is every free cell with its border; two
// blocked cells that touch at a corner let nothing through. Whole numbers are exact: a cell is kUnit of the lattice
// wide.
class GridMap {
 public:
  static constexpr std::int64_t kUnit = 1 << 16;
  static constexpr int kMostCells = 1 << 14;  // along a side, so that coordinates stay below 2^30
  // The four cells around a grid point.
  enum Quarter : std::uint8_t { kNorthEast = 1, kNorthWest = 2, kSouthWest = 4, kSouthEast = 8 };

  // `blocked` is rows x columns, row after row. Throws std::invalid_argument if a side is longer than kMostCells.
  GridMap(const std::vector<char>& blocked, int rows, int columns);

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  // From -1 to rows, -1 to columns: what lies outside is blocked.
  bool blocked(int column, int row) const { return cells_[index(column, row)] != 0; }
  // Which of the four cells around the grid point (x, y) are blocked.
  std::uint8_t around(int x, int y) const {
    return static_cast<std::uint8_t>(blocked(x, y) * kNorthEast + blocked(x - 1, y) * kNorthWest +
                                     blocked(x - 1, y - 1) * kSouthWest + blocked(x, y - 1) * kSouthEast);
  }
  // Two blocked cells touch here, and nothing passes between them.
  bool pinched(int x, int y) const {
    const std::uint8_t mask = around(x, y);
    return mask == (kNorthEast | kSouthWest) || mask == (kNorthWest | kSouthEast);
  }

  static Lattice snap(Point p) { return {std::llround(p.x * kUnit), std::llround(p.y * kUnit)}; }
  static Lattice centre(int column, int row) { return {column * kUnit + kUnit / 2, row * kUnit + kUnit / 2}; }

  bool inside(Lattice p) const { return p.x >= 0 && p.y >= 0 && p.x <= columns_ * kUnit && p.y <= rows_ * kUnit; }
  bool free(Lattice p) const;
  // The free cells that have a point inside or on their border, as column + row * columns.
  std::vector<int> cells_at(Lattice p) const;
  // Whether the straight piece between two points is free, exactly.
  bool sees(Lattice a, Lattice b) const;

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row + 1) * (columns_ + 2) + static_cast<std::size_t>(column + 1);
  }
  bool sees_level(Lattice a, Lattice b) const;
  bool sees_upright(Lattice a, Lattice b) const;
  bool sees_oblique(Lattice a, Lattice b) const;

  int rows_;
  int columns_;
  std::vector<char> cells_;  // with a blocked frame of one cell
};

}  // namespace muster
