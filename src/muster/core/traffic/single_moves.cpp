#include "traffic/single_moves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace muster {

namespace {

constexpr int kMostIdle = 10;  // rounds in which nobody moves

void check(const MovingTeam& team, int points) {
  const auto robots = team.starts.size();
  if (team.goals.size() != robots || team.radii.size() != robots || team.priorities.size() != robots ||
      team.pinned.size() != robots || team.arrived.size() != robots) {
    throw std::invalid_argument("goals, radii, priorities and pinned must be as many as starts");
  }
  std::vector<char> taken(points);
  for (std::size_t i = 0; i < robots; ++i) {
    const int start = team.starts[i], goal = team.goals[i];
    if (start < 0 || start >= points || goal < MovingTeam::kNoGoal || goal >= points) {
      throw std::invalid_argument("a start or goal is no point");
    }
    if (std::exchange(taken[start], 1)) throw std::invalid_argument("two robots start at one point");
    if (!(team.radii[i] >= 0 && 2 * team.radii[i] + team.margin > 0 && team.priorities[i] >= 0)) {
      throw std::invalid_argument("radii and priorities must be at least 0, and two robots some way apart");
    }
  }
}

}  // namespace

SingleMoves::SingleMoves(std::shared_ptr<const AnnotatedRoadmap> roadmap, MovingTeam team, Tables* tables, int horizon,
                         bool settle)
    : roadmap_(std::move(roadmap)),
      graph_(roadmap_->graph()),
      team_(std::move(team)),
      tables_(tables),
      horizon_(horizon),
      settle_(settle) {
  check(team_, graph_.size());
  pace_ = 0;
  for (int e = 0; e < graph_.edges(); ++e) pace_ += graph_.cost(e) / graph_.edges();
  most_radius_ = team_.radii.empty() ? 0 : *std::max_element(team_.radii.begin(), team_.radii.end());
  for (const int goal : team_.goals) goal_tables_.push_back(goal == MovingTeam::kNoGoal ? nullptr : &to_go(goal));
  standing_.assign(graph_.size(), -1);
  pending_.assign(team_.robots(), 0);
  tried_.assign(team_.robots(), 0);
  marked_.assign(graph_.size(), 0);
  found_cost_.resize(graph_.size());
  found_edge_.resize(graph_.size());
  found_in_.assign(graph_.size(), 0);
}

Configuration SingleMoves::start() const {
  Configuration start;
  for (int i = 0; i < team_.robots(); ++i) {
    const bool there = team_.arrived[i] || team_.pinned[i] || team_.goals[i] == MovingTeam::kNoGoal ||
                       team_.goals[i] == team_.starts[i];
    start.push_back(2 * team_.starts[i] + there);
  }
  return start;
}

// Who has the longer way goes first, by less than a round without arrival adds.
SingleMoves::Memo SingleMoves::memo() const {
  Memo memo;
  const auto robots = team_.starts.size();
  memo.driven.assign(robots, 0);
  memo.edges.assign(robots, -1);
  memo.stalled.assign(robots, 0);
  memo.errands.resize(robots);
  for (std::size_t i = 0; i < robots; ++i) {
    const double way = goal_tables_[i] == nullptr ? 0 : (*goal_tables_[i])[team_.starts[i]];
    memo.priorities.push_back(std::floor(team_.priorities[i]) + (std::isinf(way) ? 0 : way / (way + 100 * pace_)));
  }
  return memo;
}

bool SingleMoves::cut_off() const {
  for (int i = 0; i < team_.robots(); ++i) {
    if (goal_tables_[i] != nullptr && !team_.pinned[i] && std::isinf((*goal_tables_[i])[team_.starts[i]])) return true;
  }
  return false;
}

bool SingleMoves::finished(const Configuration& configuration, const Memo& memo) const {
  return memo.made >= horizon_ || all_arrived(configuration);
}

bool SingleMoves::all_arrived(const Configuration& configuration) const {
  for (int i = 0; i < team_.robots(); ++i) {
    const bool away = settle_ && !team_.pinned[i] && team_.goals[i] != MovingTeam::kNoGoal &&
                      point(configuration[i]) != team_.goals[i];
    if (away || !visited(configuration[i])) return false;
  }
  return true;
}

