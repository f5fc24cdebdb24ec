// [hart1968] (A*); [dijkstra1959]; [nash2007] (Theta*), algorithm of the same
// names.
#include "paths/grid_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <memory>
#include <new>
#include <numbers>

#include "buckets.hpp"
#include "heap.hpp"
#include "infinity.hpp"
#include "paths/clearance.hpp"

namespace muster {

namespace {

// Each diagonal after the two straight steps beside it.
struct Step {
  int dx, dy;
  double length;
};
constexpr std::array<Step, 8> kSteps{{{1, 0, 1.0},
                                      {0, 1, 1.0},
                                      {-1, 0, 1.0},
                                      {0, -1, 1.0},
                                      {1, 1, std::numbers::sqrt2},
                                      {-1, 1, std::numbers::sqrt2},
                                      {-1, -1, std::numbers::sqrt2},
                                      {1, -1, std::numbers::sqrt2}}};

// Theta* takes one cell at a time, the one with the least key, and looks from cell to cell.
class OneByOne {
 public:
  static constexpr bool kAnyAngle = true;
  explicit OneByOne(const GridMap& map) : clearance_(map) {}
  bool sees(Cell a, Cell b) const { return clearance_.sees(a, b); }
  bool empty() const { return heap_.empty(); }
  double least() const { return heap_.top().key; }
  void push(double key, int cell) { heap_.push({key, cell}); }
  void take(std::vector<int>& cells) { cells.assign(1, heap_.pop().cell); }

 private:
  struct Open {
    double key;
    int cell;
  };
  Clearance clearance_;
  Heap<Open> heap_;
};

// The others take all cells of a bucket. It is narrower than what a step adds, if it adds anything: to the length 1, to
// the octile estimate 2 - sqrt(2).
class Bucketed : public Buckets {
 public:
  static constexpr bool kAnyAngle = false;
  explicit Bucketed(const GridMap& map) : Buckets(0.5, map.rows() + map.columns()) {}
};

// Cells are numbered with the frame around the map, so that each has eight neighbours.
template <class Queue>
class Searcher {
 public:
  Searcher(const GridMap& map, Point start, Point goal, GridSearch how)
      : map_(map), goal_(goal), how_(how), stride_(map.columns() + 2), open_(map) {
    const auto cells = static_cast<std::size_t>(map.rows() + 2) * static_cast<std::size_t>(stride_);
    // Zeros that cost nothing where the search does not come by.
    found_.reset(static_cast<Found*>(std::calloc(cells, sizeof(Found))));
    if (!found_) throw std::bad_alloc();
    for (std::size_t k = 0; k < kSteps.size(); ++k) offset_[k] = kSteps[k].dy * stride_ + kSteps[k].dx;
    for (const int cell : map.cells_at(GridMap::snap(goal))) {
      const int column = cell % map.columns(), row = cell / map.columns();
      ends_.push_back({numbered(cell), column, row, distance({column + 0.5, row + 0.5}, goal)});
    }
    for (const int cell : map.cells_at(GridMap::snap(start))) {
      const int at = numbered(cell);
      reach(at, x(at), y(at), distance(start, centre(at)), at);
    }
  }

  std::vector<int> run() {
    int last = -1;
    double best = kFar;
    std::vector<int> cells;
    while (!open_.empty() && open_.least() < best) {
      open_.take(cells);
      for (const int cell : cells) {
        if (found_[cell].state != kOpen) continue;
        found_[cell].state = kClosed;
        for (const End& end : ends_) {
          if (end.cell == cell && found_[cell].g + end.rest < best) best = found_[cell].g + end.rest, last = cell;
        }
        expand(cell);
      }
    }
    return last < 0 ? std::vector<int>{} : way_to(last);
  }

 private:
  enum State : std::int32_t { kUnseen, kOpen, kClosed };
  struct Found {
    double g;
    std::int32_t parent;
    State state;
  };
  struct Parent {
    int cell;
    Cell at;
    double g;
  };
  // A last cell, and from its centre to the goal.
  struct End {
    int cell, column, row;
    double rest;
  };
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };

