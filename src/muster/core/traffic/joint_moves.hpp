// Moves by which all travellers get through their stops, one move after another.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "traffic/annotated_roadmap.hpp"
#include "traffic/roadmap_steps.hpp"
#include "traffic/traveller.hpp"

namespace muster {

// LaCAM [okumura2023] over `RoadmapSteps`. All robots go at once. Where they come no further, one of them goes on alone
// to its next stop while the others only make way, and then all again.
class JointMoves {
 public:
  // `tables` outlives it.
  JointMoves(std::shared_ptr<const AnnotatedRoadmap> roadmap, double margin, RoadmapSteps::Tables& tables)
      : roadmap_(std::move(roadmap)), margin_(margin), tables_(tables) {}

  // Each move is free while all others stand where earlier moves have left them; as far as the search has come. Of
  // travellers at one point the first counts, and others do not move. `ahead`: how many rounds each counts as having
  // waited already. So many expansions that come no nearer to the stops end a search.
  std::vector<SingleMove> moves(const std::vector<Traveller>& travellers, const std::vector<double>& ahead,
                                int expansions, std::uint64_t seed);
  // Configurations times robots that were expanded since this was last called.
  std::int64_t take_expansions() { return std::exchange(expanded_, 0); }

 private:
  bool go_on(MovingTeam& team, bool settle, std::vector<SingleMove>& moves);
  bool lead(MovingTeam& team, std::vector<SingleMove>& moves);

  std::shared_ptr<const AnnotatedRoadmap> roadmap_;
  double margin_;
  RoadmapSteps::Tables& tables_;
  int expansions_ = 0;
  std::uint64_t seed_ = 0;
  std::int64_t expanded_ = 0;
};

}  // namespace muster