double SingleMoves::least_cost(const Configuration& configuration) const {
  double sum = 0;
  for (int i = 0; i < team_.robots(); ++i) {
    if (goal_tables_[i] == nullptr || team_.pinned[i] || (!settle_ && visited(configuration[i]))) continue;
    sum += (*goal_tables_[i])[point(configuration[i])];
  }
  return sum;
}

void SingleMoves::order(const Memo& memo, std::vector<int>& robots) const {
  robots.resize(memo.priorities.size());
  std::iota(robots.begin(), robots.end(), 0);
  std::stable_sort(robots.begin(), robots.end(), [&](int i, int j) { return memo.priorities[i] > memo.priorities[j]; });
}

void SingleMoves::moves(const Configuration& configuration, int robot, std::vector<int>& found) const {
  const int at = point(configuration[robot]);
  found.assign(1, at);
  if (team_.pinned[robot]) return;
  for (const int there : graph_.neighbours(at)) found.push_back(there);
}

bool SingleMoves::next(const Configuration& from, const Memo& memo, std::span<const Constraint> said, Configuration& to,
                       Memo& grown) {
  grown = memo;
  take_up(from, grown);
  const bool found = obey(said);
  if (found) {
    rounds();
    to.clear();
    for (int i = 0; i < team_.robots(); ++i) to.push_back(2 * places_[i] + visited_[i]);
  }
  for (const int place : places_) standing_[place] = -1;
  return found;
}

void SingleMoves::again(Memo& known, const Memo& newer) const {
  known.priorities = newer.priorities;
  known.stalled = newer.stalled;
  known.errands = newer.errands;
}

void SingleMoves::take_up(const Configuration& from, Memo& memo) {
  memo_ = &memo;
  memo.moves.clear();
  undo_.clear();
  places_.clear();
  visited_.clear();
  for (int i = 0; i < team_.robots(); ++i) {
    places_.push_back(point(from[i]));
    visited_.push_back(visited(from[i]));
    standing_[places_[i]] = i;
  }
  told_ = team_.pinned;
  decided_ = told_;
}

// Who is told where to go or to stay is moved by nobody else.
bool SingleMoves::obey(std::span<const Constraint> said) {
  for (const auto [robot, where] : said) told_[robot] = 1;
  decided_ = told_;
  for (const auto [robot, where] : said) {
    if (where == places_[robot]) continue;
    const int edge = graph_.edge(places_[robot], where);
    ++attempt_;
    if (!travel(robot, {&edge, 1})) return false;
  }
  return true;
}

// One round; more while nobody moves, as others are still to come, or get impatient.
void SingleMoves::rounds() {
  for (int idle = 0; idle < kMostIdle;) {
    order(*memo_, order_);
    for (const int i : order_) {
      if (!decided_[i] && due(i)) advance(i);
    }
    if (!memo_->moves.empty()) break;
    if (!let_time_pass()) {
      ++idle;
      grow();
    }
    decided_ = told_;
  }
  memo_->now += pace_;
  memo_->made += static_cast<int>(memo_->moves.size());
  grow();
}

bool SingleMoves::let_time_pass() {
  double next = std::numeric_limits<double>::infinity();
  for (int i = 0; i < team_.robots(); ++i) {
    if (!due(i)) next = std::min(next, memo_->driven[i]);
  }
  if (std::isinf(next)) return false;
  memo_->now = next;
  return true;
}

int SingleMoves::wish(int robot) const {
  const Errand& errand = memo_->errands[robot];
  if (team_.pinned[robot]) return MovingTeam::kNoGoal;
  return errand.whose >= 0 ? errand.place : team_.goals[robot];
}

// Along the best edge that leads nearer to where it wants to be, and is free or can be freed.
void SingleMoves::advance(int robot) {
  Edges ahead;
  ways_ahead(robot, ahead);
  for (const int edge : ahead) {
    ++attempt_;
    mark(robot, route(robot, 8), team_.radii[robot] + most_radius_ + team_.margin);
    if (travel(robot, {&edge, 1})) {
      memo_->stalled[robot] = 0;
      return;
    }
  }
  decided_[robot] = 1;
  if (!ahead.empty() && ++memo_->stalled[robot] >= 2) exchange(robot, ahead.front());
}

