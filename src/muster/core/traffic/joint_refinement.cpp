#include "traffic/joint_refinement.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace muster {

namespace {

Configuration first_of(const std::vector<Configuration>& steps) {
  if (steps.empty()) throw std::invalid_argument("no paths");
  return steps.front();
}

void shuffle(std::vector<int>& values, Random& random) {
  for (std::size_t k = values.size(); k > 1; --k) {
    std::swap(values[k - 1], values[static_cast<std::size_t>(random.below(static_cast<int>(k)))]);
  }
}

}  // namespace

JointRefinement::JointRefinement(std::shared_ptr<GoalDistances> distances, const std::vector<Configuration>& steps,
                                 std::uint64_t seed)
    : random_(seed), starts_(first_of(steps)), table_(std::move(distances)), chosen_in_(starts_.size(), 0) {
  const DirectedGraph& graph = table_.graph();
  if (steps.back() != table_.distances().goals()) throw std::invalid_argument("the paths do not lead to the goals");
  for (int i = 0; i < robots(); ++i) {
    Path path;
    for (const Configuration& step : steps) {
      const int there = step.at(static_cast<std::size_t>(i));
      if (there < 0 || there >= graph.size() ||
          (!path.empty() && there != path.back() && graph.edge(path.back(), there) < 0)) {
        throw std::invalid_argument("a robot leaves the edges");
      }
      path.push_back(there);
    }
    while (path.size() > 1 && path[path.size() - 2] == path.back()) path.pop_back();
    if (!table_.is_free(path)) throw std::invalid_argument("two robots meet");
    table_.put(i, std::move(path));
    cost_ += table_.cost(i);
  }
  seen_in_.assign(static_cast<std::size_t>(graph.size()), 0);
  for (int v = 0; v < graph.size(); ++v) {
    if (graph.neighbours(v).size() > 2) crossings_.push_back(v);
  }
}

void JointRefinement::advance(int neighbourhoods) {
  for (int k = 0; k < neighbourhoods && robots() > 0; ++k) refine();
}

std::vector<Configuration> JointRefinement::solution() const {
  std::size_t longest = 1;
  for (int i = 0; i < robots(); ++i) longest = std::max(longest, table_.path(i).size());
  std::vector<Configuration> steps(longest, Configuration(starts_.size()));
  for (int i = 0; i < robots(); ++i) {
    const Path& path = table_.path(i);
    for (std::size_t step = 0; step < longest; ++step) steps[step][i] = path[std::min(step, path.size() - 1)];
  }
  return steps;
}

void JointRefinement::refine() {
  constexpr double kReaction = 0.01;  // [li2021]
  ++round_;
  const Rule used = rule();
  choose(used, std::min(2 + random_.below(kMost - 1), robots()));
  const int before = cost_;
  shuffle(chosen_, random_);
  replan();
  weights_[used] = (1 - kReaction) * weights_[used] + kReaction * std::max(before - cost_, 0);
}

// The chosen robots again, in their order; whether the new paths are kept.
bool JointRefinement::replan() {
  std::vector<Path> kept;
  int allowed = 0, ways = 0;  // costs before, and the least costs of those that are still to be planned
  for (const int robot : chosen_) {
    kept.push_back(table_.path(robot));
    allowed += table_.cost(robot);
    ways += way(robot);
    table_.remove(robot);
  }
  std::size_t planned = 0;
  for (Path path; planned < chosen_.size(); ++planned) {
    const int robot = chosen_[planned];
    ways -= way(robot);
    if (!table_.search(robot, starts_[robot], allowed - ways, random_, path)) break;
    allowed -= static_cast<int>(path.size()) - 1;
    table_.put(robot, path);
  }
  if (planned == chosen_.size()) {
    cost_ -= allowed;  // what is left of it
    return true;
  }
  while (planned > 0) table_.remove(chosen_[--planned]);
  for (std::size_t k = 0; k < chosen_.size(); ++k) table_.put(chosen_[k], std::move(kept[k]));
  return false;
}

JointRefinement::Rule JointRefinement::rule() {
  constexpr double kLeast = 0.1;  // of the largest weight: no rule is given up
  const double least = kLeast * *std::max_element(weights_.begin(), weights_.end());
  double sum = 0;
  for (const double weight : weights_) sum += std::max(weight, least);
  double drawn = random_.uniform() * sum;
  for (int k = 0; k + 1 < kRules; ++k) {
    drawn -= std::max(weights_[k], least);
    if (drawn < 0) return static_cast<Rule>(k);
  }
  return kAny;
}

void JointRefinement::choose(Rule rule, int size) {
  chosen_.clear();
  if (rule == kDelayed) {
    const int robot = delayed_robot();
    add(robot);
    for (int k = 0; k < 10 && static_cast<int>(chosen_.size()) < size; ++k) {
      walk(k == 0 ? robot : chosen_[random_.below(static_cast<int>(chosen_.size()))], size);
    }
  } else if (rule == kCrossing && !crossings_.empty()) {
    gather(crossings_[random_.below(static_cast<int>(crossings_.size()))], size);
  }
  while (rule == kAny && static_cast<int>(chosen_.size()) < size) add(random_.below(robots()));
}

void JointRefinement::add(int robot) {
  if (robot == PathTable::kNobody || chosen_in_[robot] == round_) return;
  chosen_in_[robot] = round_;
  chosen_.push_back(robot);
}

// Of a few the one that loses most.
int JointRefinement::delayed_robot() {
  int found = random_.below(robots());
  for (int k = 0; k < 10; ++k) {
    const int other = random_.below(robots());
    if (delay(other) > delay(found)) found = other;
  }
  return found;
}

// Goes from a step of its path at random, wherever the robot could still come sooner than it does; those who are in the
// way are added.
void JointRefinement::walk(int robot, int size) {
  const Path& path = table_.path(robot);
  const int cost = table_.cost(robot);
  int step = random_.below(cost + 1), at = path[static_cast<std::size_t>(step)];
  while (static_cast<int>(chosen_.size()) < size) {
    const auto neighbours = table_.graph().neighbours(at);
    int next = -1, drawn = 1;  // one of those that are possible, each with the same chance
    const auto consider = [&](int to) {
      if (step + 1 + table_.distances().to_goal(robot, to) < cost && random_.below(drawn++) == 0) next = to;
    };
    consider(at);
    for (const int to : neighbours) consider(to);
    if (next < 0) return;
    add(table_.occupant(next, step + 1));
    const int opposite = table_.occupant(next, step);
    if (opposite != PathTable::kNobody && table_.occupant(at, step + 1) == opposite) add(opposite);
    at = next;
    ++step;
  }
}

// Those who visit a vertex, and the vertices around it.
void JointRefinement::gather(int vertex, int size) {
  ++search_;
  std::vector<int> queue{vertex};
  seen_in_[vertex] = search_;
  for (std::size_t k = 0; k < queue.size() && static_cast<int>(chosen_.size()) < size; ++k) {
    table_.visitors(queue[k], visitors_);
    const std::size_t first = visitors_.empty() ? 0 : random_.below(static_cast<int>(visitors_.size()));
    for (std::size_t n = 0; n < visitors_.size() && static_cast<int>(chosen_.size()) < size; ++n) {
      add(visitors_[(first + n) % visitors_.size()]);
    }
    for (const int to : table_.graph().neighbours(queue[k])) {
      if (seen_in_[to] == search_) continue;
      seen_in_[to] = search_;
      queue.push_back(to);
    }
  }
}

}  // namespace muster
