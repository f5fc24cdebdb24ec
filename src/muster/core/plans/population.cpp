#include "plans/population.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <stdexcept>

namespace muster {

Population::Population(const Problem& problem, int size, std::uint64_t seed, Bounds bounds)
    : problem_(problem),
      bounds_(bounds),
      random_(seed),
      evaluator_(problem),
      random_allocation_(problem),
      crossover_(problem),
      ranking_(size < 1 ? throw std::invalid_argument("a population needs a member") : size),
      first_child_(problem),
      second_child_(problem) {
  members_.assign(size, Draft(problem));
  for (int k = 0; k < size; ++k) evaluator_.evaluate(members_[k]);
}

int Population::best() const {
  int best = 0;
  for (int k = 1; k < size(); ++k) {
    if (members_[k].value().better_than(members_[best].value())) best = k;
  }
  return best;
}

void Population::set_random(int k) {
  random_allocation_(random_, members_[k]);
  if (evaluator_.evaluate(members_[k])) return;
  members_[k].clear();
  evaluator_.evaluate(members_[k]);
}

bool Population::set(int k, const Draft& draft) {
  Draft copy = draft;
  if (!evaluator_.evaluate(copy)) return false;
  members_[k] = copy;
  return true;
}

// Writes the mutant into the first child.
Mutation Population::mutant_of(const Draft& draft) {
  if (bounds_.scope == Scope::kReceiver && !bounds_.inner) return reassign(problem_, random_, draft, first_child_);
  return reassign_within(problem_, random_, draft, bounds_, first_child_);
}

void Population::set_mutant(int k, int of) {
  constexpr int kTries = 100;
  for (int n = 0; n < kTries; ++n) {
    const Mutation mutation = mutant_of(members_[of]);
    if (mutation.count == 0) continue;
    if (evaluator_.evaluate(first_child_, std::span(mutation.changed, mutation.count))) {
      members_[k] = first_child_;
      return;
    }
  }
  members_[k] = members_[of];
}

void Population::replace_worst(double share) {
  std::iota(ranking_.begin(), ranking_.end(), 0);
  std::ranges::stable_sort(ranking_,
                           [this](int a, int b) { return members_[b].value().better_than(members_[a].value()); });
  const int replaced = static_cast<int>(std::floor(share * size() + 1e-9));
  for (int n = 0; n < replaced; ++n) set_random(ranking_[n]);
}

void Population::mutate(double probability) {
  for (Draft& member : members_) {
    if (random_.uniform() > probability) continue;
    const Mutation mutation = mutant_of(member);
    if (mutation.count == 0) continue;
    if (!evaluator_.evaluate(first_child_, std::span(mutation.changed, mutation.count))) continue;
    if (first_child_.value().better_than(member.value())) std::swap(member, first_child_);
  }
}

void Population::cross(double probability) {
  if (size() < 2) return;
  for (int n = 0; n < size(); ++n) {
    if (random_.uniform() > probability) continue;
    const int k = random_.below(size() - 1);
    cross_pair(n, k + (k >= n ? 1 : 0));
  }
}

void Population::cross_pair(int n, int k) {
  first_child_ = members_[n];
  second_child_ = members_[k];
  if (!crossover_(first_child_, second_child_)) return;
  std::array<Draft*, 4> family{&members_[n], &members_[k], nullptr, nullptr};
  int count = 2;
  if (evaluator_.evaluate(first_child_)) family[count++] = &first_child_;
  if (evaluator_.evaluate(second_child_)) family[count++] = &second_child_;
  // Stable, so that a child takes a parent's place only if it is better.
  std::stable_sort(family.begin(), family.begin() + count,
                   [](const Draft* a, const Draft* b) { return a->value().better_than(b->value()); });
  Draft fittest = *family[0], second = *family[1];
  members_[n] = std::move(fittest);
  members_[k] = std::move(second);
}

}  // namespace muster
