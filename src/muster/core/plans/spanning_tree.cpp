#include "plans/spanning_tree.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace muster {

void spanning_tree(const double* legs, const double* root, const double* p, std::size_t n, double* joined,
                   std::int64_t* parent) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  std::copy(root, root + n, joined);  // the least edge to each task from those that are in the tree
  std::fill(parent, parent + n, -1);
  std::vector<char> outside(n, 1);
  std::size_t nearest = static_cast<std::size_t>(std::min_element(joined, joined + n) - joined);
  for (std::size_t left = n; left > 0 && joined[nearest] < kInfinite; --left) {
    const std::size_t task = nearest;
    const double* from = legs + task * n;
    outside[task] = 0;
    double least = kInfinite;
    for (std::size_t j = 0; j < n; ++j) {
      if (!outside[j]) continue;
      const double leg = from[j] + p[j];
      if (leg < joined[j] - p[task]) {
        joined[j] = leg + p[task];
        parent[j] = static_cast<std::int64_t>(task);
      }
      if (joined[j] < least || least == kInfinite) {
        least = joined[j];
        nearest = j;
      }
    }
  }
}

}  // namespace muster
