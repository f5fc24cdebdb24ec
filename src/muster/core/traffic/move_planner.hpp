// Plans of single moves for a team on a roadmap, again and again.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "traffic/single_moves.hpp"

namespace muster {

struct MovePlan {
  enum class Outcome { kArrived, kHorizon, kUnfinished, kImpossible };

  Outcome outcome;
  std::vector<SingleMove> moves;
  Configuration places;       // where the robots stand in the end
  std::vector<char> arrived;  // who has been at its goal
};

// All robots go at once. Where they come no further, one of them goes on alone while the others only make way, and then
// all again. Keeps the ways to goals from one plan to the next.
class MovePlanner {
 public:
  struct Limits {
    int horizon;     // moves after which a plan may end before all have arrived
    int expansions;  // steps of the search without coming nearer to the goals, before it gives up
    bool settle;     // whether all must be at their goals at once in the end
    int tries;       // plans, of which the quickest counts
  };

  explicit MovePlanner(std::shared_ptr<const AnnotatedRoadmap> roadmap) : roadmap_(std::move(roadmap)) {}

  // The first try has the priorities of the team; the others add to them by chance.
  MovePlan plan(const MovingTeam& team, const Limits& limits, std::uint64_t seed);
  std::size_t tables() const { return tables_.size(); }
  const AnnotatedRoadmap& roadmap() const { return *roadmap_; }

 private:
  static constexpr std::size_t kMostTables = 2000;

  MovePlan tried(MovingTeam team, const Limits& limits, std::uint64_t seed);
  double duration(const MovingTeam& team, const MovePlan& plan);
  void go_on(MovingTeam& team, const Limits& limits, std::uint64_t seed, MovePlan& plan);
  bool lead(MovingTeam& team, const Limits& limits, std::uint64_t seed, MovePlan& plan);

  std::shared_ptr<const AnnotatedRoadmap> roadmap_;
  SingleMoves::Tables tables_;
};

}  // namespace muster
