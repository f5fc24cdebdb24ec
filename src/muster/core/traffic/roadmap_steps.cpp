#include "traffic/roadmap_steps.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace muster {

namespace {

constexpr double kChance = 0.1;  // paces by which chance may put one choice before another

void check(const SteppingTeam& team, int points) {
  const auto robots = team.starts.size();
  if (team.goals.size() != robots || team.radii.size() != robots || team.pinned.size() != robots ||
      team.stays.size() != robots) {
    throw std::invalid_argument("goals, radii, pinned and stays must be as many as starts");
  }
  std::vector<char> taken(points);
  for (std::size_t i = 0; i < robots; ++i) {
    const int start = team.starts[i], goal = team.goals[i];
    if (start < 0 || start >= points || goal < SteppingTeam::kNoGoal || goal >= points) {
      throw std::invalid_argument("a start or goal is no point");
    }
    if (std::exchange(taken[start], 1)) throw std::invalid_argument("two robots start at one point");
  }
}

}  // namespace

RoadmapSteps::RoadmapSteps(std::shared_ptr<const AnnotatedRoadmap> roadmap, SteppingTeam team, Tables* tables,
                           std::uint64_t seed)
    : roadmap_(std::move(roadmap)), graph_(roadmap_->graph()), team_(std::move(team)), random_(seed), pace_(0.0) {
  check(team_, graph_.size());
  for (int e = 0; e < graph_.edges(); ++e) pace_ += graph_.cost(e) / graph_.edges();
  for (const int goal : team_.goals) {
    const auto table = [&](int to) { return graph_.costs_to(to); };
    to_go_.push_back(goal == SteppingTeam::kNoGoal ? nullptr : &tables->to(goal, table));
  }
  standing_.assign(graph_.size(), -1);
  pending_.assign(team_.robots(), 0);
}

Configuration RoadmapSteps::start() const {
  Configuration start;
  for (int i = 0; i < team_.robots(); ++i) {
    const bool there = team_.pinned[i] || team_.goals[i] == SteppingTeam::kNoGoal || team_.goals[i] == team_.starts[i];
    start.push_back(2 * team_.starts[i] + there);
  }
  return start;
}

// Who has the longer way goes first, by less than what a step without arrival adds.
RoadmapSteps::Memo RoadmapSteps::memo() const {
  Memo memo;
  for (int i = 0; i < team_.robots(); ++i) {
    const double way = to_go_[i] == nullptr ? 0.0 : (*to_go_[i])[team_.starts[i]];
    memo.priorities.push_back(std::isinf(way) ? 0.0 : way / (way + 100.0 * pace_));
  }
  return memo;
}

bool RoadmapSteps::cut_off() const {
  for (int i = 0; i < team_.robots(); ++i) {
    if (to_go_[i] != nullptr && !team_.pinned[i] && std::isinf((*to_go_[i])[team_.starts[i]])) return true;
  }
  return false;
}

bool RoadmapSteps::finished(const Configuration& configuration, const Memo&) const {
  for (int i = 0; i < team_.robots(); ++i) {
    if (!team_.pinned[i] && wants(i, configuration[i]) && point(configuration[i]) != team_.goals[i]) return false;
  }
  return true;
}

double RoadmapSteps::cost(const Configuration& from, const Configuration& to) const {
  int under_way = 0;
  for (int i = 0; i < team_.robots(); ++i) under_way += from[i] != to[i] || metres(i, from[i]) > 0.0;
  return under_way;
}

double RoadmapSteps::least_cost(const Configuration& configuration) const {
  double sum = 0.0;
  for (int i = 0; i < team_.robots(); ++i) sum += team_.pinned[i] ? 0.0 : metres(i, configuration[i]);
  return sum;
}

void RoadmapSteps::order(const Memo& memo, std::vector<int>& robots) const {
  robots.resize(memo.priorities.size());
  std::iota(robots.begin(), robots.end(), 0);
  std::stable_sort(robots.begin(), robots.end(), [&](int i, int j) { return memo.priorities[i] > memo.priorities[j]; });
}

