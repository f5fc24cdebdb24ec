// Where a robot goes that stands in the way of another.
#include <algorithm>
#include <limits>
#include <utility>

#include "heap.hpp"
#include "traffic/roadmap_steps.hpp"

namespace muster {

namespace {

constexpr std::size_t kMostWaysOut = 6;  // out of the way, tried one after another
constexpr int kMostPoints = 64;          // looked at for them
constexpr double kAside = 4;       // paces that it is worth to get off the way of who pushes, not only ahead of it
constexpr int kPatientRounds = 8;  // rounds after which somebody is sent away who could make way

}  // namespace

// From a point outwards over edges that are passable; `visit` says of each point whether to go on.
template <class Passable, class Visit>
void RoadmapSteps::search(int from, Passable passable, Visit visit) {
  ++search_;
  Heap<Reached> open;
  found_in_[from] = search_;
  found_cost_[from] = 0;
  found_edge_[from] = -1;
  open.push({0, from});
  while (!open.empty()) {
    const auto [cost, at] = open.pop();
    if (cost > found_cost_[at]) continue;
    if (!visit(at, cost)) return;
    for (int e = graph_.begin(at); e < graph_.end(at); ++e) {
      const int there = graph_.head(e);
      const double here = cost + graph_.cost(e);
      if ((found_in_[there] == search_ && here >= found_cost_[there]) || !passable(e)) continue;
      found_in_[there] = search_;
      found_cost_[there] = here;
      found_edge_[there] = e;
      open.push({here, there});
    }
  }
}

RoadmapSteps::Edges RoadmapSteps::found_way(int to) const {
  Edges way;
  for (; found_edge_[to] >= 0; to = graph_.tail(found_edge_[to])) way.push_back(found_edge_[to]);
  std::reverse(way.begin(), way.end());
  return way;
}

// The ways to the nearest places that are clear, the best for its own goal first.
std::vector<RoadmapSteps::Edges> RoadmapSteps::ways_out(int robot) {
  const int at = places_[robot];
  const auto* to_wish = wish(robot) == MovingTeam::kNowhere ? nullptr : &to_go(wish(robot));
  std::vector<std::pair<double, Edges>> found;
  int points = 0;
  const auto visit = [&](int there, double cost) {
    if (there != at && clear(robot, there)) {
      const double left = to_wish == nullptr ? 0 : (*to_wish)[there];
      const double aside = marked_[there] == mark_ ? kAside * pace_ : 0;
      found.push_back({cost + left + aside, found_way(there)});
    }
    return found.size() < kMostWaysOut && ++points < kMostPoints;
  };
  search(at, [&](int edge) { return passable(robot, edge); }, visit);
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Edges> ways;
  for (auto& [key, way] : found) ways.push_back(std::move(way));
  return ways;
}

// Whether all who stand near the edge may be moved.
bool RoadmapSteps::passable(int robot, int edge) const {
  for (const auto [point, metres] : roadmap_->near(edge)) {
    const int other = standing_[point];
    if (other < 0 || other == robot || metres >= team_.apart(robot, other)) continue;
    if (decided_[other] || pending_[other] || tried_[other] == attempt_ || !due(other)) return false;
  }
  return true;
}

// The first edges of the shortest way from where a robot is to where it wants to be.
RoadmapSteps::Edges RoadmapSteps::route(int robot, std::size_t most) {
  Edges way;
  if (wish(robot) == MovingTeam::kNowhere) return way;
  const auto& left = to_go(wish(robot));
  for (int at = places_[robot]; left[at] > 0 && way.size() < most;) {
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (int e = graph_.begin(at); e < graph_.end(at); ++e) {
      if (graph_.cost(e) + left[graph_.head(e)] < least) {
        least = graph_.cost(e) + left[graph_.head(e)];
        best = e;
      }
    }
    if (best < 0) return way;
    way.push_back(best);
    at = graph_.head(best);
  }
  return way;
}

void RoadmapSteps::mark(int robot, const Edges& edges, double apart) {
  ++mark_;
  marked_[places_[robot]] = mark_;
  for (const int edge : edges) {
    for (const auto [point, metres] : roadmap_->near(edge)) {
      if (metres < apart) marked_[point] = mark_;
    }
  }
}

// Two meet where nobody can step aside: the one ahead is sent past the other, to where that one can get past it in
// turn, and goes first until it is there, as in the swap of [luna2011].
void RoadmapSteps::exchange(int robot, int edge) {
  std::vector<int> others;
  who_stands_near(robot, {&edge, 1}, others);
  for (const int other : others) {
    Errand& errand = memo_->errands[other];
    if (team_.fixed(other) || errand.whose >= 0 || memo_->errands[robot].whose == other) continue;
    if (memo_->stalled[robot] < kPatientRounds && gets_out(other, edge, robot)) continue;
    const auto side = this_side(robot, places_[other], team_.apart(robot, other));
    int place = MovingTeam::kNowhere;
    std::size_t steps = 0;
    search(
        places_[other], [&](int e) { return !meets_fixed(other, e); },
        [&](int there, double) {
          const Edges way = found_way(there);
          if (there != places_[other] && lets_past(robot, other, there, way, side)) {
            place = there;
            steps = way.size();
          }
          return place == MovingTeam::kNowhere;
        });
    if (place == MovingTeam::kNowhere) continue;
    errand = {place, robot, 30 + 4 * static_cast<int>(steps)};
    memo_->priorities[other] = memo_->priorities[robot] + 1;
    return;
  }
}

bool RoadmapSteps::meets_fixed(int robot, int edge) const {
  for (const auto [point, metres] : roadmap_->near(edge)) {
    const int other = standing_[point];
    if (other >= 0 && team_.fixed(other) && metres < team_.apart(robot, other)) return true;
  }
  return false;
}

// The points that a robot can come to without getting past somebody at a place.
std::vector<char> RoadmapSteps::this_side(int robot, int place, double apart) const {
  std::vector<char> seen(graph_.size());
  std::vector<int> queue{places_[robot]};
  seen[places_[robot]] = 1;
  for (std::size_t k = 0; k < queue.size(); ++k) {
    for (int e = graph_.begin(queue[k]); e < graph_.end(queue[k]); ++e) {
      if (seen[graph_.head(e)] || roadmap_->meets(e, place, apart)) continue;
      seen[graph_.head(e)] = 1;
      queue.push_back(graph_.head(e));
    }
  }
  return seen;
}

// Whether a robot can wait on its side, off the other's way, and from there come to where it wants to be, past the
// other at its new place.
bool RoadmapSteps::lets_past(int robot, int other, int place, const Edges& way, const std::vector<char>& side) const {
  const double apart = team_.apart(robot, other);
  const auto is_met = [&](std::span<const int> edges, int point) {
    return std::any_of(edges.begin(), edges.end(), [&](int e) { return roadmap_->meets(e, point, apart); });
  };
  std::vector<char> seen(graph_.size());
  std::vector<int> queue{wish(robot)};
  seen[wish(robot)] = 1;
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const int at = queue[k];
    if (side[at] && at != place && !is_met(way, at) && !is_met(graph_.entering(places_[other]), at)) return true;
    for (const int e : graph_.entering(at)) {
      if (seen[graph_.tail(e)] || roadmap_->meets(e, place, apart)) continue;
      seen[graph_.tail(e)] = 1;
      queue.push_back(graph_.tail(e));
    }
  }
  return false;
}

