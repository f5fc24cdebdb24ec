// The order in which robots pass: their moves in one sequence, carried out by order and not by clock [hoenig2019].
//
// A move is a straight way of one robot. The sequence is such that each move is free while all other robots stand where
// their earlier moves have left them. A robot goes on along its moves as far as it keeps away from what is left of all
// earlier moves of others. So whatever is late delays only who comes later, and nobody waits in a circle.
//
// By its last moves a robot may leave the place to which it was to go. Nobody is let go along these: they stand for what
// it will do when it has done there what it is to do, so that others can be planned past that place.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "lattice.hpp"

namespace muster {

// Metres from a point to a straight segment.
double segment_gap(Point p, Point from, Point to);

// Least metres between two straight segments.
double segment_gap(Point a_from, Point a_to, Point b_from, Point b_to);

class PassingOrder {
 public:
  // `margin`: metres that are left between two robots; `ahead`: metres for which a robot may have begun moves.
  PassingOrder(double margin, double ahead) : margin_(margin), ahead_(ahead) {}

  // Adds a robot that stands; returns its number.
  int add(Point place, double radius);

  // A robot stands elsewhere than was thought; nothing changes where it has moves.
  void stands(int robot, Point place);

  // Appends a move of a robot from where its moves end. False, and nothing is appended, where another robot would stand
  // in the way; one that is too near at the beginning may be left. `leaves`: it leaves the place to which it was to go.
  bool append(int robot, Point to, bool leaves = false);

  // Drops all moves that have not begun.
  void drop_ahead();

  // All moves end where robots have been let go to, and what has not begun is dropped.
  void cut();

  // A robot has come so far: it has passed the ends of so many of its moves in all, and is near this place.
  void progress(int robot, int passed, Point near);

  // How far a robot may go now.
  struct Grant {
    std::vector<Point> points;  // ends of moves, the last maybe within one
    int ended;                  // how many of these points are ends of moves
    double metres;              // from where it is
    int waits_for;              // the robot that comes first; -1: none
    bool last;                  // whether all its moves are granted but those by which it leaves
  };
  Grant grant(int robot);

  // Where a robot is when all its moves are done.
  Point end(int robot) const { return bots_[robot].end; }
  // Where it is before it leaves.
  Point stand(int robot) const;
  // Moves that a robot has finished since it was added.
  int passed(int robot) const { return bots_[robot].passed; }
  // Metres that a robot has still to go before it leaves.
  double metres_left(int robot) const;

 private:
  struct Move {
    int robot;
    Point from, to;
    double length;
    double at = 0.0;       // metres that the robot has gone of it
    double granted = 0.0;  // metres to which it has been let go
    bool begun = false;
    bool leaves = false;
    std::vector<std::size_t> earlier;  // moves of others that come near it, in order
  };
  struct Bot {
    double radius;
    Point end;
    int passed = 0;                 // moves ended since it was added
    std::deque<std::size_t> moves;  // unfinished, in order
  };

  const Move& move(std::size_t number) const { return moves_[number - first_]; }
  Move& move(std::size_t number) { return moves_[number - first_]; }
  bool over(std::size_t number) const { return number < first_ || move(number).robot < 0; }
  double apart(int a, int b) const { return bots_[a].radius + bots_[b].radius + margin_; }
  Point place(const Move& m, double at) const;
  void finish_first(Bot& bot);
  // To where a robot may go of a move, and who stops it there.
  std::pair<double, int> limit(const Move& m) const;

  double margin_, ahead_;
  std::vector<Bot> bots_;
  std::deque<Move> moves_;  // finished ones at the front are dropped; a finished one further back has robot -1
  std::size_t first_ = 0;   // the number of the first of them
};

}  // namespace muster
