// Short ways through the air over and around prisms.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "parallel.hpp"
#include "paths/air.hpp"

namespace muster {

// The shortest way turns on edges of obstacles only. Edges are sampled, the samples that see each other make a graph,
// and the way that is shortest there is pulled straight: its turning points slide along their edges to the minimum,
// which is the only one, for the length is convex in them. Where obstacles are round the graph turns at fewer, looser
// edges a little outside; before it is pulled straight a way is laid around the true ones.
class AirWays {
 public:
  // Upright edges are sampled every `rise` metres, level ones every `run`, ends included.
  AirWays(std::shared_ptr<const Air> air, double rise, double run) : air_(std::move(air)) { sample(rise, run); }

  void build(int threads, const Pause& pause);
  bool built() const { return built_; }
  // Whether ways have looked around as many samples as there are, so that to build pays ([karlin1988]).
  bool graph_pays() const { return looks_ >= samples(); }
  const Air& air() const { return *air_; }
  std::size_t samples() const { return nodes_.size(); }
  // A way with its ends; empty if there is none.
  std::vector<Spot> way(Spot from, Spot to, const Pause& pause) const;
  // The lengths from places[i], `first` <= i < `last`, to all places: of way(i, j). Zero on the diagonal.
  std::vector<double> lengths(const std::vector<Spot>& places, int first, int last, int threads,
                              const Pause& pause) const;

 private:
  struct Node {
    Spot at;
    int edge;
    bool corner;  // where several edges meet: any direction may be taut
  };
  struct Piece {
    int other;
    double length;
  };
  // A place and the nodes that see it.
  struct Seat {
    Spot at;
    bool free;
    std::vector<Piece> nodes;
  };
  struct String;
  struct Tree;

  void sample(double rise, double run);
  bool taut(const Node& node, Spot direction) const { return node.corner || loose_[node.edge].taut(direction); }
  void look_around(std::size_t node, std::size_t& blocker);
  Seat seat(Spot p) const;
  void grow(const Seat& from, Tree& tree) const;
  void grow_towards(const Seat& from, const Seat& to, Tree& tree, const Pause& pause) const;
  std::vector<Spot> way(const Seat& from, const Seat& to, const Tree& tree) const;
  std::vector<int> candidates(const Seat& to, const Tree& tree) const;
  void tighten(std::vector<Spot>& way, std::vector<int>& edges) const;
  void pull(std::vector<Spot>& way, std::vector<int>& edges) const;
  void slide_around(std::vector<Spot>& way, std::vector<int>& edges) const;
  int best_edge_at(Spot turn, int edge, Spot before, Spot after) const;
  bool slide(std::vector<Spot>& way, const std::vector<int>& edges) const;
  bool lay_evenly(std::vector<Spot>& way, const std::vector<int>& edges, std::size_t first, std::size_t last) const;
  bool all_seen(const std::vector<Spot>& way) const;

  std::shared_ptr<const Air> air_;
  std::vector<AirEdge> loose_;  // of which nodes are samples
  std::vector<Node> nodes_;
  std::vector<std::size_t> next_edge_;  // of each node: the first after it on another edge
  std::vector<std::vector<Piece>> pieces_;
  bool built_ = false;
  mutable std::atomic<std::size_t> looks_ = 0;  // around samples, without the graph
};

}  // namespace muster
