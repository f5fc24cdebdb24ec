#include "traffic/heading_distances.hpp"

#include <algorithm>
#include <numeric>

#include "parallel.hpp"

namespace muster {

HeadingDistances::HeadingDistances(const TurningGrid& grid, std::size_t most_bytes)
    : grid_(grid),
      most_tables_(std::max<std::size_t>(1, most_bytes / std::max<std::size_t>(1, 8 * grid.size()))),
      forward_costs_(4 * static_cast<std::size_t>(grid.size()), kStep),
      slots_(grid.size(), -1),
      asked_for_(grid.size(), -1) {
  for (int v = 0; v < grid.size(); ++v) {
    const int row = grid.cell(v) / grid.columns(), column = grid.cell(v) % grid.columns();
    forward_costs_[4 * v + (row % 2 == 1 ? 0 : 2)] += kAgainstLane;     // even rows lead east
    forward_costs_[4 * v + (column % 2 == 1 ? 1 : 3)] += kAgainstLane;  // even columns lead south
  }
}

void HeadingDistances::require(std::span<const int> goals, std::int64_t most, int threads) {
  ++call_;
  std::vector<int> missing = without_table(goals);
  missing.resize(std::min<std::size_t>(missing.size(), static_cast<std::size_t>(most)));
  const std::vector<int> slots = free_slots(missing.size());
  for (std::size_t k = 0; k < slots.size(); ++k) {
    tables_[slots[k]].goal = missing[k];
    slots_[missing[k]] = slots[k];
  }
  for_each_parallel(static_cast<int>(slots.size()), threads, [&] {
    return [&, open = Buckets(1.0, kMostStep)](int k) mutable { fill(tables_[slots[k]], open); };
  });
}

// Of the first goals, as many as may have tables.
std::vector<int> HeadingDistances::without_table(std::span<const int> goals) {
  std::vector<int> missing;
  std::size_t wanted = 0;
  for (const int goal : goals) {
    if (asked_for_[goal] == call_) continue;
    if (wanted++ == most_tables_) break;
    asked_for_[goal] = call_;
    if (slots_[goal] < 0) missing.push_back(goal);
  }
  return missing;
}

// New tables, then those that were not asked for longest.
std::vector<int> HeadingDistances::free_slots(std::size_t count) {
  std::vector<int> slots;
  while (slots.size() < count && tables_.size() < most_tables_) {
    slots.push_back(static_cast<int>(tables_.size()));
    tables_.emplace_back();
  }
  if (slots.size() == count) return slots;
  std::vector<int> by_age(tables_.size());
  std::iota(by_age.begin(), by_age.end(), 0);
  std::erase_if(by_age, [&](int slot) { return tables_[slot].goal < 0; });
  const auto asked = [&](int slot) { return asked_for_[tables_[slot].goal]; };
  std::stable_sort(by_age.begin(), by_age.end(), [&](int a, int b) { return asked(a) < asked(b); });
  for (std::size_t k = 0; slots.size() < count; ++k) {
    slots_[tables_[by_age[k]].goal] = -1;
    slots.push_back(by_age[k]);
  }
  return slots;
}

int HeadingDistances::without_table(int goal, int state) const {
  const int vertex = TurningGrid::vertex_of(state);
  return grid_.part(vertex) == grid_.part(goal) ? kStep * grid_.manhattan(vertex, goal) : kNoWay;
}

// Dijkstra's algorithm backwards, with a bucket for each cost: a state is entered from the cell behind it, and by
// turns. Costs above what a table holds stay at its greatest.
void HeadingDistances::fill(Table& table, Buckets& open) const {
  auto& costs = table.costs;
  costs.assign(4 * static_cast<std::size_t>(grid_.size()), kUnreached);
  open.clear();
  const auto reach = [&](int state, int sum) {
    const int cost = std::min<int>(sum, kUnreached - 1);
    if (costs[state] <= cost) return;
    costs[state] = static_cast<std::uint16_t>(cost);
    open.push(sum, state);
  };
  for (int heading = 0; heading < 4; ++heading) reach(4 * table.goal + heading, 0);
  std::vector<int> states;
  while (!open.empty()) {
    const int cost = static_cast<int>(open.least());
    open.take(states);
    for (const int state : states) {
      if (costs[state] < std::min<int>(cost, kUnreached - 1)) continue;
      const int back = grid_.ahead(TurningGrid::turned(state, 2));
      const int from = TurningGrid::turned(back, 2);
      if (back != TurningGrid::kNone) reach(from, cost + forward_costs_[from]);
      reach(TurningGrid::turned(state, 1), cost + kStep);
      reach(TurningGrid::turned(state, 3), cost + kStep);
    }
  }
}

}  // namespace muster
