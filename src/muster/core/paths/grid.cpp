#include "paths/grid.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace muster {

GridMap::GridMap(const std::vector<char>& blocked, int rows, int columns) : rows_(rows), columns_(columns) {
  if (rows > kMostCells || columns > kMostCells) throw std::invalid_argument("the grid has too many cells");
  cells_.assign(static_cast<std::size_t>(rows + 2) * (columns + 2), 1);
  for (int row = 0; row < rows; ++row) {
    const auto first = blocked.begin() + static_cast<std::ptrdiff_t>(row) * columns;
    std::copy(first, first + columns, cells_.begin() + static_cast<std::ptrdiff_t>(index(0, row)));
  }
}

std::vector<int> GridMap::cells_at(Lattice p) const {
  std::vector<int> found;
  if (!inside(p)) return found;
  const auto right = static_cast<int>(p.x / kUnit), top = static_cast<int>(p.y / kUnit);
  const int left = p.x % kUnit == 0 ? right - 1 : right, bottom = p.y % kUnit == 0 ? top - 1 : top;
  for (int row = bottom; row <= top; ++row) {
    for (int column = left; column <= right; ++column) {
      if (!blocked(column, row)) found.push_back(row * columns_ + column);
    }
  }
  return found;
}

bool GridMap::free(Lattice p) const {
  if (!inside(p)) return false;
  const auto column = static_cast<int>(p.x / kUnit), row = static_cast<int>(p.y / kUnit);
  if (!blocked(column, row)) return true;
  const bool left = p.x % kUnit == 0, below = p.y % kUnit == 0;
  return (left && !blocked(column - 1, row)) || (below && !blocked(column, row - 1)) ||
         (left && below && !blocked(column - 1, row - 1));
}

bool GridMap::sees(Lattice a, Lattice b) const {
  if (!free(a) || !free(b)) return false;
  if (a.y == b.y) return sees_level(a, b);
  if (a.x == b.x) return sees_upright(a, b);
  return sees_oblique(a, b);
}

bool GridMap::sees_level(Lattice a, Lattice b) const {
  if (a.x > b.x) std::swap(a, b);
  const auto first = static_cast<int>(a.x / kUnit), last = static_cast<int>(ceil_of(b.x, kUnit));
  const auto row = static_cast<int>(a.y / kUnit);
  const bool between_rows = a.y % kUnit == 0;
  for (int column = first; column < last; ++column) {
    if (blocked(column, row) && !(between_rows && !blocked(column, row - 1))) return false;
    if (between_rows && column > first && pinched(column, row)) return false;
  }
  return true;
}

bool GridMap::sees_upright(Lattice a, Lattice b) const {
  if (a.y > b.y) std::swap(a, b);
  const auto first = static_cast<int>(a.y / kUnit), last = static_cast<int>(ceil_of(b.y, kUnit));
  const auto column = static_cast<int>(a.x / kUnit);
  const bool between_columns = a.x % kUnit == 0;
  for (int row = first; row < last; ++row) {
    if (blocked(column, row) && !(between_columns && !blocked(column - 1, row))) return false;
    if (between_columns && row > first && pinched(column, row)) return false;
  }
  return true;
}

// Row by row: in each, all cells whose inside the line meets.
bool GridMap::sees_oblique(Lattice a, Lattice b) const {
  if (a.y > b.y) std::swap(a, b);
  const Lattice d = b - a;
  const std::int64_t wide = d.y * kUnit;  // a column, in the unit of x * d.y
  std::int64_t enters = a.x * d.y;
  for (auto row = static_cast<int>(a.y / kUnit); row * kUnit < b.y; ++row) {
    const std::int64_t top = std::min(b.y, (row + 1) * kUnit);
    const std::int64_t leaves = a.x * d.y + d.x * (top - a.y);
    const auto first = static_cast<int>(std::min(enters, leaves) / wide);
    const auto last = static_cast<int>(ceil_of(std::max(enters, leaves), wide));
    for (int column = first; column < last; ++column) {
      if (blocked(column, row)) return false;
    }
    if (top < b.y && leaves % wide == 0 && pinched(static_cast<int>(leaves / wide), row + 1)) return false;
    enters = leaves;
  }
  return true;
}

}  // namespace muster