void RoadmapSteps::moves(const Configuration& configuration, int robot, std::vector<int>& found) const {
  const int at = point(configuration[robot]);
  found.assign(1, at);
  if (team_.pinned[robot]) return;
  for (const int there : graph_.neighbours(at)) found.push_back(there);
}

bool RoadmapSteps::next(const Configuration& from, const Memo& memo, std::span<const Constraint> said,
                        Configuration& to, Memo& grown) {
  where_ = from;
  made_.clear();
  for (int i = 0; i < team_.robots(); ++i) standing_[point(from[i])] = i;
  decided_ = team_.pinned;
  bool found = true;
  // Who is said to stay does so; the others go in the order in which they are said to.
  for (const auto [robot, where] : said) decided_[robot] |= where == point(from[robot]);
  for (const auto [robot, where] : said) {
    if (!found || where == point(from[robot])) continue;
    found = !decided_[robot] && go(robot, graph_.edge(point(where_[robot]), where));
  }
  if (found) {
    order(memo, order_);
    for (const int i : order_)
      if (!decided_[i]) decide(i);
    to = where_;
    grown.priorities = memo.priorities;
    grown.moves = made_;
    for (int i = 0; i < team_.robots(); ++i) {
      double& priority = grown.priorities[i];
      priority = metres(i, to[i]) > 0.0 ? priority + 1.0 : priority - std::floor(priority);
    }
  }
  for (const int where : where_) standing_[point(where)] = -1;
  return found;
}

// Where a robot may go, the best for its goal first; without one it had rather stay.
void RoadmapSteps::rank(int robot, std::vector<Choice>& choices) {
  const int where = where_[robot], at = point(where);
  const bool wants = this->wants(robot, where);
  choices.push_back({wants ? (*to_go_[robot])[at] : -1.0, kStay});
  for (int e = graph_.begin(at); e < graph_.end(at); ++e) {
    const double left = wants ? (*to_go_[robot])[graph_.head(e)] : graph_.cost(e);
    choices.push_back({left + kChance * pace_ * random_.uniform(), e});
  }
  std::ranges::sort(choices, {}, &Choice::key);
}

bool RoadmapSteps::decide(int robot) {
  std::vector<Choice> choices;
  rank(robot, choices);
  for (const Choice& choice : choices) {
    if (choice.edge == kStay ? clear(robot, point(where_[robot])) : go(robot, choice.edge)) {
      decided_[robot] = 1;
      return true;
    }
  }
  decided_[robot] = 1;
  return false;
}

// Along an edge, after those who stand near it have moved away.
bool RoadmapSteps::go(int robot, int edge) {
  const int head = graph_.head(edge);
  std::vector<int> others;
  if (!clear(robot, head) || !who_stands_near(robot, edge, others)) return false;
  pending_[robot] = 1;
  claims_.push_back({robot, edge});
  bool free = true;
  for (std::size_t k = 0; k < others.size() && free; ++k) {
    const int other = others[k];
    if (roadmap_->meets(edge, point(where_[other]), team_.apart(robot, other)))
      free = !decided_[other] && decide(other);
  }
  claims_.pop_back();
  pending_[robot] = 0;
  others.clear();
  free = free && who_stands_near(robot, edge, others) && others.empty() && clear(robot, head);
  if (!free) return false;
  standing_[point(where_[robot])] = -1;
  standing_[head] = robot;
  where_[robot] = 2 * head + (visited(where_[robot]) || head == team_.goals[robot]);
  decided_[robot] = 1;
  made_.push_back({robot, edge});
  return true;
}

// False where one of them will not move.
bool RoadmapSteps::who_stands_near(int robot, int edge, std::vector<int>& others) const {
  for (const auto [point, metres] : roadmap_->near(edge)) {
    const int other = standing_[point];
    if (other < 0 || other == robot || metres >= team_.apart(robot, other)) continue;
    if (decided_[other] || pending_[other]) return false;
    if (std::ranges::find(others, other) == others.end()) others.push_back(other);
  }
  return true;
}

bool RoadmapSteps::clear(int robot, int point) const {
  return std::ranges::none_of(claims_, [&](const Claim& claim) {
    return claim.robot != robot && roadmap_->meets(claim.edge, point, team_.apart(robot, claim.robot));
  });
}

}  // namespace muster
