#include "paths/clearance.hpp"

#include <algorithm>
#include <cstdlib>

namespace muster {

// Two passes, each of which sees the neighbours that come before.
Clearance::Clearance(const GridMap& map) : map_(map), stride_(static_cast<std::size_t>(map.columns()) + 2) {
  steps_.assign(stride_ * (static_cast<std::size_t>(map.rows()) + 2), 0);
  const auto lower = [](std::uint8_t& step, int least) {
    step = static_cast<std::uint8_t>(std::min<int>(step, std::min(least, kMost - 1) + 1));
  };
  for (int row = 0; row < map.rows(); ++row) {
    std::uint8_t* here = &steps_[index({0, row})];
    const std::uint8_t* below = here - stride_;
    for (int k = 0; k < map.columns(); ++k) {
      if (map.blocked(k, row)) continue;
      here[k] = kMost;
      lower(here[k], std::min(std::min<int>(below[k - 1], below[k]), std::min<int>(below[k + 1], here[k - 1])));
    }
  }
  for (int row = map.rows() - 1; row >= 0; --row) {
    std::uint8_t* here = &steps_[index({0, row})];
    const std::uint8_t* above = here + stride_;
    for (int k = map.columns() - 1; k >= 0; --k) {
      lower(here[k], std::min(std::min<int>(above[k - 1], above[k]), std::min<int>(above[k + 1], here[k + 1])));
    }
  }
}

bool Clearance::sees(Cell a, Cell b) const {
  if (std::abs(b.row - a.row) > std::abs(b.column - a.column)) {
    return a.row < b.row ? sees_along<true>({a.row, a.column}, {b.row, b.column})
                         : sees_along<true>({b.row, b.column}, {a.row, a.column});
  }
  return a.column < b.column ? sees_along<false>(a, b) : sees_along<false>(b, a);
}

// Column by column, where it is no steeper than the diagonal; a steep piece is turned over, so that its rows are the
// columns here. From a column on, the piece stays within j + 1 rows of its cell there for j more columns: so many are
// passed at once as are free that far around.
template <bool kSteep>
bool Clearance::sees_along(Cell a, Cell b) const {
  const int dx = b.column - a.column, dy = b.row - a.row;
  // The row at the middle of a column, to 2^-32: the error of the whole way is far less than half a row.
  const std::int64_t rise = dx == 0 ? 0 : (static_cast<std::int64_t>(dy) << 32) / dx;
  const std::int64_t from = (static_cast<std::int64_t>(a.row) << 32) + (std::int64_t{1} << 31);
  for (int k = 0; k <= dx;) {
    const int column = a.column + k, row = static_cast<int>((from + k * rise) >> 32);
    const int around = kSteep ? at({row, column}) : at({column, row});
    if (around < 2 && !column_is_free<kSteep>(a, dx, dy, k)) return false;
    k += std::max(1, around - 1);
  }
  return true;
}

// The cells of the k-th column that the piece meets inside, and the grid point at which it leaves, in whole numbers.
template <bool kSteep>
bool Clearance::column_is_free(Cell a, int dx, int dy, int k) const {
  const std::int64_t wide = 2 * static_cast<std::int64_t>(dx);  // a row, in the unit of what follows
  const auto row_at = [&](std::int64_t half_columns) { return (2 * a.row + 1) * (wide / 2) + dy * half_columns; };
  const auto is_free = [&](std::int64_t column, std::int64_t row) {
    return at(kSteep ? Cell{static_cast<int>(row), static_cast<int>(column)}
                     : Cell{static_cast<int>(column), static_cast<int>(row)}) > 0;
  };
  if (dx == 0) return is_free(a.column, a.row);
  const std::int64_t enters = row_at(std::max(0, 2 * k - 1)), leaves = row_at(std::min(2 * dx, 2 * k + 1));
  const std::int64_t first = std::min(enters, leaves) / wide, end = ceil_of(std::max(enters, leaves), wide);
  const std::int64_t column = a.column + k;
  for (std::int64_t row = first; row < std::max(end, first + 1); ++row) {
    if (!is_free(column, row)) return false;
  }
  if (k == dx || leaves % wide != 0) return true;
  const auto y = static_cast<int>(leaves / wide), x = static_cast<int>(column + 1);
  return !(kSteep ? map_.pinched(y, x) : map_.pinched(x, y));
}

}  // namespace muster
