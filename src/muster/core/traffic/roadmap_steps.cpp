#include "traffic/roadmap_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace muster {

namespace {

constexpr int kMostIdle = 10;      // rounds in which nobody moves
constexpr double kTurnCost = 0.3;  // metres for a radian

}  // namespace

RoadmapSteps::RoadmapSteps(std::shared_ptr<const AnnotatedRoadmap> roadmap, MovingTeam team, Tables* tables,
                           bool settle)
    : roadmap_(std::move(roadmap)),
      graph_(roadmap_->graph()),
      team_(std::move(team)),
      tables_(tables),
      settle_(settle),
      most_radius_(0) {
  const int robots = team_.robots();
  for (int e = 0; e < graph_.edges(); ++e) pace_ += graph_.cost(e) / graph_.edges();
  double speeds = 0;
  for (const Traveller& who : team_.travellers) {
    most_radius_ = std::max(most_radius_, who.radius);
    speeds += who.speed;
    stride_ = std::max(stride_, static_cast<int>(who.stops.size()) + 1);
  }
  round_ = robots > 0 ? pace_ * robots / speeds : 0;
  for (int i = 0; i < robots; ++i) {
    const Traveller& who = team_.travellers[i];
    std::vector<const std::vector<double>*> tables_to;
    for (const Stop& stop : who.stops) tables_to.push_back(&to_go(stop.point));
    std::vector<double> after(who.stops.size(), 0.0);
    for (std::size_t k = who.stops.size(); k-- > 1;) after[k - 1] = (*tables_to[k])[who.stops[k - 1].point] + after[k];
    stop_tables_.push_back(std::move(tables_to));
    after_.push_back(std::move(after));
    int passed = team_.passed[i];
    double spent = who.ready;
    if (who.fixed)
      passed = static_cast<int>(who.stops.size());
    else
      pass_stops(i, who.start, passed, spent);
    start_.push_back(stride_ * who.start + passed);
    ready_.push_back(spent);
  }
  standing_.assign(graph_.size(), -1);
  pending_.assign(robots, 0);
  tried_.assign(robots, 0);
  marked_.assign(graph_.size(), 0);
  found_cost_.resize(graph_.size());
  found_edge_.resize(graph_.size());
  found_in_.assign(graph_.size(), 0);
}

void RoadmapSteps::pass_stops(int robot, int point, int& passed, double& spent) const {
  const auto& all = team_.travellers[robot].stops;
  for (; passed < static_cast<int>(all.size()) && all[passed].point == point; ++passed) spent += all[passed].hold;
}

double RoadmapSteps::cost_left(int robot, int point, int passed) const {
  if (passed < static_cast<int>(stops(robot))) return (*stop_tables_[robot][passed])[point] + after_[robot][passed];
  return settle_ && stays(robot) ? (*stop_tables_[robot].back())[point] : 0.0;
}

// Who has the longer way goes first, by less than a round without arrival adds.
RoadmapSteps::Memo RoadmapSteps::memo() const {
  Memo memo;
  const auto robots = start_.size();
  memo.spent = ready_;
  memo.edges.assign(robots, -1);
  memo.stalled.assign(robots, 0);
  memo.errands.resize(robots);
  for (int i = 0; i < team_.robots(); ++i) {
    const double way = cost_left(i, point(start_[i]), passed(start_[i]));
    memo.priorities.push_back(std::floor(team_.priorities[i]) + (std::isinf(way) ? 0 : way / (way + 100 * pace_)));
  }
  return memo;
}

bool RoadmapSteps::cut_off() const { return std::isinf(least_cost(start_)); }

bool RoadmapSteps::finished(const Configuration& configuration, const Memo&) const {
  if (team_.leader >= 0) return passed(configuration[team_.leader]) > passed(start_[team_.leader]);
  for (int i = 0; i < team_.robots(); ++i) {
    if (team_.fixed(i)) continue;
    if (passed(configuration[i]) < static_cast<int>(stops(i))) return false;
    if (settle_ && stays(i) && point(configuration[i]) != team_.travellers[i].stops.back().point) return false;
  }
  return true;
}

double RoadmapSteps::least_cost(const Configuration& configuration) const {
  double sum = 0;
  for (int i = 0; i < team_.robots(); ++i) {
    if (!team_.fixed(i) && (team_.leader < 0 || team_.leader == i))
      sum += cost_left(i, point(configuration[i]), passed(configuration[i]));
  }
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
  if (team_.fixed(robot)) return;
  for (const int there : graph_.neighbours(at)) found.push_back(there);
}

bool RoadmapSteps::next(const Configuration& from, const Memo& memo, std::span<const Constraint> said,
                        Configuration& to, Memo& grown) {
  grown = memo;
  take_up(from, grown);
  const bool found = obey(said);
  if (found) {
    rounds();
    to.clear();
    for (int i = 0; i < team_.robots(); ++i) to.push_back(stride_ * places_[i] + passed_[i]);
  }
  for (const int place : places_) standing_[place] = -1;
  return found;
}

void RoadmapSteps::again(Memo& known, const Memo& newer) const {
  known.priorities = newer.priorities;
  known.stalled = newer.stalled;
  known.errands = newer.errands;
}

void RoadmapSteps::take_up(const Configuration& from, Memo& memo) {
  memo_ = &memo;
  memo.moves.clear();
  undo_.clear();
  places_.clear();
  passed_.clear();
  for (int i = 0; i < team_.robots(); ++i) {
    places_.push_back(point(from[i]));
    passed_.push_back(passed(from[i]));
    standing_[places_[i]] = i;
  }
  told_.clear();
  for (int i = 0; i < team_.robots(); ++i) told_.push_back(team_.fixed(i));
  decided_ = told_;
}

