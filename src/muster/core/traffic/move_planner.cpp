#include "traffic/move_planner.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "random.hpp"
#include "traffic/lacam.hpp"

namespace muster {

namespace {

using MoveSearch = Lacam<SingleMoves>;

constexpr double kMostAhead = 10;  // rounds that a try puts a robot ahead
constexpr double kChanged = 0.3;   // the share of robots whose priorities a try changes

// Until it ends, or has come no nearer to the goals for so many expansions; the nearest node.
int searched(MoveSearch& search, int expansions) {
  double least = std::numeric_limits<double>::infinity();
  int best = 0;
  std::size_t looked_at = 0;
  for (int idle = 0; search.state() == SearchState::kSearching && idle < expansions; ++idle) {
    search.advance(1);
    for (; looked_at < search.size(); ++looked_at) {
      if (search.node(static_cast<int>(looked_at)).least_cost >= least) continue;
      best = static_cast<int>(looked_at);
      least = search.node(best).least_cost;
      idle = 0;
    }
  }
  return search.goal() >= 0 ? search.goal() : best;
}

// The ends of the last moves near a point: of the robot that is last, and of the last other one.
class LastMoves {
 public:
  double but_of(int robot) const { return robot == robot_ ? other_ : last_; }
  void add(int robot, double end) {
    if (robot != robot_) other_ = std::exchange(last_, end);
    robot_ = robot;
    last_ = end;
  }

 private:
  int robot_ = -1;
  double last_ = 0, other_ = 0;
};

bool better(MovePlan::Outcome outcome, double time, MovePlan::Outcome than, double than_time) {
  return outcome != than ? outcome < than : time < than_time;
}

MovePlan::Outcome outcome(const MoveSearch& search, int last) {
  if (search.state() == SearchState::kUnsolvable) return MovePlan::Outcome::kImpossible;
  if (search.goal() < 0) return MovePlan::Outcome::kUnfinished;
  return search.generator().all_arrived(search.node(last).configuration) ? MovePlan::Outcome::kArrived
                                                                         : MovePlan::Outcome::kHorizon;
}

}  // namespace

MovePlan MovePlanner::plan(const MovingTeam& team, const Limits& limits, std::uint64_t seed) {
  if (tables_.size() > kMostTables) tables_.clear();
  MovePlan best = tried(team, limits, seed);
  if (best.outcome == MovePlan::Outcome::kImpossible || limits.tries == 1) return best;
  double least = duration(team, best);
  Random random(seed);
  std::vector<double> ahead(team.robots());
  for (int k = 1; k < limits.tries; ++k) {
    MovingTeam other = team;
    auto changed = ahead;
    for (double& rounds : changed) {
      if (random.uniform() < kChanged) rounds = kMostAhead * random.uniform();
    }
    for (int i = 0; i < team.robots(); ++i) other.priorities[i] += changed[i];
    MovePlan plan = tried(std::move(other), limits, seed + k);
    const double time = duration(team, plan);
    if (better(plan.outcome, time, best.outcome, least)) {
      least = time;
      best = std::move(plan);
      ahead = std::move(changed);
    }
  }
  return best;
}

// How long the plan takes at a metre a second, and on average until a robot has been at its goal: each move begins as
// soon as all earlier moves of others near the same points have ended. Where a plan ends before, the rest of the way
// counts.
double MovePlanner::duration(const MovingTeam& team, const MovePlan& plan) {
  const DirectedGraph& graph = roadmap_->graph();
  std::vector<double> ready(team.robots()), arrived(team.robots(), -1);
  std::vector<LastMoves> last(graph.size());
  for (const auto [robot, edge] : plan.moves) {
    double begin = std::max(ready[robot], last[graph.tail(edge)].but_of(robot));
    for (const auto& near : roadmap_->near(edge)) begin = std::max(begin, last[near.point].but_of(robot));
    ready[robot] = begin + graph.cost(edge);
    last[graph.tail(edge)].add(robot, ready[robot]);
    for (const auto& near : roadmap_->near(edge)) last[near.point].add(robot, ready[robot]);
    if (graph.head(edge) == team.goals[robot] && arrived[robot] < 0) arrived[robot] = ready[robot];
  }
  double most = 0, sum = 0;
  for (int i = 0; i < team.robots(); ++i) {
    if (team.goals[i] == MovingTeam::kNoGoal || team.pinned[i] || team.starts[i] == team.goals[i]) continue;
    const auto& left = tables_.to(team.goals[i], [&](int goal) { return graph.costs_to(goal); });
    const double time = arrived[i] >= 0 ? arrived[i] : ready[i] + left[plan.places[i]];
    most = std::max(most, time);
    sum += time;
  }
  return most + sum / std::max(1, team.robots());
}

MovePlan MovePlanner::tried(MovingTeam team, const Limits& limits, std::uint64_t seed) {
  MovePlan plan{MovePlan::Outcome::kUnfinished, {}, {}, {}};
  do {
    go_on(team, limits, seed, plan);
  } while (plan.outcome == MovePlan::Outcome::kUnfinished && !limits.settle && lead(team, limits, seed, plan));
  plan.places = team.starts;
  plan.arrived = team.arrived;
  plan.moves = without_detours(*roadmap_, team, std::move(plan.moves));
  return plan;
}

// As far as all come together.
void MovePlanner::go_on(MovingTeam& team, const Limits& limits, std::uint64_t seed, MovePlan& plan) {
  const int left = limits.horizon - static_cast<int>(plan.moves.size());
  MoveSearch search(SingleMoves(roadmap_, team, &tables_, left, limits.settle), seed, false);
  const bool cut_off = search.generator().cut_off();
  const int last = cut_off ? 0 : searched(search, limits.expansions);
  // What all cannot do from here may be what they could from the start.
  plan.outcome = cut_off              ? MovePlan::Outcome::kImpossible
                 : plan.moves.empty() ? outcome(search, last)
                 : search.goal() >= 0 ? outcome(search, last)
                                      : MovePlan::Outcome::kUnfinished;
  for (const int k : search.way_to(last)) {
    const auto& moves = search.node(k).memo.moves;
    plan.moves.insert(plan.moves.end(), moves.begin(), moves.end());
  }
  const Configuration& end = search.node(last).configuration;
  for (int i = 0; i < team.robots(); ++i) {
    team.starts[i] = SingleMoves::point(end[i]);
    team.arrived[i] = SingleMoves::visited(end[i]);
  }
}

// The first robot that comes to its goal if nobody else has one.
bool MovePlanner::lead(MovingTeam& team, const Limits& limits, std::uint64_t seed, MovePlan& plan) {
  for (int leader = 0; leader < team.robots(); ++leader) {
    if (team.arrived[leader]) continue;
    MovingTeam alone = team;
    std::fill(alone.goals.begin(), alone.goals.end(), MovingTeam::kNoGoal);
    alone.goals[leader] = team.goals[leader];
    MovePlan led{MovePlan::Outcome::kUnfinished, plan.moves, {}, {}};
    go_on(alone, limits, seed, led);
    if (!alone.arrived[leader]) continue;
    for (std::size_t k = plan.moves.size(); k < led.moves.size(); ++k) {
      const auto [robot, edge] = led.moves[k];
      if (roadmap_->graph().head(edge) == team.goals[robot]) team.arrived[robot] = true;
    }
    team.starts = alone.starts;
    plan.moves = std::move(led.moves);
    return true;
  }
  return false;
}

}  // namespace muster
