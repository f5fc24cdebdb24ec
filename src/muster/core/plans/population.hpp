// The population of the genetic algorithm and its steps ([tcf-thesis], Algorithm 3); of size 1 it is a hill climber.
#pragma once

#include <utility>
#include <vector>

#include "plans/draft.hpp"
#include "plans/operators.hpp"
#include "random.hpp"

namespace muster {

class Population {
 public:
  Population(const Problem& problem, int size, std::uint64_t seed, Bounds bounds = {});

  int size() const { return static_cast<int>(members_.size()); }
  const Draft& member(int k) const { return members_[k]; }
  int best() const;

  void set_random(int k);
  bool set(int k, const Draft& draft);
  // A mutant of another member; that member itself if no admissible mutant was found in a number of tries.
  void set_mutant(int k, int of);

  // Step 4: the worst share of the members gives way to random admissible allocations.
  void replace_worst(double share);
  // Step 5: each member with this probability mutates; an admissible mutant that is better takes its place.
  void mutate(double probability);
  // Step 6: each member with this probability crosses with another; the two best of parents and children stay.
  void cross(double probability);

 private:
  void cross_pair(int n, int k);
  Mutation mutant_of(const Draft& draft);

  const Problem& problem_;
  Bounds bounds_;
  Random random_;
  Evaluator evaluator_;
  RandomAllocation random_allocation_;
  Crossover crossover_;
  std::vector<Draft> members_;
  std::vector<int> ranking_;
  Draft first_child_, second_child_;
};

}  // namespace muster
