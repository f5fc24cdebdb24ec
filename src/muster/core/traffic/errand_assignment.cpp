#include "traffic/errand_assignment.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace muster {

namespace {

// Rows are at most as many as columns.
class ShortestAugmentation {
 public:
  ShortestAugmentation(const std::vector<int>& costs, int rows, int columns)
      : costs_(costs),
        columns_of_(rows, -1),
        row_potentials_(rows, 0),
        rows_of_(columns, -1),
        from_(columns),
        column_potentials_(columns, 0),
        shortest_(columns),
        is_done_(columns) {
    for (int row = 0; row < rows; ++row) augment(row);
  }

  std::vector<int> columns_of() && { return std::move(columns_of_); }

 private:
  int columns() const { return static_cast<int>(rows_of_.size()); }

  void augment(int row) {
    const int free = nearest_free_column(row);
    update_potentials(row, shortest_[free]);
    for (int column = free, taker = -1; taker != row;) {
      taker = from_[column];
      rows_of_[column] = taker;
      column = std::exchange(columns_of_[taker], column);
    }
  }

  // Dijkstra's algorithm over columns, by reduced costs.
  int nearest_free_column(int row) {
    std::fill(shortest_.begin(), shortest_.end(), std::numeric_limits<std::int64_t>::max());
    std::fill(is_done_.begin(), is_done_.end(), false);
    for (std::int64_t length = 0;;) {
      const int* costs = costs_.data() + static_cast<std::size_t>(row) * columns();
      int nearest = -1;
      for (int k = 0; k < columns(); ++k) {
        if (is_done_[k]) continue;
        const std::int64_t reduced = length + costs[k] - row_potentials_[row] - column_potentials_[k];
        if (reduced < shortest_[k]) {
          shortest_[k] = reduced;
          from_[k] = row;
        }
        if (nearest < 0 || shortest_[k] < shortest_[nearest]) nearest = k;
      }
      if (rows_of_[nearest] < 0) return nearest;
      is_done_[nearest] = true;
      length = shortest_[nearest];
      row = rows_of_[nearest];
    }
  }

  void update_potentials(int row, std::int64_t length) {
    row_potentials_[row] += length;
    for (int k = 0; k < columns(); ++k) {
      if (!is_done_[k]) continue;
      row_potentials_[rows_of_[k]] += length - shortest_[k];
      column_potentials_[k] -= length - shortest_[k];
    }
  }

  const std::vector<int>& costs_;
  std::vector<int> columns_of_;  // by row
  std::vector<std::int64_t> row_potentials_;
  // By column; the last two are of one search.
  std::vector<int> rows_of_, from_;
  std::vector<std::int64_t> column_potentials_, shortest_;
  std::vector<char> is_done_;
};

}  // namespace

std::vector<int> cheapest_assignment(const std::vector<int>& costs, int rows, int columns) {
  if (rows <= columns) return ShortestAugmentation(costs, rows, columns).columns_of();
  std::vector<int> transposed(costs.size()), columns_of(rows, -1);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      transposed[static_cast<std::size_t>(column) * rows + row] =
          costs[static_cast<std::size_t>(row) * columns + column];
  }
  const std::vector<int> rows_of = ShortestAugmentation(transposed, columns, rows).columns_of();
  for (int column = 0; column < columns; ++column) columns_of[rows_of[column]] = column;
  return columns_of;
}

}  // namespace muster
