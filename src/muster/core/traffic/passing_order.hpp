// The order in which robots pass: their moves in one sequence, carried out by order and not by clock [hoenig2019].
//
// A move is a straight way of one robot. The sequence is such that each move is free while all other robots stand where
// their earlier moves have left them. A robot goes on along its moves as far as it keeps away from what is left of all
// earlier moves of others. So whatever is late delays only who comes later, and nobody waits in a circle.
//
// Moves lead to stops, at which robots do what they are to do. A robot is let go as far as the stop that it is told;
// its later moves stand for what it will do then, so that others can be planned past that stop.
//
// Robots enter a lane that only so many may be on in the order of the sequence, too, each when enough of those before
// it have left. A move that would be one too many in the sequence is not appended: so who waits to enter waits only for
// earlier moves.
#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "paths/lattice.hpp"
#include "traffic/limited_lane.hpp"

namespace muster {

// Metres from a point to a straight segment.
double segment_gap(Point p, Point from, Point to);

// Least metres between two straight segments.
double segment_gap(Point a_from, Point a_to, Point b_from, Point b_to);

class PassingOrder {
 public:
  // `margin`: metres that are left between two robots; `ahead`: metres for which a robot may have begun moves.
  PassingOrder(double margin, double ahead, std::vector<LimitedLane> lanes = {})
      : margin_(margin), ahead_(ahead), lanes_(std::move(lanes)) {}

  // Adds a robot that stands; returns its number.
  int add(Point place, double radius);

  // A robot stands elsewhere than was thought; nothing changes where it has moves.
  void stands(int robot, Point place);

  // Appends a move of a robot from where its moves end. False, and nothing is appended, where another robot would stand
  // in the way, or the move enters a lane on which as many would stand as may be there; one that is too near at the
  // beginning may be left. `stop`: the number, from 0, of the stop to which it leads; `speed`: the greatest on it.
  bool append(int robot, Point to, int stop = 0, double speed = std::numeric_limits<double>::infinity());

  // A robot may go as far as this stop of its moves.
  void lead(int robot, int stop) { bots_[robot].stop = stop; }

  // While a plan is made, only some moves may begin: of each robot those up to its stop that begin within so many
  // metres from where it is, and depend on no other move that may not. Returns the order of these and of the begun
  // moves, with the numbers that they have here: a plan appends its moves to it.
  PassingOrder hold(const std::vector<double>& metres);

  // No plan comes: all moves may begin again.
  void release() { holding_ = false; }

  // The moves of a plan, appended to what `hold` returned, replace those that were not to begin meanwhile.
  void adopt(PassingOrder planned);

  // All moves end where robots have been let go to, and what has not begun is dropped.
  void cut();

  // A robot that has been let go further stands here, for all that is known: its moves are dropped.
  void stop(int robot, Point place);

  // A robot has come so far: it has passed the ends of so many of its moves in all, and is near this place.
  void progress(int robot, int passed, Point near);

  // How far a robot may go now.
  struct Grant {
    std::vector<Point> points;   // ends of moves, the last maybe within one
    std::vector<double> speeds;  // the greatest on the way to each
    int ended;                   // how many of these points are ends of moves
    double metres;               // from where it is
    int waits_for;               // the robot that comes first; -1: none
    bool last;                   // whether all its moves to its stop are granted
  };
  Grant grant(int robot);

  // Where a robot is when all its moves are done.
  Point end(int robot) const { return bots_[robot].end; }
  // Where its stop is.
  Point stand(int robot) const;
  // Moves that a robot has finished since it was added.
  int passed(int robot) const { return bots_[robot].passed; }
  // Metres that a robot has still to go to its stop.
  double metres_left(int robot) const;

 private:
  struct Move {
    int robot = -1;
    Point from{}, to{};
    double length = 0.0;
    double at = 0.0;       // metres that the robot has gone of it
    double granted = 0.0;  // metres to which it has been let go
    bool begun = false;
    bool held = false;  // whether it may begin while a plan is made, which leaves it
    int stop = 0;
    double speed = 0.0;
    std::vector<int> enters;           // lanes, by number
    std::vector<std::size_t> earlier;  // moves of others that come near it or enter a lane that it enters, in order
  };
  struct Bot {
    double radius;
    Point end;
    int passed = 0;                 // moves ended since it was added
    int stop = 0;                   // as far as which it may go
    std::deque<std::size_t> moves;  // unfinished, in order
  };

  const Move& move(std::size_t number) const { return moves_[number - first_]; }
  Move& move(std::size_t number) { return moves_[number - first_]; }
  bool over(std::size_t number) const { return number < first_ || move(number).robot < 0; }
  double apart(int a, int b) const { return bots_[a].radius + bots_[b].radius + margin_; }
  Point place(const Move& m, double at) const;
  void finish_first(Bot& bot);
  void drop_done();
  bool in_the_way(int robot, Point from, Point to) const;
  // To where a robot may go of a move, and who stops it there.
  std::pair<double, int> limit(const Move& m) const;
  // The robot for which a move waits before it begins; -1: none.
  int held_up_by(const Move& m) const;
  std::vector<int> entered(Point from, Point to) const;
  bool enters_one_of(const Move& m, const std::vector<int>& lanes) const;
  // Whether a robot is on a lane, or has begun to enter it.
  bool is_on(const LimitedLane& lane, const Bot& bot) const;
  // Who is first of those on a lane where no more may be; -1: one more may. `on`: whether a robot is there.
  template <class On>
  int first_of_full(int lane, int robot, On on) const;

  // Whether a lane that a move enters is full when all moves are done.
  bool enters_full_lane(const Move& m) const;
  // Drops all moves that have not begun.
  void drop_ahead();
  // Drops the moves of a robot after the last one that `stays`.
  template <class Stays>
  void drop_after(Bot& bot, Stays stays);

  double margin_, ahead_;
  bool holding_ = false;
  std::vector<LimitedLane> lanes_;
  std::vector<Bot> bots_;
  std::deque<Move> moves_;  // finished ones at the front are dropped; a finished one further back has robot -1
  std::size_t first_ = 0;   // the number of the first of them
};

}  // namespace muster
