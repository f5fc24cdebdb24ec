// Paths in continuous time for a robot that shares a roadmap with others [phillips2011].
//
// Each robot takes the earliest path through the intervals in which the points are safe from those that were planned
// before it. A robot is at the end of an edge from when it sets out on it, as in a sequence of moves; until
// it is clear of the point that it left that one is its too.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "traffic/annotated_roadmap.hpp"
#include "traffic/joint_moves.hpp"
#include "traffic/seconds_to_goal.hpp"
#include "traffic/traveller.hpp"

namespace muster {

class SafeIntervals {
 public:
  // `rests`: whether a robot may rest at a point without standing in the way of others.
  SafeIntervals(std::shared_ptr<const AnnotatedRoadmap> roadmap, std::vector<bool> rests, double margin);

  int points() const { return roadmap_->size(); }
  // What it costs to come to a point from each, kept from one plan to the next.
  const std::vector<double>& metres_to(int goal);
  // The moves of all through their stops, in an order in which each is free.
  JointMoves joint_moves() { return {roadmap_, margin_, to_goals_}; }

  // Nobody is on the roadmap.
  void clear();
  // A robot has to get to its stops: others had better not rest there.
  void want(const Traveller& who);
  // The earliest way among all who are on it; one that stays at its start where there is none.
  Way way(const Traveller& who);
  // Labels that were expanded in searches for ways since this was last called.
  std::int64_t take_expansions() { return std::exchange(expansions_, 0); }
  // The ways of robots that make moves in turn, each as soon as those before it let it. Those that are fixed are on the
  // roadmap, and nobody else; afterwards all are.
  std::vector<Way> in_turn(std::span<const Traveller> travellers, std::span<const SingleMove> moves);
  // A robot, by its number, goes that way; it may not be on the roadmap yet.
  void reserve(int robot, const Traveller& who, const Way& way);
  // It does so no more.
  void release(int robot, const Traveller& who, const Way& way);
  // A robot has no way yet, but stays at its start so many times as long as it takes to get clear of a point.
  void reserve_start(int robot, const Traveller& who, double tails);
  void release_start(int robot, const Traveller& who) { erase_stays(robot, who.start); }
  // How often others are where a robot passes.
  std::vector<int> meetings(int robot, const Way& way, int robots) const;

 private:
  struct Span {
    double from, until;
  };
  struct Stay {
    int robot;
    double from, until, radius;
  };
  struct Pass {
    int robot;
    double start, gap, radius;
  };
  struct Label {
    double key, ready;
    int leg, edge, interval, parent;
    double start;
  };

  double apart(const Traveller& who, double radius) const;
  double tail(const Traveller& who) const;
  // Seconds that a path may be longer so that a robot rests elsewhere in the end.
  double resting(const Traveller& who, int point) const;
  SecondsToGoal& seconds_to(const Manner& manner, int goal);
  std::optional<Way> path(const Traveller& who);
  void erase_stays(int robot, int point);
  // The intervals in which a robot may be at a point.
  const std::vector<Span>& safe(const Traveller& who, int point);
  // When a robot must have left where it starts: it is there, whoever stands near.
  double leaves_by(const Traveller& who);
  // The earliest time from `from` at which a robot may set out on an edge; infinite from `until` on.
  double earliest(const Traveller& who, int edge, double from, double until);
  // When others are so near to an edge that a robot may not set out on it, in order and apart.
  const std::vector<Span>& taken(const Traveller& who, int edge);
  void find_around();

  // The least times by row and state; infinite where none has been set since it was cleared.
  class Least {
   public:
    explicit Least(int rows) : rows_(rows) {}
    double& at(int row, int state);
    void clear();

   private:
    std::vector<std::vector<double>> rows_;
    std::vector<int> used_;
  };

  std::shared_ptr<const AnnotatedRoadmap> roadmap_;
  std::vector<bool> rests_;
  double margin_;
  std::vector<int> wanted_;  // how many stops are at each point
  std::vector<std::vector<Stay>> stays_;
  std::vector<std::vector<Pass>> passes_;
  std::vector<std::vector<Span>> safe_;
  std::vector<char> known_;  // whether `safe_` of a point is that of the present traveller
  std::vector<std::vector<Span>> taken_;
  std::vector<char> known_edge_;  // the same of `taken_` of an edge
  Least by_edge_, by_point_;      // of the present search: when a robot may go on
  std::vector<std::vector<AnnotatedRoadmap::Near>>
      around_;  // of each point those as near as any edge's, itself included
  GoalTables<std::vector<double>> to_goals_;
  std::map<std::pair<int, Manner>, SecondsToGoal> seconds_to_goals_;
  std::int64_t expansions_ = 0;
};

}  // namespace muster
