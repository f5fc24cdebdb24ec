// A generator of LaCAM: priority inheritance with backtracking [okumura2022] for robots that move one after another on
// an annotated roadmap.
//
// A move takes one robot along one edge while all others stand. Who stands nearer to the edge than both radii and the
// margin must make way first, to a place that is clear of the edge, and so must those who are in its way in turn.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "random.hpp"
#include "traffic/annotated_roadmap.hpp"
#include "traffic/lacam.hpp"
#include "traffic/traveller.hpp"

namespace muster {

struct MovingTeam {
  static constexpr int kNowhere = -1;

  std::vector<Traveller> travellers;  // no two start at one point; those that are fixed cannot move
  std::vector<int> passed;            // stops of each that it has passed
  std::vector<double> priorities;     // how many rounds each is ahead of one that has 0
  double margin;
  int leader = -1;  // the only one that goes anywhere; -1: all do

  int robots() const { return static_cast<int>(travellers.size()); }
  bool fixed(int i) const { return travellers[i].fixed; }
  double apart(int i, int j) const { return travellers[i].radius + travellers[j].radius + margin; }
};

// A round lets each robot that is due go along one edge nearer to its next stop. Due is who has gone and held no longer
// than the others, so that the sequence keeps to the pace at which all go at once. A configuration says where each
// robot is, and how many stops it has passed.
class RoadmapSteps {
 public:
  using Tables = GoalTables<std::vector<double>>;
  // Where a robot is sent so that another can pass.
  struct Errand {
    int place = MovingTeam::kNowhere;
    int whose = -1;
    int rounds = 0;
  };
  struct Memo {
    std::vector<double> priorities;
    std::vector<double> spent;  // seconds after which each is at its place, and has held there
    std::vector<int> edges;     // the last one of each, -1 before
    std::vector<int> stalled;   // rounds without a move that a robot wanted
    std::vector<Errand> errands;
    std::vector<SingleMove> moves;  // from the configuration before
    double now = 0;                 // seconds that a robot has spent which never stood still
  };

  // Ends when each robot has passed its stops, and with `settle` those that stay are at their last ones at once; where
  // one leads, when that has passed its next stop. `tables` outlives it.
  RoadmapSteps(std::shared_ptr<const AnnotatedRoadmap> roadmap, MovingTeam team, Tables* tables, bool settle);

  Configuration start() const { return start_; }
  Memo memo() const;
  bool finished(const Configuration& configuration, const Memo&) const;
  double cost(const Configuration&, const Configuration&) const { return 0; }
  double least_cost(const Configuration& configuration) const;
  void order(const Memo& memo, std::vector<int>& robots) const;
  void moves(const Configuration& configuration, int robot, std::vector<int>& found) const;
  bool next(const Configuration& from, const Memo& memo, std::span<const Constraint> said, Configuration& to,
            Memo& grown);
  // What robots have learned since counts, where a configuration is come to again.
  void again(Memo& known, const Memo& newer) const;

  int point(int where) const { return where / stride_; }
  int passed(int where) const { return where % stride_; }
  const MovingTeam& team() const { return team_; }
  // Whether a robot has no way to a stop, even alone.
  bool cut_off() const;

 private:
  using Edges = std::vector<int>;
  struct Claim {
    int robot;
    std::span<const int> edges;
  };

  const std::vector<double>& to_go(int place) {
    return tables_->to(place, [this](int p) { return graph_.costs_to(p); });
  }
  std::size_t stops(int robot) const { return team_.travellers[robot].stops.size(); }
  bool stays(int robot) const { return team_.travellers[robot].stays && stops(robot) > 0; }
  // Of a robot at a point, when it has passed the stops that are there.
  void pass_stops(int robot, int point, int& passed, double& spent) const;
  double cost_left(int robot, int point, int passed) const;
  int wish(int robot) const;
  bool due(int robot) const { return memo_->spent[robot] <= memo_->now + 0.5 * round_; }
  void take_up(const Configuration& from, Memo& memo);
  bool obey(std::span<const Constraint> said);
  void rounds();
  bool let_time_pass();
  void advance(int robot);
  void grow();
  void ways_ahead(int robot, Edges& found);
  bool travel(int robot, std::span<const int> edges);
  bool make_way(int robot);
  void move(int robot, int edge);
  void undo(std::size_t moves);
  void who_stands_near(int robot, std::span<const int> edges, std::vector<int>& found) const;
  bool clear(int robot, int place) const;

  std::vector<Edges> ways_out(int robot);
  bool passable(int robot, int edge) const;
  bool meets_fixed(int robot, int edge) const;
  void exchange(int robot, int edge);
  bool gets_out(int robot, int edge, int other);
  std::vector<char> this_side(int robot, int place, double apart) const;
  bool lets_past(int robot, int other, int place, const Edges& way, const std::vector<char>& side) const;
  Edges route(int robot, std::size_t most);
  void mark(int robot, const Edges& edges, double apart);
  template <class Passable, class Visit>
  void search(int from, Passable passable, Visit visit);
  Edges found_way(int to) const;

  std::shared_ptr<const AnnotatedRoadmap> roadmap_;
  const DirectedGraph& graph_;
  MovingTeam team_;
  Tables* tables_;
  bool settle_;
  int stride_ = 1;      // more than any has stops
  double pace_ = 0;     // what an edge costs on average
  double round_ = 0;    // seconds that a robot takes for that
  double most_radius_;  // of all robots
  std::vector<std::vector<const std::vector<double>*>> stop_tables_;
  std::vector<std::vector<double>> after_;  // what it costs from each stop through all after it
  Configuration start_;
  std::vector<double> ready_;

  // The round under way.
  Memo* memo_ = nullptr;
  Configuration places_;
  std::vector<int> passed_;
  std::vector<int> standing_;  // the robot at each point, or -1
  std::vector<char> told_;     // fixed, or told what to do
  std::vector<char> decided_;  // has had its turn, and is not to be moved
  std::vector<char> pending_;  // waits until others have made way for it
  std::vector<Claim> claims_;  // of those who are pending
  std::vector<int> tried_;     // in which attempt a robot was found unable to make way
  int attempt_ = 0;
  std::vector<int> order_;
  std::vector<int> marked_;  // by point: the last time when it was on somebody's way
  int mark_ = 0;

  struct Undo {
    int robot, place, edge, passed;
    double spent;
    char decided;
  };
  std::vector<Undo> undo_;

  // A search around a place.
  struct Reached {
    double key;
    int point;
  };
  std::vector<double> found_cost_;
  std::vector<int> found_edge_, found_in_;
  int search_ = 0;
};

// The moves without those that take a robot away from a point and back to it while nobody needed that.
std::vector<SingleMove> without_detours(const AnnotatedRoadmap& roadmap, const MovingTeam& team,
                                        std::vector<SingleMove> moves);

}  // namespace muster
