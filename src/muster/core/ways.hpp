// Shortest ways in a plane with obstacles: Dijkstra and A* over the taut pieces between corners.
#pragma once

#include <memory>
#include <vector>

#include "sights.hpp"

namespace muster {

// The shortest way turns at corners of obstacles only, each time around the obstacle (Lozano-Perez and Wesley 1979; taut:
// Oh and Leong 2017). Places are points in the unit of the sights.
class Ways {
 public:
  explicit Ways(std::shared_ptr<const Sights> sights) : sights_(std::move(sights)) {}

  // Finds what every corner sees, once. Without it each search looks for itself, where it comes by.
  void build(int threads);
  bool built() const { return !first_.empty(); }
  std::size_t corners() const { return sights_->corners().size(); }
  std::size_t pieces() const { return others_.size(); }

  bool free(Point p) const { return sights_->free(sights_->snap(p)); }
  bool sees(Point a, Point b) const { return sights_->sees(sights_->snap(a), sights_->snap(b)); }
  // The shortest way with its ends; empty if there is none.
  std::vector<Point> way(Point from, Point to) const;
  // Row after row from `first` to before `last`: the lengths from exits[i] to all entries; inf where there is no way. If
  // `mutual`, entries are the exits, and row i holds its lengths to the entries after i alone, and 0 to itself.
  std::vector<double> lengths(const std::vector<Point>& exits, const std::vector<Point>& entries, bool mutual, int first,
                              int last, int threads) const;

 private:
  // A place and the corners that see it.
  struct Seat {
    Lattice at;
    Point place;
    bool free;
    std::vector<int> corners;
  };
  struct Tree;
  struct Last {
    double length;
    int corner;  // -1: straight from the place the tree begins at
  };

  Seat seat(Point p) const;
  std::vector<Seat> seats(const std::vector<Point>& places, int first, int threads) const;
  void grow(const Seat& from, const Seat* to, Tree& tree) const;
  void expand(int corner, const Seat& from, const Seat* to, Tree& tree) const;
  Last last_piece(const Seat& from, const Seat& to, const Tree& tree) const;

  std::shared_ptr<const Sights> sights_;
  // What corner c sees with the obstacle on the right is others_[first_[2c]] to before first_[2c + 1], then on the left;
  // the furthest towards the obstacle first.
  std::vector<std::size_t> first_;
  std::vector<int> others_;
};

}  // namespace muster
