// Priority inheritance with backtracking [okumura2022] for robots that move one after another on an annotated roadmap.
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

namespace muster {

struct SingleMove {
  int robot;
  int edge;
};

struct MovingTeam {
  static constexpr int kNoGoal = -1;

  Configuration starts;
  std::vector<int> goals;
  std::vector<double> radii;
  std::vector<double> priorities;  // how many rounds each is ahead of one that has 0
  std::vector<char> pinned;        // those who cannot move
  std::vector<char> arrived;       // those who have been at their goals
  double margin;
  double turn_cost;  // metres for a radian

  int robots() const { return static_cast<int>(starts.size()); }
  double apart(int i, int j) const { return radii[i] + radii[j] + margin; }
};

// A round lets each robot that is due go along one edge nearer to its goal. Due is who has gone no further than the
// others, so that the sequence keeps to the pace at which all go at once. A configuration says where each robot is, and
// whether it has been at its goal: 2 * point + 1 if so.
class SingleMoves {
 public:
  using Tables = GoalTables<std::vector<double>>;
  // Where a robot is sent so that another can pass.
  struct Errand {
    int place = MovingTeam::kNoGoal;
    int whose = -1;
    int rounds = 0;
  };
  struct Memo {
    std::vector<double> priorities;
    std::vector<double> driven;  // metres at which each is at its place
    std::vector<int> edges;      // the last one of each, -1 before
    std::vector<int> stalled;    // rounds without a move that a robot wanted
    std::vector<Errand> errands;
    std::vector<SingleMove> moves;  // from the configuration before
    int made = 0;                   // moves from the start
    double now = 0;                 // metres that a robot may have driven which never stood still
  };

  // Ends when each robot has been at its goal, with `settle` when all are there at once, or after `horizon` moves.
  // `tables` outlives it. Throws std::invalid_argument where the team does not fit the roadmap.
  SingleMoves(std::shared_ptr<const AnnotatedRoadmap> roadmap, MovingTeam team, Tables* tables, int horizon,
              bool settle);

  Configuration start() const;
  Memo memo() const;
  bool finished(const Configuration& configuration, const Memo& memo) const;
  double cost(const Configuration&, const Configuration&) const { return 0; }
  double least_cost(const Configuration& configuration) const;
  void order(const Memo& memo, std::vector<int>& robots) const;
  void moves(const Configuration& configuration, int robot, std::vector<int>& found) const;
  bool next(const Configuration& from, const Memo& memo, std::span<const Constraint> said, Configuration& to,
            Memo& grown);
  // What robots have learned since counts, where a configuration is come to again.
  void again(Memo& known, const Memo& newer) const;

  static int point(int where) { return where / 2; }
  static bool visited(int where) { return where % 2 != 0; }
  const MovingTeam& team() const { return team_; }
  const AnnotatedRoadmap& roadmap() const { return *roadmap_; }
  bool all_arrived(const Configuration& configuration) const;
  // Whether a robot has no way to its goal, even alone.
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
  int wish(int robot) const;
  bool due(int robot) const { return memo_->driven[robot] <= memo_->now + 0.5 * pace_; }
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
  bool meets_pinned(int robot, int edge) const;
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
  int horizon_;
  bool settle_;
  double pace_;                                          // metres that a round takes
  double most_radius_;                                   // of all robots
  std::vector<const std::vector<double>*> goal_tables_;  // null without goal

  // The round under way.
  Memo* memo_ = nullptr;
  Configuration places_;
  std::vector<char> visited_;
  std::vector<int> standing_;  // the robot at each point, or -1
  std::vector<char> told_;     // pinned, or told what to do
  std::vector<char> decided_;  // has had its turn, and is not to be moved
  std::vector<char> pending_;  // waits until others have made way for it
  std::vector<Claim> claims_;  // of those who are pending
  std::vector<int> tried_;     // in which attempt a robot was found unable to make way
  int attempt_ = 0;
  std::vector<int> order_;
  std::vector<int> marked_;  // by point: the last time when it was on somebody's way
  int mark_ = 0;

  struct Undo {
    int robot, place, edge;
    double driven;
    char visited, decided;
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
