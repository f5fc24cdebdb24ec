#include "move_planner.hpp"

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
  Search search(SingleMoves(roadmap_, std::move(team), &tables_, limits.horizon, limits.settle), seed, false);
  const SingleMoves& generator = search.generator();
  const bool cut_off = generator.cut_off();
  const int last = cut_off ? 0 : searched(search, limits.expansions);
  MovePlan plan{cut_off ? MovePlan::Outcome::kImpossible : outcome(search, last), {}, {}, {}};
  for (const int k : search.way_to(last)) {
    const auto& moves = search.node(k).memo.moves;
    plan.moves.insert(plan.moves.end(), moves.begin(), moves.end());
  }
  for (const int where : search.node(last).configuration) {
    plan.places.push_back(SingleMoves::point(where));
    plan.arrived.push_back(SingleMoves::visited(where));
  }
  plan.moves = without_detours(*roadmap_, generator.team(), std::move(plan.moves));
  return plan;
}

}  // namespace muster
