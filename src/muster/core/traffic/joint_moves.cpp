#include "traffic/joint_moves.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "traffic/lacam.hpp"

namespace muster {

namespace {

using Search = Lacam<RoadmapSteps>;

constexpr int kLessAlone = 3;  // so many times fewer expansions where one goes on alone

// Until it ends, or has come no nearer to the stops for so many expansions; the nearest node.
int searched(Search& search, int idle_expansions, std::int64_t& expanded) {
  double least = std::numeric_limits<double>::infinity();
  int best = 0;
  std::size_t looked_at = 0;
  for (int idle = 0; search.state() == SearchState::kSearching && idle < idle_expansions; ++idle) {
    search.advance(1);
    ++expanded;
    for (; looked_at < search.size(); ++looked_at) {
      if (search.node(static_cast<int>(looked_at)).least_cost >= least) continue;
      best = static_cast<int>(looked_at);
      least = search.node(best).least_cost;
      idle = 0;
    }
  }
  return search.goal() >= 0 ? search.goal() : best;
}

}  // namespace

std::vector<SingleMove> JointMoves::moves(const std::vector<Traveller>& travellers, const std::vector<double>& ahead,
                                          int expansions, std::uint64_t seed) {
  expansions_ = expansions;
  seed_ = seed;
  MovingTeam team{{}, {}, {}, margin_};
  std::vector<int> numbers;
  std::vector<char> taken(roadmap_->size());
  for (int k = 0; k < static_cast<int>(travellers.size()); ++k) {
    if (std::exchange(taken[travellers[k].start], 1)) continue;
    numbers.push_back(k);
    team.travellers.push_back(travellers[k]);
    team.priorities.push_back(ahead[k]);
  }
  team.passed.assign(numbers.size(), 0);
  const MovingTeam whole = team;
  std::vector<SingleMove> found;
  if (!go_on(team, true, found)) {
    bool through = go_on(team, false, found);
    while (!through && lead(team, found)) through = go_on(team, false, found);
    if (through) go_on(team, true, found);
  }
  found = without_detours(*roadmap_, whole, std::move(found));
  for (SingleMove& move : found) move.robot = numbers[move.robot];
  return found;
}

// As far as all come together, or the leader.
bool JointMoves::go_on(MovingTeam& team, bool settle, std::vector<SingleMove>& moves) {
  Search search(RoadmapSteps(roadmap_, team, &tables_, settle), seed_, false);
  const RoadmapSteps& steps = search.generator();
  if (steps.cut_off()) return false;
  std::int64_t expanded = 0;
  const int last = searched(search, team.leader < 0 ? expansions_ : std::max(1, expansions_ / kLessAlone), expanded);
  expanded_ += expanded * team.robots();
  for (const int k : search.way_to(last)) {
    const auto& more = search.node(k).memo.moves;
    moves.insert(moves.end(), more.begin(), more.end());
  }
  const Configuration& configuration = search.node(last).configuration;
  const RoadmapSteps::Memo& memo = search.node(last).memo;
  for (int i = 0; i < team.robots(); ++i) {
    team.travellers[i].start = steps.point(configuration[i]);
    team.travellers[i].ready = std::max(0.0, memo.spent[i] - memo.now);
    team.passed[i] = steps.passed(configuration[i]);
  }
  return search.goal() >= 0;
}

// The first robot that comes to its next stop if nobody else has one.
bool JointMoves::lead(MovingTeam& team, std::vector<SingleMove>& moves) {
  for (int leader = 0; leader < team.robots(); ++leader) {
    const Traveller& who = team.travellers[leader];
    if (who.fixed || team.passed[leader] == static_cast<int>(who.stops.size())) continue;
    MovingTeam led = team;
    led.leader = leader;
    std::vector<SingleMove> more;
    if (!go_on(led, false, more)) continue;
    led.leader = -1;
    team = std::move(led);
    moves.insert(moves.end(), more.begin(), more.end());
    return true;
  }
  return false;
}

}  // namespace muster
