// Costs from each cell and heading to goals, in tables that are kept while memory allows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "buckets.hpp"
#include "traffic/turning_grid.hpp"

namespace muster {

// `GoalDistances` keeps a table for each robot and its one goal. Here goals change all the time, robots and tasks share
// them, and a table takes two bytes a state.
//
// Rows and columns of the grid are lanes of alternating directions: to go against a lane costs more. That keeps dense
// traffic from meeting head-on, as graph guidance does [yukhnevich2025].
class HeadingDistances {
 public:
  // At most `most_bytes` of tables are kept, and always one.
  HeadingDistances(const TurningGrid& grid, std::size_t most_bytes);

  static constexpr int kStep = 2;         // what a step costs: forward along a lane, or a turn
  static constexpr int kAgainstLane = 4;  // what a step against a lane costs beside
  static constexpr int kNoWay = 1 << 26;

  // Makes tables of goals that have none, `most` at most, on `threads` threads. If there is no room for the tables of
  // all goals, the first ones get it, and tables that were not asked for longest make room.
  void require(std::span<const int> goals, std::int64_t most, int threads);

  // The cost to a goal; where the goal has no table, that of the Manhattan distance.
  int to_goal(int goal, int state) const {
    const int slot = slots_[goal];
    if (slot < 0) return without_table(goal, state);
    const std::uint16_t cost = tables_[slot].costs[state];
    return cost == kUnreached ? kNoWay : cost;
  }

 private:
  struct Table {
    int goal = -1;
    std::vector<std::uint16_t> costs;  // by state
  };
  static constexpr std::uint16_t kUnreached = 0xffff;
  static constexpr int kMostStep = kStep + kAgainstLane;

  std::vector<int> without_table(std::span<const int> goals);
  int without_table(int goal, int state) const;
  std::vector<int> free_slots(std::size_t count);
  void fill(Table& table, Buckets& open) const;

  const TurningGrid& grid_;
  std::size_t most_tables_;
  std::vector<std::uint8_t> forward_costs_;  // by state
  std::vector<Table> tables_;
  std::vector<int> slots_;       // by vertex: the table
  std::vector<long> asked_for_;  // by vertex: the last call
  long call_ = 0;
};

}  // namespace muster