// Whether a robot could leave an edge to another without getting past it, if all others let it.
bool RoadmapSteps::gets_out(int robot, int edge, int other) {
  const double apart = team_.apart(robot, other);
  bool found = false;
  search(
      places_[robot], [&](int e) { return !roadmap_->meets(e, places_[other], apart); },
      [&](int there, double) {
        found = there != places_[robot] && !roadmap_->meets(edge, there, apart);
        return !found;
      });
  return found;
}

std::vector<SingleMove> without_detours(const AnnotatedRoadmap& roadmap, const MovingTeam& team,
                                        std::vector<SingleMove> moves) {
  const auto needed = [&](int robot, int place, std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      const auto [other, edge] = moves[k];
      if (other != robot && roadmap.meets(edge, place, team.apart(robot, other))) return true;
    }
    return false;
  };
  for (int robot = 0; robot < team.robots(); ++robot) {
    const std::vector<Stop>& stops = team.travellers[robot].stops;
    std::vector<std::size_t> own;
    for (std::size_t k = 0; k < moves.size(); ++k) {
      if (moves[k].robot == robot) own.push_back(k);
    }
    std::vector<char> dropped(moves.size());
    bool any = false;
    for (std::size_t a = 0; a < own.size(); ++a) {
      const int place = roadmap.graph().tail(moves[own[a]].edge);
      for (std::size_t b = own.size(); b-- > a + 1;) {
        if (roadmap.graph().head(moves[own[b]].edge) != place || needed(robot, place, own[a], own[b])) continue;
        bool visits = false;
        for (std::size_t k = a; k < b; ++k)
          visits |= std::ranges::count(stops, roadmap.graph().head(moves[own[k]].edge), &Stop::point) > 0;
        if (visits) continue;
        for (std::size_t k = a; k <= b; ++k) dropped[own[k]] = any = true;
        a = b;
        break;
      }
    }
    if (!any) continue;
    std::vector<SingleMove> kept;
    for (std::size_t k = 0; k < moves.size(); ++k) {
      if (!dropped[k]) kept.push_back(moves[k]);
    }
    moves = std::move(kept);
  }
  return moves;
}

}  // namespace muster
