// Moves of all robots that share a roadmap, found together: where ways are not found one after the other.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "traffic/annotated_roadmap.hpp"
#include "traffic/roadmap_steps.hpp"
#include "traffic/safe_intervals.hpp"

namespace muster {

// A sequence of moves that brings each traveller to its first stop, by LaCAM; none where none is found by so many
// expansions. Travellers that are fixed stay.
std::optional<std::vector<SingleMove>> joint_moves(std::shared_ptr<const AnnotatedRoadmap> roadmap,
                                                   const std::vector<Traveller>& travellers, double margin,
                                                   RoadmapSteps::Tables& tables, int expansions, std::uint64_t seed);

// When each move begins that is carried out as soon as all moves before it allow: the ways of the travellers.
std::vector<Way> ways_of(const AnnotatedRoadmap& roadmap, const std::vector<Traveller>& travellers, double margin,
                         const std::vector<SingleMove>& moves);

}  // namespace muster
