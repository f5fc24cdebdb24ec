// Which places of a route a ruin takes out [christiaens2020].
#pragma once

#include <algorithm>

#include "random.hpp"

namespace muster {

// Calls `take` for `length` places around `at`, or for all from `from` to before `end`, in one string, or in one with a
// gap.
template <class Take>
void string_around(int at, int length, int from, int end, Random& random, Take take) {
  constexpr double kSplit = 0.5;       // strings that leave a part in between where it is
  constexpr double kLongerGap = 0.01;  // how often that part is longer by one
  const int loose = end - from;
  length = std::min(length, loose);
  int gap = 0;
  if (length < loose && length > 1 && random.uniform() < kSplit) {
    gap = 1;
    while (length + gap < loose && random.uniform() < kLongerGap) ++gap;
  }
  const int span = length + gap;
  const int first_least = std::max(from, at - span + 1), first_most = std::min(at, end - span);
  const int first = first_least + random.below(first_most - first_least + 1);
  const int gap_at = gap ? first + 1 + random.below(length - 1) : first + span;
  for (int k = first; k < first + span; ++k) {
    if (k < gap_at || k >= gap_at + gap) take(k);
  }
}

}  // namespace muster