  int numbered(int cell) const { return (cell / map_.columns() + 1) * stride_ + cell % map_.columns() + 1; }
  int x(int cell) const { return cell % stride_ - 1; }
  int y(int cell) const { return cell / stride_ - 1; }
  Point centre(int cell) const { return centre(Cell{x(cell), y(cell)}); }
  static Point centre(Cell at) { return {at.column + 0.5, at.row + 0.5}; }
  Parent parent_of(int cell) const {
    const int parent = found_[cell].parent;
    return {parent, {x(parent), y(parent)}, found_[parent].g};
  }

  void expand(int cell) {
    const int column = x(cell), row = y(cell);
    const Parent from = parent_of(cell);
    for (unsigned steps = steps_from(column, row); steps != 0; steps &= steps - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(steps));
      const int next = cell + offset_[k], to_column = column + kSteps[k].dx, to_row = row + kSteps[k].dy;
      if constexpr (Queue::kAnyAngle) {
        expand_any_angle(cell, from, next, {to_column, to_row}, kSteps[k].length);
      } else {
        reach(next, to_column, to_row, found_[cell].g + kSteps[k].length, cell);
      }
    }
  }

  // A bit for each step that is free: a diagonal one needs the two beside it.
  unsigned steps_from(int column, int row) const {
    unsigned free = 0;
    for (std::size_t k = 0; k < kSteps.size(); ++k) {
      free |= static_cast<unsigned>(!map_.blocked(column + kSteps[k].dx, row + kSteps[k].dy)) << k;
    }
    const unsigned straight = free & 15U, turned = straight >> 1 | (straight & 1U) << 3;
    return straight | (free & (straight & turned) << 4);
  }

  // Theta*: path 2 goes straight from the parent of the cell where that sees the next one; else path 1 goes through it.
  // Path 2 is never the longer one, so where even that gains nothing there is no need to look.
  void expand_any_angle(int cell, const Parent& from, int next, Cell to, double length) {
    const Found& before = found_[next];
    if (before.state == kClosed) return;
    const double straight = from.g + distance(centre(from.at), centre(to));
    if (before.state != kUnseen && before.g <= straight) return;
    if (from.cell != cell && open_.sees(from.at, to)) {
      reach(next, to.column, to.row, straight, from.cell);
    } else {
      reach(next, to.column, to.row, found_[cell].g + length, cell);
    }
  }

  void reach(int cell, int column, int row, double g, int from) {
    Found& found = found_[cell];
    if (found.state != kUnseen && found.g <= g) return;
    found = {g, from, kOpen};
    open_.push(g + estimate(column, row), cell);
  }

  // Theta*: the straight distance. Else the octile distance to the nearest of the last cells, and on to the goal.
  double estimate(int column, int row) const {
    if (!how_.heuristic) return 0.0;
    if (Queue::kAnyAngle) return distance({column + 0.5, row + 0.5}, goal_);
    double least = kFar;
    for (const End& end : ends_) {
      const int dx = std::abs(column - end.column), dy = std::abs(row - end.row);
      const double octile = std::max(dx, dy) + (std::numbers::sqrt2 - 1.0) * std::min(dx, dy);
      least = std::min(least, octile + end.rest);
    }
    return least;
  }

  std::vector<int> way_to(int cell) const {
    std::vector<int> way{cell};
    while (found_[cell].parent != cell) way.push_back(cell = found_[cell].parent);
    std::reverse(way.begin(), way.end());
    for (int& each : way) each = y(each) * map_.columns() + x(each);
    return way;
  }

  const GridMap& map_;
  Point goal_;
  GridSearch how_;
  int stride_;
  std::array<int, 8> offset_;
  std::vector<End> ends_;
  std::unique_ptr<Found[], Free> found_;
  Queue open_;
};

}  // namespace

std::vector<int> search_grid(const GridMap& map, Point start, Point goal, GridSearch how) {
  if (how.any_angle) return Searcher<OneByOne>(map, start, goal, how).run();
  return Searcher<Bucketed>(map, start, goal, how).run();
}

}  // namespace muster
