// Shortest ways in a plane with obstacles: A* over the taut pieces between corners.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "parallel.hpp"
#include "paths/corner_search.hpp"
#include "paths/sights.hpp"

namespace muster {

// The shortest way turns at corners of obstacles only, each time around the obstacle ([lozano1979];
// taut: [oh2017]). Places are points in the unit of the sights.
//
// One way is searched for without the graph of what corners see. Many are found faster in it. It pays when as many
// corners have been looked around as it has: whatever is asked after that, and even if nothing is, no more than about
// twice the work has been done that was needed ([karlin1988]).
class Ways {
 public:
  explicit Ways(std::shared_ptr<const Sights> sights);

  std::size_t looks() const { return looks_; }
  bool graph_pays() const { return looks_ >= corners(); }
  // Finds what corners see, once, for the next `most` of them; it is built by calls enough.
  void build(int most, int threads);
  bool built() const { return !first_.empty(); }
  std::size_t corners() const { return sights_->corners().size(); }
  std::size_t pieces() const { return pieces_.size(); }

  bool free(Point p) const { return sights_->free(sights_->snap(p)); }
  bool sees(Point a, Point b) const { return sights_->sees(sights_->snap(a), sights_->snap(b)); }
  // The shortest way with its ends; empty if there is none.
  std::vector<Point> way(Point from, Point to) const;
  // The same table as below, whole, way by way without the graph; nothing if that comes to pay before the end.
  std::optional<std::vector<double>> lengths_alone(const std::vector<Point>& exits, const std::vector<Point>& entries,
                                                   bool mutual, const Pause& pause) const;
  // In the graph, which is built: row after row from `first` to before `last`: the lengths from exits[i] to all
  // entries; inf where there is no way. If `mutual`, entries are the exits, and row i holds its lengths to the entries
  // after i alone, and 0 to itself.
  std::vector<double> lengths(const std::vector<Point>& exits, const std::vector<Point>& entries, bool mutual,
                              int first, int last, int threads) const;

 private:
  // A place and the corners that see it, and the parts of the graph that these lie in.
  struct Seat {
    Lattice at;
    Point place;
    bool free;
    std::vector<int> corners;
    std::vector<int> parts;
  };
  class Aims;
  struct Tree;
  struct Last {
    double length;
    int corner;  // -1: straight from the place the tree begins at
  };

  CornerWay way_alone(Point a, Point b) const;
  std::vector<Point> way_in_graph(Point a, Point b) const;
  Seat seat(Point p) const;
  std::vector<Seat> seats(const std::vector<Point>& places, int first, int threads) const;
  void join();
  void sort_by_turn(int corner);
  void find_parts();
  bool may_reach(const Seat& from, const Seat& to) const;
  void grow(const Seat& from, const Aims& aims, Tree& tree) const;
  void fetch(int corner, const Tree& tree) const;
  void expand(int corner, const Seat& from, const Aims& aims, Tree& tree) const;
  Last last_piece(const Seat& to, const Tree& tree) const;

  std::shared_ptr<const Sights> sights_;
  mutable std::atomic<std::size_t> looks_ = 0;  // around corners, without the graph
  // A straight piece to another corner, and whether the obstacle there is to the left of one who comes along it.
  struct Piece {
    std::uint32_t other : 31, on_left : 1;
  };
  // What corner c sees with the obstacle on the right is pieces_[first_[2c]] to before first_[2c + 1], then on the
  // left; the furthest towards the obstacle first.
  std::vector<std::size_t> first_;
  std::vector<Piece> pieces_;
  std::vector<int> part_;               // of each corner: corners in the same part are joined by pieces
  std::vector<std::vector<int>> seen_;  // while it is built: pieces from one of their ends
  // The corners' points once more, in little memory: the search goes to and fro among them.
  struct Small {
    std::int32_t x, y;
    Lattice wide() const { return {x, y}; }
  };
  std::vector<Small> at_;
  std::vector<Point> place_;
};

}  // namespace muster