void SingleMoves::ways_ahead(int robot, Edges& found) {
  const int at = places_[robot], last = memo_->edges[robot];
  if (wish(robot) == MovingTeam::kNoGoal) return;
  const auto& to_wish = to_go(wish(robot));
  std::vector<std::pair<double, int>> keys;
  for (int e = graph_.begin(at); e < graph_.end(at); ++e) {
    const double left = to_wish[graph_.head(e)];
    if (!(left < to_wish[at])) continue;
    const double turning = last < 0 ? 0 : team_.turn_cost * roadmap_->turn(last, e);
    keys.push_back({graph_.cost(e) + left + turning, e});
  }
  std::sort(keys.begin(), keys.end());
  for (const auto& [key, edge] : keys) found.push_back(edge);
}

// Goes along edges after all who stand near them have made way; if they cannot, nothing has happened.
bool SingleMoves::travel(int robot, std::span<const int> edges) {
  const std::size_t before = undo_.size();
  pending_[robot] = 1;
  claims_.push_back({robot, edges});
  std::vector<int> others;
  who_stands_near(robot, edges, others);
  bool free = true;
  for (std::size_t k = 0; k < others.size() && free; ++k) {
    free = clear(others[k], places_[others[k]]) || make_way(others[k]);
  }
  claims_.pop_back();
  pending_[robot] = 0;
  if (!free) {
    undo(before);
    return false;
  }
  for (const int edge : edges) move(robot, edge);
  return true;
}

bool SingleMoves::make_way(int robot) {
  if (decided_[robot] || pending_[robot] || tried_[robot] == attempt_ || !due(robot)) return false;
  for (const Edges& way : ways_out(robot)) {
    if (travel(robot, way)) return true;
  }
  tried_[robot] = attempt_;
  return false;
}

void SingleMoves::move(int robot, int edge) {
  const int place = places_[robot];
  undo_.push_back({robot, place, memo_->edges[robot], memo_->driven[robot], visited_[robot], decided_[robot]});
  standing_[place] = -1;
  places_[robot] = graph_.head(edge);
  standing_[places_[robot]] = robot;
  visited_[robot] = visited_[robot] || places_[robot] == team_.goals[robot];
  decided_[robot] = 1;
  memo_->driven[robot] = std::max(memo_->driven[robot], memo_->now) + graph_.cost(edge);
  memo_->edges[robot] = edge;
  memo_->moves.push_back({robot, edge});
}

void SingleMoves::undo(std::size_t moves) {
  for (; undo_.size() > moves; undo_.pop_back()) {
    const Undo& last = undo_.back();
    standing_[places_[last.robot]] = -1;
    places_[last.robot] = last.place;
    standing_[last.place] = last.robot;
    visited_[last.robot] = last.visited;
    decided_[last.robot] = last.decided;
    memo_->driven[last.robot] = last.driven;
    memo_->edges[last.robot] = last.edge;
    memo_->moves.pop_back();
  }
}

void SingleMoves::who_stands_near(int robot, std::span<const int> edges, std::vector<int>& found) const {
  for (const int edge : edges) {
    for (const auto [point, metres] : roadmap_->near(edge)) {
      const int other = standing_[point];
      if (other < 0 || other == robot || metres >= team_.apart(robot, other)) continue;
      if (std::find(found.begin(), found.end(), other) == found.end()) found.push_back(other);
    }
  }
}

// Whether a robot at a place is in the way of nobody who waits.
bool SingleMoves::clear(int robot, int place) const {
  for (const auto& [other, edges] : claims_) {
    if (other == robot) continue;
    for (const int edge : edges) {
      if (roadmap_->meets(edge, place, team_.apart(robot, other))) return false;
    }
  }
  return true;
}

// Priorities grow until a robot is where it wants to be.
void SingleMoves::grow() {
  for (int i = 0; i < team_.robots(); ++i) {
    Errand& errand = memo_->errands[i];
    if (errand.whose >= 0 && (--errand.rounds <= 0 || places_[errand.whose] == wish(errand.whose))) errand = {};
  }
  for (int i = 0; i < team_.robots(); ++i) {
    double& priority = memo_->priorities[i];
    const bool rests = wish(i) == MovingTeam::kNoGoal || places_[i] == wish(i);
    priority = rests ? priority - std::floor(priority) : priority + 1;
  }
}

}  // namespace muster
