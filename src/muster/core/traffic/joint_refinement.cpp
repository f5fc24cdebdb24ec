#include "traffic/joint_refinement.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace muster {

JointRefinement::JointRefinement(std::shared_ptr<const DirectedGraph> graph, const std::vector<Configuration>& steps,
                                 std::uint64_t seed)
    : graph_(std::move(graph)), random_(seed), last_step_(static_cast<int>(steps.size()) - 1) {
  if (steps.empty()) throw std::invalid_argument("no paths");
  goals_ = steps.back();
  standing_.assign(steps.size() * graph_->size(), kNobody);
  before_.resize(standing_.size());
  found_in_.assign(standing_.size(), 0);
  open_.resize(steps.size());
  for (int i = 0; i < static_cast<int>(goals_.size()); ++i) {
    Path path;
    for (const Configuration& step : steps) {
      const int there = step.at(i);
      if (there < 0 || there >= graph_->size() ||
          (!path.empty() && there != path.back() && graph_->edge(path.back(), there) < 0)) {
        throw std::invalid_argument("a robot leaves the edges");
      }
      if (standing(static_cast<int>(path.size()), there) != kNobody) throw std::invalid_argument("two robots meet");
      standing(static_cast<int>(path.size()), there) = i;
      path.push_back(there);
    }
    while (path.size() > 1 && path[path.size() - 2] == path.back()) path.pop_back();
    paths_.push_back(std::move(path));
  }
}

void JointRefinement::advance(int neighbourhoods) {
  for (int k = 0; k < neighbourhoods && robots() > 0; ++k) refine();
}

int JointRefinement::cost() const {
  int sum = 0;
  for (const Path& path : paths_) sum += static_cast<int>(path.size()) - 1;
  return sum;
}

std::vector<Configuration> JointRefinement::solution() const {
  std::size_t longest = 1;
  for (const Path& path : paths_) longest = std::max(longest, path.size());
  std::vector<Configuration> steps(longest);
  for (std::size_t step = 0; step < longest; ++step) {
    for (int i = 0; i < robots(); ++i) steps[step].push_back(at(i, static_cast<int>(step)));
  }
  return steps;
}

void JointRefinement::refine() {
  std::vector<int> chosen;
  neighbourhood(chosen);
  const int before = cost();
  std::vector<Path> kept;
  for (const int robot : chosen) {
    kept.push_back(paths_[robot]);
    take(robot);
  }
  std::size_t planned = 0;
  while (planned < chosen.size() && replan(chosen[planned])) put(chosen[planned++]);
  if (planned == chosen.size() && cost() <= before) return;
  while (planned > 0) take(chosen[--planned]);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    paths_[chosen[k]] = std::move(kept[k]);
    put(chosen[k]);
  }
}

// A robot that comes late, and those who are beside its path when it comes by; or any; in any order.
void JointRefinement::neighbourhood(std::vector<int>& chosen) {
  int late = random_.below(robots());
  for (int k = 0; k < 20; ++k) {  // a few draws, and the one that loses most
    const int other = random_.below(robots());
    const auto lost = [&](int i) { return static_cast<int>(paths_[i].size()) - 1 - to_goal(i)[paths_[i].front()]; };
    if (lost(other) > lost(late)) late = other;
  }
  chosen = {late};
  const auto add = [&](int other) {
    if (other != kNobody && std::find(chosen.begin(), chosen.end(), other) == chosen.end()) chosen.push_back(other);
  };
  const bool beside = random_.below(4) > 0;
  const int steps = static_cast<int>(paths_[late].size()), first = random_.below(steps);
  for (int k = 0; beside && k < steps && chosen.size() < kMost; ++k) {
    const int step = (first + k) % steps;
    for (const int there : graph_->neighbours(paths_[late][step])) add(standing(step, there));
  }
  const std::size_t size = std::min<std::size_t>(4 + random_.below(kMost - 3), robots());
  while (chosen.size() < size) add(random_.below(robots()));
  if (chosen.size() > size) chosen.resize(size);
  for (std::size_t k = chosen.size(); k > 1; --k) std::swap(chosen[k - 1], chosen[random_.below(static_cast<int>(k))]);
}

void JointRefinement::put(int robot) {
  for (int step = 0; step <= last_step_; ++step) standing(step, at(robot, step)) = robot;
}

void JointRefinement::take(int robot) {
  for (int step = 0; step <= last_step_; ++step) standing(step, at(robot, step)) = kNobody;
}

// The step from which nobody else comes to its goal.
int JointRefinement::free_from(int robot) {
  int step = last_step_;
  while (step >= 0 && standing(step, goals_[robot]) == kNobody) --step;
  return step + 1;
}

// Space-time A* [silver2005]: the soonest path past those who stand in the tables.
bool JointRefinement::replan(int robot) {
  const auto& to_goal = this->to_goal(robot);
  const int from = paths_[robot].front(), rests_from = free_from(robot);
  ++search_;
  for (auto& states : open_) states.clear();
  if (standing(0, from) != kNobody || to_goal[from] > last_step_) return false;
  found_in_[from] = search_;
  open_[to_goal[from]].push_back({0, from});
  for (int arrival = 0; arrival <= last_step_; ++arrival) {
    while (!open_[arrival].empty()) {
      const auto [step, vertex] = open_[arrival].back();
      open_[arrival].pop_back();
      if (vertex == goals_[robot] && step >= rests_from) {
        Path path(step + 1);
        for (int k = step, v = vertex; k >= 0; v = before_[static_cast<std::size_t>(k--) * graph_->size() + v])
          path[k] = v;
        paths_[robot] = std::move(path);
        return true;
      }
      if (step < last_step_) expand(robot, step, vertex, to_goal);
    }
  }
  return false;
}

void JointRefinement::expand(int robot, int step, int vertex, std::span<const int> to_goal) {
  const auto go = [&](int there) {
    const std::size_t state = static_cast<std::size_t>(step + 1) * graph_->size() + there;
    const int arrival = step + 1 + to_goal[there];
    if (found_in_[state] == search_ || arrival > last_step_ || standing_[state] != kNobody) return;
    const int who = standing(step, there);
    if (who != kNobody && who != robot && standing(step + 1, vertex) == who) return;  // they would change places
    found_in_[state] = search_;
    before_[state] = vertex;
    open_[arrival].push_back({step + 1, there});
  };
  go(vertex);
  for (const int there : graph_->neighbours(vertex)) go(there);
}

}  // namespace muster
