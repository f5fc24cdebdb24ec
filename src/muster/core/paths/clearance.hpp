// How far the nearest blocked cell is, and with it, in few steps over open ground, which centres of cells see each
// other.
#pragma once

#include <cstdint>
#include <vector>

#include "paths/grid.hpp"

namespace muster {

struct Cell {
  int column, row;
};

// Of a map that outlives it.
class Clearance {
 public:
  explicit Clearance(const GridMap& map);

  // The least number of moves of a king from a cell to a blocked one, what lies outside included: 0 if it is blocked
  // itself. At most kMost, which may be less than the truth.
  int at(Cell cell) const { return steps_[index(cell)]; }
  // Whether the straight piece between the centres of two free cells is free: as GridMap::sees, exactly.
  bool sees(Cell a, Cell b) const;

 private:
  static constexpr int kMost = 255;
  template <bool kSteep>
  bool sees_along(Cell a, Cell b) const;
  template <bool kSteep>
  bool column_is_free(Cell a, int dx, int dy, int column) const;
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.row + 1) * stride_ + static_cast<std::size_t>(cell.column + 1);
  }

  const GridMap& map_;
  std::size_t stride_;
  std::vector<std::uint8_t> steps_;  // with the blocked frame of the map
};

}  // namespace muster
