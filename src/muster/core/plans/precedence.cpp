#include "plans/precedence.hpp"

#include <algorithm>

namespace muster {

Precedence::Precedence(const Problem& problem)
    : problem_(problem),
      robots_(problem.robots()),
      last_(problem.has_prerequisites() ? problem.tasks() * robots_ : 0, Draft::kNobody),
      place_(problem.tasks(), 0) {}

int Precedence::earliest(int robot, int task) const {
  int earliest = 0;
  for (const int prerequisite : problem_.prerequisites(task)) {
    const int last = last_[prerequisite * robots_ + robot];
    if (last != Draft::kNobody) earliest = std::max(earliest, place_[last] + 1);
  }
  return earliest;
}

void Precedence::follow(const Draft& draft, std::span<const int> sequence) {
  if (!problem_.has_prerequisites()) return;
  for (int robot = 0; robot < problem_.robots(); ++robot) place(draft, robot, 0);
  for (const int task : sequence) begin(draft, task);
}

std::span<const int> Precedence::insert(const Draft& draft, int robot, int at) {
  changed_.clear();
  if (!problem_.has_prerequisites()) return changed_;
  place(draft, robot, at);
  const int inserted = draft.route(robot)[at];
  begin(draft, inserted);
  changed_.push_back(inserted);
  for (std::size_t k = 0; k < changed_.size(); ++k) {
    const int task = changed_[k];
    const auto route = draft.route(draft.robot_of(task));
    const int next = place_[task] + 1;
    if (next < static_cast<int>(route.size()) && merge(route[next], task)) changed_.push_back(route[next]);
    for (const int dependant : problem_.dependants(task)) {
      if (draft.robot_of(dependant) != Draft::kNobody && merge(dependant, task)) changed_.push_back(dependant);
    }
  }
  return changed_;
}

// All that comes before a task in a route, from what comes directly before it.
void Precedence::begin(const Draft& draft, int task) {
  const int robot = draft.robot_of(task), at = place_[task];
  std::ranges::fill(before(task), Draft::kNobody);
  for (const int prerequisite : problem_.prerequisites(task)) {
    if (draft.robot_of(prerequisite) != Draft::kNobody) merge(task, prerequisite);
  }
  if (at > 0) merge(task, draft.route(robot)[at - 1]);
  before(task)[robot] = task;
}

// Adds what is before one task to what is before another; tells whether that was more.
bool Precedence::merge(int task, int from) {
  const auto mine = before(task), its = before(from);
  bool more = false;
  for (std::size_t robot = 0; robot < robots_; ++robot) {
    if (its[robot] == Draft::kNobody) continue;
    if (mine[robot] != Draft::kNobody && place_[mine[robot]] >= place_[its[robot]]) continue;
    mine[robot] = its[robot];
    more = true;
  }
  return more;
}

void Precedence::place(const Draft& draft, int robot, int from) {
  const auto route = draft.route(robot);
  for (int at = from; at < static_cast<int>(route.size()); ++at) place_[route[at]] = at;
}

}  // namespace muster