// Who is told where to go or to stay is moved by nobody else.
bool RoadmapSteps::obey(std::span<const Constraint> said) {
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
void RoadmapSteps::rounds() {
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
  memo_->now += round_;
  grow();
}

bool RoadmapSteps::let_time_pass() {
  double next = std::numeric_limits<double>::infinity();
  for (int i = 0; i < team_.robots(); ++i) {
    if (!due(i)) next = std::min(next, memo_->spent[i]);
  }
  if (std::isinf(next)) return false;
  memo_->now = next;
  return true;
}

int RoadmapSteps::wish(int robot) const {
  const Errand& errand = memo_->errands[robot];
  if (team_.fixed(robot)) return MovingTeam::kNowhere;
  if (errand.whose >= 0) return errand.place;
  if (stops(robot) == 0 || (team_.leader >= 0 && team_.leader != robot)) return MovingTeam::kNowhere;
  const auto& all = team_.travellers[robot].stops;
  if (passed_[robot] < static_cast<int>(all.size())) return all[passed_[robot]].point;
  return stays(robot) ? all.back().point : MovingTeam::kNowhere;
}

// Along the best edge that leads nearer to where it wants to be, and is free or can be freed.
void RoadmapSteps::advance(int robot) {
  Edges ahead;
  ways_ahead(robot, ahead);
  for (const int edge : ahead) {
    ++attempt_;
    mark(robot, route(robot, 8), team_.travellers[robot].radius + most_radius_ + team_.margin);
    if (travel(robot, {&edge, 1})) {
      memo_->stalled[robot] = 0;
      return;
    }
  }
  decided_[robot] = 1;
  if (!ahead.empty() && ++memo_->stalled[robot] >= 2) exchange(robot, ahead.front());
}

void RoadmapSteps::ways_ahead(int robot, Edges& found) {
  const int at = places_[robot], last = memo_->edges[robot];
  if (wish(robot) == MovingTeam::kNowhere) return;
  const auto& to_wish = to_go(wish(robot));
  std::vector<std::pair<double, int>> keys;
  for (int e = graph_.begin(at); e < graph_.end(at); ++e) {
    const double left = to_wish[graph_.head(e)];
    if (!(left < to_wish[at])) continue;
    const double turning = last < 0 ? 0 : kTurnCost * roadmap_->turn(last, e);
    keys.push_back({graph_.cost(e) + left + turning, e});
  }
  std::sort(keys.begin(), keys.end());
  for (const auto& [key, edge] : keys) found.push_back(edge);
}

// Goes along edges after all who stand near them have made way; if they cannot, nothing has happened.
bool RoadmapSteps::travel(int robot, std::span<const int> edges) {
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

bool RoadmapSteps::make_way(int robot) {
  if (decided_[robot] || pending_[robot] || tried_[robot] == attempt_ || !due(robot)) return false;
  for (const Edges& way : ways_out(robot)) {
    if (travel(robot, way)) return true;
  }
  tried_[robot] = attempt_;
  return false;
}

void RoadmapSteps::move(int robot, int edge) {
  const int place = places_[robot];
  undo_.push_back({robot, place, memo_->edges[robot], passed_[robot], memo_->spent[robot], decided_[robot]});
  standing_[place] = -1;
  places_[robot] = graph_.head(edge);
  standing_[places_[robot]] = robot;
  decided_[robot] = 1;
  double& spent = memo_->spent[robot];
  spent = std::max(spent, memo_->now) + team_.travellers[robot].manner().along(*roadmap_, edge);
  pass_stops(robot, places_[robot], passed_[robot], spent);
  memo_->edges[robot] = edge;
  memo_->moves.push_back({robot, edge});
}

void RoadmapSteps::undo(std::size_t moves) {
  for (; undo_.size() > moves; undo_.pop_back()) {
    const Undo& last = undo_.back();
    standing_[places_[last.robot]] = -1;
    places_[last.robot] = last.place;
    standing_[last.place] = last.robot;
    passed_[last.robot] = last.passed;
    decided_[last.robot] = last.decided;
    memo_->spent[last.robot] = last.spent;
    memo_->edges[last.robot] = last.edge;
    memo_->moves.pop_back();
  }
}

void RoadmapSteps::who_stands_near(int robot, std::span<const int> edges, std::vector<int>& found) const {
  for (const int edge : edges) {
    for (const auto [point, metres] : roadmap_->near(edge)) {
      const int other = standing_[point];
      if (other < 0 || other == robot || metres >= team_.apart(robot, other)) continue;
      if (std::find(found.begin(), found.end(), other) == found.end()) found.push_back(other);
    }
  }
}

// Whether a robot at a place is in the way of nobody who waits.
bool RoadmapSteps::clear(int robot, int place) const {
  for (const auto& [other, edges] : claims_) {
    if (other == robot) continue;
    for (const int edge : edges) {
      if (roadmap_->meets(edge, place, team_.apart(robot, other))) return false;
    }
  }
  return true;
}

// Priorities grow until a robot is where it wants to be.
void RoadmapSteps::grow() {
  for (int i = 0; i < team_.robots(); ++i) {
    Errand& errand = memo_->errands[i];
    if (errand.whose >= 0 && (--errand.rounds <= 0 || places_[errand.whose] == wish(errand.whose))) errand = {};
  }
  for (int i = 0; i < team_.robots(); ++i) {
    double& priority = memo_->priorities[i];
    const bool rests = wish(i) == MovingTeam::kNowhere || places_[i] == wish(i);
    priority = rests ? priority - std::floor(priority) : priority + 1;
  }
}

}  // namespace muster
