#include "traffic/joint_moves.hpp"

#include <algorithm>
#include <utility>

#include "infinity.hpp"
#include "traffic/lacam.hpp"

namespace muster {

namespace {

// Several travellers may be thought to be at one point that stay there: they are one robot.
SteppingTeam team_of(const std::vector<Traveller>& travellers, int points, double margin, std::vector<int>& numbers) {
  SteppingTeam team{{}, {}, {}, {}, {}, margin};
  std::vector<char> taken(points);
  for (int k = 0; k < static_cast<int>(travellers.size()); ++k) {
    const Traveller& who = travellers[k];
    if (std::exchange(taken[who.start], 1) && who.fixed) continue;
    numbers.push_back(k);
    const bool goes = !who.fixed && !who.stops.empty();
    team.starts.push_back(who.start);
    team.goals.push_back(goes ? who.stops.front().point : SteppingTeam::kNoGoal);
    team.radii.push_back(who.radius);
    team.pinned.push_back(who.fixed);
    team.stays.push_back(goes && who.stays && who.stops.size() == 1);
  }
  return team;
}

// The times until which moves of others keep a robot from a point: by point, of each robot the last.
class LastTimes {
 public:
  explicit LastTimes(int points) : times_(points) {}
  void set(int point, int robot, double radius, double metres, double time) {
    times_[point].push_back({robot, radius, metres, time});
  }
  // Of all but a robot that are nearer than the radii and `apart`.
  double but_of(int robot, int point, double apart) const {
    double last = 0.0;
    for (const Time& time : times_[point])
      if (time.robot != robot && time.metres < apart + time.radius) last = std::max(last, time.time);
    return last;
  }

 private:
  struct Time {
    int robot;
    double radius, metres, time;
  };
  std::vector<std::vector<Time>> times_;
};

}  // namespace

std::optional<std::vector<SingleMove>> joint_moves(std::shared_ptr<const AnnotatedRoadmap> roadmap,
                                                   const std::vector<Traveller>& travellers, double margin,
                                                   RoadmapSteps::Tables& tables, int expansions, std::uint64_t seed) {
  std::vector<int> numbers;
  SteppingTeam team = team_of(travellers, roadmap->size(), margin, numbers);
  Lacam<RoadmapSteps> search(RoadmapSteps(std::move(roadmap), std::move(team), &tables, seed), seed, false);
  if (search.generator().cut_off()) return std::nullopt;
  search.advance(expansions);
  if (search.goal() < 0) return std::nullopt;
  std::vector<SingleMove> moves;
  for (const int node : search.way_to(search.goal()))
    for (const auto [robot, edge] : search.node(node).memo.moves) moves.push_back({numbers[robot], edge});
  return moves;
}

std::vector<Way> ways_of(const AnnotatedRoadmap& roadmap, const std::vector<Traveller>& travellers, double margin,
                         const std::vector<SingleMove>& moves) {
  struct Progress {
    double ready;
    int edge, leg;
    bool stands;
  };
  std::vector<Way> ways;
  std::vector<Progress> now;
  const auto holds = [&](int k, int point) {
    const auto& stops = travellers[k].stops;
    Progress& at = now[k];
    while (at.leg < static_cast<int>(stops.size()) && stops[at.leg].point == point) {
      at.ready += 0.5 * travellers[k].manner().stopping() + stops[at.leg++].hold;
      at.stands = true;
      ways[k].end = at.leg == static_cast<int>(stops.size()) ? at.ready : kNever;
    }
  };
  for (int k = 0; k < static_cast<int>(travellers.size()); ++k) {
    const Traveller& who = travellers[k];
    ways.push_back({{}, who.fixed || who.stops.empty() ? 0.0 : kNever, kNever});
    now.push_back({who.ready, -1, 0, true});
    if (!who.fixed) holds(k, who.start);
  }
  LastTimes left(roadmap.size()), passed(roadmap.size());
  const DirectedGraph& graph = roadmap.graph();
  for (const auto [k, edge] : moves) {
    const Traveller& who = travellers[k];
    const Manner manner = who.manner();
    Progress& at = now[k];
    const double angle = at.edge < 0 ? roadmap.turn_from(who.heading, edge) : roadmap.turn(at.edge, edge);
    const double could = at.ready + (at.stands ? manner.setting_out(angle) : manner.turning(angle));
    const double tail = (who.radius + margin) / who.speed, apart = who.radius + margin;
    double start = std::max(could, passed.but_of(k, graph.head(edge), apart) + tail);
    for (const auto& near : roadmap.near(edge))
      start = std::max(start, left.but_of(k, near.point, apart - near.metres));
    ways[k].moves.push_back({start, k, edge, at.leg});
    left.set(graph.tail(edge), k, who.radius, 0.0, start + tail);
    for (const auto& near : roadmap.near(edge)) passed.set(near.point, k, who.radius, near.metres, start);
    at = {start + manner.along(roadmap, edge) + std::min(start - could, 0.5 * manner.stopping()), edge, at.leg, false};
    holds(k, graph.head(edge));
  }
  for (std::size_t k = 0; k < ways.size(); ++k)
    if (travellers[k].stops.empty() && !travellers[k].fixed) ways[k].end = now[k].ready;
  return ways;
}

}  // namespace muster
