#include "traffic/path_table.hpp"

#include <algorithm>
#include <utility>

namespace muster {

PathTable::PathTable(std::shared_ptr<GoalDistances> distances)
    : distances_(std::move(distances)), paths_(distances_->robots()), rows_(graph().size()) {}

std::size_t PathTable::stay_at(const Row& row, int step) {
  const auto found = std::lower_bound(row.stays.begin(), row.stays.end(), step,
                                      [](const Stay& stay, int at) { return stay.end < at; });
  return static_cast<std::size_t>(found - row.stays.begin());
}

int PathTable::occupant(int vertex, int step) const {
  const Row& row = rows_[vertex];
  const std::size_t k = stay_at(row, step);
  return k < row.stays.size() && row.stays[k].begin <= step ? row.stays[k].robot : kNobody;
}

void PathTable::visitors(int vertex, std::vector<int>& found) const {
  found.clear();
  for (const Stay& stay : rows_[vertex].stays) found.push_back(stay.robot);
}

bool PathTable::is_free(const Path& path) const {
  for (std::size_t begin = 0, end; begin < path.size(); begin = end) {
    for (end = begin + 1; end < path.size() && path[end] == path[begin];) ++end;
    const Row& row = rows_[path[begin]];
    const std::size_t k = stay_at(row, static_cast<int>(begin));
    const int last = end < path.size() ? static_cast<int>(end) - 1 : kForever;
    if (k < row.stays.size() && row.stays[k].begin <= last) return false;
    if (begin == 0) continue;  // whoever was here a step ago must not have gone to where this one was
    const int step = static_cast<int>(begin), other = occupant(path[begin], step - 1);
    if (other != kNobody && occupant(path[begin - 1], step) == other) return false;
  }
  return true;
}

void PathTable::put(int robot, Path path) {
  for (std::size_t begin = 0, end; begin < path.size(); begin = end) {
    for (end = begin + 1; end < path.size() && path[end] == path[begin];) ++end;
    auto& stays = rows_[path[begin]].stays;
    const Stay stay{static_cast<int>(begin), end < path.size() ? static_cast<int>(end) - 1 : kForever, robot};
    stays.insert(stays.begin() + static_cast<std::ptrdiff_t>(stay_at(rows_[path[begin]], stay.begin)), stay);
  }
  paths_[robot] = std::move(path);
}

void PathTable::remove(int robot) {
  const Path& path = paths_[robot];
  for (std::size_t begin = 0, end; begin < path.size(); begin = end) {
    for (end = begin + 1; end < path.size() && path[end] == path[begin];) ++end;
    auto& stays = rows_[path[begin]].stays;
    stays.erase(stays.begin() + static_cast<std::ptrdiff_t>(stay_at(rows_[path[begin]], static_cast<int>(begin))));
  }
}

PathTable::Label& PathTable::label(int vertex, int interval) {
  Row& row = rows_[vertex];
  if (row.search != search_) {
    row.search = search_;
    row.labels.assign(row.stays.size() + 1, {kForever, kNobody, 0});
  }
  return row.labels[interval];
}

// A* over (vertex, safe interval), each with its soonest arrival; of equal keys the last one first, which goes deep.
bool PathTable::search(int robot, int start, int latest, Random& random, Path& found) {
  const int goal = distances_->goal(robot), way = distances_->to_goal(robot, start);
  const Row& row = rows_[goal];
  if (!row.stays.empty() && row.stays.back().end == kForever) return false;
  const int rest_from = row.stays.empty() ? 0 : row.stays.back().end + 1;
  const int last_interval = static_cast<int>(row.stays.size()), turn = random.below(4);
  if (way >= DirectedGraph::kNoWay || std::max(way, rest_from) > latest || occupant(start, 0) != kNobody) return false;
  ++search_;
  open_.clear();
  label(start, 0) = {0, kNobody, 0};
  open_.push({key_of(std::max(way, rest_from), way), 0, start, 0});
  bool done = false;
  while (!done && !open_.empty()) {
    const State state = open_.pop();
    if (label(state.vertex, state.interval).step != state.step) continue;  // it is reached sooner
    done = state.vertex == goal && state.interval == last_interval;
    if (!done) expand(robot, state, latest, rest_from, turn);
  }
  if (done) trace(goal, last_interval, found);
  return done;
}

void PathTable::expand(int robot, const State& from, int latest, int rest_from, int turn) {
  const auto& stays = rows_[from.vertex].stays;
  const std::size_t interval = static_cast<std::size_t>(from.interval);
  const Stay* after = interval < stays.size() ? &stays[interval] : nullptr;
  const int arrives_by = after == nullptr ? kForever : after->begin;  // one step after it leaves at the latest
  const auto neighbours = graph().neighbours(from.vertex);
  for (std::size_t n = 0; n < neighbours.size(); ++n) {
    const int to = neighbours[(n + static_cast<std::size_t>(turn)) % neighbours.size()];
    const int way = distances_->to_goal(robot, to);
    if (from.step + 1 + way > latest) continue;
    const auto& there = rows_[to].stays;
    for (std::size_t k = stay_at(rows_[to], from.step + 1); k <= there.size(); ++k) {
      const int free_from = k == 0 ? 0 : there[k - 1].end + 1;
      const int arrival = std::max(from.step + 1, free_from);
      if (arrival > arrives_by || arrival + way > latest) break;
      if (k < there.size() && there[k].begin <= arrival) continue;
      const bool change_places = k > 0 && after != nullptr && free_from == arrival && after->begin == arrival &&
                                 after->robot == there[k - 1].robot;
      if (change_places) continue;
      Label& known = label(to, static_cast<int>(k));
      if (known.step <= arrival) continue;
      known = {arrival, from.vertex, from.interval};
      open_.push({key_of(std::max(arrival + way, rest_from), way), arrival, to, static_cast<int>(k)});
    }
  }
}

void PathTable::trace(int vertex, int interval, Path& found) {
  found.assign(static_cast<std::size_t>(label(vertex, interval).step) + 1, vertex);
  int step = static_cast<int>(found.size());
  while (vertex != kNobody) {
    const Label at = label(vertex, interval);
    while (step > at.step) found[static_cast<std::size_t>(--step)] = vertex;
    vertex = at.parent;
    interval = at.parent_interval;
  }
}

}  // namespace muster
