#include "move_planner.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "lacam.hpp"

namespace muster {

namespace {

using Search = Lacam<SingleMoves>;

// Until it ends, or has come no nearer to the goals for so many expansions; the nearest node.
int searched(Search& search, int expansions) {
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

MovePlan::Outcome outcome(const Search& search, int last) {
  if (search.state() == SearchState::kUnsolvable) return MovePlan::Outcome::kImpossible;
  if (search.goal() < 0) return MovePlan::Outcome::kUnfinished;
  return search.generator().all_arrived(search.node(last).configuration) ? MovePlan::Outcome::kArrived
                                                                         : MovePlan::Outcome::kHorizon;
}

}  // namespace

MovePlan MovePlanner::plan(Team team, const Limits& limits, std::uint64_t seed) {
  if (tables_.size() > kMostTables) tables_.clear();
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
void MovePlanner::go_on(Team& team, const Limits& limits, std::uint64_t seed, MovePlan& plan) {
  const int left = limits.horizon - static_cast<int>(plan.moves.size());
  Search search(SingleMoves(roadmap_, team, &tables_, left, limits.settle), seed, false);
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
bool MovePlanner::lead(Team& team, const Limits& limits, std::uint64_t seed, MovePlan& plan) {
  for (int leader = 0; leader < team.robots(); ++leader) {
    if (team.arrived[leader]) continue;
    Team alone = team;
    std::fill(alone.goals.begin(), alone.goals.end(), Team::kNoGoal);
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
